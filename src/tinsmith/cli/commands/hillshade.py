"""``tinsmith hillshade``: a TIN in the light of a low sun, as a raster."""

from __future__ import annotations

from dataclasses import asdict
from time import perf_counter
from typing import TYPE_CHECKING

import click

from ..options import (
    console_options,
    input_file,
    output_files,
    product_options,
    reading_options,
    triangulating_options,
)
from ..output.console import format_json

if TYPE_CHECKING:
    from pathlib import Path

    from ..options import Reading, Triangulating, Writing
    from ..output.console import Console

__all__ = ["hillshade"]


@click.command(short_help="Shade a TIN by the light of a low sun, as a raster.")
@input_file("file")
@output_files
@click.option(
    "--spacing", metavar="LENGTH", type=float, help="Side of a cell; default a thousandth of it."
)
@click.option(
    "--azimuth",
    metavar="DEGREES",
    type=float,
    default=315.0,
    show_default=True,
    help="Where the light comes from, clockwise from north.",
)
@click.option(
    "--altitude",
    metavar="DEGREES",
    type=float,
    default=45.0,
    show_default=True,
    help="Of the light above the horizon.",
)
@click.option(
    "--exaggeration",
    metavar="FACTOR",
    type=float,
    default=1.0,
    show_default=True,
    help="Vertical exaggeration.",
)
@click.option("--smooth", is_flag=True, help="Let no edges of triangles be seen.")
@reading_options
@triangulating_options
@product_options
@console_options
def hillshade(
    file: Path,
    outputs: tuple[Path, ...],
    spacing: float | None,
    azimuth: float,
    altitude: float,
    exaggeration: float,
    smooth: bool,
    reading: Reading,
    how: Triangulating,
    writing: Writing,
    console: Console,
) -> None:
    """Shade the TIN in FILE, or that of the points in it, and write a raster with a georeference.

    Cells are 1 (no light) to 255, as gdaldem writes them, and 0 where there is no surface.

    \b
    Example:
      tinsmith hillshade sample_data/site_survey.csv --crs EPSG:32616 --spacing 0.5 -o shade.tif
    """  # noqa: D301 - click reads the control character
    from ... import terrain
    from ..files import describe_written, list_inputs, plan_outputs, read_tin, write_outputs

    started = perf_counter()
    planned = plan_outputs(
        outputs, writing, inputs=list_inputs(file, how), console=console, kinds=("Raster",)
    )
    tin, _ = read_tin(file, reading, how, console)
    with console.steps() as steps, steps.step("Shading"):
        made = terrain.hillshade(
            tin,
            spacing=spacing,
            azimuth=azimuth,
            altitude=altitude,
            exaggeration=exaggeration,
            smooth=smooth,
        )
    write_outputs(made, planned, console)
    rows, columns = made.shape
    size = f"{rows:,} rows by {columns:,} columns of {made.grid.spacing:g}"
    console.summarise(
        [
            ("Raster", size),
            *(("Note", note) for note in made.notes),
            ("Written", describe_written(planned)),
            ("Time", f"{perf_counter() - started:.2f} s"),
        ]
    )
    if console.as_json:
        raster = {"shape": list(made.shape), "spacing": made.grid.spacing}
        raster["bounds"] = asdict(made.grid.bounds)
        paths = [str(one.path) for one in planned]
        record = {"input": str(file), "raster": raster, "notes": list(made.notes)}
        console.emit(format_json(record | {"outputs": paths}))
