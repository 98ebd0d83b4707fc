"""``tinsmith refine``: a mesh for finite elements."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ....base.sentences import counted
from ...command import file_command, name_flags
from ...job import Job, surface_options
from ...output import Facts, Failure, mesh_counts, refuse_option
from ...parameters import number_option
from ...product_options import product_options


@file_command
@product_options(
    "tin.meshing.refinement.refine",
    "min_angle max_area",
    min_angle="Smallest angle of a triangle, up to 33.",
)
@number_option(
    "--max-side",
    "LENGTH",
    "Longest side of a triangle, in CRS units. (--max-edge trims the TIN before.)",
)
@number_option("--max-vertices", "N", "Largest number of vertices.", type=int, default=10_000_000)
@surface_options()
def refine(file: Path, max_side: float | None, job: Job, **limits: Any) -> None:
    """Refine the TIN in FILE, or built from the points in it, for finite elements.

    Points are added until the angles and sizes of all triangles are within the limits. Boundary,
    holes and breaklines are kept, and the new points lie on the surface.

    Example:
      tinsmith refine sample_data/site_survey.csv --codes --max-area 20 -o site.msh -o site.vtu
    """
    from ....base.errors import OptionError, TinsmithError
    from ....io.reprojection import is_geographic
    from ....tin import quality
    from ....tin import refine as refine_tin
    from ....tin.meshing import describe_flips
    from ...output import describe_tin

    planned = job.plan(job.list_inputs(file), "TIN")
    tin = job.read_tin(file)
    if is_geographic(tin.crs):
        raise Failure(
            f"'{file}' is in degrees, where angles and areas are not those on the ground: build "
            "the TIN in a projected CRS, such as EPSG:32616."
        )
    triangles = counted(len(tin.triangles), "triangle")
    with job.step(f"Refining {triangles}") as progress:
        try:
            threads = job.building.threads
            refined = refine_tin(
                tin, max_edge=max_side, threads=threads, progress=progress, **limits
            )
        except OptionError as error:  # its max_edge is not --max-edge, which trims
            raise refuse_option(error, max_edge="max_side") from error
        except TinsmithError as error:
            raise Failure(name_flags(str(error), max_edge="--max-side")) from error
    planned.write("TIN", refined)
    shapes = quality(refined)
    least, before = shapes.min_angle.min(), quality(tin).min_angle.min()
    facts = Facts(file)
    facts.add("Read", mesh_counts(tin))
    facts.add(
        "Mesh",
        mesh_counts(refined),
        tin=lambda: describe_tin(refined) | {"quality": shapes.summary()},
        report=refined.report.to_dict,
    )
    facts.add("Angles", f"from {least:.1f}° on, before from {before:.1f}°")
    facts.extend(("", sentence) for sentence in refined.report.unmended.sentences())
    facts.extend(("Note", note) for note in describe_flips(tin))
    job.finish(planned, facts)
