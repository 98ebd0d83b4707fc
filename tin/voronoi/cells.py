r"""Voronoi cells within a box, from the Delaunay triangulation, as arrays.

A half-edge is an edge of a triangle as that triangle walks it, counter-clockwise; it is numbered
``3 * triangle + opposite corner``. Half-edges of the outer side of the hull follow::

          left triangle            Each is dual to one side of its start's cell: the part of the
              . c .                bisector between two circumcentres, walked with the cell on the
           start -> end            left. It ends at the circumcentre of the triangle on its left,
             \  .                  and begins where its twin, end -> start, ends.
          right triangle
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel, topology
from ..topology import NO_NEIGHBOR, find_offsets
from .exact_corners import ExactPlane

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, Int64Array
    from ...base.types import Bounds
    from .._kernel import Growth

_OUTSIDE = -1


class Rings(NamedTuple):
    """Rings one after the other, ring i between ``offsets[i]`` and ``offsets[i + 1]``."""

    coords: Float64Array
    offsets: Int64Array


class _HalfEdges(NamedTuple):
    start: Int64Array
    left: Int64Array
    twin: Int64Array


class _Centres(NamedTuple):
    """Circumcentres, (m, 2), and where they lie: inside the box, outside, or in doubt.

    To the bit equal for triangles of one circle.
    """

    points: Float64Array
    where: Int8Array


def cells_in_box(xy: Float64Array, growth: Growth, box: Bounds) -> Rings:
    """Return the Voronoi cell of each place within a box that holds them all.

    1. Turn about every vertex: its half-edges in order, by walking from twin to twin.
    2. Circumcentres, one for all triangles of a circle, which exact predicates find. Those that
       doubles leave in doubt, or know badly, are computed exactly and rounded.
    3. A cell whose circumcentres all lie strictly inside the box has them as corners, in turn.
    4. Any other cell is cut out of the box by the bisectors with its Delaunay neighbours, exactly;
       its corners are rounded at the end.

    A corner is one place, rounded once, whichever cell it is asked for: neighbours share it to the
    bit, and so the cells tile the box, however near to each other vertices lie and however far out
    circumcentres do.

    Parameters
    ----------
    xy : (n, 2) float64 array
        Distinct places.
    growth : Growth
        Their Delaunay triangulation.
    box : Bounds

    Returns
    -------
    Rings
        n rings, counter-clockwise, the first corner not repeated; no two corners in a row equal. A
        cell narrower than the rounding of coordinates can be empty.
    """
    plane = ExactPlane(xy, box)
    edges = _gather_half_edges(growth.triangles, growth.neighbors)
    order = _sort_around_vertices(edges, len(xy), len(growth.triangles))
    centres, is_cut = _find_centres_and_cut_cells(xy, growth.triangles, edges, plane, box=box)
    cut = _cut_cells(plane, edges, order, is_cut)
    inner = order[~is_cut[edges.start[order]]]
    counts = np.bincount(edges.start[inner], minlength=len(xy))
    counts[is_cut] = cut.counts
    is_of_cut = np.repeat(is_cut, counts)
    coords = np.empty((len(is_of_cut), 2))
    coords[is_of_cut] = cut.coords
    coords[~is_of_cut] = centres[edges.left[inner]]
    cell = np.repeat(np.arange(len(xy)), counts)
    differs = (coords != coords[_find_following(find_offsets(counts))]).any(axis=1)
    counts = np.bincount(cell[differs], minlength=len(xy))
    # cells of fewer than three corners, of the width of a rounding, are empty
    left = np.where(counts >= 3, counts, 0)
    return Rings(coords[differs][np.repeat(left > 0, counts)], find_offsets(left))


def measure_signed_areas(rings: Rings) -> Float64Array:
    """Return the area of each ring, positive counter-clockwise, 0 for an empty one."""
    count = np.diff(rings.offsets)
    ring = np.repeat(np.arange(len(count)), count)
    relative = rings.coords - rings.coords[rings.offsets[:-1][ring]]
    following = relative[_find_following(rings.offsets)]
    doubled = relative[:, 0] * following[:, 1] - relative[:, 1] * following[:, 0]
    return np.asarray(0.5 * np.bincount(ring, doubled, minlength=len(count)), np.float64)


# ---------------------------------------------------------------- around a vertex


def _gather_half_edges(triangles: Int32Array, neighbors: Int32Array) -> _HalfEdges:
    across = neighbors.ravel()
    n_inner = across.size
    start, end = topology.directed_edges(triangles)
    boundary = np.flatnonzero(across == NO_NEIGHBOR)
    met = np.flatnonzero(across != NO_NEIGHBOR)
    corner = np.argmax(neighbors[across[met]] == (met // 3)[:, None], axis=1)
    twin = np.empty(n_inner + len(boundary), np.int64)
    twin[met] = 3 * across[met].astype(np.int64) + corner
    twin[boundary] = n_inner + np.arange(len(boundary))
    twin[n_inner:] = boundary
    return _HalfEdges(
        start=np.concatenate([start.ravel(), end.ravel()[boundary]]),
        left=np.concatenate([np.arange(n_inner) // 3, np.full(len(boundary), _OUTSIDE)]),
        twin=twin,
    )


def _sort_around_vertices(edges: _HalfEdges, n_vertices: int, n_triangles: int) -> Int64Array:
    """Return the half-edges by start, and counter-clockwise around it; on the hull from the hull.

    How far each is from the last one is counted by doubling: as many rounds as the logarithm of
    the largest degree.
    """
    number = np.arange(len(edges.start))
    inner = number[: 3 * n_triangles]
    first = np.empty(n_vertices, np.int64)
    first[edges.start] = number
    boundary = edges.twin[len(inner) :]
    first[edges.start[boundary]] = boundary
    following = number.copy()
    following[inner] = edges.twin[inner + np.where(inner % 3 == 0, 2, -1)]
    following = np.where(following == first[edges.start], number, following)
    to_last = (following != number).astype(np.int64)
    while (beyond := to_last[following]).any():
        to_last += beyond
        following = following[following]
    begin = np.cumsum(np.bincount(edges.start, minlength=n_vertices))
    order = np.empty_like(number)
    order[begin[edges.start] - 1 - to_last] = number
    return order


# ---------------------------------------------------------------- circumcentres

_INSIDE, _DOUBTFUL, _BEYOND = 1, 0, -1

_LARGEST_CONDITION = 64.0
"""By which the rounding of a circumcentre may be larger than that of its coordinates."""

_LARGEST_TOLD = 2.0**45
"""Condition up to which the bound of a circumcentre's error holds."""

_ROUNDING = 16 * np.finfo(np.float64).eps
"""Of a circumcentre in doubles, relative to its terms; amply above what they add up to."""


def _find_centres_and_cut_cells(
    xy: Float64Array, triangles: Int32Array, edges: _HalfEdges, plane: ExactPlane, *, box: Bounds
) -> tuple[Float64Array, BoolArray]:
    """Return the circumcentres of all triangles, and which vertices' cells the box may cut.

    Corners of cells that are cut are exact; so must be those that other cells share with them.
    """
    # for each triangle the first one of those on the same circle, exactly
    inner = np.arange(triangles.size)
    once = inner[edges.twin[: triangles.size] > inner]
    once = once[edges.left[edges.twin[once]] != _OUTSIDE]
    twin = edges.twin[once]
    opposite = triangles.ravel()[twin]
    a, b, c = (xy[triangles[once // 3, k]] for k in range(3))
    tied = _kernel.in_circle(a, b, c, xy[opposite]) == 0
    first = _find_first_of_group(once[tied] // 3, twin[tied] // 3, len(triangles))
    found = _find_circles(xy, triangles, box)
    centres = _Centres(found.points[first], found.where[first])
    is_exact = centres.where == _DOUBTFUL
    _set_exactly(centres, first, is_exact, triangles, plane)
    is_cut = np.zeros(len(xy), np.bool_)
    is_cut[triangles[centres.where == _BEYOND]] = True
    boundary = np.arange(triangles.size, len(edges.start))
    is_cut[edges.start[boundary]] = is_cut[edges.start[edges.twin[boundary]]] = True
    corners = is_cut[triangles].sum(axis=1)
    is_shared = np.bincount(first, (corners > 0) & (corners < 3), len(triangles)) > 0
    is_shared = is_shared[first] & ~is_exact & (centres.where == _INSIDE)
    _set_exactly(centres, first, is_shared, triangles, plane)
    return centres.points, is_cut


def _set_exactly(
    centres: _Centres,
    first: Int64Array,
    which: BoolArray,
    triangles: Int32Array,
    plane: ExactPlane,
) -> None:
    """Compute some circumcentres exactly, and where they lie; ``which`` holds whole circles."""
    for t in np.flatnonzero(which & (first == np.arange(len(first)))).tolist():
        point = plane.centre(*triangles[t].tolist())
        centres.where[t] = _BEYOND if point is None else _INSIDE
        if point is not None:
            centres.points[t] = point
    centres.points[which] = centres.points[first[which]]
    centres.where[which] = centres.where[first[which]]


def _find_circles(xy: Float64Array, triangles: Int32Array, box: Bounds) -> _Centres:
    """Return circumcentres, and what is sure of where they lie; doubtful if not known well.

    They are computed from the corner between the two shorter sides, where the rounding of the area
    is least, relative to the longest side.
    """
    corners = [xy[triangles[:, k]] for k in range(3)]
    lengths = [((corners[k - 2] - corners[k - 1]) ** 2).sum(axis=1) for k in range(3)]
    apex = np.argmax(lengths, axis=0)
    rows = np.arange(len(triangles))
    origin, one, other = (xy[triangles[rows, (apex + k) % 3]] for k in range(3))
    u, w = one - origin, other - origin
    left, right = u[:, 0] * w[:, 1], u[:, 1] * w[:, 0]
    uu, ww = (u**2).sum(axis=1), (w**2).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        condition = (np.abs(left) + np.abs(right)) / (left - right)
        half = 0.5 / (left - right)
        x = origin[:, 0] + half * (w[:, 1] * uu - u[:, 1] * ww)
        y = origin[:, 1] + half * (u[:, 0] * ww - w[:, 0] * uu)
        longer = np.maximum(uu, ww)
        terms = 2.0 * condition * longer * np.sqrt(longer) * half
        error = _ROUNDING * (terms + np.maximum(np.abs(x), np.abs(y)))
        depth = np.minimum(
            np.minimum(x - box.xmin, box.xmax - x), np.minimum(y - box.ymin, box.ymax - y)
        )
        is_told = (condition > 0) & (condition < _LARGEST_TOLD)
        is_inside = is_told & (depth > error) & (condition < _LARGEST_CONDITION)
        is_beyond = is_told & (depth < -error)
    where = is_inside.astype(np.int8) - is_beyond.astype(np.int8)
    return _Centres(np.stack([x, y], axis=1), where)


def _find_first_of_group(one: Int64Array, other: Int64Array, count: int) -> Int64Array:
    """Join pairs to groups, and return for each member the smallest of its group."""
    first = np.arange(count)
    while True:
        low, high = np.minimum(first[one], first[other]), np.maximum(first[one], first[other])
        if (low == high).all():
            return first
        np.minimum.at(first, high, low)
        while (first != first[first]).any():
            first = first[first]


# ---------------------------------------------------------------- rings


class _CutCells(NamedTuple):
    """Corners of cells one after the other, and how many each has."""

    coords: Float64Array
    counts: list[int]


def _cut_cells(
    plane: ExactPlane,
    edges: _HalfEdges,
    order: Int64Array,
    is_cut: BoolArray,
) -> _CutCells:
    """Return the cells that the box may cut, in the order of their vertices."""
    mine = order[is_cut[edges.start[order]]]
    neighbors = edges.start[edges.twin[mine]].tolist()
    ends = np.cumsum(np.bincount(edges.start[mine], minlength=len(is_cut)))[is_cut].tolist()
    coords: list[tuple[float, float]] = []
    counts = []
    for vertex, begin, end in zip(
        np.flatnonzero(is_cut).tolist(), [0, *ends[:-1]], ends, strict=True
    ):
        # drop corners that rounding made equal, and those to which a ring goes out and back again
        kept: list[tuple[float, float]] = []
        for corner in plane.cell(vertex, neighbors[begin:end]):
            if len(kept) >= 2 and kept[-2] == corner:
                kept.pop()
            elif not kept or kept[-1] != corner:
                kept.append(corner)
        while len(kept) >= 2 and (
            kept[0] == kept[-1] or kept[1] == kept[-1] or kept[0] == kept[-2]
        ):
            if kept[1] == kept[-1] and kept[0] != kept[-1]:
                kept.pop(0)
            else:
                kept.pop()
        coords += kept
        counts.append(len(kept))
    return _CutCells(np.array(coords, np.float64).reshape(-1, 2), counts)


def _find_following(offsets: Int64Array) -> Int64Array:
    """Return for each corner the number of the next one in its ring."""
    following = np.arange(1, offsets[-1] + 1)
    is_full = np.diff(offsets) > 0
    following[offsets[1:][is_full] - 1] = offsets[:-1][is_full]
    return following
