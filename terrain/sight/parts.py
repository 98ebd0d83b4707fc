"""The parts of triangles that are seen, as a mesh whose triangles are seen or hidden as wholes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.topology import find_offsets
from .. import _kernel
from ..surface import DividedMesh

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array, UInt8Array
    from ...tin import TIN
    from .lines import View

_SEEN, _DIVIDED = 1, 2
"""What the kernel says of a triangle."""
_THINNEST = 1e-10
"""Area of a triangle, by the square of its longest side, below which its parts are rounding."""


class _Cells(NamedTuple):
    """Convex polygons of vertices, and the line on which the side after each corner lies."""

    owners: Int64Array
    is_seen: BoolArray
    counts: Int64Array
    corners: Int64Array
    lines: Int64Array


def divide(tin: TIN, view: View) -> tuple[DividedMesh, BoolArray]:
    """Divide the triangles of a surface into what a view sees and what is hidden.

    Returns parts of triangles, and whether each is seen. Cells come from the kernel. Their sides
    lie on edges of the TIN and on rays from the eye, along which neighbours may have other corners:
    each side gets all that lie on it, so that the cells share their vertices, and then is joined
    with the middle of its cell.
    """
    found = _kernel.find_seen_parts(
        tin.points, tin.triangles, tin.neighbors, view.eye, view.target_height
    )
    points, numbers = _number_corners(tin, found.corners)
    owners, counts = found.triangles.astype(np.int64), np.diff(found.offsets)
    cells = _Cells(owners, found.is_seen, counts, numbers, found.lines)
    cells, parts = _join_thin(tin, cells, found.parts)
    cells = _choose(cells, cells.corners != cells.corners[_find_next(cells.counts)])
    cells, is_cut = _add_whole_triangles(tin, cells, parts)
    cells = _complete_sides(cells, points)
    kept = np.flatnonzero(~is_cut)
    points, fans, cell = _fan_out(cells, points)
    triangles = np.concatenate([tin.triangles[kept], fans])
    mesh = DividedMesh.of(points, triangles, np.concatenate([kept, cells.owners[cell]]))
    return mesh, np.concatenate([parts[kept] == _SEEN, cells.is_seen[cell]])


def _number_corners(tin: TIN, corners: Float64Array) -> tuple[Float64Array, Int64Array]:
    """Return the vertices of the TIN and all other corners once each, and the corners' numbers."""
    places = np.concatenate([tin.points[:, :2], corners])
    order = np.lexsort((np.arange(len(places)), places[:, 1], places[:, 0]))
    is_new = np.append(True, (np.diff(places[order], axis=0) != 0.0).any(axis=1))
    first = order[is_new]  # the vertex of the TIN, if it is one
    numbers = np.empty(len(places), np.int64)
    is_added = first >= len(tin.points)
    number = first.copy()
    number[is_added] = len(tin.points) + np.arange(is_added.sum())
    numbers[order] = number[np.cumsum(is_new) - 1]
    points = np.concatenate([tin.points[:, :2], places[first[is_added]]])
    return points, numbers[len(tin.points) :]


def _join_thin(tin: TIN, cells: _Cells, parts: UInt8Array) -> tuple[_Cells, UInt8Array]:
    """Leave triangles whole that are thinner than coordinates can tell: seen if a part is."""
    a, b, c = (tin.points[tin.triangles[:, k], :2] for k in range(3))
    squares = [((q - p) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))]
    areas = tin.triangulation.triangle_areas
    is_thin = (areas <= _THINNEST * np.max(squares, axis=0)) & (parts == _DIVIDED)
    joined = parts.copy()
    joined[is_thin] = 0
    joined[cells.owners[is_thin[cells.owners] & cells.is_seen]] = _SEEN
    return _choose(cells, np.repeat(~is_thin[cells.owners], cells.counts)), joined


def _choose(cells: _Cells, keep: BoolArray) -> _Cells:
    """Return cells with some corners alone, those that have three of them at least."""
    cell = np.repeat(np.arange(len(cells.counts)), cells.counts)
    counts = np.bincount(cell[keep], minlength=len(cells.counts))
    whole = counts > 2
    keep = keep & whole[cell]
    return _Cells(
        cells.owners[whole],
        cells.is_seen[whole],
        counts[whole],
        cells.corners[keep],
        cells.lines[keep],
    )


def _find_next(counts: Int64Array) -> Int64Array:
    """Return for each corner of polygons with so many the place of the next one."""
    ends = np.cumsum(counts)
    following = np.arange(1, counts.sum() + 1)
    following[ends - 1] = ends - counts
    return following


def _add_whole_triangles(tin: TIN, cells: _Cells, parts: UInt8Array) -> tuple[_Cells, BoolArray]:
    """Add triangles beside divided ones, and tell which triangles are cells now."""
    is_divided = parts == _DIVIDED
    across = np.where(tin.neighbors >= 0, is_divided[tin.neighbors], False)
    beside = np.flatnonzero(~is_divided & across.any(axis=1))
    own = 3 * beside[:, None] + np.arange(3)
    neighbors = tin.neighbors[beside].astype(np.int64)
    back = (tin.neighbors[neighbors] == beside[:, None, None]).argmax(axis=2)
    # An edge is named by the larger of its two triangles, and its corner opposite.
    lines = np.where(neighbors > beside[:, None], 3 * neighbors + back, own)
    is_divided[beside] = True
    added = _Cells(
        np.concatenate([cells.owners, beside]),
        np.concatenate([cells.is_seen, parts[beside] == _SEEN]),
        np.concatenate([cells.counts, np.full(len(beside), 3)]),
        np.concatenate([cells.corners, tin.triangles[beside].ravel()]),
        np.concatenate([cells.lines, lines[:, [2, 0, 1]].ravel()]),
    )
    return added, is_divided


def _complete_sides(cells: _Cells, points: Float64Array) -> _Cells:
    """Give each side the vertices of other cells that lie on it."""
    start, end = cells.corners, cells.corners[_find_next(cells.counts)]
    on_line = np.flatnonzero(cells.lines >= 0)
    lines, n = cells.lines[on_line], len(points)
    ends = np.stack([lines * n + start[on_line], lines * n + end[on_line]])
    pairs, which = np.unique(ends, return_inverse=True)
    vertices = pairs % n
    order = _sort_along_lines(pairs // n, points[vertices], *which.reshape(2, -1))
    ranks = np.empty(len(order), np.int64)
    ranks[order] = np.arange(len(order))
    first, last = np.zeros((2, len(start)), np.int64)
    first[on_line], last[on_line] = ranks[which.reshape(2, -1)]
    counts = np.maximum(np.abs(last - first), 1)
    side = np.repeat(np.arange(len(start)), counts)
    within = np.arange(len(side)) - find_offsets(counts)[side]
    is_own = within == 0
    at = first[side] + within * np.sign(last - first)[side]
    corners = start[side]
    corners[~is_own] = vertices[order][at[~is_own]]
    owner = np.repeat(np.arange(len(cells.counts)), cells.counts)
    total = np.bincount(owner, counts, len(cells.counts)).astype(np.int64)
    return cells._replace(counts=total, corners=corners, lines=cells.lines[side])


def _sort_along_lines(
    lines: Int64Array,
    places: Float64Array,
    start: Int64Array,
    end: Int64Array,
) -> Int64Array:
    """Sort places by their line, and along it, by the direction of its longest side."""
    ways = places[end] - places[start]
    by_length = np.argsort(np.hypot(*ways.T), kind="stable")
    longest = np.zeros(len(lines), np.int64)
    _, line = np.unique(lines, return_inverse=True)
    longest[line[start[by_length]]] = by_length  # the last one stays
    chosen = longest[line]
    if len(lines) == 0:
        return chosen
    along = ((places - places[start[chosen]]) * ways[chosen]).sum(axis=1)
    return np.lexsort((along, lines))


def _fan_out(cells: _Cells, points: Float64Array) -> tuple[Float64Array, Int32Array, Int64Array]:
    """Return the points with the middles of cells, triangles, and the cell of each."""
    cell = np.repeat(np.arange(len(cells.counts)), cells.counts)
    places = points[cells.corners]
    origin = places[np.cumsum(cells.counts) - cells.counts]
    sums = [
        np.bincount(cell, (places - origin[cell])[:, axis], len(cells.counts)) for axis in (0, 1)
    ]
    middles = origin + np.column_stack(sums) / np.maximum(cells.counts, 1)[:, None]
    following = cells.corners[_find_next(cells.counts)]
    fans = np.column_stack([cells.corners, following, len(points) + cell])
    return np.concatenate([points, middles]), fans.astype(np.int32), cell
