"""Canopy height models: the highest points of cells, the ground below, and what lies between."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_count, require_tin
from ...base.errors import PointsError
from ...base.products import product
from ...base.results import Raster
from ...base.sentences import counted
from ...tin import Survey
from .bands import SurfaceBand
from .grids import as_grid, describe_extent, settle_storage
from .ground_heights import place_points
from .point_cells import find_highest, locate_cells
from .point_rasters import fill_cells, list_notes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array
    from ...tin import TIN, Grid

_NOISE = {7: "low noise", 18: "high noise"}
"""Classes of the ASPRS."""


@product
def rasterize_canopy(
    tin: TIN,
    cloud: Survey | ArrayLike,
    *,
    spacing: float | None = None,
    like: Any = None,
    grid: Grid | None = None,
    threads: int | None = None,
) -> Raster:
    """Make a digital surface model, a digital terrain model and the canopy height between them.

    Parameters
    ----------
    tin : TIN
        The ground, such as that of the points of class 2, or of :func:`tinsmith.ground`.
    cloud : Survey or (n, 3) array
        As of :func:`tinsmith.height_above`: points of the ground and of what stands on it.
    spacing, like, grid
        As of :func:`tinsmith.rasterize`: one of the three is needed.
    threads : int, optional
        As :meth:`tinsmith.TIN.interpolate`.

    Returns
    -------
    Raster
        Bands ``dsm``, the elevation of the highest point in each cell, ``dtm``, that of the ground
        at its centre, and ``chm``, the first less the second; in the unit of the TIN's elevations,
        NaN where there is none. ``notes`` tell how many cells have no point, no ground or a height
        below 0, and how many of the points are noise or outside the cells.

    Raises
    ------
    OptionError, CrsError
        As :func:`tinsmith.rasterize` and :func:`tinsmith.height_above`.
    PointsError
        If no cell has both a point and ground, or points are not finite.

    Notes
    -----
    Nothing is hidden: cells without points stay without (no pits are filled), and heights below 0
    stay below 0. They are the rule on slopes of bare ground, where the highest point of a cell lies
    below its centre; :func:`tinsmith.rasterize_heights` has the height of each point above its own
    place on the ground instead. Cells hold points as those of :func:`tinsmith.rasterize_counts`.

    Examples
    --------
    >>> from tinsmith import TIN, rasterize_canopy
    >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 5], [0, 4, 9]], [[0, 1, 2]])
    >>> made = rasterize_canopy(tin, [[1, 1, 10], [1, 0.5, 5], [1, 3, 2]], spacing=2)
    >>> made.bands["chm"]
    array([[-6., nan],
           [ 6., nan]])
    >>> made.notes[-1]
    '1 of 2 cells with a height has it below 0, the lowest of -6: the DSM is below the DTM there.'
    """
    require_tin(tin)
    require_count("threads", threads, or_none=True)
    points, noted = place_points(cloud, tin)
    cells, notes = as_grid(tin, spacing=spacing, like=like, grid=grid, in_memory=True)
    highest = find_highest(cells, points, points[:, 2])
    surface = fill_cells(cells, highest, is_count=False)
    band = SurfaceBand(tin, cells, None, method="linear", is_mean=False, threads=threads)
    terrain = band[0 : cells.shape[0], 0 : cells.shape[1]]
    height = surface - terrain
    if np.isnan(height).all():
        raise PointsError(
            "No cell has both a point and ground: the cells cover "
            f"{describe_extent(cells.bounds)}, and the ground {describe_extent(tin.bounds)}."
        )
    stored_as, told = settle_storage(like)
    outside = int(np.count_nonzero(locate_cells(cells, points)[0] < 0))
    return Raster(
        {"dsm": surface, "dtm": terrain, "chm": height},
        cells,
        crs=tin.crs,
        stored_as=stored_as,
        units=dict.fromkeys(("dsm", "dtm", "chm"), tin.elevation_unit),
        name="canopy",
        notes=[
            *(f"The points above: {note}" for note in list_notes(cloud)),
            *noted,
            *notes,
            *told,
            *_describe_noise(cloud),
            *_describe_outside(outside, len(points)),
            *_describe_cells(~np.isnan(surface), ~np.isnan(terrain)),
            *_describe_below(height),
        ],
    )


def _describe_noise(cloud: Survey | ArrayLike) -> list[str]:
    """Tell how many of the points are of classes of noise, which are taken as all others."""
    if not isinstance(cloud, Survey) or "classification" not in cloud.attributes:
        return []
    classes = np.asarray(cloud.attributes["classification"])
    counts = {name: int(np.count_nonzero(classes == number)) for number, name in _NOISE.items()}
    return [
        f"{counted(count, 'point')} of the class of {name} {'is' if count == 1 else 'are'} among "
        "the points above."
        for name, count in counts.items()
        if count
    ]


def _describe_outside(outside: int, count: int) -> list[str]:
    if not outside:
        return []
    return [
        f"{outside:,} of {counted(count, 'point')} {'lies' if outside == 1 else 'lie'} outside the "
        "cells."
    ]


def _describe_cells(has_points: BoolArray, has_ground: BoolArray) -> list[str]:
    """Tell how many cells have no height, as there is no point or no ground."""
    empty = int(np.count_nonzero(has_ground & ~has_points))
    bare = int(np.count_nonzero(has_points & ~has_ground))
    found = []
    if empty:
        have = "has" if empty == 1 else "have"
        found.append(
            f"{empty:,} of {counted(int(has_ground.sum()), 'cell')} of the ground {have} no point: "
            "no DSM and no height."
        )
    if bare:
        have = "has" if bare == 1 else "have"
        found.append(
            f"{bare:,} of {counted(int(has_points.sum()), 'cell')} with points {have} no ground at "
            "the centre: no DTM and no height."
        )
    return found


def _describe_below(height: Float64Array) -> list[str]:
    below = int(np.count_nonzero(height < 0))
    if not below:
        return []
    total, have = int(np.isfinite(height).sum()), "has" if below == 1 else "have"
    return [
        f"{below:,} of {counted(total, 'cell')} with a height {have} it below 0, the lowest of "
        f"{np.nanmin(height):.6g}: the DSM is below the DTM there."
    ]
