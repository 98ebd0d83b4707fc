"""Square cells over points, and the lowest point in each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from .frame import Frame


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


def lay_cells(points: Float64Array, frame: Frame) -> Cells:
    """Lay the square cells of a frame over points that lie in it, in metres."""
    place = frame.locate(points)
    number = place[:, 0] * frame.shape[1] + place[:, 1]
    x, y, z = points.T
    return Cells(frame.shape, number, np.lexsort((y, x, z, number)))
