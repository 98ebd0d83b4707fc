"""Grids: which cells a raster has, and where their centres lie."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_length
from ...base.crs import CRS
from ...base.errors import OptionError, PointsError
from ...base.georeference import require_same_crs
from ...base.results import Raster, require_grid
from ...base.sentences import coordinate, counted, shown
from ...base.types import Affine, Bounds, CellStorage, Grid

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ...base.arrays import Float64Array
    from ...tin import TIN, Survey

MOST_CELLS = 10**11
"""Of a raster that is made as it is written: 800 GB."""

MOST_CELLS_IN_MEMORY = 2**31
"""16 GiB."""

_MOST_PER_SIDE = 2**30

_MOST_DRIFT = 1e-3
"""Of a cell: so much the last cell may be off if cells are taken to be even."""

_FINEST = 2.0**9 * np.finfo(np.float64).eps
"""A cell has so much of the largest coordinate at least, so that centres are told apart."""


class Cells(NamedTuple):
    """A grid of another raster, with what is told of it."""

    grid: Grid
    crs: CRS | None
    stored_as: CellStorage | None = None


def as_grid(
    tin: TIN | Survey,
    *,
    spacing: float | None,
    like: Any = None,
    grid: Grid | None,
    in_memory: bool,
) -> tuple[Grid, tuple[str, ...]]:
    """Return the one grid that was asked for, and what was assumed of it.

    ``spacing`` stands for cells aligned to its multiples, around the surface; ``like`` is a Raster,
    Cells, a rasterio data set or an object of xarray; ``in_memory`` tells whether all cells are to
    be held at a time.

    Raises OptionError unless exactly one is given, or if it has too many or too small cells, or
    some without area; CrsError if the other raster has another CRS; PointsError if the cells are
    not where the surface is.
    """
    given = {"spacing": spacing, "like": like, "grid": grid}
    named = [name for name, value in given.items() if value is not None]
    if len(named) != 1:
        raise OptionError("grid", named, "one of spacing, like and grid")
    notes: tuple[str, ...] = ()
    if spacing is not None:
        found = cover(tin.bounds, spacing)
    elif like is not None:
        found, crs, _ = as_cells(like)
        notes = require_same_crs(crs, tin.crs, "the other raster")
    else:
        found = as_one_grid(grid)
    require_cells(found, in_memory=in_memory)
    require_overlap(found.bounds, tin.bounds)
    return found, notes


def cover(bounds: Bounds, spacing: float) -> Grid:
    """Return the cells that cover bounds, with edges at multiples of the spacing.

    Examples
    --------
    >>> cover(Bounds(0.5, 0.5, 3.5, 2.0), 1.0)
    Grid(bounds=Bounds(xmin=0.0, ymin=0.0, xmax=4.0, ymax=2.0), shape=(2, 4), spacing=1.0)
    """
    size = as_length("spacing", spacing)
    _require_telling(size, bounds)
    west, south = math.floor(bounds.xmin / size), math.floor(bounds.ymin / size)
    columns = max(1, math.ceil(bounds.xmax / size) - west)
    rows = max(1, math.ceil(bounds.ymax / size) - south)
    around = (west * size, south * size, (west + columns) * size, (south + rows) * size)
    return Grid(Bounds(*around), shape=(rows, columns), spacing=size)


def as_one_grid(grid: Any) -> Grid:
    """Return a Grid whose numbers fit together."""
    if not isinstance(grid, Grid):
        raise OptionError("grid", grid, "a Grid")
    if not isinstance(grid.spacing, tuple):
        as_length("spacing", grid.spacing)
    require_grid(grid)
    return grid


def _require_telling(spacing: float, bounds: Bounds) -> None:
    largest = max(map(abs, (bounds.xmin, bounds.xmax, bounds.ymin, bounds.ymax)))
    least = _FINEST * largest
    if spacing < least:
        raise OptionError(
            "spacing", spacing, f"at least {least:.2g} at these coordinates, which are rounded"
        )


def require_cells(grid: Grid, *, in_memory: bool) -> None:
    """Refuse, by an OptionError, cells that are too many, or too small for the coordinates."""
    _require_telling(_measure_least(grid), grid.bounds)
    rows, columns = (int(side) for side in grid.shape)
    most = MOST_CELLS_IN_MEMORY if in_memory else MOST_CELLS
    if rows * columns > most or max(rows, columns) > _MOST_PER_SIDE:
        size = f"{counted(rows, 'row')} by {counted(columns, 'column')}"
        allowed = f"at most {most:,}, not {size}"
        raise OptionError("spacing", rows * columns, allowed, what="number of cells")


def _measure_least(grid: Grid) -> float:
    """Return the least distance of opposite sides of a cell."""
    width, height = grid.cell_size
    if grid.is_aligned:
        return min(width, height)
    a, b, _, d, e, _ = grid.transform
    return abs(a * e - b * d) / max(width, height)


def require_overlap(cells: Bounds, bounds: Bounds) -> None:
    """Refuse, by a PointsError, cells that are not where a surface is."""
    apart = cells.xmax < bounds.xmin or bounds.xmax < cells.xmin
    if apart or cells.ymax < bounds.ymin or bounds.ymax < cells.ymin:
        raise PointsError(
            f"The cells do not meet the surface: they cover {describe_extent(cells)}, the surface "
            f"{describe_extent(bounds)}."
        )


def describe_extent(bounds: Bounds) -> str:
    """Write bounds for a sentence.

    Examples
    --------
    >>> describe_extent(Bounds(0.0, 0.0, 4.0, 3.0))
    '0 to 4 east, 0 to 3 north'
    """
    return (
        f"{coordinate(bounds.xmin)} to {coordinate(bounds.xmax)} east, "
        f"{coordinate(bounds.ymin)} to "
        f"{coordinate(bounds.ymax)} north"
    )


# ---------------------------------------------------------------- other rasters


def as_cells(like: Any) -> Cells:
    """Return the cells of another raster.

    Raises OptionError if it is none, or its cells have no area.
    """
    if isinstance(like, Cells):
        return like
    if isinstance(like, Raster):
        return Cells(like.grid, like.crs, like.stored_as or _find_storage(like))
    if all(hasattr(like, name) for name in ("transform", "shape", "crs")):
        grid, crs = to_grid(like.transform, like.shape), like.crs
        stored = CellStorage(like.dtypes[0], like.nodata) if hasattr(like, "dtypes") else None
        return Cells(grid, CRS.of(crs.to_wkt()) if crs else None, stored)
    if all(hasattr(like, name) for name in ("coords", "dims")):
        return _take_coordinates(like)
    raise OptionError(
        "like",
        like,
        "a Raster, a data set of rasterio or xarray, a file object, or the path of a raster file",
    )


def to_grid(transform: Sequence[float], shape: Sequence[int], what: Any = "raster") -> Grid:
    """Return the grid of a raster with six numbers of georeference, as rasterio has them.

    ``shape`` is rows and columns. Raises OptionError, of ``what``, if cells have no area, or
    corners are not finite.
    """
    try:
        return Grid.of_transform(transform, shape)
    except OptionError as error:
        if error.option != "transform":
            raise
        allowed = f"a raster whose cells have an area (its geotransform is {shown(transform)})"
        raise OptionError("like", what, allowed) from error


def _take_coordinates(like: Any) -> Cells:
    """Return the cells of an object of xarray, whose coordinates x and y are the centres.

    One without them has the geotransform that its grid mapping holds, as rioxarray writes it.
    """
    named = like.coords["spatial_ref"].attrs if "spatial_ref" in like.coords else {}
    crs = CRS.of(named.get("crs_wkt"))
    written = _read_transform(named)
    if written is not None and {"y", "x"} <= set(like.dims) and "x" not in like.coords:
        shape = like.sizes["y"], like.sizes["x"]
        return Cells(to_grid(written, shape, like), crs, _find_array_storage(like))
    names = [name for name in ("x", "y") if name in like.coords]
    sides = [np.asarray(like.coords[name].values, np.float64) for name in names]
    if len(names) != 2 or any(side.ndim != 1 or len(side) < 2 for side in sides):
        raise OptionError("like", like, "a data set of xarray with two or more x and y")
    x, y = sides
    steps = [(side[-1] - side[0]) / (len(side) - 1) for side in sides]
    for side, step in zip(sides, steps, strict=True):
        off = np.abs(side - (side[0] + np.arange(len(side)) * step)).max()
        if not off <= _MOST_DRIFT * abs(step):
            raise OptionError("like", like, "a data set of xarray with even steps of x and y")
    across, up = (float(step) for step in steps)
    found = Affine(across, 0.0, float(x[0]) - across / 2, 0.0, up, float(y[0]) - up / 2)
    if written is not None and _is_about(written, found, max(len(x), len(y))):
        found = written
    return Cells(to_grid(found, (len(y), len(x)), like), crs, _find_array_storage(like))


def _find_storage(raster: Raster) -> CellStorage | None:
    """Return how the cells of a raster are kept, if all bands are of one type."""
    kinds = {np.dtype(band.dtype).name for band in raster.bands.values()}
    return CellStorage(kinds.pop(), raster.nodata) if len(kinds) == 1 else None


def _find_array_storage(like: Any) -> CellStorage | None:
    """Return how the cells of an object of xarray are kept, if all variables are of one type."""
    arrays = list(like.data_vars.values()) if hasattr(like, "data_vars") else [like]
    kinds = {str(one.encoding.get("dtype", one.dtype)) for one in arrays if one.ndim >= 2}
    if len(kinds) != 1:
        return None
    declared = [
        place["_FillValue"]
        for one in arrays
        for place in (one.attrs, one.encoding)
        if "_FillValue" in place
    ]
    return CellStorage(np.dtype(kinds.pop()).name, float(declared[0]) if declared else None)


def settle_storage(like: Any) -> tuple[CellStorage | None, list[str]]:
    """Return how cells of floating numbers are kept, as those of another raster, and a note of it.

    Whole numbers are not taken over: they would round what is computed.
    """
    stored = None if like is None else as_cells(like).stored_as
    if stored is None:
        return None, []
    kind, nodata = np.dtype(stored.dtype), stored.nodata
    if kind.kind in "iu":
        return None, [
            f"Cells of the other raster are {kind.name}, and these are float64, which are not "
            "rounded; `dtype` rounds them."
        ]
    if kind.kind != "f" or not 4 <= kind.itemsize <= 8:
        return None, []
    nodata = None if nodata is None or not math.isfinite(nodata) else float(nodata)
    if kind.itemsize == 8 and nodata is None:
        return None, []
    value = "" if nodata is None else f", those without data as {nodata:g}"
    return CellStorage(kind.name, nodata), [
        f"Cells are written as {kind.name}{value}, as those of the other raster."
    ]


def _read_transform(named: Mapping[str, Any]) -> Affine | None:
    """Return the geotransform of a grid mapping, in the order of GDAL there; None without one."""
    try:
        west, a, b, north, d, e = (float(word) for word in str(named["GeoTransform"]).split())
    except (KeyError, ValueError):
        return None
    return Affine(a, b, west, d, e, north)


def _is_about(written: Affine, found: Affine, count: int) -> bool:
    """Whether a geotransform is that of the coordinates, but for rounding, of so many cells."""
    off = np.abs(np.subtract(written, found))
    most = _MOST_DRIFT * np.array([abs(found.a)] * 3 + [abs(found.e)] * 3)
    return bool((off * [count, count, 1.0, count, count, 1.0] <= most).all())


def locate_edges(grid: Grid, rows: slice, columns: slice) -> tuple[Float64Array, Float64Array]:
    """Return eastings of the sides of columns, and northings of the sides of rows."""
    affine = grid.transform
    x, y = (
        np.arange(part.start, part.stop + 1, dtype=np.float64) * side
        for part, side in ((columns, affine.a), (rows, affine.e))
    )
    return affine.c + x, affine.f + y


def as_parts(key: Any, shape: Sequence[int]) -> tuple[slice, slice]:
    """Return the rows and columns of ``band[rows, columns]`` as slices from start to stop."""
    rows, columns = key
    parts = [
        slice(*part.indices(side)[:2]) for part, side in zip((rows, columns), shape, strict=True)
    ]
    return parts[0], parts[1]
