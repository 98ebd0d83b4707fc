"""Grids: which cells a raster has, and where their centres lie."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ... import _optional
from ...crs import CRS
from ...errors import CrsError, OptionError
from ...tin.types import Bounds, Grid
from ...tin.validation.options import is_finite_number
from ..results import Raster

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ...tin import TIN

__all__ = ["MOST_CELLS", "MOST_CELLS_IN_MEMORY", "as_grid", "centers", "edges"]

MOST_CELLS = 10**11
"""Of a raster that is made as it is written: 800 GB."""

MOST_CELLS_IN_MEMORY = 2**31
"""16 GiB."""

_MOST_PER_SIDE = 2**30

_FINEST = 2.0**9 * np.finfo(np.float64).eps
"""A cell has so much of the largest coordinate at least, so that centres are told apart."""


def as_grid(
    tin: TIN, *, spacing: float | None, like: Any, grid: Grid | None, in_memory: bool
) -> Grid:
    """Return the one grid that was asked for.

    Parameters
    ----------
    tin : TIN
    spacing : float or None
        Cells aligned to its multiples, around the surface.
    like : Raster, str, os.PathLike or None
    grid : Grid or None
    in_memory : bool
        Whether all cells are to be held at a time.

    Raises
    ------
    OptionError
        Unless exactly one is given, or if it has too many, too small or no square cells.
    CrsError
        If the other raster has another CRS.
    """
    given = {"spacing": spacing, "like": like, "grid": grid}
    named = [name for name, value in given.items() if value is not None]
    if len(named) != 1:
        raise OptionError("grid", named, "one of spacing, like and grid")
    if spacing is not None:
        found = _around(tin.bounds, spacing)
    else:
        found = _like(like, tin) if grid is None else grid
    _require_cells(found, in_memory)
    return found


def _around(bounds: Bounds, spacing: float) -> Grid:
    """Return the cells that cover bounds, with edges at multiples of the spacing."""
    if not (is_finite_number(spacing) and spacing > 0):
        raise OptionError("spacing", spacing, "a length > 0 in CRS units")
    size = float(spacing)
    _require_telling(size, bounds)
    west, south = math.floor(bounds.xmin / size), math.floor(bounds.ymin / size)
    columns = max(1, math.ceil(bounds.xmax / size) - west)
    rows = max(1, math.ceil(bounds.ymax / size) - south)
    around = (west * size, south * size, (west + columns) * size, (south + rows) * size)
    return Grid(Bounds(*around), shape=(rows, columns), spacing=size)


def _require_telling(spacing: float, bounds: Bounds) -> None:
    largest = max(map(abs, (bounds.xmin, bounds.xmax, bounds.ymin, bounds.ymax)))
    least = _FINEST * largest
    if spacing < least:
        raise OptionError(
            "spacing", spacing, f"at least {least:.2g} at these coordinates, which are rounded"
        )


def _require_cells(grid: Any, in_memory: bool) -> None:
    if not isinstance(grid, Grid):
        raise OptionError("grid", grid, "a Grid")
    if not (is_finite_number(grid.spacing) and grid.spacing > 0):
        raise OptionError("spacing", grid.spacing, "a length > 0 in CRS units")
    _require_telling(grid.spacing, grid.bounds)
    rows, columns = (int(side) for side in grid.shape)
    if rows < 1 or columns < 1:
        raise OptionError("shape of the grid", grid.shape, "1 or more rows and columns")
    most = MOST_CELLS_IN_MEMORY if in_memory else MOST_CELLS
    if rows * columns > most or max(rows, columns) > _MOST_PER_SIDE:
        size = f"{rows:,} rows by {columns:,} columns"
        raise OptionError("number of cells", rows * columns, f"at most {most:,}, not {size}")


def _like(like: Any, tin: TIN) -> Grid:
    if isinstance(like, Raster):
        _require_crs(tin, like.crs, "the raster")
        return like.grid
    if isinstance(like, str | os.PathLike):
        return _grid_of_file(os.fspath(like), tin)
    raise OptionError("like", like, "a Raster or the path of a raster file")


def _grid_of_file(path: str, tin: TIN) -> Grid:
    """Read the grid of a raster file from its header."""
    rasterio = _optional.load("rasterio", "The grid of a raster file")
    try:
        with rasterio.open(path) as file:
            affine, (rows, columns), crs = file.transform, file.shape, file.crs
    except rasterio.errors.RasterioError as error:
        raise OptionError("like", path, "a raster file that can be opened") from error
    _require_crs(tin, None if crs is None else CRS.of(crs.to_wkt()), f"'{path}'")
    drift = abs(affine.a + affine.e) * max(rows, columns)
    if affine.b or affine.d or affine.a <= 0 or drift > 1e-3 * affine.a:
        size = f"{affine.a:g} by {-affine.e:g}"
        raise OptionError("like", path, f"a north-up raster of square cells (these are {size})")
    bounds = Bounds(affine.c, affine.f - rows * affine.a, affine.c + columns * affine.a, affine.f)
    return Grid(bounds, shape=(rows, columns), spacing=affine.a)


def _require_crs(tin: TIN, crs: CRS | None, what: str) -> None:
    if tin.crs is not None and crs is not None and not tin.crs.horizontal.is_same(crs.horizontal):
        raise CrsError(
            f"The CRS of {what} is {crs.label}, that of the TIN {tin.crs.label}: they must be the "
            "same.",
            crs=crs,
        )


def centers(
    grid: Grid, rows: slice, columns: slice
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return eastings of the centres of columns, and northings of the centres of rows."""
    x = grid.bounds.xmin + (_numbers(columns) + 0.5) * grid.spacing
    y = grid.bounds.ymax - (_numbers(rows) + 0.5) * grid.spacing
    return x, y


def edges(
    grid: Grid, rows: slice, columns: slice
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return eastings of the sides of columns, and northings of the sides of rows."""
    x = (
        grid.bounds.xmin
        + np.arange(columns.start, columns.stop + 1, dtype=np.float64) * grid.spacing
    )
    y = grid.bounds.ymax - np.arange(rows.start, rows.stop + 1, dtype=np.float64) * grid.spacing
    return x, y


def _numbers(part: slice) -> NDArray[np.float64]:
    return np.arange(part.start, part.stop, dtype=np.float64)


def as_parts(key: Any, shape: Sequence[int]) -> tuple[slice, slice]:
    """Return the rows and columns of ``band[rows, columns]`` as slices from start to stop."""
    rows, columns = key
    parts = [
        slice(*part.indices(side)[:2]) for part, side in zip((rows, columns), shape, strict=True)
    ]
    return parts[0], parts[1]
