"""How far a TIN lies from the surface of some of its vertices, between the vertices too.

Both are piecewise linear, so the difference is largest at a vertex of one of them or where an edge
of one crosses an edge of the other. The vertices are measured elsewhere; here the crossings are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from .. import topology

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from .._kernel import Trace
    from ..surface import TIN


class Crossings(NamedTuple):
    """Where edges of the new surface cross those of the given one, and the difference there."""

    owners: Int64Array
    """(k,), ascending: the edge of the new surface."""
    xy: Float64Array
    """(k, 2)."""
    errors: Float64Array
    """(k,), as they count."""
    candidates: Int64Array
    """(k, 4): ends of the edge crossed, the nearer first, then the third corners of its triangles;
    -1 for none."""


class Violations(NamedTuple):
    """What is to be added because the difference is beyond the tolerance between vertices."""

    largest: float
    """Of all crossings."""
    rows: Int64Array
    """Vertices of the given surface."""
    edges: Int64Array
    """(k, 2), edges of it whose vertices are all there already."""


def choose_rows(
    found: Crossings, is_left: BoolArray, limit: float
) -> tuple[Int64Array, Int64Array]:
    """Return the vertices to add, and the edges for which there is none to add.

    At the worst crossing of each edge the first candidate that is not left (``is_left``, (n + 1,),
    true at its end). If both ends of the edge crossed are left, and the third corners of its
    triangles, then these triangles would be Delaunay in the new surface: so there is a vertex to
    add, unless the given triangles are not Delaunay.
    """
    order = np.lexsort((*found.xy.T, -found.errors, found.owners))
    is_first = np.append(True, np.diff(found.owners[order]) != 0)[: len(order)]
    worst = order[is_first]
    worst = worst[found.errors[worst] > limit]
    candidates = found.candidates[worst]
    is_new = ~is_left[candidates]
    has_new = is_new.any(axis=1)
    rows = candidates[has_new, is_new[has_new].argmax(axis=1)]
    edges = np.unique(np.sort(candidates[~has_new, :2], axis=1), axis=0)
    return np.unique(rows), edges


class SurfaceMeter:
    """Measures surfaces of some of a TIN's vertices against it, along their edges.

    An edge has the same difference in each of them, so it is measured once. ``forced``, (k, 2),
    are the edges of the TIN that are not Delaunay and are to be kept. ``judge`` returns what
    heights of the TIN above the surface count, which are compared with the limit.
    """

    def __init__(self, tin: TIN, judge: Callable[[Float64Array], Float64Array] = np.abs) -> None:
        self.tin, self._judge = tin, judge
        self.forced = np.empty((0, 2), np.int64)
        own = topology.edges(tin.triangles, tin.neighbors)
        self._keys = np.unique(topology.edge_keys(own, len(tin.points)))
        self._errors = np.zeros(len(self._keys))

    def measure(self, edges: Int64Array, is_left: BoolArray, limit: float) -> Violations:
        """Measure the edges inside a surface, (k, 2) vertices of the TIN."""
        keys = topology.edge_keys(edges, len(self.tin.points))
        place = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        is_known = self._keys[place] == keys
        # follow edges of the new surface over the TIN
        start, end = self.tin.points[self._sort(*edges[~is_known].T)]
        traced = self.tin.triangulation.locator.trace(
            np.ascontiguousarray(start[:, :2]), np.ascontiguousarray(end[:, :2])
        )
        if traced.failed >= 0:
            raise PointsError("The TIN cannot be simplified: triangles lie over each other.")
        owners, ratios = topology.find_owners(traced.offsets), traced.ratios
        z, other = start[owners, 2], end[owners, 2]
        own = np.where(ratios > 0.5, other + (1.0 - ratios) * (z - other), z + ratios * (other - z))
        heights = np.nan_to_num(traced.elevations - own)
        errors = self._judge(heights)
        found = Crossings(owners, traced.places, errors, self._list_candidates(traced))
        largest, counted = np.zeros((2, int((~is_known).sum())))
        np.maximum.at(largest, owners, np.abs(heights))
        np.maximum.at(counted, owners, errors)
        whole = max(largest.max(initial=0.0), self._errors[place[is_known]].max(initial=0.0))
        is_near = counted <= limit
        self._remember(keys[~is_known][is_near], largest[is_near])
        rows, forced = choose_rows(found, is_left, limit)
        if len(forced):
            self.forced = np.unique(np.concatenate([self.forced, forced]), axis=0)
        return Violations(float(whole), rows, forced)

    def _remember(self, keys: Int64Array, errors: Float64Array) -> None:
        keys, errors = np.append(self._keys, keys), np.append(self._errors, errors)
        order = np.argsort(keys, kind="stable")
        self._keys, self._errors = keys[order], errors[order]

    def _list_candidates(self, traced: Trace) -> Int64Array:
        """Return the vertices around each crossing; one that is a vertex alone."""
        xy, vertices, edges = traced.places, traced.vertices, traced.edges
        found = np.full((len(xy), 4), -1, np.int64)
        found[:, 0] = vertices
        at = np.flatnonzero((vertices < 0) & (edges >= 0))
        triangle, corner = np.divmod(edges[at], 3)
        corners = self.tin.triangles[triangle]
        rows = np.arange(len(at))
        ends = self._sort(*(corners[rows, (corner + k) % 3] for k in (1, 2)))
        away = [((self.tin.points[v, :2] - xy[at]) ** 2).sum(axis=1) for v in ends]
        found[at, :2] = np.where(away[0] <= away[1], ends, ends[::-1]).T
        apex = corners[rows, corner].astype(np.int64)
        beyond = self.tin.neighbors[triangle, corner]
        other = self.tin.triangles[beyond].sum(axis=1) - ends[0] - ends[1]
        found[at, 2:] = self._sort(apex, np.where(beyond >= 0, other, apex)).T
        return found

    def _sort(self, one: Int64Array, other: Int64Array) -> Int64Array:
        """Return pairs of vertices, (2, k), the lexicographically first first."""
        (x, y), (u, v) = (self.tin.points[which, :2].T for which in (one, other))
        is_sorted = (x < u) | ((x == u) & (y <= v))
        return np.where(is_sorted, (one, other), (other, one))
