"""The hierarchy of depressions: how hollows fill, join and spill as water rises."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.topology import find_boundary_vertices
from ..surface import follow_to_end, sort_by
from .vertices import NOWHERE

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from ...tin import TIN


class Hierarchy(NamedTuple):
    """Depressions, those that join before the one that they make."""

    pits: Int64Array
    """(d,), lowest vertex of each."""
    spill_vertices: Int64Array
    """(d,), where each is full: it joins another one, or runs over."""
    parents: Int64Array
    """(d,), the depression that it becomes a part of, ``NOWHERE`` for the outermost ones."""
    basins: Int64Array
    """(n,), for each vertex the smallest depression that its water is in once it is full,
    ``NOWHERE`` if it leaves the surface; it need not be under water then.
    """

    def find_roots(self) -> Int64Array:
        """Return the outermost depression of each."""
        is_outermost = self.parents == NOWHERE
        return follow_to_end(np.where(is_outermost, np.arange(len(self.parents)), self.parents))


def build_hierarchy(tin: TIN, rank: Int64Array | None = None) -> Hierarchy:
    """Find the depressions of a surface from which water runs off freely at the boundary.

    ``rank`` is the place of each vertex as :func:`rank_vertices` has it, by default computed.

    Notes
    -----
    As the water of a piecewise linear surface rises, its parts join at vertices, along edges: so
    the edges alone tell all [1]_. As the depression hierarchy of rasters [2]_ does:

    1. Vertices are ordered by elevation, then easting, then northing. Each belongs to the basin of
       its lowest neighbour; what has no lower one is a pit.
    2. Edges between basins, by the elevation at which they are passed, join them (Kruskal); at a
       vertex on the boundary its basin joins the outside.
    3. Two depressions that join end there, as parts of a new one. What has no depth is no
       depression: it goes on as part of the other. Several that join at one elevation are parts of
       one.

    Linear but for sorting, and a loop over the pits.

    References
    ----------
    .. [1] H. Carr, J. Snoeyink, U. Axen, Computing contour trees in all dimensions, Computational
       Geometry 24 (2003), doi:10.1016/S0925-7721(02)00093-7.
    .. [2] R. Barnes, K. L. Callaghan, A. D. Wickert, Computing water flow through complex
       landscapes, Earth Surface Dynamics 8 (2020), doi:10.5194/esurf-8-431-2020.
    """
    rank = rank_vertices(tin.points) if rank is None else rank
    edges = tin.edges.astype(np.int64)
    basin = _find_basins(rank, edges)
    pits, number = np.unique(basin, return_inverse=True)
    joining = _Joining(rank, pits)
    joining.join(_list_passes(tin, rank, edges, number))
    stands = _leave_out_shallow(joining, tin.points[:, 2])
    kept = np.flatnonzero(stands == np.arange(len(stands)))
    places = np.append(np.full(len(stands), NOWHERE), NOWHERE)
    places[kept] = np.arange(len(kept))
    return Hierarchy(
        np.array(joining.pits, np.int64)[kept],
        np.array(joining.spills, np.int64)[kept],
        places[np.array(joining.parents, np.int64)[kept]],
        places[stands[number]],
    )


def rank_vertices(points: Float64Array) -> Int64Array:
    """Return the place of each vertex in the order of elevations, no two the same."""
    rank = np.empty(len(points), np.int64)
    x, y, z = points.T
    order = np.argsort(y, kind="stable")
    rank[order[sort_by(z[order], x[order])]] = np.arange(len(points))
    return rank


def _find_basins(rank: Int64Array, edges: Int64Array) -> Int64Array:
    """Return the pit of each vertex, by way of the lowest neighbours."""
    lowest = rank.copy()
    for near, far in (edges.T, edges.T[::-1]):
        np.minimum.at(lowest, near, rank[far])
    order = np.empty(len(rank), np.int64)
    order[rank] = np.arange(len(rank))
    return follow_to_end(order[lowest])


class _Passes(NamedTuple):
    """Where basins meet, the lowest such vertex first; basin ``NOWHERE`` is the outside."""

    vertices: Int64Array
    one: Int64Array
    other: Int64Array


def _list_passes(tin: TIN, rank: Int64Array, edges: Int64Array, number: Int64Array) -> _Passes:
    """Return the lowest pass between any two basins, in the order in which water comes to them."""
    rim = np.flatnonzero(find_boundary_vertices(tin.triangles, tin.neighbors, len(tin.points)))
    edges = edges[number[edges[:, 0]] != number[edges[:, 1]]]
    vertices = np.append(
        np.where(rank[edges[:, 0]] > rank[edges[:, 1]], edges[:, 0], edges[:, 1]), rim
    )
    pairs = np.sort(number[edges], axis=1)
    one = np.append(pairs[:, 0], np.full(len(rim), NOWHERE))
    other = np.append(pairs[:, 1], number[rim])
    order = np.lexsort((rank[vertices], other, one))
    one, other, vertices = one[order], other[order], vertices[order]
    first = np.append(True, (np.diff(one) != 0) | (np.diff(other) != 0))[: len(order)]
    one, other, vertices = one[first], other[first], vertices[first]
    order = np.lexsort((other, one, rank[vertices]))
    return _Passes(vertices[order], one[order], other[order])


class _Joining:
    """Joins basins two by two; the last one stands for the outside, which ``NOWHERE`` names.

    Nodes are depressions, with and without depth, those that join before what they make.
    """

    def __init__(self, rank: Int64Array, pits: Int64Array) -> None:
        self._rank = rank
        self._joined = list(range(len(pits) + 1))
        self._node = [*range(len(pits)), NOWHERE]  # of each set of basins
        self.pits: list[int] = pits.tolist()
        self.starts: list[int] = pits.tolist()  # the vertex at which each begins
        self.spills = [NOWHERE] * len(pits)
        self.parents = [NOWHERE] * len(pits)

    def join(self, passes: _Passes) -> None:
        """Join basins pass after pass."""
        outside = len(self._joined) - 1
        for vertex, one, other in zip(*(array.tolist() for array in passes), strict=True):
            first, second = self._find(one), self._find(other)
            if first == second:
                continue
            if self._find(outside) == second:
                first, second = second, first
            if self._find(outside) == first:
                self.spills[self._node[second]] = vertex  # runs over
            else:
                self._merge(vertex, first, second)
            self._joined[second] = first

    def _find(self, basin: int) -> int:
        joined = self._joined
        while joined[basin] != basin:
            joined[basin] = joined[joined[basin]]
            basin = joined[basin]
        return basin

    def _merge(self, vertex: int, first: int, second: int) -> None:
        parts = [self._node[first], self._node[second]]
        made = len(self.pits)
        for part in parts:
            self.spills[part], self.parents[part] = vertex, made
        self.pits.append(min((self.pits[part] for part in parts), key=self._rank.__getitem__))
        self.starts.append(vertex)
        for column in (self.spills, self.parents):
            column.append(NOWHERE)
        self._node[first] = made


def _leave_out_shallow(found: _Joining, z: Float64Array) -> Int64Array:
    """Leave out nodes without depth, and those that are the only part of another one.

    Returns the node that stands for each, ``NOWHERE`` for none; parents are those that are left.
    """
    parents = found.parents
    count = len(parents)
    deep = [
        spill != NOWHERE and z[spill] > z[start]
        for spill, start in zip(found.spills, found.starts, strict=True)
    ]
    # From the outermost inwards.
    stands = [NOWHERE] * count
    for node in range(count - 1, -1, -1):
        parent = parents[node]
        if parent != NOWHERE:
            parents[node] = stands[parent]
        stands[node] = node if deep[node] else parents[node]
    return _join_single_parts(parents, deep)


def _join_single_parts(parents: list[int], deep: list[bool]) -> Int64Array:
    """Let a node stand for its part if it has one only, the others being without depth."""
    parts = [0] * len(deep)
    for node, parent in enumerate(parents):
        if deep[node] and parent != NOWHERE:
            parts[parent] += 1
    stands = np.arange(len(deep))
    for node in range(len(deep) - 1, -1, -1):
        parent = parents[node]
        is_single = parent != NOWHERE and parts[parent] == 1
        parents[node] = NOWHERE if parent == NOWHERE else int(stands[parent])
        if is_single or not deep[node]:
            stands[node] = parents[node]
    return stands
