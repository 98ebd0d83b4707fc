"""``tinsmith convert``: the same points or TIN in another format."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from .console import plain
from .options import (
    console_options,
    input_file,
    output_files,
    reading_options,
    writing_options,
)

if TYPE_CHECKING:
    from pathlib import Path

    from ..tin import TIN, Survey
    from .console import Console
    from .options import Reading, Writing

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
    from ..tin import Survey
    from .facts import file_size, reading_fields, unit_note
    from .files import plan_outputs, read_input, write_outputs

    planned = plan_outputs(outputs, writing, source=file)
    found = read_input(file, reading, console)
    write_outputs(found, planned, console)
    sizes = "\n".join(f"{one.path} ({file_size(one.path)})" for one in planned)
    notes = reading_fields(found) if isinstance(found, Survey) else []
    if note := unit_note(found):
        notes = [*notes, ("Elevation", note)]
    console.summarise([("Read", f"{_what(found)} from {file}"), *notes, ("Written", sizes)])
    if console.as_json:
        console.emit(plain({"input": str(file), "outputs": [str(one.path) for one in planned]}))


def _what(found: TIN | Survey) -> str:
    from ..tin import TIN

    if isinstance(found, TIN):
        return f"a TIN of {len(found.triangles):,} triangles"
    return f"{len(found):,} points"
