"""Which edges are near rings: by the cells of a grid that the rings run through."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int64Array

_MOST_CELLS = 1024
"""Along one side of the grid."""
_MARGIN = 1
"""Cells around an edge in which a ring is near it: rounding moves nothing so far."""


def find_near_rings(edges: Float64Array, rings: Sequence[Float64Array]) -> BoolArray:
    """Tell which edges, (k, 2, 2), may meet one of the rings, (c, 2) each.

    None that does is missing; of the others some are among them::

        . . . . . .      x  cells that a ring runs through
        . x x x . .      An edge is near if the cells of its bounds, and those around them, hold
        . x . x x .      one: a sum over a rectangle of cells tells, from sums over those that
        . x x x x .      begin in the corner of the grid.
    """
    corners = np.concatenate(rings)
    low, high = corners.min(axis=0), corners.max(axis=0)
    count = min(_MOST_CELLS, 16 + math.isqrt(len(edges)))
    size = np.maximum((high - low) / count, np.finfo(float).tiny)

    def find_cells(xy: Float64Array) -> Int64Array:
        shares = np.clip((xy - low) / size, -2.0, count + 1.0)
        cells: Int64Array = np.floor(shares).astype(np.int64) + 2
        return cells

    is_on = np.zeros((count + 4, count + 4), np.int64)
    for ring in rings:
        start, end = ring, np.roll(ring, -1, axis=0)
        pieces = 1 + np.ceil(np.abs((end - start) / size).max(axis=1)).astype(np.int64)
        of = np.repeat(np.arange(len(ring)), pieces)
        step = np.arange(len(of)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        way = (end - start)[of] / pieces[of, None]
        first = find_cells(start[of] + step[:, None] * way)
        last = find_cells(start[of] + (step + 1)[:, None] * way)
        for x in (first[:, 0], last[:, 0]):
            for y in (first[:, 1], last[:, 1]):
                is_on[x, y] = 1
    sums = np.zeros((count + 5, count + 5), np.int64)
    sums[1:, 1:] = is_on.cumsum(axis=0).cumsum(axis=1)
    a = np.maximum(find_cells(edges.min(axis=1)) - _MARGIN, 0)
    b = np.minimum(find_cells(edges.max(axis=1)) + _MARGIN + 1, count + 4)
    (left, low_row), (right, high_row) = a.T, b.T
    within = sums[right, high_row] - sums[left, high_row] - sums[right, low_row]
    is_near: BoolArray = within + sums[left, low_row] > 0
    return is_near
