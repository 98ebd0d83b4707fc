"""The elevations of a raster, read block by block, and where its cells are."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import OptionError, PointsError
from ...base.results import locate_centers, require_square
from ...base.types import seal

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ...base.arrays import Float64Array, Int64Array
    from ...base.crs import Unit
    from ...base.results import Raster

_LARGEST = 2**31 - 8
"""Cells of one block at most: the core numbers them with 32 bits."""


class Block(NamedTuple):
    """A part of a raster; neighbours share a row or a column of cells."""

    rows: slice
    columns: slice

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of cells."""
        return self.rows.stop - self.rows.start, self.columns.stop - self.columns.start

    def widen(self) -> Block:
        """Return the block with the row and the column before it."""
        return Block(
            slice(max(0, self.rows.start - 1), self.rows.stop),
            slice(max(0, self.columns.start - 1), self.columns.stop),
        )

    def own(self, shape: tuple[int, int]) -> Block:
        """Return the part that the blocks after it do not have, of a raster of some shape."""
        rows, columns = (
            slice(part.start, part.stop - (part.stop < side))
            for part, side in zip((self.rows, self.columns), shape, strict=True)
        )
        return Block(rows, columns)

    def within(self, other: Block) -> tuple[slice, slice]:
        """Return rows and columns of the block in one that holds it."""
        row, column = other.rows.start, other.columns.start
        return (
            slice(self.rows.start - row, self.rows.stop - row),
            slice(self.columns.start - column, self.columns.stop - column),
        )

    def to_raster(self, cells: Int64Array, width: int) -> Int64Array:
        """Return cells of the block as cells of a raster with so many columns."""
        row, column = np.divmod(cells, self.shape[1])
        found: Int64Array = (row + self.rows.start) * width + column + self.columns.start
        return found

    def find(self, cells: Int64Array, width: int) -> Int64Array:
        """Return the cells of a raster that lie in the block, as cells of the block."""
        row, column = np.divmod(cells, width)
        row, column = row - self.rows.start, column - self.columns.start
        height, across = self.shape
        inside = (row >= 0) & (row < height) & (column >= 0) & (column < across)
        found: Int64Array = (row * across + column)[inside]
        return found


class Elevations:
    """The elevations of a raster: row 0 is the northernmost, NaN where there is none.

    ``x`` and ``y`` are the centres of columns and rows.
    """

    def __init__(self, raster: Raster) -> None:
        name = _choose_band(raster)
        self._band, self._nodata = raster.bands[name], raster.nodata
        self._last: tuple[Block, Float64Array] | None = None
        unit = raster.units.get(name)
        self.unit: Unit | str | None = unit
        self.shape = (int(raster.shape[0]), int(raster.shape[1]))
        require_square(raster.grid, "raster", raster)
        self.x, self.y = locate_centers(raster.grid)
        self.cell_size = raster.grid.cell_size
        if min(self.shape) < 2:
            raise PointsError(
                f"A raster of {self.shape[0]:,} by {self.shape[1]:,} cells has no surface: two "
                "rows and columns are the least."
            )

    def read(self, block: Block) -> Float64Array:
        """Return the elevations of a block, not to be changed; the last one is kept."""
        if self._last is None or self._last[0] != block:
            band = np.asarray(self._band[block.rows, block.columns])
            z = np.array(band, np.float64)
            is_finite = np.isfinite(z)
            if not is_finite.all():
                z[~is_finite] = np.nan
            if not np.isnan(self._nodata):
                z[band == self._nodata] = np.nan
            self._last = block, seal(z)
        return self._last[1]

    def is_rectangle(self, rings: Sequence[Int64Array]) -> bool:
        """Whether rings are the outer cells of the raster."""
        if len(rings) != 1:
            return False
        row, column = np.divmod(rings[0], self.shape[1])
        is_outer = (row == 0) | (row == self.shape[0] - 1)
        is_outer |= (column == 0) | (column == self.shape[1] - 1)
        return bool(is_outer.all()) and len(row) == 2 * sum(self.shape) - 4

    def points(self, cells: Int64Array, z: Float64Array) -> Float64Array:
        """Return the points of cells."""
        row, column = np.divmod(cells, self.shape[1])
        return np.column_stack([self.x[column], self.y[row], z])


class Heights:
    """Elevations of some cells, (k,) in ``cells``: ascending, each once."""

    def __init__(self, cells: Int64Array, z: Float64Array) -> None:
        self.cells, first = np.unique(cells, return_index=True)
        self._z = z[first]

    def of(self, cells: Int64Array) -> Float64Array:
        """Return the elevations of cells, which are some of them."""
        return self._z[np.searchsorted(self.cells, cells)]

    def join(self, cells: Int64Array, z: Float64Array) -> Heights:
        """Return the elevations of these cells and others."""
        return Heights(np.append(self.cells, cells), np.append(self._z, z))


def _choose_band(raster: Raster) -> str:
    names = list(raster.bands)
    if len(names) == 1:
        return names[0]
    if "elevation" in names:
        return "elevation"
    raise OptionError("raster", raster, "one with one band, or with a band 'elevation'")


def cut_blocks(shape: tuple[int, int], side: int | None) -> Iterator[Block]:
    """Cut a raster into blocks with a side of so many cells, row by row; None for a single one.

    Examples
    --------
    >>> [block.columns for block in cut_blocks((4, 6), 3)]
    [slice(0, 4, None), slice(3, 6, None)]
    """
    height, width = shape
    if side is None and height * width > _LARGEST:
        allowed = f"at most {_LARGEST:,}"
        raise OptionError("side", height * width, allowed, what="number of cells")
    for rows in _cut(height, side):
        for columns in _cut(width, side):
            yield Block(rows, columns)


def _cut(count: int, side: int | None) -> list[slice]:
    if side is None or count <= side + 1:
        return [slice(0, count)]
    starts = [start for start in range(0, count, side) if start + 1 < count]
    return [slice(start, min(start + side + 1, count)) for start in starts]
