"""The meshes of levels: simplified to a tolerance, and cut along the edges of tiles.

Coordinates are whole numbers, and so are the lines of the grid. A line cuts each edge once, at a
point that is computed from the edge's own ends and is the same for the triangles on both of its
sides. So parts of the mesh on two sides of a line have the same vertices on it.

Vertices are inserted greedily (Garland and Heckbert, "Fast polygonal approximation of terrains and
height fields", 1995), in rounds: in every triangle the one farthest from the surface so far. All
vertices of the boundary are kept, and its edges.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....tin import TIN, Breakline, Survey, triangulate
from ....tin.topology import edge_keys, mark_corners

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ....base.arrays import BoolArray, Float64Array, Int64Array


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
        mesh = _cut(mesh, axis, spacing)
        steps, first, number = np.unique(mesh.steps, axis=0, return_index=True, return_inverse=True)
        triangles = number.ravel()[mesh.triangles]
        mesh = GridMesh(steps, mesh.heights[first], triangles[_measure(steps, triangles) > 0])
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
    held = rings >= 0
    order = np.argsort(~held, axis=1, kind="stable")
    packed = np.take_along_axis(rings, order, axis=1)
    counts = held.sum(axis=1)
    fans = [
        packed[counts > corner][:, [0, corner - 1, corner]] for corner in range(2, rings.shape[1])
    ]
    return GridMesh(
        np.concatenate([mesh.steps, steps]),
        np.concatenate([mesh.heights, heights]),
        np.concatenate([whole, np.concatenate(fans)]),
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
            along, low, spacing, cuts = strips
            at, other = along[near], along[far]
            line = np.where(at < low, low, low + spacing)
            number = len(along) + cuts.first_point[edge] + line // spacing - cuts.first_line[edge]
            inside = (at >= low) & (at <= low + spacing)
            found = np.where(inside, near, np.where(other == line, far, number))
            absent = (np.maximum(at, other) < low) | (np.minimum(at, other) > low + spacing)
            slots.append(np.where(absent, -1, found))
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


def _measure(steps: Int64Array, triangles: Int64Array) -> Int64Array:
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
        begins, ends = mesh.triangles, np.roll(mesh.triangles, -1, axis=1)
        same = (
            (rank[begins] >= 0)
            & (rank[ends] >= 0)
            & (mesh.steps[begins, axis] == mesh.steps[ends, axis])
        )
        gap = same & (np.abs(rank[begins] - rank[ends]) > 1)
        triangle = np.flatnonzero(gap.any(axis=1))
        corner = np.argmax(gap[triangle], axis=1)
        low = np.minimum(rank[begins[triangle, corner]], rank[ends[triangle, corner]])
        triangle, corner, between = triangle, corner, low + 1
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


def simplify(surface: TIN, tolerances: Sequence[float]) -> Iterator[Int64Array]:
    """Yield triangles of ever more vertices of a surface.

    Parameters
    ----------
    surface : TIN
    tolerances : sequence of float
        Falling: the largest difference of elevation at any vertex.

    Yields
    ------
    (m, 3) int64 array
        Vertices of the surface, counter-clockwise, for each tolerance.
    """
    chosen = np.zeros(len(surface.points), np.bool_)
    rings = [ring for ring in surface.boundary if len(ring) > 2]
    chosen[np.concatenate(rings)] = True
    lines = [Breakline(surface.points[np.append(ring, ring[0])]) for ring in rings]
    wanted = mark_corners(surface.triangles, len(surface.points))
    for tolerance in tolerances:
        while True:
            # Triangulate some vertices within the boundary.
            rows = np.flatnonzero(chosen)
            built = triangulate(
                Survey(points=surface.points[rows], breaklines=lines), duplicates="first"
            )
            row_of = np.full(len(built.points), -1, np.int64)
            row_of[built.vertex_of[: len(rows)]] = rows
            triangles = row_of[built.triangles]
            triangles = triangles[(triangles >= 0).all(axis=1)]
            middles = surface.points[triangles, :2].mean(axis=1)
            triangles = triangles[surface.locate(middles) >= 0]
            worst = _find_worst(surface, triangles, wanted & ~chosen, tolerance)
            if len(worst) == 0:
                break
            chosen[worst] = True
        yield triangles


def _find_worst(
    surface: TIN, triangles: Int64Array, left: BoolArray, tolerance: float
) -> Int64Array:
    """Return the vertex of each triangle that lies farthest from it, beyond the tolerance."""
    rows = np.flatnonzero(left)
    if len(rows) == 0:
        return rows
    rough = TIN.from_triangles(surface.points, triangles)
    xy = surface.points[rows, :2]
    error = np.abs(rough.interpolate(xy) - surface.points[rows, 2])
    far = np.flatnonzero(error > tolerance)
    home = rough.locate(xy[far])
    order = np.lexsort((-error[far], home))
    _, first = np.unique(home[order], return_index=True)
    return rows[far[order[first]]]
