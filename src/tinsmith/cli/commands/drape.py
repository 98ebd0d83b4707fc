"""``tinsmith drape``: points, lines and polygons of a file get the surface's elevations."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...base.policies import OutsidePolicy
from ..command import command
from ..inputs import name_features, read_features
from ..job import surface_options
from ..parameters import choice_option, input_file, output_files
from ..paths import LINES

if TYPE_CHECKING:
    from ...terrain import Features
    from ..job import Job

__all__ = ["drape"]


@command
@input_file("file")
@input_file("features", LINES)
@output_files
@choice_option(
    "--outside",
    OutsidePolicy,
    "Parts outside the surface: refuse, keep without elevations, or leave out.",
    default="error",
)
@surface_options()
def drape(
    file: Path,
    features: Path,
    outside: str,
    job: Job,
) -> None:
    """Drape the FEATURES of a vector file on the TIN in FILE, or built from the points in it.

    Lines and polygons get a vertex wherever they cross an edge of the TIN; columns are kept.
    FEATURES in another CRS are reprojected; FILE:LAYER names a layer.

    \b
    Example:
      tinsmith drape site.ply roads.gpkg --outside cut -o roads_3d.gpkg
    """  # noqa: D301 - click reads the control character
    from ...terrain import drape as drape_features
    from ..output.facts import Facts
    from ..output.line_summaries import mesh_counts

    inputs = job.list_inputs(file, more=name_features(features, "the file of features"))
    planned = job.plan_products(inputs, "Features")
    tin = job.read_tin(file)
    with job.step("Draping"):
        given = read_features(features, tin)
        draped = drape_features(tin, given, outside=outside)  # type: ignore[arg-type]
    planned.write("Features", draped)
    facts = Facts(file)
    facts.add("Surface", mesh_counts(tin), features=str(features))
    facts.add(
        "Draped",
        _count_draped(given, draped),
        kind=draped.kind,
        given=len(given),
        draped=len(draped),
        vertices_given=len(given.coordinates),
        vertices_draped=len(draped.coordinates),
    )
    facts.note(draped.notes)
    job.finish(planned, facts)


def _count_draped(given: Features, draped: Features) -> str:
    from ...base.sentences import counted

    vertices = (
        f"{len(given.coordinates):,} to {counted(len(draped.coordinates), 'vertex', 'vertices')}"
    )
    return f"{counted(len(draped), 'feature')} of {len(given):,} ({draped.kind}), {vertices}"
