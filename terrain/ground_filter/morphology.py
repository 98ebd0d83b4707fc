"""Erosion, dilation and opening of grids by octagons, and the least value around each cell.

Cells without a value are infinite, and count neither in an erosion nor in a dilation; nor does what
lies outside the grid. Grids are worked on in blocks of columns, so that memory is bounded.

References
----------
M. van Herk, "A fast algorithm for local minimum and maximum filters on rectangular and octagonal
kernels", Pattern Recognition Letters 13 (1992): an octagon is a sum of four lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import BoolArray, Float64Array

    Grid = Float64Array

_GROWTH = 1.3
"""Of one window to the next: finer steps find nothing more."""

_BLOCK = 4_000_000
"""Cells that are worked on at once."""


def list_windows(largest: int) -> list[int]:
    """Return half widths of windows in cells, from 1 to the largest.

    Examples
    --------
    >>> list_windows(10)
    [1, 2, 3, 4, 5, 6, 7, 9, 10]
    """
    windows = [1]
    while windows[-1] < largest:
        windows.append(min(largest, max(windows[-1] + 1, int(_GROWTH * windows[-1]))))
    return windows


def split_columns(shape: tuple[int, int], halo: int) -> Iterator[tuple[slice, slice, slice]]:
    """Cut a grid into blocks of columns.

    Yields
    ------
    wide, inner, own : slice
        Columns of the grid with a halo on both sides, those of the block in these, and those of
        the block in the grid.
    """
    columns, rows = shape
    width = max(halo, _BLOCK // max(1, rows), 1)
    for start in range(0, columns, width):
        end = min(columns, start + width)
        first = max(0, start - halo)
        wide = slice(first, min(columns, end + halo))
        yield wide, slice(start - first, end - first), slice(start, end)


def open_grid(grid: Grid, window: int, is_covered: BoolArray | None = None) -> Grid:
    """Erode a grid, and dilate what is left: what is narrower than the window goes.

    ``window`` is its half width in cells. Windows may be centred where ``is_covered`` is True, by
    default where there is a value around: one beyond the border of the data would touch nothing but
    a roof there, and leave it.
    """
    eroded = _filter(grid, window, np.minimum, np.inf)
    is_outside = np.isinf(eroded)
    if is_covered is not None:
        is_outside |= ~is_covered
    eroded[is_outside] = -np.inf
    return _filter(eroded, window, np.maximum, -np.inf)


def find_covered(is_full: BoolArray, gap: int) -> BoolArray:
    """Close gaps between cells that are no wider than twice so many cells.

    What lies outside the grid counts neither as full nor as empty.
    """
    reached = _filter(is_full.astype(np.float64), gap, np.maximum, 0.0)
    covered: BoolArray = _filter(reached, gap, np.minimum, 1.0) > 0
    return covered


def least_around(grid: Grid, core: int, reach: int, *, is_whole: bool = False) -> Grid:
    """Return the least value of the cells around each cell, infinity where there is none.

    They are further than ``core`` and no further than ``reach``, in columns or rows. The width of
    that frame is odd, and larger than twice the first. With ``is_whole`` infinity is returned, too,
    where one of the eight squares of the frame is empty.
    """
    half, away = (reach - core - 1) // 2, (reach + core + 1) // 2
    padded = np.pad(grid, away + half, constant_values=np.inf)
    squares = _reduce_square(padded, half, np.minimum)
    columns, rows = grid.shape
    least = np.full(grid.shape, np.inf)
    is_empty = np.zeros(grid.shape, np.bool_)
    for i in (0, away, 2 * away):
        for j in (0, away, 2 * away):
            if (i, j) != (away, away):
                square = squares[i : i + columns, j : j + rows]
                np.minimum(least, square, out=least)
                is_empty |= np.isinf(square)
    if is_whole:
        least[is_empty] = np.inf
    return least


def _filter(grid: Grid, window: int, choose: Any, outside: float) -> Grid:
    """Choose the least, or the largest, value within an octagon around each cell."""
    oblique = int(window * (1 - np.sqrt(0.5)))  # half length of the oblique sides of the octagon
    padded = np.pad(grid, window, constant_values=outside)
    result = _reduce_square(padded, window - 2 * oblique, choose)
    for step in ((1, 1), (1, -1)):
        result = _reduce_line(result, step, 2 * oblique + 1, choose)
    return result


def _reduce_square(padded: Grid, half: int, choose: Any) -> Grid:
    across = _reduce_line(padded, (1, 0), 2 * half + 1, choose)
    return _reduce_line(across, (0, 1), 2 * half + 1, choose)


def _reduce_line(values: Grid, step: tuple[int, int], length: int, choose: Any) -> Grid:
    """Choose along lines of so many cells, twice as many of them at a time."""
    done = 1
    while done < length:
        by = min(done, length - done)
        values = choose(*_shift(values, by * step[0], by * step[1]))
        done += by
    return values


def _shift(values: Grid, columns: int, rows: int) -> tuple[Grid, Grid]:
    """Return two views of a grid, the second moved against the first."""
    m, n = values.shape
    if rows >= 0:
        return values[: m - columns, : n - rows], values[columns:, rows:]
    return values[: m - columns, -rows:], values[columns:, : n + rows]
