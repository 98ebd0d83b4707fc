"""Cut a surface along rings: its triangles are divided, none of its other edges is changed.

The edges near the rings and the rings are noded together. The constrained Delaunay triangulation of
all vertices, with the rings, the lines, the edges of the triangles that are cut and those that are
not Delaunay as segments, has every triangle that is not cut: all of its other edges are Delaunay.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from .. import _kernel, topology
from ..constraints import Polylines, node
from ..triangulation import Triangulation, mark_illegal_edges
from ..validation import thread_count
from .near_rings import find_near_rings

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell


class CutSurface(NamedTuple):
    """A surface that rings cut, and the triangulated hull of its vertices and those of the rings.

    Chains are of vertices of ``hull``, of which the surface's own are in front.
    """

    hull: Triangulation
    """Elevations that are not known, beyond the surface, are NaN."""
    chains: list[list[int]]
    """The chains that were given, through all vertices on them."""
    rings: list[list[int]]
    """Closed, in the order given."""
    boundary: list[list[int]]
    """Closed, the surface on their left."""
    flagged: list[list[int]]
    """Constrained edges of the surface."""


def cut_along(
    surface: Triangulation,
    chains: Sequence[Int32Array],
    rings: Sequence[Float64Array],
    progress: Tell,
) -> CutSurface:
    """Cut a surface along rings, (k, 2) each, that touch one another at most.

    Where the rings run in a triangle it is divided; the others are triangles of the hull.
    ``chains`` of its vertices are segments that the triangulation must have.

    Raises
    ------
    PointsError
        If triangles overlap, or vertices share a place.
    """
    near = find_near_rings(surface.points[surface.edges, :2], rings)
    for is_near in (near, np.ones_like(near)):
        noded = _node(surface, surface.edges[is_near], rings)
        progress(0.4)
        cut = _triangulate(noded, chains, every=bool(is_near.all()))
        progress(0.9)
        if cut is not None:
            return cut
    raise PointsError(
        "The TIN cannot be cut: its triangles overlap, or parts of its lines or of its boundary "
        "lie nearer to each other than coordinates are rounded."
    )


class _Noded(NamedTuple):
    """A surface, and the vertices that are made on its edges where rings meet them."""

    surface: Triangulation
    points: Float64Array
    """(v, 3), the surface's own in front."""
    rings: list[list[int]]
    between: dict[int, list[int]]
    """The vertices on edges, from the smaller end on, by keys of edges."""
    is_cut: BoolArray
    """(m,), whether a ring runs in a triangle."""

    def follow(self, chain: Sequence[int]) -> list[int]:
        """Return a chain of vertices of the surface with those made on its edges."""
        n = len(self.surface.points)
        path = [chain[0]]
        for a, b in pairwise(chain):
            made = self.between.get(min(a, b) * n + max(a, b), [])
            path += made if a < b else made[::-1]
            path.append(b)
        return path

    def list_fixed(self, *, every: bool) -> Iterator[list[int]]:
        """Yield edges that triangulating would not keep of itself; or every edge."""
        surface = self.surface
        wanted = mark_illegal_edges(surface) | self.is_cut[:, None] | every
        n = len(surface.points)
        for key in np.unique(_make_edge_keys(surface)[wanted]).tolist():
            yield self.follow(divmod(key, n))

    def keeps_whole_triangles(self, hull: Triangulation) -> bool:
        """Tell whether a triangulation has the triangles in which no ring runs."""
        n, own = len(self.points), len(self.surface.points)
        edges = self.surface.edges
        split = np.fromiter(self.between, np.int64, len(self.between))
        whole = edges[~are_among(topology.edge_keys(edges, own), split)]
        there = topology.edge_keys(hull.edges, n)
        return bool(are_among(topology.edge_keys(whole, n), there).all())


def are_among(keys: Int64Array, known: Int64Array) -> BoolArray:
    """Tell which keys are among others, of which a few may be asked of many and many of a few."""
    if len(known) == 0:
        return np.zeros(keys.shape, np.bool_)
    known = np.sort(known)
    found: BoolArray = known[np.minimum(np.searchsorted(known, keys), len(known) - 1)] == keys
    return found


def _make_edge_keys(surface: Triangulation) -> Int64Array:
    """Return the key of the edge opposite each corner, (m, 3)."""
    start, end = topology.directed_edges(surface.triangles)
    return topology.edge_keys(np.stack([start, end], axis=-1), len(surface.points))


def _node(surface: Triangulation, edges: Int32Array, rings: Sequence[Float64Array]) -> _Noded:
    """Make vertices where some edges and the rings meet."""
    n = len(surface.points)
    corners, number = np.unique(np.concatenate(rings), axis=0, return_inverse=True)
    known = surface.vertices_at(corners)
    is_new = known < 0
    known[is_new] = n + np.arange(is_new.sum(), dtype=np.int32)
    ends = np.cumsum([len(ring) for ring in rings])[:-1]
    paths = [np.append(path, path[0]) for path in np.split(known[number.reshape(-1)], ends)]
    xy = np.concatenate([surface.points[:, :2], corners[is_new]])
    z = np.append(surface.points[:, 2], np.full(len(xy) - n, np.nan))
    used = np.unique(np.concatenate([edges.ravel(), *paths]))
    local = np.zeros(len(xy), np.int32)
    local[used] = np.arange(len(used), dtype=np.int32)
    polylines = Polylines.of_chains([*edges.tolist(), *(path.tolist() for path in paths)])
    elevations = np.append(z[edges], np.full(sum(map(len, paths)), np.nan))
    noded = node(
        np.ascontiguousarray(xy[used]),
        polylines.renumber(local),
        elevations,
        np.zeros(len(polylines)),
        threads=thread_count(None, len(used)),
    )
    points = np.concatenate([np.column_stack([xy, z]), noded.new_points])
    number_of = np.concatenate([used, len(xy) + np.arange(len(noded.new_points))])
    touches = noded.touches
    at = number_of[touches.vertex]
    is_open = np.isnan(points[at, 2])
    points[at[is_open], 2] = touches.elevation[is_open]
    is_open = np.isnan(points[:, 2])
    points[is_open, 2] = surface.locator.interpolate(np.ascontiguousarray(points[is_open, :2]))
    followed = [number_of[chain].tolist() for chain in noded.polylines]
    between = {
        min(a, b) * n + max(a, b): _from_smaller(chain)
        for (a, b), chain in zip(edges.tolist(), followed[: len(edges)], strict=True)
        if len(chain) > 2
    }
    is_cut = _find_cut(surface, between, corners[is_new])
    return _Noded(surface, points, followed[len(edges) :], between, is_cut)


def _from_smaller(chain: list[int]) -> list[int]:
    """Return what is between the ends of a chain, from its smaller end on."""
    return chain[1:-1] if chain[0] < chain[-1] else chain[-2:0:-1]


def _find_cut(
    surface: Triangulation, between: dict[int, list[int]], corners: Float64Array
) -> BoolArray:
    """Tell which triangles have a vertex on an edge, or a corner of a ring inside."""
    split = np.fromiter(between, np.int64, len(between))
    is_cut = np.asarray(are_among(_make_edge_keys(surface), split).any(axis=1), np.bool_)
    if len(corners):
        holding = surface.locator.locate(np.ascontiguousarray(corners))
        is_cut[holding[holding >= 0]] = True
    return is_cut


def _triangulate(noded: _Noded, chains: Sequence[Int32Array], *, every: bool) -> CutSurface | None:
    """Triangulate all vertices with what must be edges; None if rounding lets some of it cross."""
    surface, n = noded.surface, len(noded.points)
    growth = _kernel.grow(np.nan_to_num(noded.points), threads=thread_count(None, n))
    if growth.kept_row is not None:
        raise PointsError(
            "The TIN cannot be cut: two of its vertices are at one place, where only one "
            "elevation can count; triangulate its points first."
        )
    rings = [[*ring.tolist(), int(ring[0])] for ring in surface.rings]
    edges = topology.edges_at(surface.triangles, surface.constrained).tolist()
    cut = CutSurface(
        surface,
        [noded.follow(chain.tolist()) for chain in chains],
        noded.rings,
        [noded.follow(ring) for ring in rings],
        [noded.follow(edge) for edge in edges],
    )
    fixed = [*cut.chains, *cut.rings, *cut.boundary, *cut.flagged, *noded.list_fixed(every=every)]
    mesh = _kernel.Mesh(noded.points, growth.triangles, growth.neighbors)
    passed, blocked = mesh.force(Polylines.of_chains(fixed).segments())
    if len(passed) or len(blocked):
        return None
    hull = Triangulation(noded.points, *mesh.arrays(thread_count(None, n)))
    return cut._replace(hull=hull) if noded.keeps_whole_triangles(hull) else None
