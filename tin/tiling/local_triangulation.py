"""The triangles of a whole surface that meet a box, each proven from what lies near.

Ties between cocircular points are broken by the points' own coordinates, so the constrained
Delaunay triangulation is a function of the sets of points and segments. A triangle of some of them
that meets no other segment, and whose closed circumscribed disc holds no other vertex that is seen
from it, is therefore one of the whole, whatever else there is: what was not looked at can only hide
more of what was.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from .. import _kernel
from ..building import merge_rows
from ..topology import edge_keys, ends
from .boxes import are_in_box, list_sides, widen
from .circles import bound_discs
from .duplicates import list_differing
from .rings import find_inside
from .sources import NumberedPoints, NumberedSegments
from .unseen import UnsettledTriangles, count_taken, find_unseen_points, find_unseen_segments
from .visibility import Views, find_views

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import DuplicatePolicy
    from ...base.types import Bounds
    from .rings import Rings
    from .sources import PointSource, SegmentSource

_EVERYWHERE = (-np.inf, -np.inf, np.inf, np.inf)

_WORTH_LOOKING = 20_000
"""Points from which on it is worth while to look at some of them first."""
_MOST_LOOKS = 8
"""Rings reach further with each answer."""
_THINNING = 16
"""Of the points far inside one of so many is enough to tell what those at the rim will ask for."""


class LocalTriangulation(NamedTuple):
    """Triangles of the whole surface that meet a box, and their vertices.

    Attributes
    ----------
    points : (n, 3) float64 array
        The vertices, with the elevations that they have in the whole.
    numbers : (n,) int64 array
        The first row, among all, that each stands for; ascending.
    triangles : (m, 3) int32 array
        Counter-clockwise from the vertex with the least easting, then northing: the same for each
        triangle, whatever box it is asked with.
    neighbors : (m, 3) int32 array
        The triangle across the edge opposite each corner; -1 where none of these is.
    constrained : (m, 3) bool array
        Whether the edge opposite each corner is a segment of a line.
    owned : (m,) bool array
        Whether the first corner lies in the box without its eastern and northern side. Of boxes
        that tile the plane each triangle has one owner.
    cutting : (h,) bool array
        Which holes cut away triangles that meet the box.
    rounds : int
        How often the source was asked for more.
    differing : (k, 3) float64 array
        Places at which points differ in elevation, and by how much, of all points in ``around``
        and some others.
    """

    points: Float64Array
    numbers: Int64Array
    triangles: Int32Array
    neighbors: Int32Array
    constrained: BoolArray
    owned: BoolArray
    cutting: BoolArray
    rounds: int
    differing: Float64Array


def triangulate_box(
    source: PointSource,
    box: Bounds,
    *,
    around: Bounds | None = None,
    lines: SegmentSource | None = None,
    duplicates: DuplicatePolicy = "mean",
    rings: int = 0,
    threads: int = 1,
    ordered: bool = True,
) -> LocalTriangulation:
    """Return the triangles of the whole surface that meet a closed box.

    Parameters
    ----------
    source : PointSource
    box : Bounds
    around : Bounds, optional
        Box whose points and segments are read at once; a margin of some ten distances between
        points spares most questions. Default the box itself.
    lines : SegmentSource, optional
    duplicates : DuplicatePolicy
        As of :func:`tinsmith.triangulate`.
    rings : int
        How often to go on to all triangles around the vertices of these.
    threads : int
    ordered : bool
        Whether triangles are in the order of the numbers of their first and second corners. Else
        they are in the order in which they are found, where neighbours mostly lie side by side:
        another one with other points around, and had for less time.

    Raises
    ------
    PointsError
        If all points are collinear, or rows of vertices coincide and may not.
    """
    around = box if around is None else around
    seen = _Seen(source, lines, around)
    proven = np.empty((0, 3), np.int64)
    if lines is None:
        proven = _look_beyond(seen, box, around, rings, threads)
    rounds = 0
    while True:
        made = _triangulate(seen, threads)
        found = _find(made, box, around, rings)
        names, unsettled = _find_open(made, found, around, proven, seen.segments)
        unsettled = unsettled._replace(most=count_taken(rounds))
        is_safe, has_more = seen.ask(unsettled)
        if not has_more:
            break
        rounds += 1
        proven = np.concatenate([proven, names[is_safe]])
    merged = merge_rows(seen.points.points, made.kept_row, duplicates, seen.points.numbers)
    local = _extract(made, found, merged.points, ordered=ordered)._replace(
        rounds=rounds, differing=list_differing(merged.points, merged.account)
    )
    if len(seen.segments.are_rings):
        at = np.searchsorted(local.numbers, seen.segments.vertices.numbers)
        is_there = np.append(local.numbers, -1)[at] == seen.segments.vertices.numbers
        local.points[at[is_there], 2] = seen.segments.vertices.points[is_there, 2]
    if lines is None or lines.rings is None:
        return local
    return _cut(local, seen.segments, lines.rings)


def _look_beyond(seen: _Seen, box: Bounds, around: Bounds, rings: int, threads: int) -> Int64Array:
    """Ask for what most triangles at the rim of a large box will ask for, before all are made.

    They are about the same with few of the points far inside, and are had for a fraction of the
    time. What is found more than needed does no harm. Returns the names of triangles in whose discs
    nothing unseen lies, whether they are made of all points or not.
    """
    nothing = proven = np.empty((0, 3), np.int64)
    points = seen.points
    sides = zip(list_sides(box), list_sides(around), strict=True)
    margins = [abs(own - outer) for own, outer in sides if np.isfinite(own)]
    if len(points.points) < _WORTH_LOOKING or not margins:
        return nothing
    is_taken = ~are_in_box(points.points, widen(box, -max(margins)))
    is_taken[::_THINNING] = True
    some = points.choose(np.flatnonzero(is_taken))
    for rounds in range(_MOST_LOOKS if rings else 1):
        try:
            made = _sweep(some, threads)
        except PointsError:  # all in line: those of all may not be
            return nothing
        found = _find(made, box, around, rings)
        names, unsettled = _find_open(made, found, around, proven, seen.segments)
        is_safe, has_more = seen.ask(unsettled._replace(most=count_taken(rounds)))
        proven = np.concatenate([proven, names[is_safe]])
        if not has_more:
            break
        some = some.add(seen.latest)
    return proven


class _Found(NamedTuple):
    """Triangles, as the core finds them: see ``_kernel.find_in_box``."""

    chosen: Int32Array
    firsts: AnyArray
    owned: BoolArray
    open: Int32Array


def _find(made: _Made, box: Bounds, around: Bounds, rings: int) -> _Found:
    """Return the triangles that meet a box, and rings around them, which it does not own."""
    met = _kernel.find_in_box(made.places, made.triangles, list_sides(box), list_sides(around))
    if rings == 0:
        return _Found(met.chosen, met.firsts, met.owned, met.open)
    chosen = met.chosen
    for _ in range(rings):
        chosen = find_around(made.triangles, chosen, len(made.places))
    corners = np.ascontiguousarray(made.triangles[chosen])
    every = _kernel.find_in_box(made.places, corners, _EVERYWHERE, list_sides(around))
    owned = np.zeros(len(chosen), np.bool_)
    owned[np.searchsorted(chosen, met.chosen)] = met.owned
    return _Found(chosen, every.firsts, owned, every.open)


def find_around(triangles: Int32Array, chosen: Int32Array, n_vertices: int) -> Int32Array:
    """Return all triangles that have a vertex of chosen ones: these, and a ring around them."""
    is_corner = np.zeros(n_vertices, np.bool_)
    is_corner[triangles[chosen]] = True
    return np.flatnonzero(is_corner[triangles].any(axis=1)).astype(np.int32)


def find_triangles_at(points: Float64Array, triangles: Int32Array, box: Bounds) -> Int32Array:
    """Return the triangles that meet a closed box, exactly; ascending."""
    places = np.ascontiguousarray(points[:, :2])
    return _kernel.find_in_box(places, triangles, list_sides(box), _EVERYWHERE).chosen


class _Seen:
    """The points and segments that are known."""

    def __init__(self, source: PointSource, lines: SegmentSource | None, around: Bounds) -> None:
        self._source, self._lines = source, lines
        self.latest = NumberedPoints.none()
        self.segments = NumberedSegments.none()
        others = source.skeleton
        if lines is not None:
            self.segments = lines.read_box(around)
            others = NumberedPoints.join([others, lines.skeleton, self.segments.vertices])
        self.points = source.read_box(around).sort().add(others.sort())

    def ask(self, unsettled: UnsettledTriangles) -> tuple[BoolArray, bool]:
        """Look at more; tell which triangles are proven, and whether anything was found."""
        points, is_safe = find_unseen_points(self._source, unsettled, self.points.numbers)
        if self._lines is not None:
            segments, is_clear = find_unseen_segments(self._lines, unsettled, self.segments)
            self.segments = self.segments.add(segments)
            points = NumberedPoints.join([points, segments.vertices])
            is_safe &= is_clear
        self.points, self.latest = self.points.add(points), points
        return is_safe, not bool(is_safe.all())


class _Made(NamedTuple):
    """A triangulation of all that is known.

    Attributes
    ----------
    places : (n, 2) float64 array
        Of distinct vertices.
    triangles, neighbors : (m, 3) int32 arrays
    fixed : (m, 3) bool array or None
        Whether an edge is a segment; None if there are no segments.
    rows : (n,) int32 array or None
        The number of each vertex among the kept rows; None if that is its own.
    kept_row : (k,) int32 array or None
        As that of :func:`._kernel.grow`, of all known points.
    first : (n,) int64 array
        The number, among all points, of each kept row.
    """

    places: Float64Array
    triangles: Int32Array
    neighbors: Int32Array
    fixed: BoolArray | None
    rows: Int32Array | None
    kept_row: Int32Array | None
    first: Int64Array

    def list_names(self, triangles: Int32Array) -> Int64Array:
        """Return the numbers of the corners of triangles, ascending."""
        rows = triangles if self.rows is None else self.rows[triangles]
        return np.sort(self.first[rows], axis=1)


def _triangulate(seen: _Seen, threads: int) -> _Made:
    if len(seen.segments.are_rings):
        return _triangulate_constrained(np.ascontiguousarray(seen.points.points), seen, threads)
    return _sweep(seen.points, threads)


def _sweep(known: NumberedPoints, threads: int) -> _Made:
    grown = _kernel.sweep(np.ascontiguousarray(known.points), threads=threads)
    first = _choose_kept(known.numbers, grown.kept_row)
    return _Made(
        grown.places, grown.triangles, grown.neighbors, None, grown.rows, grown.kept_row, first
    )


def _triangulate_constrained(points: Float64Array, seen: _Seen, threads: int) -> _Made:
    mesh, kept_row = _kernel.triangulate_mesh(points, threads=threads)
    kept = _choose_kept(points, kept_row)
    names = np.searchsorted(seen.points.numbers, seen.segments.names)
    if kept_row is not None:
        is_kept = kept_row == np.arange(len(kept_row))
        names = (np.cumsum(is_kept) - 1)[kept_row[names]]
    segments = np.unique(names[names[:, 0] != names[:, 1]], axis=0)
    passed, blocked = mesh.force(segments.astype(np.int32))
    if len(passed) or len(blocked):
        raise AssertionError("lines were not cut at all places where they meet")
    first = _choose_kept(seen.points.numbers, kept_row)
    places = np.ascontiguousarray(kept[:, :2])
    return _Made(places, *mesh.arrays(threads), None, kept_row, first)


def _choose_kept(rows: AnyArray, kept_row: Int32Array | None) -> AnyArray:
    if kept_row is None:
        return rows
    kept: AnyArray = rows[kept_row == np.arange(len(kept_row), dtype=np.int32)]
    return kept


def _find_open(
    made: _Made,
    found: _Found,
    around: Bounds,
    proven: Int64Array,
    segments: NumberedSegments,
) -> tuple[Int64Array, UnsettledTriangles]:
    """Return the names of triangles that are not proven yet, and what to ask for them."""
    number = found.chosen[found.open]
    triangles = made.triangles[number]
    discs = bound_discs(made.places, triangles)
    names = made.list_names(triangles)
    is_open = ~discs.are_within(around) & ~_are_among(names, proven)
    number, triangles = number[is_open], triangles[is_open]
    discs = discs.choose(is_open)
    fixed, views = np.zeros(triangles.shape, np.bool_), Views.unknown(discs)
    if made.fixed is not None:
        fixed = made.fixed[number]
        views = find_views(made.places, made.triangles, made.neighbors, made.fixed, number, discs)
    return names[is_open], UnsettledTriangles(
        made.places[triangles], fixed, discs, segments.ends_in_plane, views, count_taken(0)
    )


def _are_among(names: Int64Array, proven: Int64Array) -> BoolArray:
    if not len(proven):
        return np.zeros(len(names), np.bool_)
    kind = np.dtype((np.void, 24))
    one, other = (np.ascontiguousarray(part).view(kind).ravel() for part in (names, proven))
    return np.isin(one, other)


def _extract(
    made: _Made, found: _Found, merged: Float64Array, *, ordered: bool
) -> LocalTriangulation:
    """Return the triangles found, with their vertices numbered anew."""
    chosen = _kernel.extract(
        made.places,
        made.triangles,
        made.neighbors,
        made.rows,
        made.fixed,
        found.chosen,
        found.firsts,
        ordered,
    )
    fixed = np.zeros(chosen.triangles.shape, np.bool_) if chosen.fixed is None else chosen.fixed
    return LocalTriangulation(
        points=np.take(merged, chosen.vertices, axis=0),
        numbers=made.first[chosen.vertices],
        triangles=chosen.triangles,
        neighbors=chosen.neighbors,
        constrained=fixed,
        owned=found.owned[chosen.order] if ordered else found.owned,
        cutting=np.empty(0, np.bool_),
        rounds=0,
        differing=np.empty((0, 3)),
    )


# ------------------------------------------------------------------------ lines


def _cut(local: LocalTriangulation, segments: NumberedSegments, rings: Rings) -> LocalTriangulation:
    """Return the triangles that are inside rings."""
    barrier = _find_barrier(local, segments.choose(segments.are_rings))
    keep, cutting = find_inside(local.points, local.triangles, local.neighbors, barrier, rings)
    number = np.append(np.where(keep, np.cumsum(keep) - 1, -1), -1).astype(np.int32)
    triangles = local.triangles[keep]
    is_used = np.zeros(len(local.points), np.bool_)
    is_used[triangles] = True
    return LocalTriangulation(
        points=local.points[is_used],
        numbers=local.numbers[is_used],
        triangles=(np.cumsum(is_used, dtype=np.int32) - np.int32(1))[triangles],
        neighbors=number[local.neighbors[keep]],
        constrained=local.constrained[keep],
        owned=local.owned[keep],
        cutting=cutting,
        rounds=local.rounds,
        differing=local.differing,
    )


def _find_barrier(local: LocalTriangulation, rings: NumberedSegments) -> BoolArray:
    """Tell which edges are segments of rings."""
    n = len(local.numbers)
    names = rings.names
    at = np.searchsorted(local.numbers, names)
    is_there = (np.append(local.numbers, -1)[at] == names).all(axis=1)
    triangle, corner = np.nonzero(local.constrained)
    pairs = np.stack(ends(local.triangles, triangle, corner), axis=1)
    is_ring = np.isin(edge_keys(pairs, n), edge_keys(at[is_there], n))
    barrier = np.zeros(local.constrained.shape, np.bool_)
    barrier[triangle[is_ring], corner[is_ring]] = True
    return barrier
