"""All points of a run: chunks on disk, and the few points that every task knows."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..base.types import Bounds
from ..tin.tiling import NumberedPoints, are_in_box, find_outermost, reduce_to_hull

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..base.arrays import Float64Array, Int64Array
    from ..tin.tiling import Discs
    from .chunks import Chunk

__all__ = ["PointStore", "count_by_cells", "join_skeletons"]

_SIDE_OF_SKELETON = 32
"""Rows and columns of the cells each of which keeps its outermost points, however many chunks."""
_NO_POINTS = NumberedPoints(np.empty((0, 3)), np.empty(0, np.int64))


class PointStore:
    """A source of points for :func:`tinsmith.tin.tiling.local_triangulation.triangulate_box`.

    Parameters
    ----------
    chunks : sequence of Chunk
    skeleton : NumberedPoints
        All vertices of the convex hull, and outermost points of parts of it.
    """

    def __init__(self, chunks: Sequence[Chunk], skeleton: NumberedPoints) -> None:
        self.chunks = tuple(chunks)
        self.skeleton = skeleton

    @cached_property
    def _corners(self) -> Float64Array:
        boxes = [chunk.bounds for chunk in self.chunks]
        sides = [(box.xmin, box.ymin, box.xmax, box.ymax) for box in boxes]
        return np.array(sides, np.float64).reshape(-1, 4)

    @property
    def count(self) -> int:
        """Points in it."""
        return sum(chunk.count for chunk in self.chunks)

    @property
    def bounds(self) -> Bounds:
        """Bounds of all points."""
        west, south, east, north = self._corners.T
        return Bounds(*map(float, (west.min(), south.min(), east.max(), north.max())))

    def read_box(self, box: Bounds) -> NumberedPoints:
        """Return all points in a closed box, in order of their numbers."""
        found = self._read([box])
        return found.choose(are_in_box(found.points, box))

    def read_discs(self, discs: Discs) -> NumberedPoints:
        """Return all points in any of some closed discs, and others near them."""
        reach = discs.radii[:, None] * (1 + 2.0**-40) + 2.0**-40 * np.abs(discs.centers)
        boxes = np.column_stack([discs.centers - reach, discs.centers + reach])
        return self._read([Bounds(*box) for box in boxes.tolist()])

    def _read(self, boxes: list[Bounds]) -> NumberedPoints:
        """Return the points of the chunks' cells that some closed boxes meet, each once."""
        west, south, east, north = self._corners.T
        wanted: dict[int, list[slice]] = {}
        for box in boxes:
            meets = (west <= box.xmax) & (east >= box.xmin)
            meets &= (south <= box.ymax) & (north >= box.ymin)
            for number in np.flatnonzero(meets).tolist():
                slices = self.chunks[number].list_slices(box)
                wanted.setdefault(number, []).extend(slices)
        return _sort(
            [self.chunks[key].read(_join_slices(parts)) for key, parts in sorted(wanted.items())]
        )


def _sort(parts: list[NumberedPoints]) -> NumberedPoints:
    """Join the points of chunks in order of their numbers; no number is in two of them."""
    if not parts:
        return _NO_POINTS
    points = np.concatenate([one.points for one in parts])
    numbers = np.concatenate([one.numbers for one in parts])
    order = np.argsort(numbers, kind="stable")
    return NumberedPoints(points[order], numbers[order])


def _join_slices(parts: list[slice]) -> list[slice]:
    """Return slices in order, those that touch or overlap as one."""
    joined: list[slice] = []
    for part in sorted(parts, key=lambda one: (one.start, one.stop)):
        if part.start == part.stop:
            continue
        if joined and part.start <= joined[-1].stop:
            joined[-1] = slice(joined[-1].start, max(joined[-1].stop, part.stop))
        else:
            joined.append(part)
    return joined


def join_skeletons(parts: Sequence[NumberedPoints], bounds: Bounds) -> NumberedPoints:
    """Return the points that every task must know, of those that single chunks named.

    These are the vertices of the convex hull of all, and in each of some cells over the bounds the
    points that lie furthest in 16 directions: a bounded number, however many chunks there are.
    """
    known = NumberedPoints.join(parts)
    side = _SIDE_OF_SKELETON
    places = []
    for k, (low, high) in enumerate(((bounds.xmin, bounds.xmax), (bounds.ymin, bounds.ymax))):
        extent = high - low
        steps = (known.points[:, k] - low) / extent * side if extent > 0 else known.points[:, k] * 0
        places.append(np.clip(steps, 0, side - 1).astype(np.int64))
    cells = places[1] * side + places[0]
    kept = [reduce_to_hull(known)]
    kept += [find_outermost(known.choose(cells == cell)) for cell in np.unique(cells)]
    return NumberedPoints.join(kept)


def count_by_cells(chunks: Sequence[Chunk], bounds: Bounds, side: int) -> Int64Array:
    """Return about how many points lie in each cell of a lattice over bounds, (side, side) array.

    The points of a cell of a chunk are counted where its middle lies; rows are from the south.
    """
    counts = np.zeros(side * side, np.int64)
    for chunk in chunks:
        rows, columns = chunk.shape
        box = chunk.bounds
        x = box.xmin + (np.arange(columns) + 0.5) * (box.width / columns)
        y = box.ymin + (np.arange(rows) + 0.5) * (box.height / rows)
        across, up = (
            np.clip((values - low) / extent * side if extent > 0 else values * 0, 0, side - 1)
            for values, low, extent in (
                (x, bounds.xmin, bounds.width),
                (y, bounds.ymin, bounds.height),
            )
        )
        cells = up.astype(np.int64)[:, None] * side + across.astype(np.int64)
        np.add.at(counts, cells.ravel(), np.diff(chunk.offsets))
    return counts.reshape(side, side)
