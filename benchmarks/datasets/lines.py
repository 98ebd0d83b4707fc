"""Points with breaklines, as survey and contour map give them, at UTM-sized coordinates.

No two lines cross, so that every tool can take part. Seeds are fixed: the same call gives the same
points and lines.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tinsmith.base.arrays import BoolArray, Float64Array, Int64Array

from .points import SEED, UTM_CORNER, lift_to_ground, make_points

__all__ = ["LEAST_POINTS", "LINE_DATASETS", "LineTask", "make_lines"]


LEAST_POINTS = 1_000
BLOCK = 24
"""Point spacings along the side of a block of short lines."""
STRIP = 4
"""Point spacings across the strip that holds one of them: about 100 points a line."""
STEPS = 10
"""Segments of a short line."""
RING_CORNERS = 140
RINGS_OF_HILL = 70
TIGHT, WIDE = 1.001, 1.03
"""Ratios of the radii of neighbouring rings: twice what their chords need lest they cross, and
such that corners are about as far from the next ring as from each other."""
SHIFTED_BITS = 34
"""UTM coordinates in metres are whole numbers of 2 ** -34."""


class LineTask(NamedTuple):
    """Points and lines, for tinsmith as they are, for the peers as a graph.

    Attributes
    ----------
    points : (n, 3) float64 array
        Mass points, metres.
    coords : (k, 3) float64 array
        Vertices of the lines, one line after the other; a ring ends where it begins.
    offsets : (l + 1,) int64 array
        Line ``i`` is ``coords[offsets[i]:offsets[i + 1]]``.
    vertices : (v, 2) float64 array
        Every place once: the points, then the vertices of lines that are none.
    segments : (s, 2) int64 array
        The lines, as pairs of ``vertices``.
    steps : (t, 2) int64 array
        The same, cut at the vertices that lie on them exactly: the edges that a right answer has.
    """

    points: Float64Array
    coords: Float64Array
    offsets: Int64Array
    vertices: Float64Array
    segments: Int64Array
    steps: Int64Array

    def breaklines(self) -> list[Float64Array]:
        """Return the lines one by one."""
        return np.split(self.coords, self.offsets[1:-1])


def make_lines(name: str, n: int) -> LineTask:
    """Make the data set of that name in ``LINE_DATASETS``, of about n points."""
    return LINE_DATASETS[name](n, np.random.default_rng(SEED))


# ------------------------------------------------------------------- the data sets


def make_short_lines(n: int, rng: np.random.Generator) -> LineTask:
    """Uniform points, and n / 10 segments in lines of ten, a few point spacings each."""
    side = np.sqrt(n)
    corners, is_upright = _place_strips(int(side // BLOCK))
    along = np.arange(STEPS + 1) + rng.uniform(0.1, 0.9, (len(corners), STEPS + 1))
    across = rng.uniform(0.05, 0.95, along.shape) * STRIP
    xy = _put_into_strips(along * (BLOCK / (STEPS + 1)), across, corners, is_upright)
    return _make_separate_task(make_points("uniform", n), xy + UTM_CORNER)


def make_nested_rings(n: int, rng: np.random.Generator) -> LineTask:
    """Contour rings, n / 140, of one hill, each inside the next, and no other points."""
    return _make_ring_task([_make_hill(n // RING_CORNERS, TIGHT, rng)])


def make_hills(n: int, rng: np.random.Generator) -> LineTask:
    """Contour rings, n / 140, 70 on each of many hills, and no other points."""
    count = max(1, n // RING_CORNERS // RINGS_OF_HILL)
    per_hill = n // RING_CORNERS // count
    found = [_make_hill(per_hill, WIDE, rng) for _ in range(count)]
    width = 2.2 * max(np.abs(rings).max() for rings in found)
    columns = round(np.sqrt(count))
    places = [width * np.array(divmod(i, columns)) for i in range(count)]
    return _make_ring_task([rings + place for rings, place in zip(found, places, strict=True)])


def make_raster_lines(n: int, rng: np.random.Generator) -> LineTask:
    """0.1 m raster as read from text, and n / 10 segments between its points.

    Many segments run over further points: along a row or column exactly, aslant nearly.
    """
    points = make_points("decimal raster", n)
    columns = round(np.sqrt(n))
    rows = n // columns
    corners, is_upright = _place_strips(min(columns, rows) // BLOCK)
    along = np.cumsum(rng.integers(1, 4, (len(corners), STEPS + 1)), axis=1)
    along = np.minimum(along, BLOCK - 1 - STEPS + np.arange(STEPS + 1)) - 1
    across = rng.integers(0, STRIP, along.shape)
    x, y = _put_into_strips(along, across, corners, is_upright).T.astype(np.int64)
    numbers = ((rows - 1 - y) * columns + x).T
    segments = _link_neighbors(numbers)
    return LineTask(
        points,
        points[numbers.ravel()],
        _find_offsets(numbers),
        np.ascontiguousarray(points[:, :2]),
        segments,
        _cut_at_lattice(points[:, :2], segments, columns),
    )


def make_long_lines(n: int, rng: np.random.Generator) -> LineTask:
    """Uniform points, and 300 (of a million) straight lines from side to side, nearly parallel."""
    side = np.sqrt(n)
    count = round(0.3 * side)
    y = (np.arange(count)[:, None] + rng.uniform(0.1, 0.9, (count, 2))) * (side / count)
    x = np.broadcast_to([0.0, side], y.shape)
    return _make_separate_task(make_points("uniform", n), np.stack([x, y], axis=2) + UTM_CORNER)


LINE_DATASETS: dict[str, Callable[[int, np.random.Generator], LineTask]] = {
    "short lines": make_short_lines,
    "nested rings": make_nested_rings,
    "hills": make_hills,
    "raster lines": make_raster_lines,
    "long lines": make_long_lines,
}
"""The generators by name."""


# -------------------------------------------------------------------------- parts


def _place_strips(blocks: int) -> tuple[Float64Array, BoolArray]:
    """Lower left corners of strips, lying in every other block and upright in the others."""
    per_block = BLOCK // STRIP
    number = np.arange(blocks * blocks * per_block)
    block, strip = np.divmod(number, per_block)
    row, column = np.divmod(block, blocks)
    is_upright = (row + column) % 2 == 1
    shift = strip * STRIP
    x = column * BLOCK + np.where(is_upright, shift, 0)
    y = row * BLOCK + np.where(is_upright, 0, shift)
    return np.column_stack([x, y]).astype(np.float64), is_upright


def _put_into_strips(
    along: NDArray[np.generic],
    across: NDArray[np.generic],
    corners: Float64Array,
    is_upright: BoolArray,
) -> Float64Array:
    """Put lines, (l, k) each, into their strips: (l, k, 2)."""
    lying = np.stack([along, across], axis=2).astype(np.float64)
    turned = np.where(is_upright[:, None, None], lying[:, :, ::-1], lying)
    return turned + corners[:, None]


def _make_hill(count: int, growth: float, rng: np.random.Generator) -> Float64Array:
    """Rings about the origin, (count, corners, 2), the innermost first, radius from 10 m."""
    radius = 10.0 * growth ** np.arange(count)[:, None]
    corner = np.arange(RING_CORNERS) + rng.uniform(-0.3, 0.3, (count, RING_CORNERS))
    angle = corner * (2.0 * np.pi / RING_CORNERS)
    bulge = 1.0 + 0.05 * np.cos(2 * angle + 1.0) + 0.01 * np.sin(5 * angle)
    return np.stack([np.cos(angle), np.sin(angle)], axis=2) * (radius * bulge)[:, :, None]


def _make_ring_task(hills: list[Float64Array]) -> LineTask:
    """Make a data set of rings whose heights fall evenly from the middle of each hill."""
    xy = np.concatenate(hills) + UTM_CORNER
    fall = np.concatenate([np.arange(len(rings)) for rings in hills])
    z = np.broadcast_to(1000.0 - 0.1 * fall[:, None], xy.shape[:2])
    corners = np.concatenate([xy, z[:, :, None]], axis=2)
    closed = np.concatenate([corners, corners[:, :1]], axis=1)
    numbers = np.arange(xy.shape[0] * xy.shape[1]).reshape(xy.shape[:2])
    segments = _link_neighbors(np.concatenate([numbers, numbers[:, :1]], axis=1))
    return LineTask(
        np.empty((0, 3)),
        closed.reshape(-1, 3),
        _find_offsets(closed),
        xy.reshape(-1, 2),
        segments,
        segments,
    )


def _make_separate_task(points: Float64Array, xy: Float64Array) -> LineTask:
    """Make a data set of points and lines that share no place; lines are (l, k, 2)."""
    coords = lift_to_ground(xy.reshape(-1, 2))
    segments = _link_neighbors(len(points) + np.arange(len(coords)).reshape(xy.shape[:2]))
    vertices = np.concatenate([points[:, :2], coords[:, :2]])
    return LineTask(points, coords, _find_offsets(xy), vertices, segments, segments)


def _link_neighbors(numbers: Int64Array) -> Int64Array:
    """Pairs of neighbours in lines of vertex numbers, (l, k) to (l * (k - 1), 2)."""
    return np.stack([numbers[:, :-1].ravel(), numbers[:, 1:].ravel()], axis=1)


def _find_offsets(lines: NDArray[np.generic]) -> Int64Array:
    return np.arange(len(lines) + 1, dtype=np.int64) * lines.shape[1]


def _cut_at_lattice(xy: Float64Array, segments: Int64Array, columns: int) -> Int64Array:
    """Cut segments between lattice points at the lattice points that lie on them exactly."""
    start, end = segments.T
    rows_down, columns_right = end // columns - start // columns, end % columns - start % columns
    parts = np.gcd(rows_down, columns_right)
    done = []
    last = start.copy()
    for part in range(1, int(parts.max())):
        is_inner = part < parts
        inner = start + np.where(is_inner, part * (end - start) // parts, 0)
        is_on = is_inner & _find_between(xy, start, inner, end)
        done.append(np.stack([last[is_on], inner[is_on]], axis=1))
        last[is_on] = inner[is_on]
    return np.concatenate([*done, np.stack([last, end], axis=1)])


def _find_between(
    xy: Float64Array, start: Int64Array, inner: Int64Array, end: Int64Array
) -> BoolArray:
    """Whether lattice points between two others are on the straight line, in whole numbers."""
    whole = np.ldexp(xy, SHIFTED_BITS).astype(np.int64)
    ux, uy = (whole[inner] - whole[start]).T.astype(object)
    vx, vy = (whole[end] - whole[start]).T.astype(object)
    is_on: BoolArray = (ux * vy == uy * vx).astype(np.bool_)
    return is_on
