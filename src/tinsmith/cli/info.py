"""``tinsmith info``: what is in a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from .options import console_options, input_file, reading_options

if TYPE_CHECKING:
    from pathlib import Path

    from .console import Console
    from .options import Reading

__all__ = ["info"]


@click.command(short_help="Describe a file of points or a TIN.")
@input_file("file")
@reading_options
@console_options
def info(file: Path, reading: Reading, console: Console) -> None:
    """Describe FILE: survey points, an elevation raster or a TIN.

    Counts, extent, elevations and CRS; of a TIN also areas and slopes.

    \b
    Example:
      tinsmith info sample_data/jacksboro.tif
      tinsmith info sample_data/site_survey.csv --crs EPSG:32616 --json
    """  # noqa: D301 - click reads the control character
    from ..tin import TIN
    from .facts import survey_facts, survey_fields, tin_facts, tin_fields
    from .files import read_input

    found = read_input(file, reading, console)
    about = {"input": str(file)}
    if isinstance(found, TIN):
        console.answer([("File", str(file)), *tin_fields(found)], about | tin_facts(found))
    else:
        console.answer([("File", str(file)), *survey_fields(found)], about | survey_facts(found))
