"""Rounding: how closely coordinates are known, what products lose, which triangles are thinner."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...tin import TIN
from ...tin.topology import NO_NEIGHBOR

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array

_DECIMALS = range(3, 10)
"""Coordinates with fewer, such as whole numbers, are taken as they are."""
_SPACINGS = 4.0
"""Spacings of floating point numbers: what a few operations leave."""


_MEANINGFUL = 16.0
"""Spacings: a last decimal below is one that every number of this size has."""

_SPLITTER = 2.0**27 + 1
"""Dekker's: cuts a double into two halves of 26 bits."""

_ROUNDINGS = 8.0
"""Points on a line, turned and rounded, lie off it by some three roundings of a coordinate."""


def find_rounding(xy: Float64Array) -> float:
    """Return how far from the places meant coordinates, (n, 2), may lie because of their rounding.

    Half a unit of the last decimal in either direction, if all of them are written with so few
    decimals, from 3 to 9; at least a few spacings of floating point numbers of their size.
    """
    return max(find_written_rounding(xy), _SPACINGS * _find_spacing(xy))


def find_written_rounding(xy: Float64Array) -> float:
    """Return the same for coordinates that are taken as they are unless decimals tell more."""
    if (np.round(xy, _DECIMALS[0] - 1) == xy).all():
        return 0.0
    decimals = next((n for n in _DECIMALS if (np.round(xy, n) == xy).all()), None)
    if decimals is None or 10.0**-decimals < _MEANINGFUL * _find_spacing(xy):
        return 0.0
    return float(np.hypot(0.5, 0.5)) * 10.0**-decimals


def _find_spacing(xy: Float64Array) -> float:
    return float(np.spacing(np.abs(xy).max(initial=1.0)))


def multiply_exactly(a: Float64Array, b: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Return products, and what these are short of the true ones."""
    product = a * b
    (p, q), (r, s) = _split(a), _split(b)
    return product, q * s - (((product - p * r) - q * r) - p * s)


def _split(value: Float64Array) -> tuple[Float64Array, Float64Array]:
    scaled = _SPLITTER * value
    high = scaled - (scaled - value)
    return high, value - high


def measure_rounding(points: Float64Array) -> float:
    """Return the distance between neighbouring doubles at the largest coordinate."""
    return float(np.spacing(np.abs(points[:, :2]).max(initial=0.0)))


def leave_out_slivers(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    rounding: float | None = None,
) -> tuple[Int32Array, Int32Array]:
    """Return triangles and neighbours without those that :func:`find_slivers` finds."""
    is_kept = ~find_slivers(points, triangles, neighbors, rounding)
    return keep_triangles(triangles, neighbors, is_kept)


def keep_triangles(
    triangles: Int32Array, neighbors: Int32Array, is_kept: BoolArray
) -> tuple[Int32Array, Int32Array]:
    """Return some triangles, and their neighbours numbered anew."""
    if is_kept.all():
        return triangles, neighbors
    number = np.append(np.cumsum(is_kept) - 1, NO_NEIGHBOR)  # the last for no neighbour
    number[:-1][~is_kept] = NO_NEIGHBOR
    kept = np.ascontiguousarray(triangles[is_kept])
    return kept, number[neighbors[is_kept]].astype(np.int32)


def take_without_slivers(tin: TIN) -> TIN:
    """Return a TIN without the triangles that :func:`find_slivers` finds."""
    triangles, _ = leave_out_slivers(tin.points, tin.triangles, tin.neighbors)
    return tin if triangles is tin.triangles else TIN.from_triangles(tin.points, triangles)


def find_slivers(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    rounding: float | None = None,
    *,
    is_inner: BoolArray | None = None,
) -> BoolArray:
    """Tell which triangles lie along the boundary by rounding only: (m,).

    The boundary points of a turned grid, or of a slanted line, are collinear as surveyed and not in
    doubles: the hull has triangles there with a height of a few roundings and any slope, whose
    longest edge lies in the boundary, or two of their edges. Without them others do, and follow.
    The boundary moves by no more than their heights. None is one if all would be. Of a part of a
    surface ``is_inner`` tells which triangles have all their neighbours: others are none.
    """
    if rounding is None:
        rounding = measure_rounding(points)
    is_thin, longest = _measure_thin(points, triangles, rounding)
    if is_inner is not None:
        is_thin &= is_inner
    is_sliver = np.zeros(len(triangles), bool)
    pending = np.flatnonzero(is_thin).tolist()
    while pending:
        triangle = pending.pop()
        if is_sliver[triangle]:
            continue
        across = neighbors[triangle].tolist()
        is_open = [other == NO_NEIGHBOR or is_sliver[other] for other in across]
        if is_open[longest[triangle]] or sum(is_open) > 1:
            is_sliver[triangle] = True
            pending += [other for other in across if other != NO_NEIGHBOR and is_thin[other]]
    return is_sliver & ~is_sliver.all()


def find_thin(points: Float64Array, triangles: Int32Array, rounding: float) -> BoolArray:
    """Tell which triangles are so thin that :func:`find_slivers` may find them."""
    return _measure_thin(points, triangles, rounding)[0]


def _measure_thin(
    points: Float64Array, triangles: Int32Array, rounding: float
) -> tuple[BoolArray, Int64Array]:
    """Tell which triangles are thinner above their longest edge, which is returned too.

    Counted from the first corner by easting, then northing, however corners are numbered.
    """
    height = _ROUNDINGS * rounding
    xy = points[triangles, :2]
    is_west = xy[..., 0] == xy[..., 0].min(axis=1)[:, None]
    first = np.argmin(np.where(is_west, xy[..., 1], np.inf), axis=1)
    xy = xy[np.arange(len(xy))[:, None], (first[:, None] + (0, 1, 2)) % 3]
    edges = xy[:, [2, 0, 1]] - xy[:, [1, 2, 0]]
    (ux, uy), (vx, vy) = edges[:, 1].T, edges[:, 2].T
    lengths = np.hypot(edges[..., 0], edges[..., 1])
    with np.errstate(over="ignore", invalid="ignore"):
        is_thin = np.abs(ux * vy - uy * vx) <= height * lengths.max(axis=1)
    return is_thin, (lengths.argmax(axis=1) + first) % 3
