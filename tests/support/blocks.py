"""The blocks of code of the pages of the documentation."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]

_BLOCK = re.compile(r"^(`{3,})([^\n`]*)\n(.*?)^\1[ ]*$", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, the line at which it begins."""

    language: str
    text: str
    line: int


def list_pages():
    """Return the pages of the repository: those of docs/, and those that stand elsewhere."""
    elsewhere = ("README.md", "ARCHITECTURE.md", "CHANGELOG.md", "sample_data/README.md")
    elsewhere += ("tests/data/README.md", "tin/cpp/README.md")
    return [*sorted((ROOT / "docs").rglob("*.md")), *(ROOT / name for name in elsewhere)]


def name_page(page):
    """Return the path of a page from the root of the repository."""
    return page.relative_to(ROOT).as_posix()


def read_blocks(page, *languages):
    """Return the blocks of a page that are in these languages; of all where none is given."""
    text = page.read_text(encoding="utf-8")
    blocks = [
        Block(found[2].strip(), found[3], text.count("\n", 0, found.start()) + 1)
        for found in _BLOCK.finditer(text)
    ]
    return [block for block in blocks if not languages or block.language in languages]


def list_commands(page):
    """Return the lines of the blocks for a shell, those that go on below joined."""
    text = "".join(block.text for block in read_blocks(page, "sh", "bash"))
    lines = text.replace("\\\n", " ").splitlines()
    return [line for line in lines if line.strip() and not line.lstrip().startswith("#")]


def list_sessions(page):
    """Return command and expected output of each prompt in the blocks that show a console."""
    found = []
    for block in read_blocks(page, "console"):
        for part in re.split(r"^\$ ", block.text.replace("\\\n", " "), flags=re.MULTILINE)[1:]:
            command, _, output = part.partition("\n")
            found.append((command, output))
    return found


def remove_code(text):
    """Return a page's text without what it shows as code."""
    return re.sub(r"``[^`]+``|`[^`\n]+`", "code", _BLOCK.sub("", text))
