"""``tinsmith raster``: a surface as a raster."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any, get_args

import click

from ...policies import InterpolationMethod, RasterSample, RasterValue
from ..options import (
    console_options,
    input_file,
    output_files,
    reading_options,
    triangulating_options,
)
from ..output.console import format_json
from ..paths import LINES, Named

if TYPE_CHECKING:
    from pathlib import Path

    from ...terrain import Raster
    from ...tin import TIN
    from ..files import Output
    from ..options import Reading, Triangulating
    from ..output.console import Console

__all__ = ["raster"]


@click.command(short_help="Turn a surface into a raster: elevation, slope, aspect, hillshade.")
@input_file("file")
@output_files
@click.option(
    "--spacing",
    metavar="LENGTH",
    type=float,
    help="Side of a cell, CRS units; cells are aligned to its multiples.",
)
@click.option("--like", metavar="FILE", type=LINES, help="Raster whose cells are taken.")
@click.option(
    "--value",
    type=click.Choice(get_args(RasterValue)),
    default="elevation",
    show_default=True,
    help="What the cells hold; slope and aspect in degrees, hillshade from 1 to 255.",
)
@click.option(
    "--method",
    type=click.Choice(get_args(InterpolationMethod)),
    default="linear",
    show_default=True,
    help="What lies between the vertices.",
)
@click.option(
    "--at",
    "sample",
    type=click.Choice(get_args(RasterSample)),
    default="center",
    show_default=True,
    help="The value at the centre of each cell, or its mean.",
)
@click.option(
    "--azimuth",
    metavar="DEGREES",
    type=float,
    default=315.0,
    show_default=True,
    help="Of the light of hillshade.",
)
@click.option(
    "--altitude",
    metavar="DEGREES",
    type=float,
    default=45.0,
    show_default=True,
    help="Of the light of hillshade.",
)
@click.option("--output-format", metavar="NAME", help="Format of the output, whatever its suffix.")
@reading_options
@triangulating_options
@console_options
def raster(
    file: Path,
    outputs: tuple[Path, ...],
    spacing: float | None,
    like: Path | None,
    output_format: str | None,
    reading: Reading,
    how: Triangulating,
    console: Console,
    **asked: Any,
) -> None:
    """Turn the TIN in FILE, or that of the points in it, into a raster.

    Cells outside the surface have no data. A raster may be larger than memory.

    \b
    Example:
      tinsmith raster sample_data/site_survey.csv --crs EPSG:32616 --codes
        --spacing 0.5 -o site.tif
    """  # noqa: D301 - click reads the control character
    from ...io.raster.cells import read_cells
    from ..files import list_inputs, plan_outputs, read_tin, write_outputs
    from ..options import Writing

    if (spacing is None) == (like is None):
        raise click.UsageError("One of --spacing and --like is needed.")
    started = perf_counter()
    inputs = list_inputs(file, how)
    if like is not None:
        inputs.append(Named(like, "the raster of --like"))
    writing = Writing(output_format=output_format)
    planned = plan_outputs(outputs, writing, inputs=inputs, console=console, kinds=("Raster",))
    cells = None if like is None else read_cells(like)
    tin, _ = read_tin(file, reading, how, console)
    made = _rasterize(tin, spacing, cells, how.threads, asked)
    write_outputs(made, planned, console)
    _tell(tin, made, planned, started, console)
    if console.as_json:
        console.emit(format_json(_as_record(file, made, planned)))


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
        azimuth=asked["azimuth"],
        altitude=asked["altitude"],
        lazy=True,
        threads=threads,
    )


def _tell(tin: TIN, made: Raster, planned: list[Output], started: float, console: Console) -> None:
    from ..files import describe_written
    from ..output.line_summaries import mesh_counts

    rows, columns = made.shape
    box = made.grid.bounds
    console.summarise(
        [
            ("Surface", mesh_counts(tin)),
            ("Raster", f"{rows:,} rows by {columns:,} columns of {made.grid.spacing:g}"),
            ("", f"west {box.xmin:.10g}, north {box.ymax:.10g}"),
            *(("Note", note) for note in made.notes),
            ("Written", describe_written(planned)),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )


def _as_record(file: Path, made: Raster, planned: list[Output]) -> dict[str, Any]:
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
        "outputs": [str(one.path) for one in planned],
    }
