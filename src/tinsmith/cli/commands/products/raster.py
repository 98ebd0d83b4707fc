"""``tinsmith raster``: a surface as a raster."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.policies import CellValue
from ....base.sentences import coordinate, counted
from ...command import file_command
from ...job import Job
from ...output import Facts
from ...parameters import choice_option, file_option
from ...paths import Named
from ...point_rasters import PointChoice, point_options
from ...product_options import product_options
from ...tiling import choose_tiles, compute_tiles, describe_points, tiled_options

if TYPE_CHECKING:
    from ....terrain import Raster
    from ....tin import TIN

_RASTERIZE = "terrain.gridding.rasters.rasterize"


@file_command
@product_options(_RASTERIZE, "spacing")
@file_option("--like", "Raster whose cells are used, of any geotransform.")
@choice_option(
    "--value",
    CellValue,
    "Value of the cells: of the surface elevation, slope and aspect in degrees, hillshade from 1 "
    "to 255; of each cell and its neighbours curvatures, ruggedness (tri), topographic position "
    "(tpi), roughness; of points their count, the height of the highest above the surface, or "
    "(canopy) a DSM of the highest, the DTM below and the height between them, as three bands.",
    default="elevation",
)
@product_options(
    _RASTERIZE,
    "method at azimuth altitude smooth operator compute_edges",
    method="Interpolation between the vertices.",
    operator="Compute slope, aspect or hillshade of the elevations of each cell and its eight "
    "neighbours, as gdaldem does, by Horn or Zevenbergen and Thorne; ruggedness by Riley (default) "
    "or Wilson.",
    compute_edges="Values of cells and their neighbours also where neighbours have no elevation, "
    "and at the rim of the raster, as gdaldem's -compute_edges.",
)
@point_options
@tiled_options()
def raster(file: Path, spacing: float | None, like: Path | None, job: Job, **asked: Any) -> None:
    """Rasterize the TIN in FILE, or built from the points in it.

    FILE may be a folder of tiles. Cells outside the surface have no data. Points and raster may be
    larger than memory. For --value height and canopy the surface is that of --classes or
    --find-ground, and all points of FILE but noise are above it, or those of --above.

    Example:
      tinsmith raster sample_data/site_survey.csv --crs EPSG:32616 --codes
        --spacing 0.5 -o site.tif
      tinsmith raster cloud.laz --find-ground --value canopy --spacing 1 -o canopy.tif
    """
    from ....io.raster import read_cells
    from ...output import describe_raster_size

    if (spacing is None) == (like is None):
        raise click.UsageError("One of --spacing and --like is needed.")
    chosen = PointChoice.take(file, job, asked)
    more = [] if like is None else [Named(like, "the raster of --like")]
    planned = job.plan(job.list_inputs(*chosen.files, more=more), "Raster")
    asked |= {"spacing": spacing, "like": None if like is None else read_cells(like)}
    cloud = choose_tiles(job, file, whole=chosen.whole, others=chosen.others)
    facts = Facts(file)
    if cloud is not None:
        asked |= chosen.in_tiles()
        product = {"count": "counts", "height": "point_rasters"}.get(chosen.value, "raster")
        with compute_tiles(cloud, product, planned, job, bounds=cloud.bounds, **asked) as made:
            planned.write("Raster", made)
        facts.add("Points", describe_points(cloud))
    else:
        made, tin, count = chosen.compute(asked) if chosen else _rasterize(file, job, asked)
        planned.write("Raster", made)
        if tin is not None:
            facts.add_surface(tin)
        if count:
            facts.add("Points", counted(count, "point"))
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


def _rasterize(file: Path, job: Job, asked: dict[str, Any]) -> tuple[Raster, TIN, int]:
    from ....terrain import rasterize

    tin = job.read_tin(file)
    return rasterize(tin, lazy=True, threads=job.building.threads, **asked), tin, 0
