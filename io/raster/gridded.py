"""Points that are the cells of a regular grid, as a raster."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from ...base.results import Raster
from ...base.types import Bounds, Grid

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from ...tin import Survey

_OFF = 1e-3
"""Of a cell's side: as far from its centre a point may lie, for files of rounded coordinates."""

_EMPTIEST = 100
"""Cells for each point at most; points that are sparser are no raster."""


class _Axis(NamedTuple):
    """Centres of columns or rows: the first, the distance between them, their number."""

    start: float
    spacing: float
    n_cells: int


def make_raster(survey: Survey) -> Raster:
    """Return the raster whose cells have points as their centres; no elevation is interpolated.

    Parameters
    ----------
    survey : Survey
        Such as one read from a raster, or from a text file of a grid.

    Returns
    -------
    Raster
        With one band, ``elevation``; NaN in cells without a point.

    Raises
    ------
    PointsError
        If the points are not centres of square cells side by side, or two are in one cell.

    Examples
    --------
    >>> import tinsmith as ts
    >>> points = [[x, y, x + y] for y in (10, 12, 14) for x in (0, 2)]
    >>> make_raster(ts.Survey(points=points))
    <Raster: 3 rows by 2 columns, spacing 2, bands elevation, crs unknown>
    """
    points = survey.points
    spacing = _find_spacing(points)
    x, y = (_fit_axis(points[:, axis], spacing) for axis in (0, 1))
    if x.n_cells * y.n_cells > _EMPTIEST * len(points):
        raise _describe_no_grid(f"they would fill {len(points)} of {x.n_cells * y.n_cells} cells")
    columns, rows = _find_cells(points[:, 0], x), y.n_cells - 1 - _find_cells(points[:, 1], y)
    cells = rows * x.n_cells + columns
    _, first = np.unique(cells, return_index=True)
    if len(first) < len(cells):
        row = int(np.setdiff1d(np.arange(len(cells)), first)[0])
        raise _describe_no_grid(f"row {row} is in the cell of another point", row)
    band = np.full(x.n_cells * y.n_cells, np.nan)
    band[cells] = points[:, 2]
    half = spacing / 2
    west, south = x.start - half, y.start - half
    east, north = west + spacing * x.n_cells, south + spacing * y.n_cells
    grid = Grid(Bounds(west, south, east, north), (y.n_cells, x.n_cells), spacing)
    return Raster(
        {"elevation": band.reshape(grid.shape)},
        grid,
        crs=survey.crs,
        units={"elevation": survey.elevation_unit},
        notes=survey.notes,
    )


def _find_spacing(points: Float64Array) -> float:
    """Return the distance of neighbouring columns, or else rows, from the extent they span."""
    for axis in (0, 1):
        values = np.unique(points[:, axis])
        gaps = np.diff(values)
        if len(gaps):
            least = gaps[gaps > gaps.max() * _OFF].min()
            span = values[-1] - values[0]
            return float(span / max(round(span / least), 1))
    raise _describe_no_grid("they are all at one place")


def _fit_axis(values: Float64Array, spacing: float) -> _Axis:
    start, end = float(values.min()), float(values.max())
    return _Axis(start, spacing, round((end - start) / spacing) + 1)


def _find_cells(values: Float64Array, axis: _Axis) -> Int64Array:
    """Return the column or row of each value, which must be its centre."""
    places = (values - axis.start) / axis.spacing
    cells = np.rint(places)
    off = np.abs(places - cells)
    if off.max() > _OFF:
        row = int(np.argmax(off))
        raise _describe_no_grid(
            f"row {row} is {off[row]:.3g} of a cell's side ({axis.spacing:g}) off its centre", row
        )
    return cells.astype(np.int64)


def _describe_no_grid(why: str, *rows: int) -> PointsError:
    return PointsError(
        f"The points are not the cells of a grid: {why}.",
        rows=rows,
    )
