"""``tinsmith formats``: what can be read and written."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click

from ..options import console_options
from ..output.console import format_json

if TYPE_CHECKING:
    from ...io import Format
    from ..output.console import Console

__all__ = ["formats"]


@click.command(short_help="List the formats that can be read and written.")
@console_options
def formats(console: Console) -> None:
    """List the formats: what each is, and whether it can be read and written.

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
        "extra": one.extra,
    }


def _draw_table(known: tuple[Format, ...]) -> str:
    from io import StringIO
    from shutil import get_terminal_size

    from rich import box
    from rich.console import Console as RichConsole
    from rich.markup import escape
    from rich.table import Table

    table = Table(box=box.SIMPLE, pad_edge=False, header_style="bold")
    for heading in ("Name", "Read", "Write", "Format", "Suffixes"):
        table.add_column(heading, overflow="fold")
    for one in known:
        table.add_row(
            one.name,
            "yes" if one.read else "-",
            "yes" if one.write else "-",
            escape(one.description + (f" (needs tinsmith[{one.extra}])" if one.extra else "")),
            " ".join(one.suffixes),
        )
    text = StringIO()
    RichConsole(
        file=text, width=get_terminal_size().columns, force_terminal=sys.stdout.isatty()
    ).print(table)
    return "\n".join(line.rstrip() for line in text.getvalue().strip("\n").splitlines())
