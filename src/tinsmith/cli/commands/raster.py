"""``tinsmith raster``: a surface as a raster."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from ...base.sentences import coordinate
from ..command import file_command
from ..job import Job
from ..output.counts import mesh_counts
from ..output.facts import Facts
from ..parameters import file_option
from ..paths import Named
from ..product_options import product_options
from ..tiling import choose_tiles, compute_tiles, describe_points, tell_plan, tiled_options

_RASTERIZE = "terrain.gridding.rasters.rasterize"


@file_command
@product_options(_RASTERIZE, "spacing")
@file_option("--like", "Raster whose cells are used.")
@product_options(
    _RASTERIZE,
    "value method at azimuth altitude smooth",
    value="Value of the cells; slope and aspect in degrees, hillshade from 1 to 255.",
    method="Interpolation between the vertices.",
)
@tiled_options()
def raster(file: Path, spacing: float | None, like: Path | None, job: Job, **asked: Any) -> None:
    """Rasterize the TIN in FILE, or built from the points in it.

    FILE may be a folder of tiles. Cells outside the surface have no data. Points and raster may be
    larger than memory.

    Example:
      tinsmith raster sample_data/site_survey.csv --crs EPSG:32616 --codes
        --spacing 0.5 -o site.tif
    """
    from ...io.raster.cells import read_cells
    from ...terrain import rasterize
    from ..output.summaries import describe_raster_size

    if (spacing is None) == (like is None):
        raise click.UsageError("One of --spacing and --like is needed.")
    more = [] if like is None else [Named(like, "the raster of --like")]
    planned = job.plan(job.list_inputs(file, more=more), "Raster")
    asked |= {"spacing": spacing, "like": None if like is None else read_cells(like)}
    cloud = choose_tiles(job, file)
    if cloud is not None and job.tiling.plan:
        tell_plan(cloud, job, file)
        return
    facts = Facts(file)
    if cloud is not None:
        with compute_tiles(cloud, "raster", planned, job, bounds=cloud.bounds, **asked) as made:
            planned.write("Raster", made)
        facts.add("Points", describe_points(cloud))
    else:
        tin = job.read_tin(file)
        made = rasterize(tin, lazy=True, threads=job.building.threads, **asked)
        planned.write("Raster", made)
        facts.add("Surface", mesh_counts(tin))
    box = made.grid.bounds
    facts.add(
        "Raster",
        describe_raster_size(made),
        rows=made.shape[0],
        columns=made.shape[1],
        spacing=made.grid.spacing,
        bands=list(made.bands),
        crs=None if made.crs is None else str(made.crs),
    )
    place = f"west {coordinate(box.xmin)}, north {coordinate(box.ymax)}"
    facts.add("", place, bounds=asdict(box))
    facts.note(made.notes)
    job.finish(planned, facts)
