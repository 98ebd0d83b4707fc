"""``tinsmith hydroflatten``: flowing water, level from bank to bank and falling downstream."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...command import file_command
from ...job import Job, name_features, surface_options
from ...output import Facts, mesh_counts
from ...parameters import file_option
from ...product_options import product_options


@file_command
@file_option(
    "--stream", "Vector file of polygons: one stream, its islands as holes.", required=True
)
@file_option("--centreline", "Vector file of one line; default that in the middle of the water.")
@product_options(
    "terrain.sections.rivers.flattening.hydroflatten",
    "spacing fit downstream",
    spacing="Longest distance of lines across the water along the centreline.",
    fit="How levels follow the shores: never above the ground there, or by least squares.",
    downstream="Which way the water flows: as the shores fall, along the centreline, or against.",
)
@surface_options()
def hydroflatten(file: Path, stream: Path, centreline: Path | None, job: Job, **asked: Any) -> None:
    """Make a stream in the TIN in FILE, or built from the points in it, level across, and fall.

    At each station of the centreline the water has one level, from shore to shore, which is
    nowhere higher than upstream. Standing water is flattened by --water of "tinsmith build". Notes
    tell which way the water flows, and how far it lies below the ground at the shore.

    Example:
      tinsmith hydroflatten ground.laz --stream river.gpkg --spacing 10 -o flat.gpkg
    """
    from ....terrain import hydroflatten as flatten

    more = [*name_features(stream, "--stream"), *name_features(centreline, "--centreline")]
    planned = job.plan(job.list_inputs(file, more=more), "TIN")
    tin = job.read_tin(file)
    polygons = job.read_features(stream, tin, "polygons")
    line = None
    if centreline is not None:
        line = job.read_features(centreline, tin, "lines", "a centreline is a line")
    with job.step("Flattening") as progress:
        made = flatten(tin, polygons, line, **asked, progress=progress)
    facts = Facts(file)
    facts.add("Read", mesh_counts(tin))
    job.finish_tin(planned, facts, "Flattened", made)
