"""``tinsmith clip``: the part of a surface inside polygons, or outside them."""

from __future__ import annotations

from pathlib import Path

import click

from ...command import file_command
from ...job import Job, name_features, surface_options
from ...output import Facts, mesh_counts
from ...parameters import file_option


@file_command
@file_option("--by", "Vector file of polygons, with holes and in several parts.", required=True)
@click.option("--outside", is_flag=True, help="Keep what is outside of the polygons.")
@surface_options()
def clip(file: Path, by: Path, outside: bool, job: Job) -> None:
    """Keep the part of the TIN in FILE, or built from the points in it, inside polygons.

    The surface does not change: triangles inside stay as they are, those that a polygon crosses are
    divided along it; breaklines end there. --boundary of "tinsmith build" leaves out the points
    outside and triangulates the others anew, so that the surface changes along the boundary.

    Example:
      tinsmith clip site.gpkg --by parcels.geojson -o part.gpkg
      tinsmith clip site.gpkg --by buildings.gpkg --outside -o ground.gpkg
    """
    from ....terrain import clip as clip_tin

    planned = job.plan(job.list_inputs(file, more=name_features(by, "the file of --by")), "TIN")
    tin = job.read_tin(file)
    polygons = job.read_features(by, tin, "polygons")
    with job.step("Clipping") as progress:
        part = clip_tin(tin, polygons, keep="outside" if outside else "inside", progress=progress)
    facts = Facts(file)
    facts.add("Read", mesh_counts(tin))
    job.finish_tin(planned, facts, "Clipped", part)
