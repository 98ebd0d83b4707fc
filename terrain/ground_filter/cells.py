"""Square cells over points, and the lowest point in each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import PointsError
from ...base.sentences import counted

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array

__all__ = ["Cells", "lay_cells"]

_CELLS_PER_POINT = 100
_FEWEST = 4_000_000
"""Cells that there may be whatever the number of points: their memory is some 40 MB."""


@dataclass(frozen=True, eq=False)
class Cells:
    """Points in the order of their cells; in a cell from the lowest up, then by coordinates."""

    shape: tuple[int, int]
    """Columns from west to east, and rows from south to north."""
    number: Int64Array
    """(n,), number of each point's cell, in the order of the points: ``column * rows + row``."""
    order: Int64Array
    """(n,), rows of the points by cell and elevation; the same points have the same order however
    they are given.
    """

    def find_lowest(self, is_taken: BoolArray) -> Int64Array:
        """Return the rows of the lowest of the points taken in each cell that has one."""
        rows = self.order[is_taken[self.order]]
        numbers = self.number[rows]
        is_first = np.ones(len(rows), bool)
        is_first[1:] = numbers[1:] != numbers[:-1]
        return rows[is_first]

    def spread(self, rows: Int64Array, elevations: Float64Array) -> Float64Array:
        """Return a grid of the elevations of one point a cell, infinity where there is none."""
        grid = np.full(self.shape, np.inf)
        grid.reshape(-1)[self.number[rows]] = elevations[rows]
        return grid

    def values_at(self, grid: Float64Array, rows: Int64Array) -> Float64Array:
        """Return the values of a grid in the cells of some points."""
        return grid.reshape(-1)[self.number[rows]]


def lay_cells(points: Float64Array, side: float) -> Cells:
    """Lay square cells over points whose least easting and northing are 0.

    Raises PointsError if there would be far more cells than points.
    """
    counts = np.floor(points[:, :2].max(axis=0) / side) + 1
    most = max(_FEWEST, _CELLS_PER_POINT * len(points))
    if counts.prod() > most:
        width, height = points[:, :2].max(axis=0)
        raise PointsError(
            f"{counted(len(points), 'point')} on {width:.6g} by {height:.6g} m make "
            f"{counts.prod():,.0f} cells of {side:g} m, and {most:,} are the most for so many: "
            "leave points far from the others out, or give larger cells."
        )
    columns, rows = counts.astype(np.int64).tolist()
    place = np.floor(points[:, :2] / side).astype(np.int64)
    number = place[:, 0] * rows + place[:, 1]
    x, y, z = points.T
    return Cells((columns, rows), number, np.lexsort((y, x, z, number)))
