"""A skeleton of all points: few enough for every task, and wide enough that no disc is huge.

With all vertices of the convex hull in it, no edge of a local hull is wrong; with the outermost
points of every cell, no disc that is empty of them holds a cell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError
from ...base.types import Bounds
from .. import _kernel
from ..topology import boundary_rings
from .boxes import are_in_box
from .sources import NumberedPoints

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array

_DIRECTIONS = 16
_MANY, _SAMPLE = 4_096, 1_024
"""Points of which it pays to look at some first, and how many are looked at."""
_SHARES = (0.98, 0.9, 0.7, 0.5)
"""Of the bounds of these that a box may have."""


def find_outermost(cell: NumberedPoints) -> NumberedPoints:
    """Return the points of a cell that lie furthest in each of 16 directions."""
    rim = _drop_middle(cell)
    return rim.choose(np.unique(_find_extremes(rim.points)))


def reduce_to_hull(points: NumberedPoints) -> NumberedPoints:
    """Return the points on the boundary of the convex hull; of collinear ones the ends.

    The points of several cells may be joined and reduced again: the hull is that of all.
    """
    rim = _drop_middle(points)
    ring = _make_ring(rim.points)
    left = rim if ring is None else rim.choose(~_are_within(ring, rim.points[:, :2]))
    if not len(left.numbers):
        return left
    try:
        growth = _kernel.grow(np.ascontiguousarray(left.points), threads=1)
    except PointsError:  # collinear, or fewer than three places
        order = np.lexsort((left.points[:, 1], left.points[:, 0]))
        return left.choose(np.unique(order[[0, -1]]))
    kept = np.arange(len(left.numbers))
    if growth.kept_row is not None:
        kept = kept[growth.kept_row == kept]
    (rim_vertices,) = boundary_rings(growth.triangles, growth.neighbors)
    return left.choose(np.sort(kept[rim_vertices]))


def find_skeleton(points: NumberedPoints) -> NumberedPoints:
    """Return the points of a part that every task must know: its hull, and its outermost ones."""
    rim = _drop_middle(points)
    return NumberedPoints.join([reduce_to_hull(rim), find_outermost(rim)])


def _drop_middle(points: NumberedPoints) -> NumberedPoints:
    """Return the points without those in a box that lies strictly inside the hull of some.

    None of these is the furthest in any direction; two comparisons for each coordinate tell.
    """
    places = points.points[:, :2]
    if len(places) < _MANY:
        return points
    ring = _make_ring(places[:: len(places) // _SAMPLE])
    if ring is None:
        return points
    middle, half = (ring.min(axis=0) + ring.max(axis=0)) / 2, np.ptp(ring, axis=0) / 2
    for share in _SHARES:
        low, high = middle - share * half, middle + share * half
        corners = np.array([[x, y] for x in (low[0], high[0]) for y in (low[1], high[1])])
        if _are_within(ring, corners).all():
            return points.choose(~are_in_box(places, Bounds(*low.tolist(), *high.tolist())))
    return points


def _find_extremes(points: Float64Array) -> Int64Array:
    angles = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    if not len(points):
        return np.empty(0, np.int64)
    x, y = (points[:, :2] - points[:1, :2]).T.copy()  # no BLAS: its threads wait for each other
    return np.array([np.argmax(np.cos(a) * x + np.sin(a) * y) for a in angles])


def _make_ring(places: Float64Array) -> Float64Array | None:
    """Return the outermost places counter-clockwise; None where they are no polygon."""
    ring = places[_find_extremes(places), :2]
    is_side = (ring != np.roll(ring, -1, axis=0)).any(axis=1)
    return ring[is_side] if is_side.sum() >= 3 else None


def _are_within(ring: Float64Array, places: Float64Array) -> BoolArray:
    """Tell which places lie strictly left of all sides of a ring, exactly.

    They lie strictly inside the hull of its corners, whether rounding made it convex or not.
    """
    inside = np.arange(len(places))
    for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        left = np.ascontiguousarray(places[inside])
        a, b = (np.broadcast_to(one, left.shape).copy() for one in (start, end))
        inside = inside[_kernel.orientation(a, b, left) > 0]
    is_within = np.zeros(len(places), np.bool_)
    is_within[inside] = True
    return is_within
