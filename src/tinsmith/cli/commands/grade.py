"""``tinsmith grade``: a pad with side slopes, put into the ground."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...base.sentences import counted
from ..command import file_command
from ..job import Job, name_features, surface_options
from ..output.counts import mesh_counts
from ..output.facts import Facts
from ..output.failures import Failure
from ..parameters import file_option
from ..product_options import product_options


@file_command
@file_option("--pad", "Vector file of one polygon: the pad.", required=True)
@product_options(
    "terrain.earthwork.grading.grades.grade",
    "elevation cut_slope fill_slope",
    cut_slope="Slope of cuts, horizontal over vertical: 2 is 2:1.",
    fill_slope="Slope of fills, horizontal over vertical.",
)
@surface_options()
def grade(file: Path, pad: Path, elevation: float | None, job: Job, **slopes: float) -> None:
    r"""Grade a level pad into the TIN in FILE, or built from the points in it.

    Side slopes rise from the edge of the pad in cuts and fall in fills, to the daylight line,
    where they meet the ground. The summary gives cut and fill.

    Example:
      tinsmith grade sample_data/site_survey.csv --codes --crs EPSG:32616 --pad pad.geojson \
        --elevation 326 --cut-slope 2 --fill-slope 3 -o graded.gpkg
    """
    from ...io import read_polygons
    from ...io.vector.survey_lines import split_layer
    from ...terrain import grade as grade_tin
    from ...terrain import volume

    planned = job.plan(job.list_inputs(file, more=name_features(pad, "--pad")), "TIN")
    tin = job.read_tin(file)
    notes: list[str] = []
    path, layer = split_layer(pad)
    found: Any = read_polygons(
        path,
        crs=tin.crs,
        target_unit=tin.elevation_unit,
        elevation_unit=job.building.lines_elevation_unit,
        layer=layer,
        drape=elevation is not None,
        notes=notes,
    )
    if len(found) != 1 or len(found[0]) != 1:
        rings = sum(map(len, found))
        held = f"{counted(len(found), 'polygon')} of {counted(rings, 'ring')}"
        raise Failure(f"'{path}' holds {held}: a pad is one ring.")
    with job.step("Grading") as progress:
        graded = grade_tin(tin, found[0][0], elevation, **slopes, progress=progress)
        table = volume(tin, graded)
    planned.write("TIN", graded)
    unit = table.units.get("cut") or "cubic units of the CRS"
    volumes = {name: float(table[name][0]) for name in ("cut", "fill", "cut_area", "fill_area")}
    facts = Facts(file)
    facts.add("Ground", mesh_counts(tin))
    facts.add_tin("Graded", graded, volume=volumes)
    for name in ("cut", "fill"):
        facts.add(name.capitalize(), f"{volumes[name]:,.1f} {unit}")
    facts.note([*notes, *table.notes])
    job.finish(planned, facts)
