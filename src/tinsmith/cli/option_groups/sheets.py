"""Options of sheets of paper, which the help of ``plan`` lists."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from ...base.sentences import counted
from ..parameters import Decorator, file_option, parsed, under
from ..paths import Named
from ..product_options import list_product_options

if TYPE_CHECKING:
    from collections.abc import Container, Sequence
    from pathlib import Path

    from ...terrain import ProfileSheets, SectionSheets
    from ..output import Facts
    from ..outputs import Products


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


def name_title_block(path: Path | None) -> list[Named]:
    """Return the file of a title block and that of its logo, for the list of inputs."""
    if path is None:
        return []
    from ...terrain.plans import find_logo

    logo = find_logo(path)
    named = [Named(path, "the file of --title-block")]
    return named if logo is None else [*named, Named(logo, "the logo of --title-block")]


def take_sheets(
    asked: dict[str, Any], planned: Products, names: Sequence[str], what: str
) -> dict[str, Any]:
    """Take what sheets are asked for; refuse it where there are none."""
    from ..outputs import list_document_suffixes

    sheets = {name: asked.pop(name) for name in names}
    if not planned.holds("sheets"):
        context = click.get_current_context()
        for name in names:
            if context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
                flag = f"--{name.replace('_', '-')}"
                suffixes = ", ".join(list_document_suffixes("sheets"))
                raise click.UsageError(
                    f"{flag} is for {what}: name a file that ends in {suffixes}."
                )
    return sheets


def add_sheets(facts: Facts, drawn: SectionSheets | ProfileSheets, told: Container[str]) -> None:
    """Add what was drawn, and notes that are not told already."""
    facts.add("Scale", drawn.scale_text, scale=drawn.scale)
    many = counted(len(drawn), "sheet")
    facts.add("Sheets", f"{many}, {drawn.paper_name}", paper=list(drawn.paper), sheets=len(drawn))
    facts.note(note for note in drawn.notes if note not in told)


def _list_options(names: Sequence[str]) -> list[Decorator]:
    own: dict[str, Decorator] = {
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
        "title_block": file_option(
            "--title-block",
            "TOML file with what the office writes in its title block: company, client, project, "
            "drawing number, names, revisions, logo.",
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
