"""The triangles of a whole surface that meet a box, each proven from the points near by.

Ties between cocircular points are broken by the points' own coordinates, so the Delaunay
triangulation is a function of the set of points. A triangle of some of the points whose closed
circumscribed disc holds no other point is therefore a triangle of the whole, whatever else there
is: no point that was not looked at can take part in it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel
from ..building.duplicates import merge_rows
from .boxes import are_in_box, find_limits
from .circles import Discs, bound_discs
from .sources import NumberedPoints, PointSource

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import DuplicatePolicy
    from ...base.types import Bounds

__all__ = ["LocalTriangulation", "find_around", "find_triangles_at", "triangulate_box"]

_MOST_OF_A_DISC = 64
"""Points that are taken from one disc in a round: the deepest, which change the triangle most."""


_SLACK = 2.0**-48
_NO_POINTS = NumberedPoints(np.empty((0, 3)), np.empty(0, np.int64))


class LocalTriangulation(NamedTuple):
    """Triangles of the whole surface that meet a box, and their vertices.

    Attributes
    ----------
    points : (n, 3) float64 array
        The vertices, with the elevations that they have in the whole.
    numbers : (n,) int64 array
        The first row, among all, that each stands for; ascending.
    triangles : (m, 3) int32 array
        Counter-clockwise from the vertex with the least easting, then northing, in ascending order
        of these: the same for each triangle, whatever box it is asked with.
    neighbors : (m, 3) int32 array
        The triangle across the edge opposite each corner; -1 where none of these is.
    rounds : int
        How often the source was asked for more.
    """

    points: Float64Array
    numbers: Int64Array
    triangles: Int32Array
    neighbors: Int32Array
    rounds: int


def triangulate_box(
    source: PointSource,
    box: Bounds,
    *,
    around: Bounds | None = None,
    duplicates: DuplicatePolicy = "mean",
    rings: int = 0,
    threads: int = 1,
) -> LocalTriangulation:
    """Return the triangles of the whole surface that meet a closed box.

    Parameters
    ----------
    source : PointSource
    box : Bounds
    around : Bounds, optional
        Box whose points are read at once; a margin of some ten distances between points spares
        most questions. Default the box itself.
    duplicates : DuplicatePolicy
        As of :func:`tinsmith.triangulate`.
    rings : int
        How often to go on to all triangles around the vertices of these.
    threads : int

    Raises
    ------
    PointsError
        If all points are collinear, or rows of vertices coincide and may not.
    """
    around = box if around is None else around
    known = NumberedPoints.join([source.read_box(around), source.skeleton])
    proven = np.empty((0, 3), np.int64)
    rounds = 0
    while True:
        growth = _kernel.grow(np.ascontiguousarray(known.points), threads=threads)
        first = known.numbers if growth.kept_row is None else _choose_first(known, growth.kept_row)
        xy = known.points if growth.kept_row is None else known.points[_is_first(growth.kept_row)]
        meets = find_triangles_at(xy, growth.triangles, box)
        for _ in range(rings):
            meets = find_around(growth.triangles, meets, len(xy))
        asked = growth.triangles[meets]
        discs = bound_discs(xy, asked)
        names = np.sort(first[asked], axis=1)
        is_open = ~discs.are_within(around) & ~_are_among(names, proven)
        asking = np.flatnonzero(is_open)
        question = Question(xy[asked[asking], :2], discs.choose(asking))
        more, is_empty = _ask(source, question, known.numbers)
        if not len(more.numbers):
            break
        rounds += len(asking) > 0
        proven = np.concatenate([proven, names[asking[is_empty]]])
        known = NumberedPoints.join([known, more])
    merged = merge_rows(known.points, growth.kept_row, duplicates, known.numbers)
    return _extract(merged.points, first, growth, meets, rounds)


def _is_first(kept_row: Int32Array) -> BoolArray:
    return np.asarray(kept_row == np.arange(len(kept_row)))


def _choose_first(known: NumberedPoints, kept_row: Int32Array) -> Int64Array:
    return known.numbers[_is_first(kept_row)]


def find_triangles_at(xy: Float64Array, triangles: Int32Array, box: Bounds) -> Int64Array:
    """Return the triangles that meet a closed box, exactly.

    Of convex figures that do not meet, one lies beyond a side of the other.
    """
    corners = xy[triangles, :2]
    low, high = find_limits(box)
    rows = np.flatnonzero(
        ((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)
    )
    doubtful = np.flatnonzero(~are_in_box(corners[rows], box).any(axis=1))
    west, south = np.maximum(low, xy[:, :2].min(axis=0))  # no side of a box at the rim is endless
    east, north = np.minimum(high, xy[:, :2].max(axis=0))
    is_beyond = np.zeros(len(doubtful), np.bool_)
    for k in range(3):
        start, end = corners[rows[doubtful], k], corners[rows[doubtful], (k + 1) % 3]
        is_right = np.ones(len(doubtful), np.bool_)
        for place in ((west, south), (east, south), (east, north), (west, north)):
            places = np.broadcast_to(np.array(place), start.shape)
            is_right &= _kernel.orientation(*map(np.ascontiguousarray, (start, end, places))) < 0
        is_beyond |= is_right
    return np.delete(rows, doubtful[is_beyond])


def find_around(triangles: Int32Array, chosen: Int64Array, n_vertices: int) -> Int64Array:
    """Return all triangles that have a vertex of chosen ones: these, and a ring around them."""
    is_corner = np.zeros(n_vertices, np.bool_)
    is_corner[triangles[chosen]] = True
    return np.flatnonzero(is_corner[triangles].any(axis=1))


class Question(NamedTuple):
    """Triangles that an unseen point may put an end to: their corners (k, 3, 2), and discs."""

    corners: Float64Array
    discs: Discs


def _ask(
    source: PointSource, question: Question, seen: Int64Array
) -> tuple[NumberedPoints, BoolArray]:
    """Return unseen points in the closed discs of triangles, and which discs hold none.

    Of a disc that holds many, those are taken that lie deepest.
    """
    corners, discs = question
    found = source.read_discs(discs) if len(corners) else _NO_POINTS
    found = found.choose(~np.isin(found.numbers, seen))
    found = found.choose(np.argsort(found.points[:, 0], kind="stable"))
    reach = discs.radii + _SLACK * (np.abs(discs.centers[:, 0]) + discs.radii)
    west = np.searchsorted(found.points[:, 0], discs.centers[:, 0] - reach, "left")
    east = np.searchsorted(found.points[:, 0], discs.centers[:, 0] + reach, "right")
    is_wanted = np.zeros(len(found.numbers), np.bool_)
    is_empty = np.ones(len(corners), np.bool_)
    for k in np.flatnonzero(west < east).tolist():
        near = np.arange(west[k], east[k])
        distances = np.hypot(*(found.points[near, :2] - discs.centers[k]).T)
        is_near = distances <= discs.radii[k] * (1 + _SLACK)
        near, distances = near[is_near], distances[is_near]
        is_inside = _are_in_disc(corners[k], found.points[near, :2])
        near, distances = near[is_inside], distances[is_inside]
        is_wanted[near[np.argsort(distances, kind="stable")[:_MOST_OF_A_DISC]]] = True
        is_empty[k] = len(near) == 0
    return found.choose(is_wanted), is_empty


def _are_in_disc(corners: Float64Array, places: Float64Array) -> BoolArray:
    """Tell which places lie in the closed circumscribed disc of a triangle, exactly."""
    a, b, c = (np.broadcast_to(corner, places.shape).copy() for corner in corners)
    return np.asarray(_kernel.in_circle(a, b, c, np.ascontiguousarray(places)) >= 0)


def _are_among(names: Int64Array, proven: Int64Array) -> BoolArray:
    if not len(proven):
        return np.zeros(len(names), np.bool_)
    kind = np.dtype((np.void, 24))
    one, other = (np.ascontiguousarray(part).view(kind).ravel() for part in (names, proven))
    return np.isin(one, other)


def _extract(
    points: Float64Array,
    numbers: Int64Array,
    growth: _kernel.Growth,
    chosen: Int64Array,
    rounds: int,
) -> LocalTriangulation:
    """Return some triangles, with their vertices numbered anew, in an order of their own."""
    triangles = growth.triangles[chosen]
    place = np.empty(len(points), np.int64)
    place[np.lexsort((points[:, 1], points[:, 0]))] = np.arange(len(points))
    turns = (np.arange(3) + np.argmin(place[triangles], axis=1)[:, None]) % 3
    triangles = np.take_along_axis(triangles, turns, axis=1)
    order = np.lexsort(place[triangles].T[::-1])
    chosen, triangles, turns = chosen[order], triangles[order], turns[order]
    is_used = np.zeros(len(points), np.bool_)
    is_used[triangles] = True
    vertex = np.cumsum(is_used, dtype=np.int32) - np.int32(1)
    number = np.full(len(growth.triangles) + 1, -1, np.int32)
    number[chosen] = np.arange(len(chosen), dtype=np.int32)
    return LocalTriangulation(
        points=points[is_used],
        numbers=numbers[is_used],
        triangles=vertex[triangles],
        neighbors=np.take_along_axis(number[growth.neighbors[chosen]], turns, axis=1),
        rounds=rounds,
    )
