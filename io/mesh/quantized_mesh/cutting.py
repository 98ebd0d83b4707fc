"""A mesh cut along the lines of a grid, so that no triangle reaches over one.

Coordinates are whole numbers, and so are the lines. A line cuts each edge once, at a point that is
computed from the edge's own ends and is the same for the triangles on both of its sides. So parts
of the mesh on two sides of a line have the same vertices on it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....tin.topology import edge_keys

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array

__all__ = ["GridMesh", "cut_along_grid"]


class GridMesh(NamedTuple):
    """A mesh on a grid."""

    steps: Int64Array
    """(n, 2), eastings and northings."""
    heights: Float64Array
    """(n,)."""
    triangles: Int64Array
    """(m, 3), counter-clockwise."""


def cut_along_grid(mesh: GridMesh, spacing: int) -> GridMesh:
    """Cut triangles along all multiples of a spacing, and round the cuts to the grid.

    Returns
    -------
    GridMesh
        Each place has one vertex. A triangle that lost its area, or turned over, as places were
        rounded is left out: its neighbours cover its place. Vertices on a line are those of the
        triangles on both sides of it.
    """
    for axis in (0, 1):
        mesh = _merge(_cut(mesh, axis, spacing))
    for axis in (0, 1):
        mesh = _match(mesh, axis, spacing)
    return mesh


class _Cuts(NamedTuple):
    """Points in which lines cut edges: those of an edge follow one another."""

    keys: Int64Array
    first_line: Int64Array
    first_point: Int64Array


class _Strips(NamedTuple):
    """The strips between lines that triangles are cut into."""

    along: Int64Array
    """Of each vertex: its coordinate across the lines."""
    low: Int64Array
    """Of each triangle: the line at which its strip begins."""
    spacing: int
    cuts: _Cuts


def _cut(mesh: GridMesh, axis: int, spacing: int) -> GridMesh:
    """Cut along the lines on which one coordinate is a multiple of the spacing."""
    along = mesh.steps[:, axis]
    corners = along[mesh.triangles]
    first = corners.min(axis=1) // spacing
    last = -(-corners.max(axis=1) // spacing) - 1
    is_cut = last > first
    whole, parts = mesh.triangles[~is_cut], mesh.triangles[is_cut]
    if len(parts) == 0:
        return mesh
    cuts, steps, heights = _cut_edges(mesh, parts, axis, spacing)
    counts = (last - first + 1)[is_cut]
    rows = np.repeat(np.arange(len(parts)), counts)
    within = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
    low = (first[is_cut][rows] + within) * spacing
    rings = _clip(parts[rows], _Strips(along, low, spacing, cuts))
    return GridMesh(
        np.concatenate([mesh.steps, steps]),
        np.concatenate([mesh.heights, heights]),
        np.concatenate([whole, _cut_rings_into_fans(rings)]),
    )


def _cut_edges(
    mesh: GridMesh, triangles: Int64Array, axis: int, spacing: int
) -> tuple[_Cuts, Int64Array, Float64Array]:
    """Return the points in which lines cut the edges of triangles, each edge once."""
    pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]],
                                    triangles[:, [2, 0]]]), axis=1)  # fmt: skip
    keys, row = np.unique(edge_keys(pairs, len(mesh.steps)), return_index=True)
    a, b = pairs[row].T
    start, end = mesh.steps[a], mesh.steps[b]
    low = np.minimum(start[:, axis], end[:, axis])
    high = np.maximum(start[:, axis], end[:, axis])
    first_line = low // spacing + 1
    counts = np.maximum(-(-high // spacing) - first_line, 0)
    owner = np.repeat(np.arange(len(keys)), counts)
    first_point = np.cumsum(counts) - counts
    line = (first_line[owner] + np.arange(len(owner)) - first_point[owner]) * spacing
    share = (line - start[owner, axis]) / (end[owner, axis] - start[owner, axis])
    steps = np.empty((len(owner), 2), np.int64)
    steps[:, axis] = line
    other = 1 - axis
    steps[:, other] = start[owner, other] + np.rint(
        share * (end[owner, other] - start[owner, other])
    ).astype(np.int64)
    heights = mesh.heights[a][owner] * (1 - share) + mesh.heights[b][owner] * share
    return _Cuts(keys, first_line, first_point), steps, heights


def _clip(triangles: Int64Array, strips: _Strips) -> Int64Array:
    """Return the ring of vertices that each triangle has in its strip, (k, 6), -1 for none."""
    slots = []
    keys, n_vertices = strips.cuts.keys, len(strips.along)
    for corner in range(3):
        a, b = triangles[:, corner], triangles[:, (corner + 1) % 3]
        edge = np.searchsorted(keys, edge_keys(np.stack([a, b], axis=1), n_vertices))
        for near, far in ((a, b), (b, a)):
            slots.append(_find_end(near, far, edge, strips))
    ring = np.stack(slots, axis=1)
    last = ring.max(axis=1) * 0 - 1
    for slot in range(6):  # what repeats the one before it is left out
        repeats = ring[:, slot] == last
        last = np.where(ring[:, slot] >= 0, ring[:, slot], last)
        ring[repeats, slot] = -1
    first = np.argmax(ring >= 0, axis=1)
    rows = np.arange(len(ring))
    closes = (last == ring[rows, first]) & ((ring >= 0).sum(axis=1) > 1)
    final = 5 - np.argmax(ring[:, ::-1] >= 0, axis=1)
    ring[rows[closes], final[closes]] = -1
    return ring


def _find_end(near: Int64Array, far: Int64Array, edge: Int64Array, strips: _Strips) -> Int64Array:
    """Return the vertex at which edges end in their strips, towards ``near``; -1 outside."""
    along, low, spacing, cuts = strips
    at, other = along[near], along[far]
    line = np.where(at < low, low, low + spacing)
    number = len(along) + cuts.first_point[edge] + line // spacing - cuts.first_line[edge]
    inside = (at >= low) & (at <= low + spacing)
    found = np.where(inside, near, np.where(other == line, far, number))
    absent = (np.maximum(at, other) < low) | (np.minimum(at, other) > low + spacing)
    return np.where(absent, -1, found)


def _cut_rings_into_fans(rings: Int64Array) -> Int64Array:
    held = rings >= 0
    order = np.argsort(~held, axis=1, kind="stable")
    packed = np.take_along_axis(rings, order, axis=1)
    counts = held.sum(axis=1)
    fans = [
        packed[counts > corner][:, [0, corner - 1, corner]] for corner in range(2, rings.shape[1])
    ]
    return np.concatenate(fans)


def _merge(mesh: GridMesh) -> GridMesh:
    """Give each place one vertex, and leave triangles out that have no area."""
    steps, first, number = np.unique(mesh.steps, axis=0, return_index=True, return_inverse=True)
    triangles = number.ravel()[mesh.triangles]
    return GridMesh(steps, mesh.heights[first], triangles[_measure(steps, triangles) > 0])


def _measure(steps: Int64Array, triangles: Int64Array) -> Int64Array:
    """Return twice the area of each triangle."""
    a, b, c = (steps[triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _match(mesh: GridMesh, axis: int, spacing: int) -> GridMesh:
    """Split edges on lines where a triangle on the other side has a vertex within them."""
    while True:
        on_line = np.flatnonzero(np.bincount(mesh.triangles.ravel(), minlength=len(mesh.steps)))
        on_line = on_line[mesh.steps[on_line, axis] % spacing == 0]
        order = np.lexsort((mesh.steps[on_line, 1 - axis], mesh.steps[on_line, axis]))
        rank = np.full(len(mesh.steps), -1, np.int64)
        rank[on_line[order]] = np.arange(len(on_line))
        triangle, corner, between = _find_split_edge(mesh, rank, axis)
        if len(triangle) == 0:
            return mesh
        ring = mesh.triangles[triangle]
        rows = np.arange(len(triangle))
        a, b = ring[rows, corner], ring[rows, (corner + 1) % 3]
        c = ring[rows, (corner + 2) % 3]
        middle = on_line[order][between]
        left = np.delete(mesh.triangles, triangle, axis=0)
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        mesh = mesh._replace(triangles=np.concatenate([left, *halves]))


def _find_split_edge(
    mesh: GridMesh, rank: Int64Array, axis: int
) -> tuple[Int64Array, Int64Array, Int64Array]:
    """Return triangles, the corner at which an edge of each begins, and a vertex within that."""
    a, b = mesh.triangles, np.roll(mesh.triangles, -1, axis=1)
    same = (rank[a] >= 0) & (rank[b] >= 0) & (mesh.steps[a, axis] == mesh.steps[b, axis])
    gap = same & (np.abs(rank[a] - rank[b]) > 1)
    triangle = np.flatnonzero(gap.any(axis=1))
    corner = np.argmax(gap[triangle], axis=1)
    low = np.minimum(rank[a[triangle, corner]], rank[b[triangle, corner]])
    return triangle, corner, low + 1
