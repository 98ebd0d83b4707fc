"""Where edges between cells of a raster cross the triangles of all its cells.

The triangles of a raster are halves of squares of four cells, cut from the north-west to the
south-east, as the Delaunay triangulation of the cells has them. So an edge crosses theirs on whole
columns, on whole rows and on diagonals, at shares of whole numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.meshing import Crossings
from ...tin.topology import find_offsets, find_owners

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array


class _Lines(NamedTuple):
    """Lines of edges of the triangles; steps are rows and columns, from the first end of an edge.

    A line is where ``row * level[0] + column * level[1]`` is a whole number; along it the row
    counts, or the column.
    """

    level: tuple[int, int]
    counts_rows: bool
    to_end: tuple[int, int]
    to_corners: tuple[tuple[int, int], tuple[int, int]]


_COLUMNS = _Lines((0, 1), True, (1, 0), ((0, -1), (1, 1)))
_ROWS = _Lines((1, 0), False, (0, 1), ((-1, 0), (1, 1)))
_DIAGONALS = _Lines((1, -1), False, (1, 1), ((0, 1), (1, 0)))


def cross_cells(z: Float64Array, start: Int64Array, end: Int64Array) -> Crossings:
    """Return the crossings of edges between cells with the edges of the triangles of all cells.

    Parameters
    ----------
    z : (rows, columns) float64 array
        Elevations, NaN where there is no surface.
    start, end : (e,) int64 arrays
        Ends of the edges, cells row by row.

    Returns
    -------
    Crossings
        ``xy`` holds columns and rows. Where a cell is met there is none.
    """
    found = [_cross(z, start, end, lines) for lines in (_COLUMNS, _ROWS, _DIAGONALS)]
    owners, xy, errors, candidates = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = np.argsort(owners, kind="stable")
    return Crossings(owners[order], xy[order], errors[order], candidates[order])


def _cross(z: Float64Array, start: Int64Array, end: Int64Array, lines: _Lines) -> Crossings:
    """Return the crossings with lines strictly between the ends of the edges."""
    begin, stop = (np.stack(np.divmod(cells, z.shape[1])) for cells in (start, end))
    level, to_level = (np.tensordot(lines.level, ends, 1) for ends in (begin, stop))
    whole = np.abs(to_level - level)
    offsets = find_offsets(np.maximum(whole - 1, 0))
    owners = find_owners(offsets)
    step = np.arange(len(owners)) - offsets[owners] + 1
    axis = 0 if lines.counts_rows else 1
    along = begin[axis, owners] * whole[owners] + step * (stop - begin)[axis, owners]
    at, rest = np.divmod(along, np.maximum(whole, 1)[owners])
    is_between = rest > 0
    owners, step, at, rest = (one[is_between] for one in (owners, step, at, rest))
    line = level[owners] + step * np.sign(to_level - level)[owners]
    first = {_COLUMNS: (at, line), _ROWS: (line, at), _DIAGONALS: (line + at, at)}[lines]
    share, along_edge = rest / whole[owners], step / whole[owners]
    low, high = (z.ravel()[cells[owners]] for cells in (start, end))
    own = _mix(low, high, along_edge)
    corners = _list_corners(z, lines, *first)
    other = _mix(_look_up(z, corners[:, 0]), _look_up(z, corners[:, 1]), share)
    xy = np.stack([k + share * d for k, d in zip(first, lines.to_end, strict=True)], axis=1)[
        :, ::-1
    ]
    corners[share > 0.5, :2] = corners[share > 0.5, 1::-1]
    return Crossings(owners, xy, np.nan_to_num(np.abs(own - other)), corners)


def _mix(low: Float64Array, high: Float64Array, share: Float64Array) -> Float64Array:
    """Interpolate from the nearer end."""
    return np.where(share > 0.5, high + (1.0 - share) * (low - high), low + share * (high - low))


def _list_corners(
    z: Float64Array, lines: _Lines, row: Int64Array, column: Int64Array
) -> Int64Array:
    """Return the cells at both ends of edges and beside them, (k, 4); -1 where there is none."""
    height, width = z.shape
    cells = np.empty((len(row), 4), np.int64)
    for k, (down, right) in enumerate(((0, 0), lines.to_end, *lines.to_corners)):
        r, c = row + down, column + right
        is_inside = (r >= 0) & (r < height) & (c >= 0) & (c < width)
        cells[:, k] = np.where(is_inside, r * width + c, -1)
    cells[np.isnan(_look_up(z, cells.ravel())).reshape(cells.shape)] = -1
    return cells


def _look_up(z: Float64Array, cells: Int64Array) -> Float64Array:
    """Return the elevations of cells, NaN where there is none."""
    return np.where(cells >= 0, z.ravel()[cells], np.nan)
