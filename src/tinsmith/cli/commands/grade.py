"""``tinsmith grade``: a pad with side slopes, put into the ground."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.sentences import counted
from ..command import file_command
from ..inputs import name_features
from ..job import surface_options
from ..output.failures import Failure
from ..parameters import file_option, number_option

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN
    from ..job import Job

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
    job: Job,
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
    from ..output.facts import Facts
    from ..output.line_summaries import mesh_counts
    from ..output.summaries import describe_tin

    planned = job.plan(job.list_inputs(file, more=name_features(pad, "--pad")), "TIN")
    tin = job.read_tin(file)
    notes: list[str] = []
    ring = _read_pad(pad, tin, elevation, job.how.lines_elevation_unit, notes)
    with job.step("Grading") as progress:
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
    unit = table.units.get("cut") or "cubic units of the CRS"
    volumes = {name: float(table[name][0]) for name in ("cut", "fill", "cut_area", "fill_area")}
    facts = Facts(file)
    facts.add("Ground", mesh_counts(tin))
    facts.add("Graded", mesh_counts(graded), tin=lambda: describe_tin(graded), volume=volumes)
    for name in ("cut", "fill"):
        facts.add(name.capitalize(), f"{volumes[name]:,.1f} {unit}")
    facts.note([*notes, *table.notes])
    job.finish(planned, facts)


def _read_pad(
    path: Path, tin: TIN, elevation: float | None, elevation_unit: str | None, notes: list[str]
) -> Any:
    """Return the one ring of a file, in the CRS and unit of the ground."""
    from ...io import read_polygons
    from ...io.vector.survey_lines import split_layer

    file, layer = split_layer(path)
    found = read_polygons(
        file,
        crs=tin.crs,
        target_unit=tin.elevation_unit,
        elevation_unit=elevation_unit,
        layer=layer,
        drape=elevation is not None,
        notes=notes,
    )
    if len(found) != 1 or len(found[0]) != 1:
        rings = sum(map(len, found))
        held = f"{counted(len(found), 'polygon')} of {counted(rings, 'ring')}"
        raise Failure(f"'{file}' holds {held}: a pad is one ring.")
    return found[0][0]
