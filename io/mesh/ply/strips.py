"""Triangle strips of a PLY file, in which each vertex makes a triangle with the two before it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ....arrays import Int64Array

__all__ = ["STRIPS", "unroll_strips"]

STRIPS = "tristrips"
"""Name of the element."""


def unroll_strips(items: Int64Array, offsets: Int64Array) -> Int64Array:
    """Return the triangles of strips, (m, 3); a number below 0 begins a new strip.

    Every other triangle of a strip runs the other way round; those that name a vertex twice only
    join parts of a strip, and are none.

    Examples
    --------
    >>> unroll_strips(np.array([0, 1, 3, 2, -1, 4, 5, 6]), np.array([0, 8])).tolist()
    [[0, 1, 3], [3, 1, 2], [4, 5, 6]]
    """
    starts = np.zeros(len(items) + 1, np.bool_)
    starts[offsets] = True
    starts[1:] |= items < 0
    first = np.maximum.accumulate(np.where(starts, np.arange(len(starts)), 0))[:-1]
    place = np.arange(len(items)) - first  # within the strip
    ends = np.flatnonzero((place >= 2) & (items >= 0))
    triangles = np.stack([items[ends - 2], items[ends - 1], items[ends]], axis=1)
    is_turned = place[ends] % 2 == 1
    triangles[is_turned, :2] = triangles[is_turned, 1::-1]
    a, b, c = triangles.T
    found: Int64Array = triangles[(a != b) & (b != c) & (c != a)]
    return found
