"""Skeletons of flat regions: middles of the edges across them, and how far along each lies."""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .regions import CAPS, find_apexes

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from ....tin import TIN
    from .regions import Regions


class Skeleton(NamedTuple):
    """Points of skeletons; each is the middle of an edge across its region."""

    xy: Float64Array
    """(k, 2)."""
    regions: Int64Array
    """(k,)."""
    radii: Float64Array
    """(k,), distance from the nearest line around the region, or from the hull, CRS units."""
    widths: Float64Array
    """(k,), length of the edge that it is the middle of."""
    exits: Float64Array
    """(k,), of points on the border: distance of the corner that the triangle beyond leads to;
    infinity for others.
    """
    tips: Float64Array
    """(k,), of points in a triangle with no other such edge: distance of the corner opposite; 0 for
    others.
    """
    arcs: list[list[tuple[int, float]]]
    """Points in the same triangles, and how far they are."""


def trace_skeleton(tin: TIN, regions: Regions) -> Skeleton:
    """Return the skeletons of the regions whose kind is clear.

    The chordal axis of L. Prasad, "Morphological analysis of shapes" (1997): in a constrained
    Delaunay triangulation of the region the middles of the inner edges lie near the medial axis,
    and follow it as the lines' points grow dense.
    """
    is_clear = np.append(regions.kinds != 0, False)
    triangles, corners, is_exit = _list_edges(tin, regions, is_clear)
    ends = [tin.triangles[triangles, (corners + k) % 3] for k in (1, 2)]
    xy = (tin.points[ends[0], :2] + tin.points[ends[1], :2]) / 2.0
    widths = np.hypot(*(tin.points[ends[1], :2] - tin.points[ends[0], :2]).T)
    nodes_of = _gather_nodes(tin, triangles, corners, is_exit)
    exits = np.full(len(xy), np.inf)
    leaving = triangles[is_exit]
    apexes = find_apexes(tin, leaving, tin.neighbors[leaving, corners[is_exit]])
    exits[is_exit] = np.hypot(*(tin.points[apexes, :2] - xy[is_exit]).T)
    tips, arcs = _link(tin, xy, nodes_of)
    xy, of_node, lonely = _add_lonely(tin, regions, xy, regions.region_of[triangles])
    radii = _measure_radii(tin, regions, xy, of_node)
    return Skeleton(
        xy,
        of_node,
        radii,
        np.append(widths, np.zeros(lonely)),
        np.append(exits, np.full(lonely, np.inf)),
        np.append(tips, np.zeros(lonely)),
        arcs + [[] for _ in range(lonely)],
    )


def _list_edges(
    tin: TIN, regions: Regions, is_clear: BoolArray
) -> tuple[Int64Array, Int64Array, BoolArray]:
    """Return the inner edges of regions, each once, and their exits: triangle, corner, which."""
    region_of = regions.region_of
    inner = (region_of[:, None] >= 0) & ~tin.constrained
    inner &= (tin.neighbors > np.arange(len(region_of))[:, None]) & is_clear[region_of][:, None]
    inner &= region_of[tin.neighbors] == region_of[:, None]
    triangles, corners = np.nonzero(inner)
    border = regions.border
    out = border.is_exit & is_clear[border.regions]
    is_exit = np.arange(len(triangles) + int(out.sum())) >= len(triangles)
    return (
        np.append(triangles, border.triangles[out]),
        np.append(corners, border.corners[out]),
        is_exit,
    )


def _gather_nodes(
    tin: TIN,
    triangles: Int64Array,
    corners: Int64Array,
    is_exit: BoolArray,
) -> dict[int, list[tuple[int, int]]]:
    """Return the points at each flat triangle, each with the vertex opposite."""
    nodes_of: dict[int, list[tuple[int, int]]] = {}
    across = tin.neighbors[triangles, corners]
    opposite = tin.triangles[triangles, corners]
    columns = (triangles, across, opposite, find_apexes(tin, triangles, across), is_exit)
    for node, (t, n, v, w, leaves) in enumerate(
        zip(*(column.tolist() for column in columns), strict=True)
    ):
        nodes_of.setdefault(t, []).append((node, v))
        if not leaves:
            nodes_of.setdefault(n, []).append((node, w))
    return nodes_of


def _link(
    tin: TIN, xy: Float64Array, nodes_of: dict[int, list[tuple[int, int]]]
) -> tuple[Float64Array, list[list[tuple[int, float]]]]:
    tips = np.zeros(len(xy))
    arcs: list[list[tuple[int, float]]] = [[] for _ in range(len(xy))]
    for nodes in nodes_of.values():
        if len(nodes) == 1:
            ((node, vertex),) = nodes
            tips[node] = max(tips[node], float(np.hypot(*(tin.points[vertex, :2] - xy[node]))))
            continue
        for i, (one, _) in enumerate(nodes):
            for other, _ in nodes[i + 1 :]:
                length = float(np.hypot(*(xy[one] - xy[other])))
                arcs[one].append((other, length))
                arcs[other].append((one, length))
    return tips, arcs


def _add_lonely(
    tin: TIN, regions: Regions, xy: Float64Array, of_node: Int64Array
) -> tuple[Float64Array, Int64Array, int]:
    """Add the middle of each cap that is a single triangle, with no edge across it."""
    has_node = np.zeros(regions.size, np.bool_)
    has_node[of_node] = True
    lonely = np.flatnonzero(np.isin(regions.kinds, CAPS) & ~has_node)
    triangles = np.flatnonzero(np.isin(regions.region_of, lonely))
    middles = tin.points[tin.triangles[triangles], :2].mean(axis=1).reshape(-1, 2)
    return (
        np.concatenate([xy, middles]),
        np.append(of_node, regions.region_of[triangles]),
        len(triangles),
    )


def _measure_radii(
    tin: TIN, regions: Regions, xy: Float64Array, of_node: Int64Array
) -> Float64Array:
    """Return the distance of each point from the lines, and the hull, around its own region."""
    import shapely

    border = regions.border
    lines = ~border.is_exit
    start, end = (
        tin.points[tin.triangles[border.triangles, (border.corners + k) % 3], :2] for k in (1, 2)
    )
    segments = shapely.linestrings(np.stack([start, end], axis=1)[lines])
    of_segment = border.regions[lines]
    bounds = np.searchsorted(of_segment, np.arange(regions.size + 1))
    radii = np.full(len(xy), np.inf)
    order = np.argsort(of_node, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(of_node[order])) + 1):
        if len(rows) == 0:
            continue
        region = of_node[rows[0]]
        own = segments[bounds[region] : bounds[region + 1]]
        if len(own):
            (row, _), found = shapely.STRtree(own).query_nearest(
                shapely.points(xy[rows]), return_distance=True, all_matches=False
            )
            radii[rows[row]] = found
    return radii


# ------------------------------------------------------------- shares along a skeleton


def find_shares(skeleton: Skeleton) -> Float64Array:
    """Return how far each point lies from its region's line, 0, to the next contour, 1.

    1. Every point hangs by the shortest way on the exit that is nearest along the skeleton: the
       ways are trees.
    2. From each exit the longest branch is a straight rise, from 1 at the next contour down to 0 at
       the line around the region's tip; shorter branches fall from where they leave it to their own
       tips. Where two trees meet there is no tip, and a branch ends at the share of the distances
       from both contours: a saddle.

    Of points from which no exit is reached (peaks and pits) it is NaN.
    """
    distance, parent, order = _hang(skeleton)
    tail, low = _measure_tails(skeleton, distance, parent, order)
    shares = np.full(len(distance), np.nan)
    for node in order:
        up, way = parent[node]
        above = 1.0 if up < 0 else shares[up]
        length = way + tail[node]
        shares[node] = above if length == 0 else above + (low[node] - above) * way / length
    return shares


def _hang(
    skeleton: Skeleton,
) -> tuple[Float64Array, dict[int, tuple[int, float]], list[int]]:
    """Return the distance from the next contour, the way there, and the points from there on.

    The shortest ways of Dijkstra, "A note on two problems in connexion with graphs" (1959).
    """
    distance = skeleton.exits.copy()
    starts = np.flatnonzero(np.isfinite(distance)).tolist()
    parent: dict[int, tuple[int, float]] = {n: (-1, float(distance[n])) for n in starts}
    queue = [(float(distance[node]), node) for node in starts]
    heapq.heapify(queue)
    order: list[int] = []
    while queue:
        far, node = heapq.heappop(queue)
        if far > distance[node]:
            continue
        order.append(node)
        for other, way in skeleton.arcs[node]:
            if far + way < distance[other]:
                distance[other] = far + way
                parent[other] = (node, way)
                heapq.heappush(queue, (far + way, other))
    return distance, parent, order


def _measure_tails(
    skeleton: Skeleton,
    distance: Float64Array,
    parent: dict[int, tuple[int, float]],
    order: list[int],
) -> tuple[Float64Array, Float64Array]:
    """Return the length of the longest branch at each point, and the share at its end."""
    tail = skeleton.tips.copy()
    low = np.zeros(len(tail))
    has_child = np.zeros(len(tail), np.bool_)
    for node in reversed(order):
        if tail[node] == 0.0 and not has_child[node]:
            nearness = float(skeleton.radii[node])
            low[node] = nearness / (nearness + distance[node]) if np.isfinite(nearness) else 0.5
        up, way = parent[node]
        if up >= 0:
            if way + tail[node] > tail[up]:
                tail[up], low[up] = way + tail[node], low[node]
            has_child[up] = True
    return tail, low
