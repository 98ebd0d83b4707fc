"""``tinsmith formats``: what can be read and written."""

from __future__ import annotations

import sys
from shutil import get_terminal_size
from typing import TYPE_CHECKING, Any

import click

from ...command import command
from ...format_options import list_flags_of
from ...job import Job, surface_options
from ...options import CONSOLE
from ...output import format_json

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....io import Format

_OF_OUTPUT = (
    "An option of writing is --output-NAME where the command, or the format of its input, has one "
    "of that name."
)


@command
@click.argument("names", metavar="[NAME]...", nargs=-1)
@surface_options(CONSOLE)
def formats(names: tuple[str, ...], job: Job) -> None:
    """List the formats: what each reads and writes, what it needs, and whether that is installed.

    With the NAME or suffix of a format all that is known of it: its options for reading and
    writing, which every command takes that reads or writes such a file, to which digit coordinates
    come back, and what is lost. A TIN is a surface, a Survey points with their lines, Features are
    points, lines or polygons. Formats of plug-ins come last.

    Example:
      tinsmith formats
      tinsmith formats csv gpkg
    """
    from ....io import known_formats

    chosen = known_formats() if not names else _choose(names)
    console = job.console
    if console.as_json:
        console.emit(format_json({"formats": [_describe_format(one) for one in chosen]}))
    elif names:
        console.emit("\n\n".join(map(_describe_in_full, chosen)))
    else:
        console.emit(_draw_table(chosen))


def _choose(names: Sequence[str]) -> tuple[Format, ...]:
    """Return the formats that have one of the names or suffixes."""
    from ....base.errors import FormatError
    from ....base.sentences import suggest
    from ....io.registry import find_formats

    found: list[Format] = []
    for name in names:
        try:
            found += find_formats(name)
        except FormatError as error:
            raise click.UsageError(f"{error}{suggest(name, error.known)}") from error
    return tuple(dict.fromkeys(found))


def _describe_in_full(one: Format) -> str:
    """Return what is known of a format, with the flags of its options."""
    heading = f"{one.name}: {one.description}"
    facts = {
        "Suffixes": " ".join(one.suffixes),
        "Reads": ", ".join(one.reads) if one.read else "",
        "Writes": ", ".join(one.writes) if one.write else "",
        "Needs": _describe_needs(one).replace("\n", ", ") if one.needs else "",
        "Precision": one.precision if one.write else "",
        "Not kept": one.losses if one.write else "",
        "From": "" if one.is_built_in else one.distribution,
    }
    formatter = click.HelpFormatter(width=max(min(get_terminal_size().columns, 100) - 2, 50))
    formatter.write_heading(heading)
    with formatter.indentation():
        formatter.write_dl([(f"{name}:", text) for name, text in facts.items() if text])
    options = list_flags_of(one)
    for heading, records in options.items():
        with formatter.indentation(), formatter.section(heading):
            formatter.write_dl(records)
    if "Writing" in options:
        formatter.write_paragraph()
        with formatter.indentation():
            formatter.write_text(_OF_OUTPUT)
    return formatter.getvalue().rstrip("\n")


def _describe_format(one: Format) -> dict[str, Any]:
    return {
        "name": one.name,
        "description": one.description,
        "suffixes": list(one.suffixes),
        "read": one.read is not None,
        "write": one.write is not None,
        "reads": list(one.reads) if one.read else [],
        "writes": list(one.writes) if one.write else [],
        "precision": one.precision,
        "losses": one.losses,
        "extra": one.extra,
        "needs": one.needs,
        "installed": one.is_installed,
        "options": {
            way: [
                {"name": option.name, "type": option.kind, "text": option.text}
                for option in one.describe_options(way)
            ]
            for way in ("read", "write")
        },
        "from": one.distribution,
    }


def _draw_table(known: tuple[Format, ...]) -> str:
    from io import StringIO

    from rich import box
    from rich.console import Console as RichConsole
    from rich.markup import escape
    from rich.table import Table

    table = Table(box=box.SIMPLE, pad_edge=False, header_style="bold")
    for heading in ("Name", "Reads", "Writes", "Needs", "Format", "Suffixes"):
        table.add_column(heading, overflow="fold", no_wrap=heading not in ("Format", "Suffixes"))
    for one in known:
        table.add_row(
            one.name,
            "\n".join(one.reads) if one.read else "-",
            "\n".join(one.writes) if one.write else "-",
            escape(_describe_needs(one)),
            escape(one.description + ("" if one.is_built_in else f" (plug-in {one.distribution})")),
            " ".join(one.suffixes),
        )
    text = StringIO()
    is_shown = sys.stdout is not None and sys.stdout.isatty()
    RichConsole(file=text, width=get_terminal_size().columns, force_terminal=is_shown).print(table)
    return "\n".join(line.rstrip() for line in text.getvalue().strip("\n").splitlines())


def _describe_needs(one: Format) -> str:
    """Return what a format needs, and whether it is there."""
    if not one.needs:
        return "-"
    return f"{one.needs}\n{'installed' if one.is_installed else 'not installed'}"
