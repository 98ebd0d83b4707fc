"""A skeleton of all points: few enough for every task, and wide enough that no disc is huge.

With all vertices of the convex hull in it, no edge of a local hull is wrong; with the outermost
points of every cell, no disc that is empty of them holds a cell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError
from .. import _kernel
from ..topology import boundary_rings
from .sources import NumberedPoints

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array

__all__ = ["find_outermost", "reduce_to_hull"]

_DIRECTIONS = 16


def find_outermost(cell: NumberedPoints) -> NumberedPoints:
    """Return the points of a cell that lie furthest in each of 16 directions."""
    return cell.choose(np.unique(_find_extremes(cell.points)))


def reduce_to_hull(points: NumberedPoints) -> NumberedPoints:
    """Return the points on the boundary of the convex hull; of collinear ones the ends.

    The points of several cells may be joined and reduced again: the hull is that of all.
    """
    left = points.choose(~_are_within_extremes(points.points))
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
    (ring,) = boundary_rings(growth.triangles, growth.neighbors)
    return left.choose(np.sort(kept[ring]))


def _find_extremes(points: Float64Array) -> Int64Array:
    angles = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    xy = points[:, :2] - points[:1, :2]
    if not len(xy):
        return np.empty(0, np.int64)
    return np.array([np.argmax(xy @ (np.cos(a), np.sin(a))) for a in angles])


def _are_within_extremes(points: Float64Array) -> BoolArray:
    """Tell which points lie strictly inside the polygon of the outermost ones, exactly."""
    is_inside = np.zeros(len(points), np.bool_)
    ring = points[_find_extremes(points), :2]
    is_side = (ring != np.roll(ring, -1, axis=0)).any(axis=1)
    if is_side.sum() < 3:
        return is_inside
    places = np.ascontiguousarray(points[:, :2])
    is_inside[:] = True
    for start, end in zip(ring[is_side], np.roll(ring, -1, axis=0)[is_side], strict=True):
        a, b = (np.broadcast_to(one, places.shape).copy() for one in (start, end))
        is_inside &= _kernel.orientation(a, b, places) > 0
    return is_inside
