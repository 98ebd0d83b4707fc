"""The surface along lines: each tile has the triangles that lines meet in it, which are joined."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..terrain.parts import lines
from ..terrain.surface import as_segments
from ..tin import triangulate
from ..tin.tiling import reduce_to_hull
from .given import Given, load_given
from .lines import open_lines
from .reading import open_store
from .tasks import load_arrays, save_arrays

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from ..base.results import Features
    from ..terrain.surface import Segments
    from ..tin import TIN
    from .reading import StoredPoints
    from .running import Record
    from .tasks import Part


def keep_lines(value: Any, features: Features) -> Given:
    """Return lines, or the rings of polygons, for tasks; ``value`` is what they were taken from."""
    xy = np.ascontiguousarray(features.coordinates[:, :2]) + 0.0
    return Given(value, xy=xy, offsets=np.asarray(features.offsets[0], np.int64))


def _make_options(segments: Segments, points: Path, breaklines: Path | None) -> lines.LineOptions:
    """Add the vertices on the boundary of the whole surface, counter-clockwise."""
    if breaklines is not None:
        return lines.LineOptions(segments, open_lines(breaklines).rim)
    tin = triangulate(reduce_to_hull(open_store(points).skeleton).points)
    return lines.LineOptions(segments, tin.points[tin.boundary[0]])


@lru_cache(maxsize=1)
def _load_options(
    folder: Path, description: str, points: Path, breaklines: Path | None
) -> lines.LineOptions:
    """Return the lines of a run, which are kept for the next task."""
    given = cast("Any", load_given(folder, description))
    return _make_options(as_segments(given["xy"], given["offsets"]), points, breaklines)


def compute_along(part: Part, name: str) -> tuple[int, dict[str, Any], list[str]]:
    """Return the triangles that lines meet in a tile; they are the option of this name."""
    job = part.job
    options = _load_options(job.folder / name, job.options[name], job.points, job.lines)
    reach = lines.find_reach(job.tile.box, options)
    if reach is None:
        return 0, {}, []
    local = part.triangulate(reach, rings=lines.RINGS, ordered=False)
    if not len(local.triangles):
        return 0, {}, []
    found = lines.compute_part(local, job.tile.box, options)
    return len(local.points), {}, save_arrays(part, **found._asdict())


def join_along(
    points: StoredPoints, given: Given, records: Mapping[str, Record], folder: Path
) -> TIN:
    """Return the surface along lines, of the parts of all tiles."""
    segments = as_segments(given.arrays["xy"], given.arrays["offsets"])
    options = _make_options(segments, points.folder, points.lines)
    parts = load_parts(records, folder)
    return lines.join(parts, options, points.crs, points.elevation_unit)


def load_parts(records: Mapping[str, Record], folder: Path) -> Iterator[lines.SurfacePart]:
    """Yield what :func:`compute_along` wrote of each tile."""
    for record in records.values():
        if record.files:
            yield lines.SurfacePart(**load_arrays(folder, record))
