"""Figures of the structure of checkouts, side by side: what is large, and what is carried.

``python -m benchmarks.structure [CHECKOUT]...``: each a folder (default this one), or a commit of
this repository. A room is a package below tin, terrain, io, cli or base, or a module beside it.
"""

from __future__ import annotations

import ast
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path

from .report.tables import TEXT, Table

ROOT = Path(__file__).parents[1]
AREAS = ("tin", "terrain", "io", "tiled", "cli", "base")
FOLDERS = {"tin": "tin", "terrain": "terrain", "io": "io", "": "src/tinsmith"}
PARAMETERS = ("crs", "elevation_unit", "interval", "path")
MOST_POSITIONAL = 4

_FIRST = """
import sys
sys.meta_path[:] = [one for one in sys.meta_path if "ScikitBuild" not in type(one).__name__]
sys.path.insert(0, {folder!r})
"""
_COUNT_OPTIONS = """
import re
from click.testing import CliRunner
from tinsmith.cli import main
from tinsmith.cli.command_list import SUMMARIES
count = 0
for name in SUMMARIES:
    text = CliRunner().invoke(main, [name, "--help"], terminal_width=300).output
    options = re.findall(r"^  (?:-\\w, )?--[a-z-]+", text, re.MULTILINE)
    count += len(options) - sum(one.endswith("--help") for one in options)
print(count)
"""


@dataclass
class Figures:
    """What is counted of one checkout."""

    lines: Counter[str] = field(default_factory=Counter)
    arrows: dict[str, set[tuple[str, str]]] = field(default_factory=lambda: defaultdict(set))
    past_a_face: list[tuple[str, str]] = field(default_factory=list)
    functions: int = 0
    called_once: int = 0
    splinters: list[str] = field(default_factory=list)
    longest: int = 0
    carriers: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    with_path: int = 0

    @property
    def rows(self) -> list[tuple[str, str]]:
        """Labels and figures."""
        total = sum(self.lines.values())
        shares = ", ".join(f"{area} {self.lines[area]:,}" for area in AREAS)
        found = [("lines of Python in the product", f"{total:,} ({shares})")]
        found += [
            (f"arrows between rooms of {area}", f"{len(self.arrows[area])}")
            for area in ("the whole", *AREAS)
        ]
        found += [
            ("imports past a package's face", f"{len(self.past_a_face):,}"),
            ("functions", f"{self.functions:,}"),
            ("private functions called once", f"{self.called_once:,}"),
            (f"of them with more than {MOST_POSITIONAL} positional", f"{len(self.splinters):,}"),
            ("lines of the longest function", f"{self.longest}"),
            ("functions of io that take a path", f"{self.with_path}"),
        ]
        found += [
            (f"files with functions that take {name}", f"{len(self.carriers[name])}")
            for name in PARAMETERS
        ]
        return found


def measure(root: Path) -> Figures:
    """Count what a checkout holds."""
    found = Figures()
    modules = {
        module: path
        for start, folder in FOLDERS.items()
        for path in (root / folder).rglob("*.py")
        for module in [_name_module(start, path.relative_to(root / folder))]
    }
    packages = {name for name, path in modules.items() if path.name == "__init__.py"}
    for module, path in modules.items():
        text = path.read_text()
        found.lines[_find_area(module)] += text.count("\n")
        nodes = list(ast.walk(ast.parse(text)))
        _count_functions(nodes, module, found)
        is_package = module in packages
        for target in _list_imports(nodes, module, is_package, modules):
            _count_import(module, target, packages, found)
    return found


def _name_module(start: str, path: Path) -> str:
    parts = [*path.with_suffix("").parts]
    if parts[-1] == "__init__":
        parts.pop()
    return ".".join([start, *parts] if start else parts)


def _find_area(module: str) -> str:
    first = module.split(".")[0]
    return first if first in AREAS else "base"


def _list_imports(nodes, module, is_package, modules):
    """Yield the modules that a module imports from its own project."""
    for node in nodes:
        if not isinstance(node, ast.ImportFrom):
            continue
        if node.level:
            parts = module.split(".") if module else []
            up = node.level - is_package
            base = parts[: len(parts) - up] if up else parts
            target = ".".join([*base, *(node.module or "").split(".")]).strip(".")
        elif (node.module or "").startswith("tinsmith"):
            target = node.module.removeprefix("tinsmith").strip(".")
        else:
            continue
        inner = [f"{target}.{one.name}".strip(".") for one in node.names]
        yield from (one for one in inner if one in modules)
        if target in modules and any(one not in modules for one in inner):
            yield target


def _count_import(module, target, packages, found):
    own, other = module.split("."), target.split(".")
    if not module or not target:
        return
    if own[0] != other[0]:
        found.arrows["the whole"].add((_find_area(module), _find_area(target)))
    elif own[1:2] != other[1:2]:
        found.arrows[_find_area(module)].add((".".join(own[:2]), ".".join(other[:2])))
    package = ".".join(other[:-1])
    is_face = target in packages
    if not is_face and package not in ("", *AREAS) and not module.startswith(package):
        found.past_a_face.append((module, target))


def _count_functions(nodes, module, found):
    used = Counter(
        getattr(node, "id", getattr(node, "attr", None))
        for node in nodes
        if isinstance(node, ast.Name | ast.Attribute)
    )
    for node in nodes:
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        found.functions += 1
        body = node.body[1:] if ast.get_docstring(node, clean=False) is not None else node.body
        found.longest = max(found.longest, body[-1].end_lineno - body[0].lineno + 1 if body else 0)
        positional = [one.arg for one in (*node.args.posonlyargs, *node.args.args)]
        positional = [name for name in positional if name not in ("self", "cls")]
        names = {*positional, *(one.arg for one in node.args.kwonlyargs)}
        for name in names & {*PARAMETERS}:
            found.carriers[name].add(module)
        found.with_path += _find_area(module) == "io" and "path" in names
        is_private = node.name.startswith("_") and not node.name.startswith("__")
        if is_private and used[node.name] == 1:
            found.called_once += 1
            if len(positional) > MOST_POSITIONAL:
                found.splinters.append(f"{module}.{node.name}")


def count_options(root: Path) -> str:
    """Return how many options the helps of all commands list; "-" if they do not run, with why."""
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder) / "tinsmith"
        package.mkdir()
        for path in (root / "src/tinsmith").iterdir():
            (package / path.name).symlink_to(path)
        for name in ("tin", "terrain", "io"):
            (package / name).symlink_to(root / name)
        program = _FIRST.format(folder=folder) + _COUNT_OPTIONS
        done = subprocess.run(
            [_find_python(), "-c", program], capture_output=True, text=True, check=False
        )
    last = done.stdout.strip().rpartition("\n")[2]
    if done.returncode == 0 and last.isdecimal():
        return last
    why = done.stderr.strip().rpartition("\n")[2] or f"exit code {done.returncode}"
    print(f"The commands of {root} do not run: {why}", file=sys.stderr)
    return "-"


def _find_python() -> str:
    """Return an interpreter that has what commands import: this one, or that of the checkout."""
    own = ROOT / ".venv/bin/python"
    return sys.executable if find_spec("click") or not own.exists() else str(own)


def main(places: list[str]) -> None:
    """Print the figures of checkouts beside each other."""
    columns = []
    with tempfile.TemporaryDirectory() as folder:
        for number, place in enumerate(places or ["."]):
            root = Path(place).resolve()
            if not root.is_dir():
                root = Path(folder) / str(number)
                root.mkdir()
                archive = ["git", "-C", str(ROOT), "archive", place, *FOLDERS.values()]
                packed = subprocess.run(archive, capture_output=True, check=True).stdout
                subprocess.run(["tar", "-x", "-C", str(root)], input=packed, check=True)
            columns.append([*measure(root).rows, ("options in all helps", count_options(root))])
    table = Table(dict.fromkeys(("", *(places or ["."])), TEXT))
    for rows in zip(*columns, strict=True):
        table.show(rows[0][0], *(value for _, value in rows))


if __name__ == "__main__":
    main(sys.argv[1:])
