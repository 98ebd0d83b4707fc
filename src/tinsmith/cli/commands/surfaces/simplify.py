"""``tinsmith simplify``: a TIN of few points that stays within a tolerance of all."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from ....base.sentences import coordinate, counted
from ...command import file_command
from ...job import Job
from ...output import Facts, Failure, mesh_counts, note_written
from ...parameters import file_option
from ...paths import INPUT, Named
from ...product_options import product_options
from ...tiling import (
    choose_tiles,
    describe_lost,
    describe_points,
    showing_progress,
    tiled_options,
)

if TYPE_CHECKING:
    from ....base.arrays import AnyArray
    from ....terrain import Raster
    from ....tin import TIN


@file_command
@product_options(
    "terrain.simplification.surfaces.simplify",
    "tolerance points hold side",
    tolerance="Largest vertical distance from the new surface, in the unit of elevations.",
    points="Number of points to keep, instead of a tolerance.",
    side="Where the new surface may lie: nowhere below a point (above), such as a sea bed for "
    "navigation, nowhere above one (below), or on both sides.",
)
@file_option(
    "--keep",
    "File of points to keep, such as benchmarks: each must be a vertex of the surface.",
    type=INPUT,
)
@tiled_options()
def simplify(
    file: Path,
    tolerance: float | None,
    points: int | None,
    keep: Path | None,
    job: Job,
    **how: Any,
) -> None:
    """Leave out points of the TIN in FILE, or built from the points in it, within a tolerance.

    At every point the elevation of the new surface differs by at most --tolerance; with
    --hold surface between the points too, and with --side above it lies nowhere below a point.
    Boundary, holes, breaklines and water are kept, and so are voids of a raster. A raster may be
    larger than memory: it is read and simplified in blocks.

    In tiles (--tiles N) the surface is another one: squares that fit at their sides, in one PLY
    file, the same for any N.

    Example:
      tinsmith simplify sample_data/jacksboro.tif --tolerance 2 -o hills.ply
      tinsmith simplify lidar/ --classes 2 --tolerance 0.1 --tiles 16 -o ground.ply
    """
    from ....terrain import simplify as simplify_surface
    from ....tin import TIN
    from ...output import summarise_news

    if (tolerance is None) == (points is None):
        wrong = "give one of them" if points is None else "not both"
        raise click.UsageError(f"The options are --tolerance or --points: {wrong}.")
    if job.tiling.given:
        side = None if how["side"] == "both" else how["side"]
        asked = {"--points": points, "--hold": how["hold"], "--side": side, "--keep": keep}
        whole = next((flag for flag, value in asked.items() if value is not None), "")
        _simplify_tiles(file, tolerance, job, whole)
        return
    more = [] if keep is None else [Named(keep, "--keep")]
    planned = job.plan(job.list_inputs(file, more=more), "TIN")
    given = job.read_cells(file) or job.read_tin(file)
    kept = () if keep is None else _find_kept(given, keep, job)
    if isinstance(given, TIN):
        size, counts = counted(len(given.points), "point"), mesh_counts(given)
    else:
        size = counts = f"{given.shape[0] * given.shape[1]:,} cells"
    with job.step(f"Simplifying {size}") as progress:
        simple = simplify_surface(
            given,
            tolerance=tolerance,
            points=points,
            keep=kept,
            threads=job.building.threads,
            progress=progress,
            **how,
        )
    planned.write("TIN", simple)
    facts = Facts(file)
    facts.add("Read", counts)
    facts.add_tin("Left", simple, simplification=None)
    found = simple.report.simplification
    if found is not None:
        facts.add(
            "Errors",
            f"largest {found.largest_error:.4g}, RMS {found.rms_error:.4g}, at all points\n"
            f"{found.describe_surface()}",
            simplification=found.to_dict(),
        )
        kept_by = "of lines, boundary and those to be kept"
        facts.add("Kept", f"{counted(found.required, 'point')} {kept_by}")
        before = given.report.notes if isinstance(given, TIN) else given.notes
        facts.extend(summarise_news(simple, [*before, found.sentence()]))
    job.finish(planned, facts)


def _simplify_tiles(file: Path, tolerance: float | None, job: Job, whole: str) -> None:
    """Write the surface in tiles."""
    planned = job.plan(job.list_inputs(file), "TIN")
    cloud = choose_tiles(job, file, whole=whole)
    if cloud is None:
        raise AssertionError("tiles were asked for")
    if len(planned.paths) != 1 or job.writing.options:
        raise Failure("The surface of tiles is written as one file: name it by -o.")
    output, name = planned.paths[0], job.writing.output_format
    with showing_progress(job) as way:
        cloud.simplify(output, cast("float", tolerance), format=name, **way)
    note_written(output)
    facts = Facts(file)
    facts.add("Read", describe_points(cloud))
    facts.note(describe_lost(cloud))
    job.finish(planned, facts)


def _find_kept(surface: TIN | Raster, path: Path, job: Job) -> AnyArray:
    """Return the vertices at the points of a file; of a raster the cells with their centres there.

    Cells count row by row.
    """
    import numpy as np

    from ....base.results import locate_centers
    from ....tin import TIN

    places = job.read(path).points[:, :2]
    if isinstance(surface, TIN):
        vertices = {
            place: row for row, place in enumerate(map(tuple, surface.points[:, :2].tolist()))
        }
        found = [vertices.get(place, -1) for place in map(tuple, places.tolist())]
    else:
        columns, rows = (
            {centre: number for number, centre in enumerate(centres.tolist())}
            for centres in locate_centers(surface.grid)
        )
        found = [
            rows[y] * surface.shape[1] + columns[x] if x in columns and y in rows else -1
            for x, y in places.tolist()
        ]
    missing = [row for row, vertex in enumerate(found) if vertex < 0]
    if missing:
        x, y = places[missing[0]].tolist()
        raise Failure(
            f"'{path}': {counted(len(missing), 'point')} of {len(found):,} to be kept "
            f"{'is not a vertex' if len(missing) == 1 else 'are not vertices'} of the surface; the "
            f"first is at {coordinate(x)}, {coordinate(y)}."
        )
    return np.array(found, np.int64)
