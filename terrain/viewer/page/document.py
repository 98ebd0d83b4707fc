"""The page as one file: markup, style, code and data in a text that asks for nothing else."""

from __future__ import annotations

import json
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from ...drawing import PAGE, SAMPLE_FRAME

if TYPE_CHECKING:
    from collections.abc import Mapping


def make_document(content: Mapping[str, Any]) -> str:
    """Return the HTML of a page of what :func:`.content.describe_page` gives.

    Data cannot end its own element or begin another: "<" is written as an escape of JSON, and the
    words of the title as character references. A content security policy in the page forbids every
    request.
    """
    folder = files(__package__)
    text = json.dumps(content, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    parts = {
        "title": escape(content["title"]),
        "subtitle": escape(content["subtitle"]),
        "notes": escape(content["notes"]),
        "colors": _write_colors(),
        "style": folder.joinpath("style.css").read_text("utf-8"),
        "payload": text.replace("<", "\\u003c"),
        "viewer": folder.joinpath("viewer.js").read_text("utf-8"),
    }
    pieces = folder.joinpath("template.html").read_text("utf-8").split("{{")
    filled = [pieces[0]]
    for piece in pieces[1:]:
        name, _, rest = piece.partition("}}")
        filled += [parts[name], rest]
    return "".join(filled)


def _write_colors() -> str:
    """Return the colours of both themes as variables of CSS."""
    themes = ((":root", "light"), (':root[data-theme="dark"]', "dark"))
    rules = [
        f"{selector} {{ {' '.join(f'--{name}: {code};' for name, code in PAGE[theme].items())} }}"
        for selector, theme in themes
    ]
    return "\n".join([f":root {{ --sample: {SAMPLE_FRAME}; }}", *rules])
