"""``tinsmith raster``: a surface as a raster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ...base.policies import InterpolationMethod, RasterSample, RasterValue
from ...base.sentences import coordinate
from ..command import file_command
from ..parameters import choice_option, file_option, number_option, smooth_option
from ..paths import Named
from ..request import surface_options

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain import Raster
    from ...tin import TIN
    from ..output.console import Row
    from ..request import Request

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
@surface_options()
def raster(
    file: Path,
    spacing: float | None,
    like: Path | None,
    request: Request,
    **asked: Any,
) -> None:
    """Rasterize the TIN in FILE, or built from the points in it.

    Cells outside the surface have no data. A raster may be larger than memory.

    \b
    Example:
      tinsmith raster sample_data/site_survey.csv --crs EPSG:32616 --codes
        --spacing 0.5 -o site.tif
    """  # noqa: D301 - click reads the control character
    from ...io.raster.cells import read_cells

    if (spacing is None) == (like is None):
        raise click.UsageError("One of --spacing and --like is needed.")
    more = [] if like is None else [Named(like, "the raster of --like")]
    planned = request.plan(request.list_inputs(file, more=more), "Raster")
    cells = None if like is None else read_cells(like)
    tin = request.read_tin(file)
    made = _rasterize(tin, spacing, cells, request.how.threads, asked)
    planned.write("Raster", made)
    request.finish(planned, _summarise_raster(tin, made), lambda: _describe_raster(file, made))


def _rasterize(
    tin: TIN, spacing: float | None, cells: Any, threads: int | None, asked: dict[str, Any]
) -> Raster:
    from ...terrain import rasterize

    return rasterize(
        tin,
        spacing=spacing,
        like=cells,
        value=asked["value"],
        method=asked["method"],
        at=asked["sample"],
        smooth=asked["smooth"],
        azimuth=asked["azimuth"],
        altitude=asked["altitude"],
        lazy=True,
        threads=threads,
    )


def _summarise_raster(tin: TIN, made: Raster) -> list[Row]:
    from ..output.line_summaries import mesh_counts
    from ..output.summaries import describe_raster_size

    box = made.grid.bounds
    return [
        ("Surface", mesh_counts(tin)),
        ("Raster", describe_raster_size(made)),
        ("", f"west {coordinate(box.xmin)}, north {coordinate(box.ymax)}"),
        *(("Note", note) for note in made.notes),
    ]


def _describe_raster(file: Path, made: Raster) -> dict[str, Any]:
    from dataclasses import asdict

    return {
        "input": str(file),
        "rows": made.shape[0],
        "columns": made.shape[1],
        "spacing": made.grid.spacing,
        "bounds": asdict(made.grid.bounds),
        "bands": list(made.bands),
        "crs": None if made.crs is None else str(made.crs),
        "notes": list(made.notes),
    }
