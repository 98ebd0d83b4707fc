"""Faults of triangles in a heap: a point in the circle, an overlap."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..predicates import columns, in_circle, orientation

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array
    from ..predicates import Columns

_ROWS = 1 << 20  # point-in-circle tests at a time
_BLOCK = 256  # triangles at a time
_CHUNK = 32  # neighbours of each looked at before asking whether an overlap is found


def find_violating(points: Float64Array, triangles: Int32Array) -> BoolArray:
    """Tell which counter-clockwise triangles have a point strictly inside their circle; exactly."""
    xy = columns(points)
    everywhere = np.arange(len(points))
    found = np.zeros(len(triangles), np.bool_)
    at_once = max(_ROWS // len(points), 1)
    for start in range(0, len(triangles), at_once):
        block = triangles[start : start + at_once]
        which = np.repeat(np.arange(len(block)), len(points))
        candidates = np.tile(everywhere, len(block))
        other = (block[which] != candidates[:, None]).all(axis=1)
        which, candidates = which[other], candidates[other]
        a, b, c = block[which].T
        inside = in_circle(xy, a, b, c, candidates) > 0
        found[start + which[inside]] = True
    return found


def find_overlapping(points: Float64Array, triangles: Int32Array) -> BoolArray:
    """Tell which triangles share area with another one, exactly: as :func:`find_violating`."""
    xy = columns(points)
    found = np.zeros(len(triangles), np.bool_)
    for start in range(0, len(triangles), _BLOCK):
        block = np.arange(start, min(start + _BLOCK, len(triangles)))
        block = block[~found[block]]
        # for each triangle of a block which triangles have a bounding box that meets its own
        corners = points[triangles, :2]
        low, high = corners.min(axis=1), corners.max(axis=1)
        near = np.ones((len(block), len(corners)), np.bool_)
        for axis in range(2):
            near &= low[:, axis] < high[block, axis, None]
            near &= high[:, axis] > low[block, axis, None]
        near[np.arange(len(block)), block] = False
        # mark triangles of the block, and some of those that they overlap, if they overlap any
        rank = np.cumsum(near, axis=1, dtype=np.int32)
        seen, ahead = 0, _CHUNK
        while len(block) and seen < rank.max():
            row, other = np.nonzero(near & (rank > seen) & (rank <= ahead))
            first, second = triangles[block[row]], triangles[other]
            hit = ~(_is_apart(xy, first, second) | _is_apart(xy, second, first))
            found[block[row[hit]]] = True
            found[other[hit]] = True
            is_left = ~found[block]
            block, near, rank = block[is_left], near[is_left], rank[is_left]
            seen, ahead = ahead, 2 * ahead
    return found


def _is_apart(xy: Columns, first: Int32Array, second: Int32Array) -> BoolArray:
    """Tell where an edge of the first triangle has the whole second one on its outer side."""
    apart = np.zeros(len(first), np.bool_)
    for k in range(3):
        a, b = first[:, k], first[:, (k + 1) % 3]
        outer = [orientation(xy, a, b, second[:, corner]) <= 0 for corner in range(3)]
        apart |= np.logical_and.reduce(outer)
    return apart
