"""``tinsmith paste``: one surface in the place of a part of another."""

from __future__ import annotations

from pathlib import Path

from ...command import command
from ...job import Job, surface_options
from ...output import Facts, mesh_counts
from ...parameters import input_file, output_files


@command
@input_file("base")
@input_file("patch")
@output_files
@surface_options()
def paste(base: Path, patch: Path, job: Job) -> None:
    """Replace a part of the TIN in BASE by the TIN in PATCH.

    Within the boundary of PATCH the surface is that of PATCH, elsewhere that of BASE: a new survey
    in an old one, a design in the ground. Where PATCH extends beyond BASE the surface becomes
    larger, with a note. Either file may hold points, from which the TIN is built. Elevations along
    the seam are those of PATCH.

    Example:
      tinsmith paste sample_data/site_survey.csv sample_data/design_pad.csv --codes -o site.gpkg
    """
    from ....terrain import paste as paste_tin

    files = (base, patch)
    planned = job.plan(job.list_inputs(*files), "TIN")
    surfaces = job.read_tins(files)
    with job.step("Pasting"):
        pasted = paste_tin(*surfaces)
    facts = Facts(*files)
    facts.extend(zip(("Base", "Patch"), map(mesh_counts, surfaces), strict=True))
    job.finish_tin(planned, facts, "Pasted", pasted)
