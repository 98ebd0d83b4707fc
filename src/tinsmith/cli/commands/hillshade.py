"""``tinsmith hillshade``: a TIN in the light of a low sun, as a raster."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

from ..command import file_command
from ..job import surface_options
from ..parameters import number_option, smooth_option

if TYPE_CHECKING:
    from pathlib import Path

    from ..job import Job

__all__ = ["hillshade"]


@file_command
@number_option("--spacing", "LENGTH", "Cell size; default a thousandth of the extent.")
@number_option(
    "--azimuth", "DEGREES", "Direction of the light, clockwise from north.", default=315.0
)
@number_option("--altitude", "DEGREES", "Altitude of the light above the horizon.", default=45.0)
@number_option("--exaggeration", "FACTOR", "Vertical exaggeration.", default=1.0)
@smooth_option
@surface_options()
def hillshade(
    file: Path,
    spacing: float | None,
    azimuth: float,
    altitude: float,
    exaggeration: float,
    smooth: bool | None,
    job: Job,
) -> None:
    """Write a georeferenced hillshade raster of the TIN in FILE, or built from the points in it.

    Cells are 1 (no light) to 255, as in gdaldem, and 0 where there is no surface.

    \b
    Example:
      tinsmith hillshade sample_data/site_survey.csv --crs EPSG:32616 --spacing 0.5 -o shade.tif
    """  # noqa: D301 - click reads the control character
    from ... import terrain
    from ..output.facts import Facts
    from ..output.summaries import describe_raster_size

    planned = job.plan(job.list_inputs(file), "Raster")
    tin = job.read_tin(file)
    with job.step("Shading"):
        made = terrain.hillshade(
            tin,
            spacing=spacing,
            azimuth=azimuth,
            altitude=altitude,
            exaggeration=exaggeration,
            smooth=smooth,
        )
    planned.write("Raster", made)
    raster = {"shape": list(made.shape), "spacing": made.grid.spacing}
    facts = Facts(file)
    facts.add(
        "Raster", describe_raster_size(made), raster=raster | {"bounds": asdict(made.grid.bounds)}
    )
    facts.note(made.notes)
    job.finish(planned, facts)
