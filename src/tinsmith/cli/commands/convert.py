"""``tinsmith convert``: the same points or TIN in another format."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.sentences import counted
from ..command import file_command
from ..options import console_options, reading_options, writing_options
from ..paths import name_file

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain import Raster
    from ...tin import TIN, Survey
    from ..files import Output
    from ..options import Reading, Writing
    from ..output.console import Console

__all__ = ["convert"]


_KINDS = ("TIN", "Survey", "Raster")
"""What can be written."""


@file_command
@reading_options
@writing_options
@console_options
def convert(
    file: Path, outputs: tuple[Path, ...], reading: Reading, writing: Writing, console: Console
) -> None:
    """Write what is in FILE in another format: a TIN as a TIN, points as points.

    A TIN can also be written as points or features (--kind), and points that are the cells of a
    grid, such as those of a DEM, as a raster. To build a TIN from points, use 'tinsmith build';
    for a raster of another surface 'tinsmith raster'.

    \b
    Example:
      tinsmith convert sample_data/site_survey.csv -o site.xyz
    """  # noqa: D301 - click reads the control character
    from ..files import describe_written, list_inputs, note_found, plan_outputs, read_input
    from ..output.summaries import note_assumed_unit, summarise_reading

    planned = plan_outputs(
        outputs, writing, inputs=list_inputs(file), console=console, kinds=_KINDS
    )
    found = read_input(file, reading, console)
    _write(found, planned, console)
    note_found(found, console)
    notes = summarise_reading(found)
    if note := note_assumed_unit(found):
        notes = [*notes, ("Elevation", note)]
    read = ("Read", f"{_describe_content(found)} from {name_file(file)}")
    console.summarise([read, *notes, ("Written", describe_written(planned))])
    if console.as_json:
        console.emit_record({"input": str(file), "outputs": [str(one.path) for one in planned]})


def _write(found: TIN | Survey, planned: list[Output], console: Console) -> None:
    """Write points as a raster where nothing else can be, everything else as it is."""
    from ...tin import Survey
    from ..files import write_outputs

    rasters = [one for one in planned if {*one.formats} == {"Raster"}]
    if rasters and isinstance(found, Survey):
        raster = _make_raster(found, rasters[0].path)
        write_outputs(found, [one for one in planned if one not in rasters], console)
        write_outputs(raster, rasters, console)
        return
    write_outputs(found, planned, console)


def _make_raster(survey: Survey, path: Path) -> Raster:
    from ...base.errors import PointsError
    from ...io.raster.gridded import make_raster
    from ..output.failures import Failure

    try:
        return make_raster(survey)
    except PointsError as error:
        way = "'tinsmith raster' makes one of their surface."
        raise Failure(f"Cannot write '{path}': {error} {way}") from error


def _describe_content(found: TIN | Survey) -> str:
    from ...tin import TIN

    if isinstance(found, TIN):
        return f"a TIN of {counted(len(found.triangles), 'triangle')}"
    return counted(len(found), "point")
