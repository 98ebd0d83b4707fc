r"""Connections of a triangle list: who is whose neighbour, which edges, which hull.

Numbering, used everywhere::

            corner 2
            /      \
    edge 1 /        \ edge 0        edge k lies opposite corner k,
          /          \              and neighbors[t, k] is the triangle
    corner 0 -------- corner 1       across it, NO_NEIGHBOR outside.
             edge 2
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..base.errors import PointsError
from . import _kernel

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..base.arrays import AnyArray, BoolArray, Int32Array, Int64Array

NO_NEIGHBOR = -1


def directed_edges(triangles: Int32Array) -> tuple[Int64Array, Int64Array]:
    """Return start and end vertex, (m, 3) each, of the edge opposite every corner."""
    return (
        triangles[:, [1, 2, 0]].astype(np.int64),
        triangles[:, [2, 0, 1]].astype(np.int64),
    )


def ends(
    triangles: Int32Array, triangle: Int64Array, corner: Int64Array
) -> tuple[Int64Array, Int64Array]:
    """Return start and end vertex of the edges opposite some corners of some triangles."""
    return (
        triangles[triangle, (corner + 1) % 3].astype(np.int64),
        triangles[triangle, (corner + 2) % 3].astype(np.int64),
    )


def edges_at(triangles: Int32Array, is_chosen: BoolArray) -> Int32Array:
    """Return the edges opposite the chosen corners, (k, 2) vertex pairs, triangle by triangle.

    ``is_chosen`` has a flag for each corner, (m, 3).
    """
    triangle, corner = np.nonzero(is_chosen)
    return np.stack(
        [triangles[triangle, (corner + 1) % 3], triangles[triangle, (corner + 2) % 3]], axis=1
    )


def find_boundary_vertices(triangles: Int32Array, neighbors: Int32Array, count: int) -> BoolArray:
    """Tell which of so many vertices lie on the boundary of the surface, or of a hole in it."""
    is_boundary = np.zeros(count, np.bool_)
    is_boundary[edges_at(triangles, neighbors == NO_NEIGHBOR)] = True
    return is_boundary


def mark_corners(triangles: AnyArray, count: int) -> BoolArray:
    """Mark which of so many vertices are corners of triangles; files may have others."""
    is_corner = np.zeros(count, np.bool_)
    is_corner[triangles] = True
    return is_corner


def edge_keys(pairs: AnyArray, n_vertices: int) -> Int64Array:
    """Return one number for each edge, whatever its direction: smaller end * n + larger end.

    ``pairs`` are (..., 2) vertices.
    """
    return _make_keys(pairs[..., 0].astype(np.int64), pairs[..., 1].astype(np.int64), n_vertices)


def _make_keys(start: Int64Array, end: Int64Array, n_vertices: int) -> Int64Array:
    keys: Int64Array = np.minimum(start, end) * n_vertices + np.maximum(start, end)
    return keys


def neighbors_of(triangles: Int32Array, n_vertices: int) -> Int32Array:
    """Match the edges of counter-clockwise triangles.

    Returns the triangle across the edge opposite each corner, (m, 3), ``NO_NEIGHBOR`` outside.
    Raises PointsError if an edge is used by more than two triangles or twice in the same direction.
    """
    neighbors, is_sound = _kernel.join_triangles(np.ascontiguousarray(triangles), n_vertices)
    if not is_sound:
        _require_manifold(triangles, n_vertices)
    return neighbors


def _require_manifold(triangles: Int32Array, n_vertices: int) -> None:
    starts, ends = directed_edges(triangles)
    keys = _make_keys(starts, ends, n_vertices).ravel()
    forward = (starts < ends).ravel()
    order = np.argsort(keys, kind="stable")
    same = keys[order][1:] == keys[order][:-1]
    thrice = same[1:] & same[:-1]
    if thrice.any():
        a, b = _get_edge(triangles, int(order[np.argmax(thrice)]))
        raise PointsError(
            f"Edge {a}-{b} belongs to more than two triangles: a TIN allows two at most."
        )
    clash = same & (forward[order[1:]] == forward[order[:-1]])
    if clash.any():
        a, b = _get_edge(triangles, int(order[np.argmax(clash)]))
        raise PointsError(
            f"The two triangles at edge {a}-{b} lie on the same side of it: "
            "triangles of a TIN must not overlap."
        )


def _get_edge(triangles: Int32Array, slot: int) -> tuple[int, int]:
    triangle, corner = divmod(slot, 3)
    return int(triangles[triangle, (corner + 1) % 3]), int(triangles[triangle, (corner + 2) % 3])


def edges(triangles: Int32Array, neighbors: Int32Array) -> Int32Array:
    """Return every edge once, as a (k, 2) int32 array of vertex pairs."""
    across = np.arange(len(triangles), dtype=np.int32)[:, None]
    once = (neighbors == NO_NEIGHBOR) | (neighbors > across)
    return np.stack([triangles[:, [1, 2, 0]][once], triangles[:, [2, 0, 1]][once]], axis=1)


def boundary_rings(triangles: Int32Array, neighbors: Int32Array) -> list[Int32Array]:
    """Return the boundary as closed vertex rings (first vertex not repeated), interior on the left.

    At a vertex where two rings touch, they are kept apart by turning about the vertex through
    the triangles inside, so that every ring is one walk along the surface's boundary.
    """
    edges, offsets = boundary_walks(triangles, neighbors)
    start = triangles[edges // 3, (edges % 3 + 1) % 3]
    return [start[a:b] for a, b in pairwise(offsets.tolist())]


def boundary_walks(triangles: Int32Array, neighbors: Int32Array) -> tuple[Int64Array, Int64Array]:
    """Return the boundary edges, ring by ring, as in :func:`boundary_rings`.

    Returns
    -------
    edges : (k,) int64 array
        Each as 3 * triangle + corner that it lies opposite of.
    offsets : (n_rings + 1,) int64 array
        Ring r is ``edges[offsets[r]:offsets[r + 1]]``.
    """
    return _kernel.boundary_walks(np.ascontiguousarray(triangles), np.ascontiguousarray(neighbors))


# ---------------------------------------------------------------- by vertex


class HalfEdges(NamedTuple):
    """The edges of triangles, each as its triangle walks it, by start and then by end.

    Those that start at vertex ``v`` are ``offsets[v]`` to ``offsets[v + 1]``; their triangles are
    the triangles of ``v``.
    """

    keys: Int64Array
    """(3 m,), start times the number of vertices, plus end; ascending."""
    triangles: Int32Array
    """(3 m,), the triangle on the left of each."""
    offsets: Int64Array
    """(n + 1,)."""


def sort_half_edges(triangles: Int32Array, n_vertices: int) -> HalfEdges:
    """Sort the edges of counter-clockwise triangles by their start and their end."""
    start, end = directed_edges(triangles)
    keys = (start * n_vertices + end).ravel()
    order = np.argsort(keys)
    counts = np.bincount(start.ravel(), minlength=n_vertices)
    return HalfEdges(
        keys=keys[order],
        triangles=(order // 3).astype(np.int32),
        offsets=find_offsets(counts),
    )


def find_triangles(edges: HalfEdges, start: Int64Array, end: Int64Array) -> Int32Array:
    """Return the triangle on the left of each edge, ``NO_NEIGHBOR`` if there is none."""
    wanted = start * (len(edges.offsets) - 1) + end
    at = np.minimum(np.searchsorted(edges.keys, wanted), len(edges.keys) - 1)
    found = edges.keys[at] == wanted
    return np.where(found, edges.triangles[at], np.int32(NO_NEIGHBOR))


def turn_about(
    triangles: Int32Array, edges: HalfEdges, vertex: int
) -> tuple[Int32Array, Int32Array]:
    r"""Return the triangles around a vertex, and its neighbours, both counter-clockwise.

    Each part of the surface that meets in the vertex is turned through from boundary to boundary,
    or, if it goes all the way round, from its smallest triangle; parts by their first triangles::

            c --- b         start -> end of the triangles:   a -> b, b -> c
             \   / \         neighbours:                      a, b, c
               v --- a
    """
    begin, stop = edges.offsets[vertex : vertex + 2].tolist()
    own = np.sort(edges.triangles[begin:stop])
    corner = np.argmax(triangles[own] == vertex, axis=1)
    following, last = (triangles[own, (corner + k) % 3].tolist() for k in (1, 2))
    ahead = dict(zip(following, zip(own.tolist(), last, strict=True), strict=True))
    inner = set(last)
    around: list[int] = []
    neighbors: list[int] = []
    for first in [*(end for end in following if end not in inner), *following]:
        end = first
        while end in ahead:
            neighbors.append(end)
            triangle, end = ahead.pop(end)
            around.append(triangle)
        if end != first:
            neighbors.append(end)
    return np.array(around, np.int32), np.array(neighbors, np.int32)


# ---------------------------------------------------------------- ragged arrays
#
#   offsets   0       2   2           5      part 0 has two items, part 1 none, part 2 three
#   items     a   b   c   d   e
#   owners    0   0   2   2   2


def find_offsets(lengths: Iterable[int] | AnyArray) -> Int64Array:
    """Return where each part of a ragged array begins, and the last one ends."""
    lengths = lengths if isinstance(lengths, np.ndarray) else list(lengths)
    return np.concatenate([[0], np.cumsum(lengths, dtype=np.int64)])


def find_owners(offsets: AnyArray) -> Int64Array:
    """Return for each item of a ragged array the part that it belongs to."""
    return np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))


def gather(offsets: Int64Array, parts: Int64Array) -> tuple[Int64Array, Int64Array]:
    """Return where the items of some parts of a ragged array stand, and whose of these each is."""
    begins = offsets[parts]
    chosen = find_offsets(offsets[parts + 1] - begins)
    owner = find_owners(chosen)
    return np.arange(len(owner)) + (begins - chosen[:-1])[owner], owner
