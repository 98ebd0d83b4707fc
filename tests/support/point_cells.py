"""All points of a surface in cells of a lattice, of which a task sees only what it reads."""

from __future__ import annotations

import numpy as np

from tinsmith.base.types import Bounds
from tinsmith.tin.tiling.boxes import are_in_box
from tinsmith.tin.tiling.skeleton import find_outermost, reduce_to_hull
from tinsmith.tin.tiling.sources import NumberedPoints


def find_limits(box):
    """Return the southwestern and the northeastern corner, (2,) arrays."""
    return np.array([box.xmin, box.ymin]), np.array([box.xmax, box.ymax])


def may_meet(discs, box):
    """Tell which discs may have a point in common with a closed box."""
    low, high = find_limits(box)
    gap = np.maximum(np.maximum(low - discs.centers, discs.centers - high), 0.0)
    near = np.hypot(gap[:, 0], gap[:, 1]) * (1 - 2.0**-50) <= discs.radii
    return near | np.isinf(discs.radii)


class PointCells:
    """A source of points for tasks, with what it was asked."""

    def __init__(self, points, xs, ys):
        """Divide points between the lines of a lattice at ``xs`` and ``ys``, which ascend."""
        self.xs, self.ys = np.array(xs, float), np.array(ys, float)
        column = np.searchsorted(self.xs, points[:, 0], "right")
        row = np.searchsorted(self.ys, points[:, 1], "right")
        whole = NumberedPoints(points, np.arange(len(points)))
        self.cells = {}
        for key in sorted({*zip(column.tolist(), row.tolist(), strict=True)}):
            self.cells[key] = whole.choose(np.flatnonzero((column == key[0]) & (row == key[1])))
        hull = reduce_to_hull(
            NumberedPoints.join([reduce_to_hull(cell) for cell in self.cells.values()])
        )
        self.skeleton = NumberedPoints.join([hull, *map(find_outermost, self.cells.values())])
        self.rows_read = 0

    def box_of(self, key):
        """Return the box of a cell; the outermost have no end."""
        xs, ys = ([-np.inf, *values, np.inf] for values in (self.xs, self.ys))
        return Bounds(xs[key[0]], ys[key[1]], xs[key[0] + 1], ys[key[1] + 1])

    def list_cells(self):
        """Return all cells, empty ones too."""
        return [(i, j) for i in range(len(self.xs) + 1) for j in range(len(self.ys) + 1)]

    def read_box(self, box):
        """Return all points in a closed box."""
        parts = []
        for cell in self.cells.values():
            parts.append(cell.choose(are_in_box(cell.points, box)))
        return self._count(NumberedPoints.join(parts))

    def read_some(self, discs):
        """Return nothing: no disc holds very many points."""
        return self.skeleton.choose(slice(0, 0))

    def read_discs(self, discs):
        """Return the points of the cells that meet discs."""
        parts = [self.skeleton.choose(slice(0, 0))]
        for key, cell in self.cells.items():
            box = self.box_of(key)
            if may_meet(discs, box).any():
                parts.append(cell)
        return self._count(NumberedPoints.join(parts))

    def _count(self, found):
        self.rows_read += len(found.numbers)
        return found
