"""``tinsmith simplify``: a TIN of few points that stays within a tolerance of all."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ...base.policies import SimplificationHold
from ...base.sentences import coordinate, counted
from ..command import file_command
from ..job import surface_options
from ..output.failures import Failure
from ..parameters import choice_option, file_option, number_option
from ..paths import INPUT, Named

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...terrain import Raster
    from ...tin import TIN
    from ..job import Job
    from ..output.facts import Facts

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
    job: Job,
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
    from ..inputs import find_cells, read_cells
    from ..output.facts import Facts
    from ..output.line_summaries import mesh_counts
    from ..output.summaries import describe_tin

    if (tolerance is None) == (points is None):
        wrong = "give one of them" if points is None else "not both"
        raise click.UsageError(f"The options are --tolerance or --points: {wrong}.")
    more = [] if keep is None else [Named(keep, "--keep")]
    planned = job.plan(job.list_inputs(file, more=more), "TIN")
    raster = read_cells(file, job)
    given = job.read_tin(file) if raster is None else raster
    find = _find_vertices if raster is None else find_cells
    kept = () if keep is None else _find_kept(given, find, keep, job)
    size, counts = _count(given)
    with job.step(f"Simplifying {size}") as progress:
        simple = simplify_surface(
            given,
            tolerance=tolerance,
            points=points,
            keep=kept,
            hold=hold,
            threads=job.how.threads,
            progress=progress,
        )
    planned.write("TIN", simple)
    facts = Facts(file)
    facts.add("Read", counts)
    facts.add("Left", mesh_counts(simple), tin=lambda: describe_tin(simple), simplification=None)
    _add_errors(facts, simple, given)
    job.finish(planned, facts)


def _count(given: TIN | Raster) -> tuple[str, str]:
    """Return what there is to simplify, and what was read, in words."""
    from ...terrain import Raster
    from ..inputs import count_cells
    from ..output.line_summaries import mesh_counts

    if isinstance(given, Raster):
        return count_cells(given), count_cells(given)
    return counted(len(given.points), "point"), mesh_counts(given)


def _find_vertices(tin: TIN, places: AnyArray) -> list[int]:
    """Return the vertices at places, -1 where there is none."""
    vertex_at = {place: row for row, place in enumerate(map(tuple, tin.points[:, :2].tolist()))}
    return [vertex_at.get(place, -1) for place in map(tuple, places.tolist())]


def _find_kept(
    surface: Any, find: Callable[[Any, AnyArray], list[int]], path: Path, job: Job
) -> AnyArray:
    """Return the vertices or cells at the points of a file."""
    import numpy as np

    from ..files import read_input

    places = read_input(path, job.reading, job.console).points[:, :2]
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


def _add_errors(facts: Facts, simple: TIN, given: TIN | Raster) -> None:
    from ...terrain import Raster
    from ..output.line_summaries import summarise_news

    found = simple.report.simplification
    if found is None:
        return
    before = given.notes if isinstance(given, Raster) else given.report.notes
    facts.add(
        "Errors",
        f"largest {found.largest_error:.4g}, RMS {found.rms_error:.4g}, at all points\n"
        f"{found.describe_surface()}",
        simplification=found.to_dict(),
    )
    facts.add("Kept", f"{counted(found.required, 'point')} of lines, boundary and those to be kept")
    facts.extend(summarise_news(simple, [*before, found.sentence()]))
