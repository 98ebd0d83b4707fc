"""``tinsmith raster``: a surface as a raster."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from ...base.policies import InterpolationMethod, RasterSample, RasterValue
from ...base.sentences import coordinate
from ..command import file_command
from ..job import surface_options
from ..parameters import choice_option, file_option, number_option, smooth_option
from ..paths import Named
from ..tiling import choose_tiles, compute_tiles, describe_plan, describe_points, tiling_options

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.results import Raster
    from ..job import Job
    from ..output.facts import Facts
    from ..tiling import Tiling

__all__ = ["raster"]


@file_command
@number_option(
    "--spacing", "LENGTH", "Cell size, in CRS units; cells are aligned to its multiples."
)
@file_option("--like", "Raster whose cells are used.")
@choice_option(
    "--value",
    RasterValue,
    "Value of the cells; slope and aspect in degrees, hillshade from 1 to 255.",
    default="elevation",
)
@choice_option(
    "--method", InterpolationMethod, "Interpolation between the vertices.", default="linear"
)
@choice_option(
    "--at",
    RasterSample,
    "Value at the centre of each cell, or mean over the cell.",
    name="sample",
    default="center",
)
@number_option("--azimuth", "DEGREES", "Of the light of hillshade.", default=315.0)
@number_option("--altitude", "DEGREES", "Of the light of hillshade.", default=45.0)
@smooth_option
@tiling_options
@surface_options()
def raster(
    file: Path,
    spacing: float | None,
    like: Path | None,
    job: Job,
    tiling: Tiling,
    **asked: Any,
) -> None:
    """Rasterize the TIN in FILE, or built from the points in it.

    FILE may be a folder of tiles. Cells outside the surface have no data. Points and raster may be
    larger than memory.

    \b
    Example:
      tinsmith raster sample_data/site_survey.csv --crs EPSG:32616 --codes
        --spacing 0.5 -o site.tif
    """  # noqa: D301 - click reads the control character
    from ...io.raster.cells import read_cells
    from ...terrain import rasterize
    from ..output.facts import Facts
    from ..output.line_summaries import mesh_counts

    if (spacing is None) == (like is None):
        raise click.UsageError("One of --spacing and --like is needed.")
    more = [] if like is None else [Named(like, "the raster of --like")]
    planned = job.plan(job.list_inputs(file, more=more), "Raster")
    asked |= {"spacing": spacing, "like": None if like is None else read_cells(like)}
    asked["at"] = asked.pop("sample")
    cloud = choose_tiles(file, job, tiling)
    facts = Facts(file)
    if cloud is not None and tiling.plan:
        describe_plan(cloud, tiling, facts)
        job.console.answer(facts.lines, facts.values)
        return
    if cloud is not None:
        with compute_tiles(cloud, "raster", planned, job, tiling, **asked) as made:
            planned.write("Raster", made)
            facts.add("Points", describe_points(cloud))
            _describe(made, facts)
    else:
        tin = job.read_tin(file)
        made = rasterize(tin, lazy=True, threads=job.how.threads, **asked)
        planned.write("Raster", made)
        facts.add("Surface", mesh_counts(tin))
        _describe(made, facts)
    job.finish(planned, facts)


def _describe(made: Raster, facts: Facts) -> None:
    from ..output.summaries import describe_raster_size

    facts.add(
        "Raster",
        describe_raster_size(made),
        rows=made.shape[0],
        columns=made.shape[1],
        spacing=made.grid.spacing,
        bands=list(made.bands),
        crs=None if made.crs is None else str(made.crs),
    )
    box = made.grid.bounds
    place = f"west {coordinate(box.xmin)}, north {coordinate(box.ymax)}"
    facts.add("", place, bounds=asdict(box))
    facts.note(made.notes)
