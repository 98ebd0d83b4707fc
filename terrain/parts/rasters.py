"""Rasters of a surface, block by block.

The centre of a cell lies in triangles that meet every closed box around it: so the value there
needs no others, also where it lies on an edge or a vertex. Means need those that meet the cells.
Slopes that change evenly between vertices need all triangles around the vertices of these, as
``rings`` of `triangulate_box`: how far these reach, only the triangles can tell.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import OptionError
from ...base.results import locate_centers
from ...base.types import Bounds
from ..gridding import GridMeasure, OperatorBand, ReliefBand, SurfaceBand, locate_edges
from ..surface import NORTHWEST, Light, PlaneMeasure
from .surfaces import as_surface

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import Float64Array
    from ...base.crs import CRS, Unit
    from ...base.policies import RasterSample, RasterValue
    from ...base.types import Grid
    from ...tin.tiling import LocalTriangulation

_NO_CELLS = slice(0, 0)


class RasterOptions(NamedTuple):
    """What a raster holds: as the arguments of :func:`tinsmith.rasterize`, settled."""

    grid: Grid
    value: RasterValue = "elevation"
    is_smooth: bool = False
    of_cells: GridMeasure | None = None
    """What is measured of cells and their neighbours, in place of the surface."""
    at: RasterSample = "center"
    light: Light = NORTHWEST
    exaggeration: float = 1.0
    crs: CRS | None = None
    elevation_unit: Unit | None = None
    threads: int | None = 1


class RasterBlock(NamedTuple):
    """Some rows and columns of a raster, and the values of their cells; NaN off the surface."""

    rows: slice
    columns: slice
    values: Float64Array


def count_rings(options: RasterOptions) -> int:
    """Return how many rings of triangles are needed around those that meet the cells' centres."""
    is_relief = options.value != "elevation" and options.of_cells is None
    return int(options.is_smooth and is_relief and options.at == "center")


def find_cells(grid: Grid, box: Bounds) -> tuple[slice, slice]:
    """Return the rows and columns of cells whose centres lie in a box.

    Its west and south sides count, the others do not: of boxes that tile the plane each cell is in
    one.
    """
    height, width = grid.shape
    columns = slice(*(_count_before(grid, x, width, axis=0) for x in (box.xmin, box.xmax)))
    north, south = (_count_before(grid, y, height, axis=1) for y in (box.ymax, box.ymin))
    rows = slice(north, south)
    if rows.start >= rows.stop or columns.start >= columns.stop:
        return _NO_CELLS, _NO_CELLS
    return rows, columns


def _count_before(grid: Grid, limit: float, count: int, axis: int) -> int:
    """Return how many columns have their centres west of an easting, or rows not south of one.

    Centres are rounded, so it is they that are compared, of the cells that may be the last.
    """
    if math.isinf(limit):
        return count if (limit > 0) == (axis == 0) else 0
    start = limit - grid.bounds.xmin if axis == 0 else grid.bounds.ymax - limit
    guess = math.floor(min(max(start / grid.spacing, 0.0), count))
    near = slice(max(0, guess - 2), min(count, guess + 3))
    if axis == 0:
        is_before = locate_centers(grid, _NO_CELLS, near)[0] < limit
    else:
        is_before = locate_centers(grid, near, _NO_CELLS)[1] >= limit
    return near.start + int(np.count_nonzero(is_before))


def find_reach(options: RasterOptions, rows: slice, columns: slice) -> Bounds:
    """Return the box of which a part is needed for cells, one at least: that of their centres.

    For means it is that of the cells. Values of cells and their neighbours need one cell more.
    """
    if options.of_cells is not None:
        rows, columns = (
            slice(max(0, part.start - 1), min(side, part.stop + 1))
            for part, side in zip((rows, columns), options.grid.shape, strict=True)
        )
    locate = locate_centers if options.at == "center" else locate_edges
    x, y = locate(options.grid, rows, columns)
    return Bounds(float(x[0]), float(y[-1]), float(x[-1]), float(y[0]))


def compute_part(part: LocalTriangulation, box: Bounds, options: RasterOptions) -> RasterBlock:
    """Return the cells whose centres lie in a box, without its east and north sides.

    Parameters
    ----------
    part : LocalTriangulation
        All triangles that meet :func:`find_reach` of these cells, with :func:`count_rings` rings
        of triangles around them. For values at centres this is no larger than the box, but where
        neighbours count.
    box : Bounds
    options : RasterOptions
    """
    return compute_block(part, *find_cells(options.grid, box), options)


def compute_block(
    part: LocalTriangulation, rows: slice, columns: slice, options: RasterOptions
) -> RasterBlock:
    """Return some cells; ``part`` has all triangles that meet :func:`find_reach`, at least."""
    shape = rows.stop - rows.start, columns.stop - columns.start
    if 0 in shape or not len(part.triangles):
        return RasterBlock(rows, columns, np.full(shape, np.nan))
    return RasterBlock(rows, columns, _make_band(part, options)[rows, columns])


def _make_band(part: LocalTriangulation, options: RasterOptions) -> Any:
    tin = as_surface(part, options.crs, options.elevation_unit)
    how: dict[str, Any] = {"is_mean": options.at == "mean", "threads": options.threads}
    if options.value == "elevation" or options.of_cells is not None:
        band = SurfaceBand(tin, options.grid, None, method="linear", **how)
        if options.of_cells is None:
            return band
        return OperatorBand(band, options.grid, options.of_cells)
    plane: Any = options.value
    measure = PlaneMeasure(plane, options.light, options.exaggeration)
    return ReliefBand(tin, options.grid, measure, is_smooth=options.is_smooth, **how)


def join(blocks: Iterable[RasterBlock], options: RasterOptions) -> Float64Array:
    """Return all cells, (rows, columns), of blocks in any order.

    Raises
    ------
    OptionError
        If cells are missing, or in two blocks.
    """
    band = np.full(options.grid.shape, np.nan)
    count = 0
    for block in blocks:
        band[block.rows, block.columns] = block.values
        count += block.values.size
    if count != band.size:
        raise OptionError("blocks", count, f"all {band.size} cells, once each")
    return band
