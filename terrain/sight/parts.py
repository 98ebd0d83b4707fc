"""The parts of triangles that are seen, as a mesh whose triangles are seen or hidden as wholes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from ...tin.validation import thread_count
from .. import _kernel
from ..surface import DividedMesh, sort_by

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
    workers = thread_count(None, len(tin.points))
    found = _kernel.find_seen_parts(
        tin.points, tin.triangles, tin.neighbors, view.eye, view.target_height, workers
    )
    points, numbers = _number_corners(tin, found.corners)
    owners, counts = found.triangles.astype(np.int64), np.diff(found.offsets)
    cells = _Cells(owners, found.is_seen, counts, numbers, found.lines)
    parts = found.parts
    del found, owners, counts, numbers  # of all corners: what was used is let go
    cells, parts = _join_thin(tin, cells, parts)
    cells = _choose(cells, cells.corners != cells.corners[_find_next(cells.counts)])
    cells, is_cut = _add_whole_triangles(tin, cells, parts)
    cells = _complete_sides(cells, points)
    kept = np.flatnonzero(~is_cut)
    points, fans, cell = _fan_out(cells, points)
    triangles = np.concatenate([tin.triangles[kept], fans])
    is_seen = np.concatenate([parts[kept] == _SEEN, cells.is_seen[cell]])
    owners = np.concatenate([kept, cells.owners[cell]])
    del cells, cell, fans, kept
    try:
        return DividedMesh.of(points, triangles, owners), is_seen
    except PointsError as error:
        raise PointsError(
            "What is seen has parts that are thinner than coordinates can tell apart: the eye "
            "needs another place or height."
        ) from error


def _number_corners(tin: TIN, corners: Float64Array) -> tuple[Float64Array, Int64Array]:
    """Return the vertices of the TIN and all other corners once each, and the corners' numbers."""
    places = np.concatenate([tin.points[:, :2], corners])
    order = sort_by(*places.T)
    is_new = np.append(True, (np.diff(places[order], axis=0) != 0.0).any(axis=1))
    first = order[is_new]  # the vertex of the TIN, if it is one
    numbers = np.empty(len(places), np.int64)
    is_added = first >= len(tin.points)
    number = first.copy()
    number[is_added] = len(tin.points) + np.arange(is_added.sum())
    numbers[order] = number[np.cumsum(is_new) - 1]
    points = np.concatenate([tin.points[:, :2], places[first[is_added]]])
    return _join_near(points, numbers[len(tin.points) :], len(tin.points))


def _join_near(
    points: Float64Array, numbers: Int64Array, n_vertices: int
) -> tuple[Float64Array, Int64Array]:
    """Make corners one that are nearer to each other, or to a vertex, than coordinates can tell.

    Where one coordinate is near zero, it tells far more than the other: cells between such corners
    would have no width but for rounding.
    """
    places = np.rint(points / (4.0 * np.spacing(np.abs(points).max())))
    order = sort_by(*places.T)
    is_new = np.append(True, (np.diff(places[order], axis=0) != 0.0).any(axis=1))
    target = np.empty(len(points), np.int64)
    target[order] = order[is_new][np.cumsum(is_new) - 1]
    own = np.arange(len(points))
    target[:n_vertices] = own[:n_vertices]
    is_kept = target == own
    return points[is_kept], (np.cumsum(is_kept) - 1)[target[numbers]]


def _join_thin(tin: TIN, cells: _Cells, parts: UInt8Array) -> tuple[_Cells, UInt8Array]:
    """Leave triangles whole that are thinner than coordinates can tell: seen if a part is."""
    divided = np.flatnonzero(parts == _DIVIDED)
    a, b, c = (tin.points[tin.triangles[divided, k], :2] for k in range(3))
    squares = [((q - p) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))]
    areas = tin.triangulation.triangle_areas[divided]
    is_thin = np.zeros(len(parts), np.bool_)
    is_thin[divided] = areas <= _THINNEST * np.max(squares, axis=0)
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
    counts, corners, lines = _kernel.complete_sides(
        points, cells.counts, cells.corners, cells.lines, int(cells.lines.max(initial=-1)) + 1
    )
    return cells._replace(counts=counts, corners=corners, lines=lines)


def _fan_out(cells: _Cells, points: Float64Array) -> tuple[Float64Array, Int32Array, Int64Array]:
    """Return the points with the middles of cells, triangles, and the cell of each."""
    cell = np.repeat(np.arange(len(cells.counts)), cells.counts)
    origin = points[cells.corners[np.cumsum(cells.counts) - cells.counts]]
    sums = [
        np.bincount(cell, points[cells.corners, axis] - origin[cell, axis], len(cells.counts))
        for axis in (0, 1)
    ]
    middles = origin + np.column_stack(sums) / np.maximum(cells.counts, 1)[:, None]
    fans = np.empty((len(cell), 3), np.int32)
    fans[:, 0] = cells.corners
    fans[:, 1] = cells.corners[_find_next(cells.counts)]
    fans[:, 2] = len(points) + cell
    return np.concatenate([points, middles]), fans, cell
