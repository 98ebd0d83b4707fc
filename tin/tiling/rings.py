"""Which triangles of a part lie inside the boundary and outside the holes of the whole."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel
from ..constraints import in_rings

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Rings:
    """Rings of a surface as its lines run, cut where they meet other lines.

    Attributes
    ----------
    boundary, extent : lists of (k, 2) float64 arrays
        The surface lies inside an odd number of rings of each, if there are any.
    holes : list of lists of (k, 2) float64 arrays
        The rings of each, the outer one and its islands.
    """

    boundary: list[Float64Array] = field(default_factory=list)
    extent: list[Float64Array] = field(default_factory=list)
    holes: list[list[Float64Array]] = field(default_factory=list)


def find_inside(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    barrier: BoolArray,
    rings: Rings,
) -> tuple[BoolArray, BoolArray]:
    """Tell which triangles lie inside the surface, and which holes cut some away here.

    Parameters
    ----------
    points : (n, 3) float64 array
    triangles, neighbors : (m, 3) int32 arrays
    barrier : (m, 3) bool array
        Whether an edge is a segment of a ring.
    rings : Rings

    Notes
    -----
    Triangles that are joined across edges that are no barrier lie on one side of every ring: one
    place strictly within one of them tells for all.
    """
    region, largest = _kernel.regions(points, triangles, neighbors, barrier)
    corners = points[triangles[largest], :2]
    middles = (
        corners[:, 0] + ((corners[:, 1] - corners[:, 0]) + (corners[:, 2] - corners[:, 0])) / 3
    )
    is_in_doubt = ~_are_strictly_within(corners, middles)
    is_within = np.ones(len(largest), np.bool_)
    for group in (rings.boundary, rings.extent):
        if group:
            is_within &= _are_inside(corners, middles, is_in_doubt, group)
    is_cut = np.zeros(len(largest), np.bool_)
    cuts = np.zeros(len(rings.holes), np.bool_)
    for number, hole in enumerate(rings.holes):
        in_hole = _are_inside(corners, middles, is_in_doubt, hole)
        cuts[number] = (in_hole & is_within).any()
        is_cut |= in_hole
    is_inside: BoolArray = (is_within & ~is_cut)[region]
    return is_inside, cuts


def _are_strictly_within(corners: Float64Array, places: Float64Array) -> BoolArray:
    """Tell which places lie strictly within a triangle each, exactly."""
    turns = [_turn(corners[:, k], corners[:, (k + 1) % 3], places) for k in range(3)]
    return np.asarray(np.min(turns, axis=0) > 0)


def _turn(a: Float64Array, b: Float64Array, c: Float64Array) -> Int8Array:
    return _kernel.orientation(*map(np.ascontiguousarray, (a, b, c)))


def _are_inside(
    corners: Float64Array,
    middles: Float64Array,
    is_in_doubt: BoolArray,
    rings: Sequence[Float64Array],
) -> BoolArray:
    """Tell of which triangles the middle lies inside an odd number of rings."""
    low = np.min([ring.min(axis=0) for ring in rings], axis=0)
    high = np.max([ring.max(axis=0) for ring in rings], axis=0)
    is_inside = np.asarray(((middles >= low) & (middles <= high)).all(axis=1), np.bool_)
    asked = np.flatnonzero(is_inside & ~is_in_doubt)
    is_inside[asked] = in_rings(middles[asked], rings) > 0
    for k in np.flatnonzero(is_in_doubt).tolist():
        is_inside[k] = _is_middle_inside(corners[k].tolist(), rings)
    return is_inside


def _is_middle_inside(corners: list[list[float]], rings: Sequence[Float64Array]) -> bool:
    """Tell the same of a triangle too thin for a rounded middle, in fractions."""
    x, y = (sum(map(Fraction, values)) / 3 for values in zip(*corners, strict=True))
    is_inside = False
    for (ax, ay), (bx, by) in _list_edges_at(rings, float(y)):
        if (ay > y) != (by > y):
            cross = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
            is_inside ^= (cross > 0) == (by > ay)
    return is_inside


def _list_edges_at(
    rings: Sequence[Float64Array], y: float
) -> Iterator[tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]]:
    """Return the edges that may cross a northing, which is rounded, as fractions."""
    for ring in rings:
        closed = np.concatenate([ring, ring[:1]])[:, :2]
        for start, end in pairwise(closed.tolist()):
            if min(start[1], end[1]) <= y <= max(start[1], end[1]):
                yield (
                    (Fraction(start[0]), Fraction(start[1])),
                    (Fraction(end[0]), Fraction(end[1])),
                )
