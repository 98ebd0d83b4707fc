"""How a heap of triangles covers the hull: where twice or more, and where not at all.

How often a place is covered, less the once that it should be, is the winding number round it of
all edges of the triangles, less those of the hull. Edges used once in each direction cancel, so of
a triangulation nothing is left, and of any heap only the edges at its faults. These are swept from
south to north.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array, Int32Array, Int64Array

_LINES = 4_000
"""Lines across the sweep, at least: where edges cross, areas are good to about one in as many."""

_MOST_CROSSINGS = 1_000_000
"""Of edges and lines that are looked at together."""


class _Edges(NamedTuple):
    """Southern and northern ends, (n, 2), and by how much an edge changes the cover eastwards."""

    south: Float64Array
    north: Float64Array
    step: Int64Array


class Cover(NamedTuple):
    """Areas of the places covered more than once, and of those not covered, CRS units squared."""

    overlap: float
    gap: float


def cover(points: Float64Array, triangles: Int32Array, hull: Int32Array) -> Cover:
    """Measure overlaps and gaps of counter-clockwise triangles in a hull.

    The hull is its vertices, counter-clockwise, those within its edges too. Areas are exactly zero
    where there are none; otherwise exact but for rounding where no edges cross.
    """
    # edges, smaller vertex first, and how often more they run forwards than backwards
    n = len(points)
    start = np.concatenate([triangles.ravel(), np.roll(hull, -1)]).astype(np.int64)
    end = np.concatenate([triangles[:, [1, 2, 0]].ravel(), hull]).astype(np.int64)
    keys, which = np.unique(
        np.minimum(start, end) * n + np.maximum(start, end), return_inverse=True
    )
    runs = np.bincount(which, np.where(start < end, 1, -1)).astype(np.int64)
    edges = np.stack([keys // n, keys % n], axis=1)
    counts = (runs != 0) & (points[edges[:, 0], 1] != points[edges[:, 1], 1])  # not level ones
    edges, weights = edges[counts], runs[counts]
    xy = points[:, :2] - points[:, :2].min(axis=0)
    # the southern and the northern end of every edge
    first, second = xy[edges[:, 0]], xy[edges[:, 1]]
    is_northward = (first[:, 1] < second[:, 1])[:, None]
    south, north = np.where(is_northward, first, second), np.where(is_northward, second, first)
    # An edge that runs north has its triangle in the west: eastwards, the triangle ends there.
    step = np.where(xy[edges[:, 0], 1] < xy[edges[:, 1], 1], -weights, weights)
    overlap = gap = 0.0
    edges_at_fault = _Edges(south, north, step)
    for middle, height in _walk_strips(edges_at_fault):
        found = _measure_areas(edges_at_fault, middle, height)
        overlap += found.overlap
        gap += found.gap
    return Cover(overlap, gap)


def _walk_strips(edges: _Edges) -> Iterator[tuple[Float64Array, Float64Array]]:
    """Yield middles and heights of strips that no edge begins or ends in, many at a time."""
    y = np.concatenate([edges.south[:, 1], edges.north[:, 1]])
    if len(y) == 0:
        return
    levels = np.union1d(y, np.linspace(y.min(), y.max(), _LINES))
    low, high = levels[:-1], levels[1:]
    middle = low + (high - low) / 2
    is_between = (low < middle) & (middle < high)
    middle, height = middle[is_between], (high - low)[is_between]
    size = max(1, _MOST_CROSSINGS // len(edges.step))
    for start in range(0, len(middle), size):
        yield middle[start : start + size], height[start : start + size]


def _measure_areas(edges: _Edges, y: Float64Array, height: Float64Array) -> Cover:
    """Return the areas of surplus and of lack in strips, by lines from west to east in them."""
    south, north, step = edges
    strip, edge = np.nonzero((south[:, 1] < y[:, None]) & (y[:, None] < north[:, 1]))
    low, across = south[edge], north[edge] - south[edge]
    x = low[:, 0] + across[:, 0] * ((y[strip] - low[:, 1]) / across[:, 1])
    order = np.lexsort((x, strip))  # along one line after the other, each of which ends with 0
    surplus = np.cumsum(step[edge][order])[:-1]
    area = np.diff(x[order]) * height[strip[order][:-1]]
    return Cover(float(area[surplus > 0].sum()), float(area[surplus < 0].sum()))
