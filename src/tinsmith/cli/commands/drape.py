"""``tinsmith drape``: points, lines and polygons of a file get the surface's elevations."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...base.policies import OutsidePolicy
from ..command import command
from ..parameters import choice_option, input_file, output_files
from ..paths import LINES, Named
from ..request import surface_options

if TYPE_CHECKING:
    from ...terrain import Features
    from ..request import Request

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
    request: Request,
) -> None:
    """Drape the FEATURES of a vector file on the TIN in FILE, or built from the points in it.

    Lines and polygons get a vertex wherever they cross an edge of the TIN; columns are kept.
    FEATURES in another CRS are reprojected; FILE:LAYER names a layer.

    \b
    Example:
      tinsmith drape site.ply roads.gpkg --outside cut -o roads_3d.gpkg
    """  # noqa: D301 - click reads the control character
    from ...io.vector.geometries import read_geometries
    from ...io.vector.survey_lines import split_layer
    from ...terrain import drape as drape_features
    from ..output.line_summaries import mesh_counts

    path, layer = split_layer(features)
    inputs = request.list_inputs(file, more=[Named(path, "the file of features")])
    planned = request.plan_products(inputs, "Features")
    tin = request.read_tin(file)
    with request.step("Draping"):
        given = read_geometries(path, crs=tin.crs, layer=layer)
        draped = drape_features(tin, given, outside=outside)  # type: ignore[arg-type]
    planned.write("Features", draped)
    rows = [
        ("Surface", mesh_counts(tin)),
        ("Draped", _count_draped(given, draped)),
        *[("Note", note) for note in draped.notes],
    ]
    record = {
        "input": str(file),
        "features": str(features),
        "kind": draped.kind,
        "given": len(given),
        "draped": len(draped),
        "vertices_given": len(given.coordinates),
        "vertices_draped": len(draped.coordinates),
        "notes": list(draped.notes),
    }
    request.finish(planned, rows, lambda: record)


def _count_draped(given: Features, draped: Features) -> str:
    from ...base.sentences import counted

    vertices = (
        f"{len(given.coordinates):,} to {counted(len(draped.coordinates), 'vertex', 'vertices')}"
    )
    return f"{counted(len(draped), 'feature')} of {len(given):,} ({draped.kind}), {vertices}"
