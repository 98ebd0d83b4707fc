"""The order in which the core sweeps points, and so that of triangles, for parts of a whole.

The core keeps points in cells, row by row from the south-west, each of about two points. A cell
with many holds cells of its own, and so on; in a cell points are in the order of easting, then
northing. So the order is a function of the point set (``tin/cpp/index/grid.hpp``). A triangle
belongs to its first vertex in this order (``tin/cpp/insertion/canonical_order.hpp``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import Float64Array, Int64Array

_POINTS_PER_CELL = 2.0
_CROWDED_IF_EVEN, _CROWDED_IF_UNEVEN = 16, 6
"""Points of a cell above which it has cells of its own."""
_EVEN = 4.0
DEEPEST = 12
"""Levels of cells within cells."""
_ROUNDINGS = 2.0**-48
"""Share of a distance by which others may be shorter than they are computed."""


class Cells(NamedTuple):
    """Square cells over the bounds of groups of points, a row of each array for each group.

    Attributes
    ----------
    low : (g, 2) float64 array
    per_cell : (g,) float64 array
        One over the side of a cell.
    columns, rows : (g,) int64 arrays
    """

    low: Float64Array
    per_cell: Float64Array
    columns: Int64Array
    rows: Int64Array

    @classmethod
    def fitted(cls, low: Float64Array, high: Float64Array, counts: Int64Array) -> Cells:
        """Return cells over bounds, (g, 2), of so many points; rounded as the core does."""
        width, height = (high - low).T
        cells = np.maximum(1.0, counts / _POINTS_PER_CELL)
        even = np.sqrt(width / cells) * np.sqrt(height)
        side = np.maximum(np.maximum(even, width / cells), height / cells)
        per_cell = 1.0 / np.where(side > 0.0, side, 1.0)
        columns, rows = (1 + (extent * per_cell).astype(np.int64) for extent in (width, height))
        return cls(low, per_cell, columns, rows)

    @property
    def counts(self) -> Int64Array:
        """How many cells each group has."""
        return self.columns * self.rows

    def locate(self, xy: Float64Array, group: Int64Array | int = 0) -> Int64Array:
        """Return the cell of each point among those of its group, row by row."""
        at = (xy - self.low[group]) * self.per_cell[group, ..., None]
        last = np.stack([self.columns[group], self.rows[group]], axis=-1) - 1
        column, row = np.clip(at, 0, last).astype(np.int64).T
        return np.asarray(row * self.columns[group] + column)


def choose_crowd(squares: float, count: int) -> int:
    """Return above how many points a cell is crowded.

    Parameters
    ----------
    squares : float
        Of the numbers of points in the cells over all points, summed up.
    count : int
        Of all points.
    """
    return _CROWDED_IF_EVEN if squares / count < _EVEN else _CROWDED_IF_UNEVEN


def sort_in_cells(xy: Float64Array, cells: Int64Array, crowd: int, *, depth: int = 0) -> Int64Array:
    """Return the order of points, all those of some cells.

    Parameters
    ----------
    xy : (n, 2) float64 array
        Distinct.
    cells : (n,) int64 array
    crowd : int
        Points above which a cell has cells of its own.
    depth : int
        Levels of cells above these.
    """
    order = np.lexsort((xy[:, 1], xy[:, 0], cells))
    places, key = np.arange(len(order)), cells[order]
    for _ in range(depth, DEEPEST):
        starts = np.flatnonzero(np.append(True, key[1:] != key[:-1]))
        counts = np.diff(np.append(starts, len(key)))
        is_crowded = counts > crowd
        if not is_crowded.any():
            break
        places, counts = places[np.repeat(is_crowded, counts)], counts[is_crowded]
        rows = order[places]
        own, begins = xy[rows], np.cumsum(counts) - counts
        low, high = (ends.reduceat(own, begins, axis=0) for ends in (np.minimum, np.maximum))
        inner = Cells.fitted(low, high, counts)
        group = np.repeat(np.arange(len(counts)), counts)
        key = (np.cumsum(inner.counts) - inner.counts)[group] + inner.locate(own, group)
        within = np.lexsort((own[:, 1], own[:, 0], key))
        order[places], key = rows[within], key[within]
    return np.asarray(order)


# ------------------------------------------------------------------------ triangles


def turn_to_first(triangles: Int64Array) -> Int64Array:
    """Return triangles from their least corner on, (m, 3), by this corner."""
    turn = (triangles.argmin(axis=1)[:, None] + np.arange(3)) % 3
    turned = np.take_along_axis(triangles, turn, axis=1)
    return np.asarray(turned[np.argsort(turned[:, 0], kind="stable")])


def sort_stars(triangles: Int64Array, locate: Callable[[Int64Array], Float64Array]) -> Int64Array:
    """Return triangles in the order of the core.

    By their first vertex; those of one vertex sector by sector, these by where they start, counter-
    clockwise within each. A vertex that has its whole star starts at its nearest neighbour.

    Parameters
    ----------
    triangles : (m, 3) int64 array
        Counter-clockwise from the first vertex, by places in the order of the sweep, below 2**31;
        all those of each first vertex.
    locate : callable
        Returns the easting and northing of vertices, (k, 2), by their places.
    """
    triangles = triangles[np.lexsort((triangles[:, 1], triangles[:, 0]))]
    owner, start, end = triangles.T
    key = owner << 32 | start
    after = np.minimum(np.searchsorted(key, owner << 32 | end), len(key) - 1)
    is_followed = key[after] == owner << 32 | end
    before = np.arange(len(key))
    before[after[is_followed]] = np.flatnonzero(is_followed)
    is_start = before == np.arange(len(key))
    begins = np.flatnonzero(np.append(True, owner[1:] != owner[:-1])[: len(owner)])
    ends = np.append(begins[1:], len(owner))
    is_whole = ~np.logical_or.reduceat(is_start, begins) if len(begins) else begins > 0
    for begin, stop in zip(begins[is_whole].tolist(), ends[is_whole].tolist(), strict=True):
        nearest = begin + _find_nearest(locate(owner[begin : begin + 1]), locate(start[begin:stop]))
        before[nearest] = nearest
    head, steps = _follow(before)
    return np.asarray(triangles[np.lexsort((steps, start[head], owner))])


def _follow(before: Int64Array) -> tuple[Int64Array, Int64Array]:
    """Return where each chain begins, which is before itself, and how many steps behind it."""
    steps = (before != np.arange(len(before))).astype(np.int64)
    while True:
        further = before[before]
        if np.array_equal(further, before):
            return before, steps
        steps, before = steps + steps[before], further


def _find_nearest(place: Float64Array, others: Float64Array) -> int:
    """Return the nearest of some places, (k, 2), to one, (1, 2); of equally near ones the first."""
    off = others - place
    squares = (off * off).sum(axis=1)
    best, *rest = np.flatnonzero(squares <= squares.min() * (1 + _ROUNDINGS)).tolist()
    for other in rest:
        pair = others[[other]], others[[best]]
        if _kernel.compare_distances(place, *pair)[0] < 0:
            best = other
    return int(best)
