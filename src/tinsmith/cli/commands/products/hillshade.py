"""``tinsmith hillshade``: a TIN in the light of a low sun, as a raster."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...command import file_command
from ...job import Job, surface_options
from ...output import Facts
from ...product_options import product_options


@file_command
@product_options(
    "terrain.gridding.hillshades.hillshade", "spacing azimuth altitude exaggeration smooth"
)
@surface_options()
def hillshade(file: Path, job: Job, **asked: Any) -> None:
    """Write a georeferenced hillshade raster of the TIN in FILE, or built from the points in it.

    Cells are 1 (no light) to 255, as in gdaldem, and 0 where there is no surface.

    Example:
      tinsmith hillshade sample_data/site_survey.csv --crs EPSG:32616 --spacing 0.5 -o shade.tif
    """
    from .... import terrain
    from ...output import describe_raster_size

    planned = job.plan(job.list_inputs(file), "Raster")
    tin = job.read_tin(file)
    with job.step("Shading"):
        made = terrain.hillshade(tin, **asked)
    planned.write("Raster", made)
    facts = Facts(file)
    grid = made.grid
    raster = {"shape": list(made.shape), "spacing": grid.spacing, "bounds": asdict(grid.bounds)}
    facts.add("Raster", describe_raster_size(made), raster=raster)
    facts.note(made.notes)
    job.finish(planned, facts)
