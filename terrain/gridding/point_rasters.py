"""Rasters of points: how many lie in each cell, and how high they rise above a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_count, require_tin
from ...base.errors import PointsError
from ...base.products import product
from ...base.results import Raster
from ...base.sentences import counted
from ...tin import Survey
from ...tin.report import describe_skipped
from ...tin.validation import as_points
from .grids import as_grid, describe_extent, settle_storage
from .ground_heights import place_points
from .point_cells import add_cells, count_points, find_highest, make_empty

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ...tin import TIN, Grid
    from .point_cells import CellBlock


def rasterize_counts(
    points: Survey | ArrayLike,
    *,
    spacing: float | None = None,
    like: Any = None,
    grid: Grid | None = None,
) -> Raster:
    """Count the points in each cell of a raster.

    Parameters
    ----------
    points : Survey or (n, 3) array
        All of them count, also those at one place.
    spacing, like, grid
        As of :func:`tinsmith.rasterize`: one of the three is needed.

    Returns
    -------
    Raster
        One band, ``count``, uint32; 0 in cells without points.

    Raises
    ------
    OptionError, CrsError
        As :func:`tinsmith.rasterize`.
    PointsError
        If no point lies in a cell, or points are not finite.

    Notes
    -----
    The cell of a point is ``floor((x - xmin) / spacing)`` from the west and
    ``floor((ymax - y) / spacing)`` from the north, as GDAL has it: of a point on the side between
    two cells the eastern or the southern one. Points on the rim of the raster count in the cells
    within. (PDAL's ``writers.gdal`` counts points on a side between rows in the northern cell.)

    Examples
    --------
    >>> from tinsmith import rasterize_counts
    >>> rasterize_counts([[0, 0, 5], [1, 1, 6], [3, 1, 7], [4, 4, 9]], spacing=2).bands["count"]
    array([[0, 1],
           [2, 1]], dtype=uint32)
    """
    survey = points if isinstance(points, Survey) else Survey(points=as_points(points))
    xyz = as_points(survey.points)
    if not len(xyz):
        raise PointsError("There are no points to count.")
    cells, notes = as_grid(survey, spacing=spacing, like=like, grid=grid, in_memory=True)
    block = count_points(cells, xyz)
    crs = survey.crs
    return Raster(
        {"count": fill_cells(cells, block, is_count=True)},
        cells,
        crs=None if crs is None else crs.horizontal,
        name="count",
        notes=[*list_notes(survey), *notes],
    )


@product
def rasterize_heights(
    tin: TIN,
    cloud: Survey | ArrayLike,
    *,
    spacing: float | None = None,
    like: Any = None,
    grid: Grid | None = None,
    threads: int | None = None,
) -> Raster:
    """Find how high the highest point in each cell lies above a surface: a canopy height model.

    Parameters
    ----------
    tin : TIN
        The ground.
    cloud : Survey or (n, 3) array
        As of :func:`tinsmith.height_above`: points of the ground and of what stands on it.
    spacing, like, grid
        As of :func:`tinsmith.rasterize`: one of the three is needed.
    threads : int, optional
        As :meth:`tinsmith.TIN.interpolate`.

    Returns
    -------
    Raster
        One band, ``height``, in the unit of the TIN's elevations; NaN in cells without a point
        above or below the surface. ``notes`` tell how many points lie outside the surface.

    Raises
    ------
    OptionError, CrsError
        As :func:`tinsmith.rasterize` and :func:`tinsmith.height_above`.
    PointsError
        If no cell would have a value, or points are not finite.

    Notes
    -----
    Each point's height is that above its own place on the surface, as of PDAL's
    ``filters.hag_delaunay`` and lasR's ``normalize``, and the largest in a cell is kept: on a slope
    this is less than the highest elevation less the ground at the cell's centre. Cells hold points
    as those of :func:`tinsmith.rasterize_counts`. Noise among the points is not told from trees:
    leave out its classes (7 and 18) as they are read.

    Examples
    --------
    >>> from tinsmith import TIN, rasterize_heights
    >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 5], [0, 4, 9]], [[0, 1, 2]])
    >>> rasterize_heights(tin, [[1, 1, 10], [1, 0.5, 5], [5, 5, 10]], spacing=2).bands["height"]
    array([[nan, nan],
           [ 6., nan]])
    """
    require_tin(tin)
    require_count("threads", threads, or_none=True)
    points, noted = place_points(cloud, tin)
    cells, notes = as_grid(tin, spacing=spacing, like=like, grid=grid, in_memory=True)
    heights = measure_heights(points, tin.interpolate(points[:, :2], threads=threads))
    block = find_highest(cells, points, heights)
    require_points(block is not None, cells)
    outside = int(np.count_nonzero(np.isnan(heights)))
    stored_as, told = settle_storage(like)
    return Raster(
        {"height": fill_cells(cells, block, is_count=False)},
        cells,
        crs=None if tin.crs is None else tin.crs.horizontal,
        stored_as=stored_as,
        units={"height": tin.elevation_unit},
        name="height",
        notes=[
            *(f"The points above: {note}" for note in list_notes(cloud)),
            *noted,
            *notes,
            *told,
            *describe_points_outside(outside, len(points)),
        ],
    )


def list_notes(points: Survey | ArrayLike) -> list[str]:
    """Return what is known of points, with rows that were left out."""
    if not isinstance(points, Survey):
        return []
    return [*points.notes, *describe_skipped(points.skipped)]


def measure_heights(points: Float64Array, ground: Float64Array) -> Float64Array:
    """Return heights above the ground, NaN where there is none."""
    found: Float64Array = points[:, 2] - ground
    return found


def fill_cells(grid: Grid, block: CellBlock | None, *, is_count: bool) -> Any:
    """Return cells with the values of a block; refuse, by a PointsError, that there is none."""
    cells = make_empty(grid.shape, is_count=is_count)
    require_points(block is not None, grid)
    if block is not None:
        add_cells(cells[block.rows, block.columns], block.values)
    return cells


def require_points(has_points: bool, grid: Grid) -> None:
    """Refuse, by a PointsError, a raster in whose cells there is no point."""
    if not has_points:
        raise PointsError(f"No cell has a point: the cells cover {describe_extent(grid.bounds)}.")


def describe_points_outside(outside: int, count: int) -> list[str]:
    """Tell how many points are not above or below a surface."""
    if not outside:
        return []
    verb, they = ("lies", "it has") if outside == 1 else ("lie", "they have")
    return [
        f"{outside:,} of {counted(count, 'point')} {verb} outside the surface: {they} no height."
    ]
