"""``tinsmith refine``: a mesh for finite elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.sentences import counted
from ..command import file_command
from ..flags import name_flags
from ..job import surface_options
from ..output.failures import Failure, refuse_option
from ..parameters import number_option

if TYPE_CHECKING:
    from pathlib import Path

    from ...tin import TIN
    from ..job import Job

__all__ = ["refine"]


@file_command
@number_option("--min-angle", "DEGREES", "Smallest angle of a triangle, up to 33.", default=25.0)
@number_option("--max-area", "AREA", "Largest area of a triangle, in CRS units squared.")
@number_option(
    "--max-side",
    "LENGTH",
    "Longest side of a triangle, in CRS units. (--max-edge trims the TIN before.)",
)
@number_option("--max-vertices", "N", "Largest number of vertices.", type=int, default=10_000_000)
@surface_options()
def refine(
    file: Path,
    min_angle: float,
    max_area: float | None,
    max_side: float | None,
    max_vertices: int,
    job: Job,
) -> None:
    """Refine the TIN in FILE, or built from the points in it, for finite elements.

    Points are added until the angles and sizes of all triangles are within the limits. Boundary,
    holes and breaklines are kept, and the new points lie on the surface.

    \b
    Example:
      tinsmith refine sample_data/site_survey.csv --codes --max-area 20 -o site.msh -o site.vtu
    """  # noqa: D301 - click reads the control character
    from ...base.errors import OptionError, TinsmithError
    from ...tin import quality
    from ...tin import refine as refine_tin
    from ...tin.meshing.flips import describe_flips
    from ..output.facts import Facts
    from ..output.line_summaries import mesh_counts
    from ..output.summaries import describe_tin

    planned = job.plan(job.list_inputs(file), "TIN")
    tin = job.read_tin(file)
    _require_lengths(tin, file)
    triangles = counted(len(tin.triangles), "triangle")
    with job.step(f"Refining {triangles}") as progress:
        try:
            refined = refine_tin(
                tin,
                min_angle=min_angle,
                max_area=max_area,
                max_edge=max_side,
                max_vertices=max_vertices,
                threads=job.how.threads,
                progress=progress,
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


def _require_lengths(tin: TIN, file: Path) -> None:
    from ...io.reprojection.transformation import is_geographic

    if is_geographic(tin.crs):
        raise Failure(
            f"'{file}' is in degrees, where angles and areas are not those on the ground: build "
            "the TIN in a projected CRS, such as EPSG:32616."
        )
