"""Options of sheets of paper, which the help of ``plan`` lists."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..parameters import Decorator, parsed, under
from ..product_options import list_product_options

if TYPE_CHECKING:
    from collections.abc import Sequence


@parsed
def _parse_paper(_flag: str, text: str) -> str | tuple[float, float]:
    """Return the name of a paper, or width and height such as 900x600."""
    parts = text.lower().replace("mm", "").split("x")
    try:
        width, height = (float(part) for part in parts)
    except ValueError:
        return text
    return width, height


def sheet_options(names: str) -> Decorator:
    """Return a decorator that adds options of sheets: their names, with blanks between them."""

    def decorate(command: Any) -> Any:
        for option in reversed(under("Sheets", *_list_options(names.split()))):
            command = option(command)
        return command

    return decorate


def _list_options(names: Sequence[str]) -> list[Decorator]:
    own = {
        "scale": click.option(
            "--scale",
            metavar="SCALE",
            help="Scale, such as 500 for 1:500, or '1\"=20 ft'; default the largest usual one with "
            "which everything, or four sections, fit on a sheet.",
        ),
        "paper": click.option(
            "--paper",
            metavar="NAME",
            default="A3",
            show_default=True,
            callback=_parse_paper,
            help="A4 to A0, Letter, Legal, Tabloid, 'ANSI A' to 'ANSI E', 'ARCH A' to 'ARCH E', or "
            "width and height in millimetres such as 900x600.",
        ),
        "title": click.option(
            "--title",
            metavar="TEXT",
            help="Title of what is drawn; default the names of the files.",
        ),
    }
    words = {
        "date": "Date in the title block, as text.",
        "ground_unit": "Unit of eastings and northings, if the CRS is not known.",
    }
    known = "terrain.plans.production.plan"
    return [
        own[name] if name in own else list_product_options(known, name, **words)[0]
        for name in names
    ]
