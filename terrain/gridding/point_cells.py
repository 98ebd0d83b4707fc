"""Points in the cells of a grid: how many there are, and the highest value in each.

Points may be taken part by part, in any order: counts are added and the higher value is kept, so
that the cells are the same to the last bit.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.types import Grid

_ROUNDINGS = 4.0
"""Of the largest coordinate: so much a point may be beyond the rim of cells that cover it."""

COUNT_TYPE = np.dtype(np.uint32)


class CellBlock(NamedTuple):
    """Some rows and columns of a grid, and the values of their cells, (rows, columns)."""

    rows: slice
    columns: slice
    values: AnyArray


def locate_cells(grid: Grid, points: Float64Array) -> tuple[Int64Array, Int64Array]:
    """Return rows and columns of the cells that hold points, (n, 2 or more); -1 outside the grid.

    Of a point on the side between two cells it is the eastern or the southern one, as of
    ``rasterio.transform.rowcol`` where the grid is north up; on the rim of the grid it is the cell
    within. In a rotated grid it is the one with the larger number.

    Examples
    --------
    >>> from tinsmith import Bounds, Grid
    >>> grid = Grid(Bounds(0.0, 0.0, 2.0, 2.0), shape=(2, 2), spacing=1.0)
    >>> locate_cells(grid, np.array([[1.0, 1.0], [2.0, 0.0], [0.5, 2.0], [2.5, 1.0]]))
    (array([ 1,  1,  0, -1]), array([ 1,  1,  0, -1]))
    """
    box, (height, width), affine = grid.bounds, grid.shape, grid.transform
    reach = max(map(abs, (box.xmin, box.ymin, box.xmax, box.ymax)))
    slack = _ROUNDINGS * math.ulp(reach)
    x, y = points[:, 0], points[:, 1]
    near = (x >= box.xmin - slack) & (x <= box.xmax + slack)
    near &= (y >= box.ymin - slack) & (y <= box.ymax + slack)
    across, down = affine.locate(x, y)
    if not grid.is_aligned:  # the box holds more than the cells
        a, b, _, d, e, _ = affine
        beyond = slack * max(grid.cell_size) / abs(a * e - b * d)
        near &= (across >= -beyond) & (across <= width + beyond)
        near &= (down >= -beyond) & (down <= height + beyond)
        return _find_steps(down, height, near), _find_steps(across, width, near)
    rows = _find_steps(down, height, near, is_turned=affine.e > 0.0)
    return rows, _find_steps(across, width, near, is_turned=affine.a < 0.0)


def _find_steps(
    places: Float64Array, count: int, near: BoolArray, *, is_turned: bool = False
) -> Int64Array:
    """Return whole steps to places; what is between two is in the latter, turned in the former."""
    steps = np.full(len(places), -1, np.int64)
    whole = np.ceil(places[near]) - 1.0 if is_turned else np.floor(places[near])
    steps[near] = np.clip(whole, 0, count - 1).astype(np.int64)
    return steps


def count_points(grid: Grid, points: Float64Array) -> CellBlock | None:
    """Return how many points lie in each cell of the rows and columns that have any, uint32."""
    return _fill(grid, points, None)


def find_highest(grid: Grid, points: Float64Array, values: Float64Array) -> CellBlock | None:
    """Return the highest of some values at points in each cell, NaN where there is none.

    Values that are NaN are left out.
    """
    is_known = ~np.isnan(values)
    return _fill(grid, points[is_known], values[is_known])


def _fill(grid: Grid, points: Float64Array, values: Float64Array | None) -> CellBlock | None:
    rows, columns = locate_cells(grid, points)
    inside = rows >= 0
    if not inside.any():
        return None
    rows, columns = rows[inside], columns[inside]
    across, down = (slice(int(one.min()), int(one.max()) + 1) for one in (columns, rows))
    shape = down.stop - down.start, across.stop - across.start
    cells = (rows - down.start) * shape[1] + columns - across.start
    if values is None:
        counts = np.bincount(cells, minlength=shape[0] * shape[1])
        return CellBlock(down, across, counts.astype(COUNT_TYPE).reshape(shape))
    found = np.full(shape[0] * shape[1], -np.inf)
    np.maximum.at(found, cells, values[inside] + 0.0)  # -0.0 and 0.0 are one value
    return CellBlock(down, across, np.where(np.isinf(found), np.nan, found).reshape(shape))


def make_empty(shape: tuple[int, int], *, is_count: bool) -> AnyArray:
    """Return cells without points."""
    return np.zeros(shape, COUNT_TYPE) if is_count else np.full(shape, np.nan)


def add_cells(cells: AnyArray, values: AnyArray) -> None:
    """Take further points of some cells into account, in place."""
    if cells.dtype == COUNT_TYPE:
        cells += values
    else:
        np.fmax(cells, values, out=cells)
