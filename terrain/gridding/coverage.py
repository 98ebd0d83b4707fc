"""Coverage: whether the cells of a raster hold any of a surface at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError
from .bands import SurfaceBand
from .grids import describe_extent

if TYPE_CHECKING:
    from ...tin import TIN, Grid

_SAMPLE = 1000
"""Triangles that are looked at first."""
_BLOCK_CELLS = 1 << 22


def require_covered(tin: TIN, grid: Grid, *, is_mean: bool = False) -> None:
    """Refuse, by a PointsError, a raster no cell of which would have a value.

    With ``is_mean`` a cell has a value if any part of it is covered, else if its centre is.
    """
    if _sample_covers(tin, grid, is_mean):
        return
    level = np.zeros(len(tin.triangles))
    band = SurfaceBand(tin, grid, level, method="linear", is_mean=is_mean, threads=None)
    rows, columns = grid.shape
    height = max(1, _BLOCK_CELLS // columns)
    for top in range(0, rows, height):
        block = band[slice(top, min(top + height, rows)), slice(0, columns)]
        if np.isfinite(block).any():
            return
    what = "part of a cell" if is_mean else "centre of a cell"
    raise PointsError(
        f"No {what} lies on the surface: the cells are {grid.spacing:g} wide and cover "
        f"{describe_extent(grid.bounds)}, the surface {describe_extent(tin.bounds)}."
    )


def _sample_covers(tin: TIN, grid: Grid, is_mean: bool) -> bool:
    """Whether the cells at the middle of some triangles hold a part of the surface."""
    chosen = tin.triangles[:: max(1, len(tin.triangles) // _SAMPLE)]
    xy = tin.points[chosen, :2].mean(axis=1)
    bounds, (rows, columns) = grid.bounds, grid.shape
    from_corner = np.column_stack([xy[:, 0] - bounds.xmin, bounds.ymax - xy[:, 1]])
    at = np.floor(from_corner / grid.spacing)  # column and row
    at = at[((at >= 0) & (at < (columns, rows))).all(axis=1)]
    if is_mean or len(at) == 0:
        return len(at) > 0
    x = bounds.xmin + (at[:, 0] + 0.5) * grid.spacing
    y = bounds.ymax - (at[:, 1] + 0.5) * grid.spacing
    return bool((tin.locate(np.column_stack([x, y])) >= 0).any())
