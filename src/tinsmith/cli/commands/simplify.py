"""``tinsmith simplify``: a TIN of few points that stays within a tolerance of all."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ...base.policies import SimplificationHold
from ...base.sentences import coordinate, counted
from ..command import file_command
from ..output.failures import Failure
from ..parameters import choice_option, file_option, number_option
from ..paths import INPUT, Named
from ..request import surface_options

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...terrain import Raster
    from ...tin import TIN
    from ..output.console import Row
    from ..request import Request

__all__ = ["simplify"]


@file_command
@number_option(
    "--tolerance",
    "HEIGHT",
    "Largest vertical distance from the new surface, in the unit of elevations.",
)
@number_option("--points", "N", "Number of points to keep, instead of a tolerance.", type=int)
@choice_option(
    "--hold",
    SimplificationHold,
    "Hold the tolerance at the points, or between them too, anywhere on the surface; default "
    "surface where there are breaklines or triangles that are not Delaunay.",
)
@file_option(
    "--keep",
    "File of points to keep, such as benchmarks: each must be a vertex of the surface.",
    type=INPUT,
)
@surface_options()
def simplify(
    file: Path,
    tolerance: float | None,
    points: int | None,
    hold: SimplificationHold | None,
    keep: Path | None,
    request: Request,
) -> None:
    """Leave out points of the TIN in FILE, or built from the points in it, within a tolerance.

    At every point the elevation of the new surface differs by at most --tolerance; with
    --hold surface between the points too. Boundary, holes, breaklines and water are kept, and so
    are voids of a raster. A raster may be larger than memory: it is read and simplified in blocks.

    \b
    Example:
      tinsmith simplify sample_data/jacksboro.tif --tolerance 2 -o hills.ply
    """  # noqa: D301 - click reads the control character
    from ...terrain import simplify as simplify_surface
    from ..output.line_summaries import mesh_counts
    from ..raster_input import find_cells, read_cells

    if (tolerance is None) == (points is None):
        wrong = "give one of them" if points is None else "not both"
        raise click.UsageError(f"The options are --tolerance or --points: {wrong}.")
    more = [] if keep is None else [Named(keep, "--keep")]
    planned = request.plan(request.list_inputs(file, more=more), "TIN")
    raster = read_cells(file, request)
    given = request.read_tin(file) if raster is None else raster
    find = _find_vertices if raster is None else find_cells
    kept = () if keep is None else _find_kept(given, find, keep, request)
    size, counts = _count(given)
    with request.step(f"Simplifying {size}") as progress:
        simple = simplify_surface(
            given,
            tolerance=tolerance,
            points=points,
            keep=kept,
            hold=hold,
            threads=request.how.threads,
            progress=progress,
        )
    planned.write("TIN", simple)
    rows = [
        ("Read", counts),
        ("Left", mesh_counts(simple)),
        *_summarise_errors(simple, given),
    ]
    request.finish(planned, rows, lambda: _describe_simplification(file, simple))


def _count(given: TIN | Raster) -> tuple[str, str]:
    """Return what there is to simplify, and what was read, in words."""
    from ...terrain import Raster
    from ..output.line_summaries import mesh_counts
    from ..raster_input import count_cells

    if isinstance(given, Raster):
        return count_cells(given), count_cells(given)
    return counted(len(given.points), "point"), mesh_counts(given)


def _find_vertices(tin: TIN, places: AnyArray) -> list[int]:
    """Return the vertices at places, -1 where there is none."""
    vertex_at = {place: row for row, place in enumerate(map(tuple, tin.points[:, :2].tolist()))}
    return [vertex_at.get(place, -1) for place in map(tuple, places.tolist())]


def _find_kept(
    surface: Any, find: Callable[[Any, AnyArray], list[int]], path: Path, request: Request
) -> AnyArray:
    """Return the vertices or cells at the points of a file."""
    import numpy as np

    from ..files import read_input

    places = read_input(path, request.reading, request.console).points[:, :2]
    found = find(surface, places)
    missing = [row for row, vertex in enumerate(found) if vertex < 0]
    if missing:
        x, y = places[missing[0]].tolist()
        raise Failure(
            f"'{path}': {counted(len(missing), 'point')} of {len(found):,} to be kept "
            f"{'is not a vertex' if len(missing) == 1 else 'are not vertices'} of the surface; the "
            f"first is at {coordinate(x)}, {coordinate(y)}."
        )
    return np.array(found, np.int64)


def _summarise_errors(simple: TIN, given: TIN | Raster) -> list[Row]:
    from ...terrain import Raster
    from ..output.line_summaries import summarise_news

    found = simple.report.simplification
    if found is None:
        return []
    before = given.notes if isinstance(given, Raster) else given.report.notes
    return [
        (
            "Errors",
            f"largest {found.largest_error:.4g}, RMS {found.rms_error:.4g}, at all points\n"
            f"{found.describe_surface()}",
        ),
        ("Kept", f"{counted(found.required, 'point')} of lines, boundary and those to be kept"),
        *summarise_news(simple, [*before, found.sentence()]),
    ]


def _describe_simplification(file: Path, simple: TIN) -> dict[str, Any]:
    from ..output.summaries import describe_tin

    found = simple.report.simplification
    return {
        "input": str(file),
        "tin": describe_tin(simple),
        "simplification": None if found is None else found.to_dict(),
    }
