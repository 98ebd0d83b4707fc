"""``tinsmith convert``: the same points or TIN in another format."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..._sentences import counted
from ..options import console_options, reading_options, writing_options
from ..output.console import format_json
from ..parameters import input_file, output_files
from ..paths import name_file

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
    from ..files import describe_written, list_inputs, plan_outputs, read_input, write_outputs
    from ..output.summaries import note_assumed_unit, summarise_reading

    planned = plan_outputs(outputs, writing, inputs=list_inputs(file), console=console)
    found = read_input(file, reading, console)
    write_outputs(found, planned, console)
    notes = summarise_reading(found)
    if note := note_assumed_unit(found):
        notes = [*notes, ("Elevation", note)]
    read = ("Read", f"{_describe_content(found)} from {name_file(file)}")
    console.summarise([read, *notes, ("Written", describe_written(planned))])
    if console.as_json:
        console.emit(
            format_json({"input": str(file), "outputs": [str(one.path) for one in planned]})
        )


def _describe_content(found: TIN | Survey) -> str:
    from ...tin import TIN

    if isinstance(found, TIN):
        return f"a TIN of {counted(len(found.triangles), 'triangle')}"
    return counted(len(found), "point")
