"""``tinsmith convert``: the same points or TIN in another format."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..._sentences import counted
from ..options import console_options, input_file, output_files, reading_options, writing_options
from ..output.console import plain
from ..paths import name_of

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN, Survey
    from ..options import Reading, Writing
    from ..output.console import Console

__all__ = ["convert"]


@click.command(short_help="Write points or a TIN in another format.")
@input_file("file")
@output_files
@reading_options
@writing_options
@console_options
def convert(
    file: Path, outputs: tuple[Path, ...], reading: Reading, writing: Writing, console: Console
) -> None:
    """Write what is in FILE in another format: a TIN as a TIN, points as points.

    To make a TIN of points, use 'tinsmith build'.

    \b
    Example:
      tinsmith convert sample_data/site_survey.csv -o site.xyz
    """  # noqa: D301 - click reads the control character
    from ..files import inputs_of, plan_outputs, read_input, write_outputs, written_text
    from ..output.summaries import reading_fields, unit_note

    planned = plan_outputs(outputs, writing, inputs=inputs_of(file), console=console)
    found = read_input(file, reading, console)
    write_outputs(found, planned, console)
    notes = reading_fields(found)
    if note := unit_note(found):
        notes = [*notes, ("Elevation", note)]
    read = ("Read", f"{_what(found)} from {name_of(file)}")
    console.summarise([read, *notes, ("Written", written_text(planned))])
    if console.as_json:
        console.emit(plain({"input": str(file), "outputs": [str(one.path) for one in planned]}))


def _what(found: TIN | Survey) -> str:
    from ...tin import TIN

    if isinstance(found, TIN):
        return f"a TIN of {counted(len(found.triangles), 'triangle')}"
    return counted(len(found), "point")
