"""Vertices: which way water leaves each of them, along an edge or down a triangle."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...tin.topology import NO_NEIGHBOR, find_triangles, gather, sort_half_edges
from ..surface import cross_exactly
from .falls import find_corners

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...tin.topology import HalfEdges
    from .falls import Falls

NOWHERE = -1
_CLOSE = 1e-9
"""Slopes that differ by less, relative to the steepest, are compared in fractions."""
_ROUNDING = 4 * 2.0**-53
"""Relative error of a product of two differences."""


class Exits(NamedTuple):
    """Steepest descent from vertices: to another one along an edge, or down a triangle."""

    vertices: Int64Array
    """(k,), at the other end of the edge, else ``NOWHERE``."""
    triangles: Int64Array
    """(k,), through which the fall line runs, else ``NOWHERE``."""
    slopes: Float64Array
    """(k,), fall over run, elevations as they are; 0 where there is no descent."""
    leaves: BoolArray
    """(k,), whether water leaves the surface there."""


class _Candidates(NamedTuple):
    """Ways down from vertices, those of each together."""

    owners: Int64Array
    vertices: Int64Array
    triangles: Int64Array
    slopes: Float64Array


def find_exits(
    falls: Falls,
    half_edges: HalfEdges,
    vertices: Int64Array,
    is_boundary: BoolArray,
    levels: Float64Array | None = None,
) -> Exits:
    """Find the steepest descent from vertices, (k,).

    The half-edges are those of the triangles at them, others need not be there; ``is_boundary``
    tells of all vertices, (n,). Where water has levels there is a descent only to where it stands
    lower.

    Candidates are the edges that descend, and the triangles whose fall line through the vertex lies
    inside them. Slopes are compared exactly where doubles cannot tell; of equal ones the direction
    with the smallest azimuth is taken. At the boundary water leaves where nothing descends, and
    where the steepest way is an edge of the boundary across which its triangle drains.
    """
    found = _list_candidates(falls, half_edges, vertices)
    if levels is not None:
        found = _leave_out_water(falls, vertices, found, levels)
    chosen = _choose_steepest(falls, vertices, found)
    to_vertex, to_triangle = (np.full(len(vertices), NOWHERE) for _ in range(2))
    slopes = np.zeros(len(vertices))
    owners = found.owners[chosen]
    to_vertex[owners] = found.vertices[chosen]
    to_triangle[owners] = found.triangles[chosen]
    slopes[owners] = found.slopes[chosen]
    drains = _drains_outwards(falls, half_edges, vertices, to_vertex)
    leaves = is_boundary[vertices] & ((slopes == 0.0) | drains)
    to_vertex[leaves] = NOWHERE
    return Exits(to_vertex, to_triangle, slopes, leaves)


def sort_edges_at(triangles: Int32Array, vertices: Int64Array, count: int) -> HalfEdges:
    """Sort the edges of the triangles at some of so many vertices, and of no others."""
    is_asked = np.zeros(count, np.bool_)
    is_asked[vertices] = True
    one, other, last = is_asked[triangles.T]
    near = np.flatnonzero(one | other | last).astype(np.int32)
    found = sort_half_edges(triangles[near], count)
    return found._replace(triangles=near[found.triangles])


def _list_candidates(falls: Falls, half_edges: HalfEdges, vertices: Int64Array) -> _Candidates:
    """List the edge on one side of each triangle, at the boundary that on the other side, and it.

    In this order, so that those of each vertex are together.
    """
    slots, owners = gather(half_edges.offsets, vertices)
    triangles = half_edges.triangles[slots].astype(np.int64)
    start, z = vertices[owners], falls.points[:, 2]
    corners = find_corners(falls.triangles, triangles, start)
    one, other = falls.ends(triangles, corners)
    is_rim = falls.neighbors[triangles, (corners + 1) % 3] == NO_NEIGHBOR
    signs = [falls.signs[triangles, (corners + turn) % 3] for turn in range(3)]
    is_down = np.empty((len(slots), 3), np.bool_)
    is_down[:, 0] = z[one] < z[start]
    is_down[:, 1] = is_rim & (z[other] < z[start])
    is_down[:, 2] = (signs[0] > 0) & (signs[1] < 0) & (signs[2] < 0)
    slot, kind = np.divmod(np.flatnonzero(is_down), 3)
    ends = np.where(kind == 0, one[slot], other[slot])
    found = _Candidates(
        owners[slot],
        np.where(kind == 2, NOWHERE, ends),
        np.where(kind == 2, triangles[slot], NOWHERE),
        np.empty(len(slot)),
    )
    edges, inside = kind != 2, np.flatnonzero(kind == 2)
    step = falls.points[ends[edges]] - falls.points[start[slot[edges]]]
    slopes = -step[:, 2] / np.hypot(step[:, 0], step[:, 1])
    # Of a fall that underflows there is still a descent.
    found.slopes[edges] = np.maximum(slopes, 5e-324)
    found.slopes[inside] = _measure_triangles(falls, found.triangles[inside])
    return found


def _measure_triangles(falls: Falls, triangles: Int64Array) -> Float64Array:
    a, b, c = (falls.points[falls.triangles[triangles, k]] for k in range(3))
    (east, north, area), poor = _cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):  # those are measured again below
        slopes = np.hypot(east, north) / area
    for row in np.flatnonzero(poor).tolist():
        x, y, whole = cross_exactly(falls.points[falls.triangles[triangles[row]]])
        slopes[row] = math.hypot(float(x / whole), float(y / whole))
    found: Float64Array = slopes
    return found


def _cross(u: Float64Array, v: Float64Array) -> tuple[Any, BoolArray]:
    """Return the components of cross products, and where rounding spoils one."""
    normals, poor = [], np.zeros(len(u), np.bool_)
    for i, j in ((1, 2), (2, 0), (0, 1)):
        left, right = u[:, i] * v[:, j], u[:, j] * v[:, i]
        normals.append(left - right)
        poor |= np.abs(left - right) * _CLOSE < (np.abs(left) + np.abs(right)) * _ROUNDING
    level = [one == 0.0 for one in normals[:2]]
    return normals, poor & ~(level[0] & level[1])


def _leave_out_water(
    falls: Falls, vertices: Int64Array, found: _Candidates, levels: Float64Array
) -> _Candidates:
    """Leave out ways down under water that stands as high as the vertex."""
    z = falls.points[:, 2]
    corners = falls.triangles[found.triangles]
    lowest = corners[np.arange(len(corners)), z[corners].argmin(axis=1)]
    beyond = np.where(found.vertices == NOWHERE, lowest, found.vertices)
    kept = levels[beyond] < z[vertices[found.owners]]
    return _Candidates._make(array[kept] for array in found)


def _choose_steepest(falls: Falls, vertices: Int64Array, found: _Candidates) -> Int64Array:
    """Return the number of the steepest candidate of each vertex that has one."""
    if len(found.owners) == 0:
        return np.zeros(0, np.int64)
    firsts = np.flatnonzero(np.append(True, np.diff(found.owners) != 0))
    group = np.cumsum(np.append(False, np.diff(found.owners) != 0))
    best = np.maximum.reduceat(found.slopes, firsts)[group]
    close = np.flatnonzero(found.slopes >= best - _CLOSE * best)
    is_first = np.append(True, np.diff(group[close]) != 0)
    chosen: Int64Array = close[is_first]
    same = (found.vertices[close] == found.vertices[chosen][group[close]]) & (
        found.triangles[close] == found.triangles[chosen][group[close]]
    )
    for number in np.unique(group[close[~same]]).tolist():
        rivals = close[slice(*np.searchsorted(group[close], [number, number + 1]))]
        origin = int(vertices[found.owners[rivals[0]]])
        keys = [_measure_exactly(falls, origin, found, int(one)) for one in rivals]
        chosen[number] = rivals[min(range(len(rivals)), key=keys.__getitem__)]
    return chosen


def _measure_exactly(
    falls: Falls, origin: int, found: _Candidates, number: int
) -> tuple[Fraction, float]:
    """Return minus the squared slope, exactly, and the azimuth."""
    if found.vertices[number] != NOWHERE:
        ends = [origin, int(found.vertices[number])]
        p, q = ([Fraction(value) for value in falls.points[end].tolist()] for end in ends)
        east, north, fall = (end - start for start, end in zip(p, q, strict=True))
        square = fall * fall / (east * east + north * north)
    else:
        east, north, area = cross_exactly(falls.points[falls.triangles[found.triangles[number]]])
        square = (east * east + north * north) / area**2
    largest = max(abs(east), abs(north))
    return -square, math.atan2(east / largest, north / largest) % math.tau


def _drains_outwards(
    falls: Falls, half_edges: HalfEdges, vertices: Int64Array, ends: Int64Array
) -> BoolArray:
    """Tell which edges are of the boundary, with their triangle draining across them."""
    drains = np.zeros(len(vertices), np.bool_)
    chosen = np.flatnonzero(ends != NOWHERE)
    for start, end in ((vertices, ends), (ends, vertices)):
        left = find_triangles(half_edges, start[chosen], end[chosen])
        right = find_triangles(half_edges, end[chosen], start[chosen])
        rows = np.flatnonzero((left != NO_NEIGHBOR) & (right == NO_NEIGHBOR))
        at = falls.triangles[left[rows]] == start[chosen[rows]][:, None]
        edge = (np.argmax(at, axis=1) + 2) % 3
        drains[chosen[rows]] = falls.signs[left[rows], edge] > 0
    return drains
