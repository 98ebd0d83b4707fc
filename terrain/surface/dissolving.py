"""Dissolving: triangles of one class become polygons with holes, vertex by vertex exact."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from ...base.results import Features
from ...tin.topology import NO_NEIGHBOR, boundary_walks, gather, neighbors_of
from .. import _kernel
from .sorting import sort_by

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...base.results import Units
    from ...tin import TIN


class Mesh(Protocol):
    """Triangles that share their vertices: a TIN, or what has these of its arrays."""

    @property
    def points(self) -> Float64Array:
        """Vertices, (n, 2) or (n, 3)."""

    @property
    def triangles(self) -> Int32Array:
        """Of vertices, counter-clockwise."""

    @property
    def neighbors(self) -> Int32Array:
        """Across each edge, -1 outside."""


class DividedMesh(NamedTuple):
    """Triangles that share their vertices, each a part of something: a triangle, a region."""

    points: Float64Array
    triangles: Int32Array
    neighbors: Int32Array
    owners: Int64Array
    """(m,), what each triangle is a part of."""

    @classmethod
    def of(cls, points: Float64Array, triangles: Int32Array, owners: Int64Array) -> DividedMesh:
        """Return triangles with their neighbours."""
        return cls(points, triangles, neighbors_of(triangles, len(points)), owners)


class Dissolved(NamedTuple):
    """Polygons of vertices, as :meth:`Features.of_polygons` takes them."""

    vertices: Int64Array
    """(n,), of all rings, each closed."""
    ring_offsets: Int64Array
    polygon_offsets: Int64Array
    feature_offsets: Int64Array
    """A feature has all polygons of a class."""
    classes: Int64Array
    """(n_features,), those that have a triangle, ascending."""


def dissolve(tin: Mesh, classes: Int64Array) -> Dissolved:
    """Join the triangles of each class to polygons; those of a class below 0 are left out.

    1. Two triangles of one class that share an edge belong to one polygon; those that only share a
       vertex do not, so that the inside of every polygon is connected.
    2. The boundary is walked with the inside on the left. A walk that comes to a vertex again is
       cut there: rings touch in points, and never themselves.
    3. Of the rings of a polygon the exterior is the one through its westernmost vertex (of several
       the southernmost); the others are its holes. No point in polygon is asked for.

    Vertices are those of the TIN, and nothing is computed with them but the choice in 3, so that
    the polygons tile the triangles exactly. Linear in the triangles, but for sorting.
    """
    wanted = np.flatnonzero(classes >= 0)
    if len(wanted) == 0:
        nothing = np.zeros(1, np.int64)
        return Dissolved(nothing[:0], nothing, nothing, nothing, nothing[:0])
    neighbors = tin.neighbors.copy()
    for side in neighbors.T:
        side[classes[side] != classes] = NO_NEIGHBOR  # which stays so, whatever that compares
    parts = number_components(neighbors)
    rings = _trace_rings(tin.triangles, neighbors, parts, classes)
    return _as_levels(rings, _sort_exteriors_first(rings, classes, tin.points), classes)


def make_polygons(
    tin: TIN,
    found: Dissolved,
    *,
    columns: Mapping[str, Any],
    units: Units,
    name: str,
    notes: Sequence[str],
    points: Float64Array | None = None,
) -> Features:
    """Return the polygons of classes as features, in the plane of the CRS of their TIN.

    ``points`` are their vertices; default those of the TIN.
    """
    return Features.of_polygons(
        (tin.points if points is None else points)[found.vertices, :2],
        found.ring_offsets,
        found.polygon_offsets,
        found.feature_offsets,
        columns=columns,
        units=units,
        crs=None if tin.crs is None else tin.crs.horizontal,
        name=name,
        notes=notes,
    )


class _Rings(NamedTuple):
    """Open rings, one after the other, and the component that each bounds."""

    vertices: Int64Array
    offsets: Int64Array
    parts: Int64Array


def number_components(neighbors: Int32Array) -> Int64Array:
    """Return the smallest triangle that each is connected to."""
    return _kernel.number_components(neighbors)


def join_components(count: int, one: Int64Array, other: Int64Array) -> Int64Array:
    """Return the smallest of so many numbers that each is connected to, by pairs of them."""
    pairs = (np.ascontiguousarray(numbers, np.int64) for numbers in (one, other))
    return _kernel.join_components(count, *pairs)


def follow_to_end(nexts: Int64Array) -> Int64Array:
    """Return for each number the last one of the way that ``nexts`` lead, which is its own next."""
    while True:
        further = nexts[nexts]
        if np.array_equal(further, nexts):
            return nexts
        nexts = further


def _trace_rings(
    triangles: Int32Array,
    neighbors: Int32Array,
    parts: Int64Array,
    classes: Int64Array,
) -> _Rings:
    """Return rings that never meet a vertex twice."""
    edges, offsets = boundary_walks(triangles, neighbors)
    first = edges[offsets[:-1]] // 3
    is_wanted = classes[first] >= 0
    chosen, _ = gather(offsets, np.flatnonzero(is_wanted))
    edges, first = edges[chosen], first[is_wanted]
    lengths = np.diff(offsets)[is_wanted]
    vertices = triangles[edges // 3, (edges % 3 + 1) % 3].astype(np.int64)
    walks = _Rings(vertices, np.append(0, np.cumsum(lengths)), parts[first])
    return _drop_repeats(walks)


def _drop_repeats(walks: _Rings) -> _Rings:
    """Cut the walks that meet a vertex twice."""
    lengths = np.diff(walks.offsets)
    walk = np.repeat(np.arange(len(lengths)), lengths)
    keys = np.sort(walk * (walks.vertices.max() + 1) + walks.vertices)
    repeated = np.unique(keys[1:][keys[1:] == keys[:-1]] // (walks.vertices.max() + 1))
    if len(repeated) == 0:
        return walks
    is_whole = np.ones(len(lengths), np.bool_)
    is_whole[repeated] = False
    pieces: list[int] = []
    counts: list[int] = []
    owners: list[int] = []
    for number in repeated.tolist():
        begin, end = walks.offsets[number : number + 2].tolist()
        for piece in cut_at_repeats(walks.vertices[begin:end].tolist()):
            pieces += piece
            counts.append(len(piece))
            owners.append(int(walks.parts[number]))
    vertices = np.append(walks.vertices[is_whole[walk]], np.array(pieces, np.int64))
    lengths = np.append(lengths[is_whole], np.array(counts, np.int64))
    parts = np.append(walks.parts[is_whole], np.array(owners, np.int64))
    return _Rings(vertices, np.append(0, np.cumsum(lengths)), parts)


def cut_at_repeats(walk: list[int]) -> list[list[int]]:
    """Cut a closed walk into rings, each of which meets every vertex once."""
    rings: list[list[int]] = []
    path: list[int] = []
    place: dict[int, int] = {}
    for vertex in walk:
        if vertex in place:
            begin = place[vertex]
            rings.append(path[begin:])
            for gone in path[begin:]:
                del place[gone]
            del path[begin:]
        place[vertex] = len(path)
        path.append(vertex)
    rings.append(path)
    return rings


def _sort_exteriors_first(rings: _Rings, classes: Int64Array, points: Float64Array) -> Int64Array:
    """Sort rings by class, by polygon, and within it the exterior before the holes."""
    is_used = np.zeros(len(points), np.bool_)
    is_used[rings.vertices] = True
    used = np.flatnonzero(is_used)
    rank = np.empty(len(points), np.int64)
    rank[used[sort_by(*points[used, :2].T)]] = np.arange(len(used))
    western = np.minimum.reduceat(rank[rings.vertices], rings.offsets[:-1])
    # Where a hole touches its exterior in the westernmost vertex, the exterior turns left.
    areas = _measure_ring_areas(points, rings)
    return np.lexsort((-areas, western, rings.parts, classes[rings.parts]))


def _measure_ring_areas(points: Float64Array, rings: _Rings) -> Float64Array:
    """Return twice the signed area of each ring."""
    starts, ends = rings.offsets[:-1], rings.offsets[1:]
    x, y = (np.ascontiguousarray(axis)[rings.vertices] for axis in points[:, :2].T)
    lengths = ends - starts
    x, y = (axis - np.repeat(axis[starts], lengths) for axis in (x, y))
    following = np.arange(1, len(rings.vertices) + 1)
    following[ends - 1] = starts
    turns = x * y[following] - x[following] * y
    areas: Float64Array = np.add.reduceat(turns, starts)
    return areas


def _as_levels(rings: _Rings, order: Int64Array, classes: Int64Array) -> Dissolved:
    """Close the rings in some order, and count them by polygon and by class."""
    parts = rings.parts[order]
    slots, owner = gather(rings.offsets, order)
    lengths = np.bincount(owner, minlength=len(order))
    ends = np.cumsum(lengths)
    vertices = rings.vertices[slots]
    closed = np.insert(vertices, ends, vertices[ends - lengths])
    polygon_starts = np.flatnonzero(np.append(True, parts[1:] != parts[:-1]))
    class_of = classes[parts[polygon_starts]]
    feature_starts = np.flatnonzero(np.append(True, class_of[1:] != class_of[:-1]))
    return Dissolved(
        closed,
        np.append(0, np.cumsum(lengths + 1)),
        np.append(polygon_starts, len(order)),
        np.append(feature_starts, len(polygon_starts)),
        class_of[feature_starts].astype(np.int64),
    )
