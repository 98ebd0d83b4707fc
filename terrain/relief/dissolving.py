"""Dissolving: triangles of one class become polygons with holes, vertex by vertex exact."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.topology import NO_NEIGHBOR, boundary_walks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN

__all__ = ["Dissolved", "dissolve"]


class Dissolved(NamedTuple):
    """Polygons of vertices, as :meth:`Features.of_polygons` takes them.

    Attributes
    ----------
    vertices : (n,) int64 array
        Of all rings, each closed.
    ring_offsets, polygon_offsets, feature_offsets : int64 arrays
        A feature has all polygons of a class.
    classes : (n_features,) int64 array
        Those that have a triangle, ascending.
    """

    vertices: NDArray[np.int64]
    ring_offsets: NDArray[np.int64]
    polygon_offsets: NDArray[np.int64]
    feature_offsets: NDArray[np.int64]
    classes: NDArray[np.int64]


def dissolve(tin: TIN, classes: NDArray[np.int64]) -> Dissolved:
    """Join the triangles of each class to polygons.

    Parameters
    ----------
    tin : TIN
    classes : (m,) int array
        Class of each triangle; below 0 it is left out.

    Returns
    -------
    Dissolved

    Notes
    -----
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
    neighbors = _within_classes(tin.neighbors, classes)
    parts = _components(neighbors)
    rings, part_of_ring = _rings(tin.triangles, neighbors, parts, classes)
    order = _exteriors_first(rings, part_of_ring, classes, tin.points)
    return _as_levels([rings[k] for k in order], part_of_ring[order], classes)


def _within_classes(neighbors: NDArray[np.int32], classes: NDArray[np.int64]) -> NDArray[np.int32]:
    """Return the neighbours of the same class, ``NO_NEIGHBOR`` for others."""
    is_same = (neighbors != NO_NEIGHBOR) & (classes[neighbors] == classes[:, None])
    return np.where(is_same, neighbors, np.int32(NO_NEIGHBOR))


def _components(neighbors: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return the smallest triangle that each is connected to.

    Roots hook onto the smallest root beside them, then every path is halved until it is one step
    long (Shiloach and Vishkin 1982, doi:10.1016/0196-6774(82)90008-6).
    """
    triangle, corner = np.nonzero(neighbors != NO_NEIGHBOR)
    across = neighbors[triangle, corner].astype(np.int64)
    root = np.arange(len(neighbors))
    while len(triangle):
        near, far = root[triangle], root[across]
        is_lower = far < near
        np.minimum.at(root, near[is_lower], far[is_lower])
        while True:
            shorter = root[root]
            if np.array_equal(shorter, root):
                break
            root = shorter
        apart = root[triangle] != root[across]
        triangle, across = triangle[apart], across[apart]
    return root


def _rings(
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    parts: NDArray[np.int64],
    classes: NDArray[np.int64],
) -> tuple[list[NDArray[np.int64]], NDArray[np.int64]]:
    """Return rings that never meet a vertex twice, and the component of each."""
    rings: list[NDArray[np.int64]] = []
    owners: list[int] = []
    for walk in boundary_walks(triangles, neighbors):
        first = int(walk[0]) // 3
        if classes[first] < 0:
            continue
        vertices = triangles[walk // 3, (walk % 3 + 1) % 3].astype(np.int64)
        pieces = _cut_at_repeats(vertices.tolist())
        rings += [vertices] if len(pieces) == 1 else [np.array(piece) for piece in pieces]
        owners += [int(parts[first])] * len(pieces)
    return rings, np.array(owners, np.int64)


def _cut_at_repeats(walk: list[int]) -> list[list[int]]:
    """Cut a closed walk into rings, each of which meets every vertex once."""
    if len(set(walk)) == len(walk):
        return [walk]
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


def _exteriors_first(
    rings: list[NDArray[np.int64]],
    parts: NDArray[np.int64],
    classes: NDArray[np.int64],
    points: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Sort rings by class, by polygon, and within it the exterior before the holes."""
    rank = np.empty(len(points), np.int64)
    rank[np.lexsort((points[:, 1], points[:, 0]))] = np.arange(len(points))
    starts = np.append(0, np.cumsum([len(ring) for ring in rings])[:-1])
    vertices = np.concatenate(rings)
    western = np.minimum.reduceat(rank[vertices], starts)
    # Where a hole touches its exterior in the westernmost vertex, the exterior turns left.
    areas = _ring_areas(points, vertices, starts)
    return np.lexsort((-areas, western, parts, classes[parts]))


def _ring_areas(
    points: NDArray[np.float64], vertices: NDArray[np.int64], starts: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Return twice the signed area of each open ring."""
    lengths = np.diff(np.append(starts, len(vertices)))
    origin = np.repeat(points[vertices[starts], :2], lengths, axis=0)
    following = np.arange(1, len(vertices) + 1)
    following[np.append(starts[1:], len(vertices)) - 1] = starts
    here = points[vertices, :2] - origin
    there = points[vertices[following], :2] - origin
    turns = here[:, 0] * there[:, 1] - there[:, 0] * here[:, 1]
    areas: NDArray[np.float64] = np.add.reduceat(turns, starts)
    return areas


def _as_levels(
    rings: list[NDArray[np.int64]], parts: NDArray[np.int64], classes: NDArray[np.int64]
) -> Dissolved:
    """Close the rings, and count them by polygon and by class."""
    closed = [np.append(ring, ring[0]) for ring in rings]
    lengths = np.array([len(ring) for ring in closed])
    polygon_starts = np.flatnonzero(np.append(True, parts[1:] != parts[:-1]))
    class_of = classes[parts[polygon_starts]]
    feature_starts = np.flatnonzero(np.append(True, class_of[1:] != class_of[:-1]))
    return Dissolved(
        np.concatenate(closed),
        np.append(0, np.cumsum(lengths)),
        np.append(polygon_starts, len(rings)),
        np.append(feature_starts, len(polygon_starts)),
        class_of[feature_starts].astype(np.int64),
    )
