"""``tinsmith formats``: what can be read and written."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from ..options import console_options
from ..output.console import format_json
from ..parameters import command

if TYPE_CHECKING:
    from ...io import Format
    from ..output.console import Console

__all__ = ["formats"]


@command
@console_options
def formats(console: Console) -> None:
    """List the formats: what each reads and writes, what it needs, and whether that is installed.

    A TIN is a surface, a Survey points with their lines, Features are points, lines or polygons.
    Formats of plug-ins come last. docs/formats.md describes what each format keeps.

    \b
    Example:
      tinsmith formats
    """  # noqa: D301 - click reads the control character
    from ...io import known_formats

    if console.as_json:
        console.emit(format_json({"formats": [_describe_format(one) for one in known_formats()]}))
    else:
        console.emit(_draw_table(known_formats()))


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
        "from": one.distribution,
    }


def _draw_table(known: tuple[Format, ...]) -> str:
    from io import StringIO
    from shutil import get_terminal_size

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
