"""``tinsmith drape``: points, lines and polygons of a file get the surface's elevations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ....base.sentences import counted
from ...command import command
from ...job import Job, name_features
from ...output import Facts, mesh_counts
from ...parameters import input_file, output_files
from ...paths import LINES
from ...product_options import product_options
from ...tiling import choose_tiles, compute_tiles, describe_points, tiled_options


@command
@input_file("file")
@input_file("features", LINES)
@output_files
@product_options("terrain.sections.draping.drape", "outside")
@tiled_options()
def drape(file: Path, features: Path, outside: Any, job: Job) -> None:
    """Drape the FEATURES of a vector file on the TIN in FILE, or built from the points in it.

    Lines and polygons get a vertex wherever they cross an edge of the TIN; columns are kept.
    FEATURES in another CRS are reprojected; FILE:LAYER names a layer.

    Example:
      tinsmith drape site.ply roads.gpkg --outside cut -o roads_3d.gpkg
    """
    from ....terrain import drape as drape_features

    inputs = job.list_inputs(file, more=name_features(features, "the file of features"))
    planned = job.plan(inputs, "Features")
    cloud = choose_tiles(job, file)
    if cloud is not None:
        given = job.read_features(features, cloud)
        asked = {"features": given, "outside": outside}
        with compute_tiles(cloud, "drape", planned, job, **asked) as draped:
            planned.write("Features", draped)
        surface = describe_points(cloud)
    else:
        tin = job.read_tin(file)
        with job.step("Draping"):
            given = job.read_features(features, tin)
            draped = drape_features(tin, given, outside=outside)
        planned.write("Features", draped)
        surface = mesh_counts(tin)
    facts = Facts(file)
    facts.add("Surface", surface, features=str(features))
    before, after = len(given.coordinates), len(draped.coordinates)
    facts.add(
        "Draped",
        f"{counted(len(draped), 'feature')} of {len(given):,} ({draped.kind}), {before:,} to "
        f"{counted(after, 'vertex', 'vertices')}",
        kind=draped.kind,
        given=len(given),
        draped=len(draped),
        vertices_given=before,
        vertices_draped=after,
    )
    facts.note(draped.notes)
    job.finish(planned, facts)
