"""``tinsmith merge``: surfaces beside each other and over each other as one."""

from __future__ import annotations

from pathlib import Path

import click

from ...command import command
from ...job import Job, surface_options
from ...output import Facts, mesh_counts
from ...parameters import input_files, number_option, output_files


@command
@input_files("files")
@output_files
@number_option(
    "--blend",
    "LENGTH",
    "Width of the strip in which a surface goes over into the one below it, CRS units.",
    default=0.0,
)
@surface_options()
def merge(files: tuple[Path, ...], blend: float, job: Job) -> None:
    """Put the TINs in FILES together to one: where several lie over each other the first counts.

    Each file may hold points, from which its TIN is built. Notes tell how much of each surface lies
    over those after it, how far they are apart along the seam, and of gaps, which are left.

    Example:
      tinsmith merge sample_data/design_pad.csv sample_data/site_survey.csv --codes -o site.gpkg
      tinsmith merge new.gpkg old.gpkg --blend 5 -o merged.gpkg
    """
    from ....terrain import merge as merge_tins

    if len(files) < 2:
        raise click.UsageError("One file is given: two or more are put together.")
    planned = job.plan(job.list_inputs(*files), "TIN")
    surfaces = job.read_tins(files)
    with job.step(f"Merging {len(files)} surfaces") as progress:
        merged = merge_tins(surfaces, blend=blend, progress=progress)
    facts = Facts(inputs=[str(file) for file in files])
    facts.extend((f"Surface {k}", mesh_counts(one)) for k, one in enumerate(surfaces, start=1))
    job.finish_tin(planned, facts, "Merged", merged)
