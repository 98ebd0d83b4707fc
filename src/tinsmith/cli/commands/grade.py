"""``tinsmith grade``: a pad with side slopes, put into the ground."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.sentences import counted
from ..command import file_command
from ..output.failures import Failure
from ..parameters import file_option, number_option
from ..paths import Named
from ..request import surface_options

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain import Table
    from ...tin import TIN
    from ..output.console import Row
    from ..request import Request

__all__ = ["grade"]


@file_command
@file_option("--pad", "Vector file of one polygon: the pad.", required=True)
@number_option(
    "--elevation",
    "ELEVATION",
    "Elevation of the pad, in the unit of the ground; default that of its corners.",
)
@number_option(
    "--cut-slope", "RATIO", "Slope of cuts, horizontal over vertical: 2 is 2:1.", required=True
)
@number_option("--fill-slope", "RATIO", "Slope of fills, horizontal over vertical.", required=True)
@surface_options()
def grade(
    file: Path,
    pad: Path,
    elevation: float | None,
    cut_slope: float,
    fill_slope: float,
    request: Request,
) -> None:
    """Grade a level pad into the TIN in FILE, or built from the points in it.

    Side slopes rise from the edge of the pad in cuts and fall in fills, to the daylight line,
    where they meet the ground. The summary gives cut and fill.

    \b
    Example:
      tinsmith grade sample_data/site_survey.csv --codes --crs EPSG:32616 --pad pad.geojson \\
        --elevation 326 --cut-slope 2 --fill-slope 3 -o graded.gpkg
    """  # noqa: D301 - click reads the control character
    from ...terrain import grade as grade_tin
    from ...terrain import volume

    planned = request.plan(request.list_inputs(file, more=[_name_pad(pad)]), "TIN")
    tin = request.read_tin(file)
    notes: list[str] = []
    ring = _read_pad(pad, tin, elevation, request.how.lines_z_unit, notes)
    with request.step("Grading") as progress:
        graded = grade_tin(
            tin,
            ring,
            elevation,
            cut_slope=cut_slope,
            fill_slope=fill_slope,
            progress=progress,
        )
        table = volume(tin, graded)
    planned.write("TIN", graded)
    notes += table.notes
    rows = _summarise_grading(tin, graded, table, notes)
    request.finish(planned, rows, lambda: _describe_grading(file, graded, table, notes))


def _name_pad(pad: Path) -> Named:
    from ...io.vector.survey_lines import split_layer

    return Named(split_layer(pad)[0], "--pad")


def _read_pad(
    path: Path, tin: TIN, elevation: float | None, z_unit: str | None, notes: list[str]
) -> Any:
    """Return the one ring of a file, in the CRS and unit of the ground."""
    from ...io import read_polygons
    from ...io.vector.survey_lines import split_layer

    file, layer = split_layer(path)
    found = read_polygons(
        file,
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
        z_unit=z_unit,
        layer=layer,
        drape=elevation is not None,
        notes=notes,
    )
    if len(found) != 1 or len(found[0]) != 1:
        rings = sum(map(len, found))
        held = f"{counted(len(found), 'polygon')} of {counted(rings, 'ring')}"
        raise Failure(f"'{file}' holds {held}: a pad is one ring.")
    return found[0][0]


def _summarise_grading(tin: TIN, graded: TIN, table: Table, notes: list[str]) -> list[Row]:
    from ..output.line_summaries import mesh_counts

    unit = table.units.get("cut") or "cubic units of the CRS"
    volumes = [(name.capitalize(), f"{table[name][0]:,.1f} {unit}") for name in ("cut", "fill")]
    counts = [("Ground", mesh_counts(tin)), ("Graded", mesh_counts(graded))]
    return [*counts, *volumes, *(("Note", note) for note in notes)]


def _describe_grading(file: Path, graded: TIN, table: Table, notes: list[str]) -> dict[str, Any]:
    from ..output.summaries import describe_tin

    volumes = {name: float(table[name][0]) for name in ("cut", "fill", "cut_area", "fill_area")}
    return {"input": str(file), "tin": describe_tin(graded), "volume": volumes, "notes": notes}
