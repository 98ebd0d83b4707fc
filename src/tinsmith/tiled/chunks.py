"""Points on disk: chunks as they were read, each in the order of cells of its own.

A chunk is written once, by the task that read it, and never changed. Its points lie in the order
of the cells of a lattice over the chunk's own bounds, so that a box is read as few slices of a
mapped file, whatever order the input had: one lidar tile gives compact chunks, a shuffled file
chunks that each cover all of it with fewer points a cell. Nothing is merged or sorted afterwards.
Points of files that are read in place have cells, too, see :mod:`.in_place`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..base.atomic import replacing
from ..base.types import Bounds
from ..tin.tiling import NumberedPoints

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ..base.arrays import AnyArray, BoolArray, Float64Array, Int64Array

_POINT = np.dtype([("xyz", "<f8", 3), ("row", "<u4")])
"""A point on disk: its coordinates, and its row behind the first one of the chunk."""

BYTES_ON_DISK = _POINT.itemsize

ROWS_OF_A_FILE = 2**40
"""Numbers of rows are those in the file, and this times the number of the file."""

_POINTS_OF_A_CELL = 1_000
_CELLS_AT_A_TIME = 8
_MOST_CELLS_AT_A_TIME = 1_024
_MAPPED = 128
"""Files that are kept mapped: a process may have some hundred open."""
_MOST_CELLS = 2**16 - 1
"""Cells are sorted as numbers of 16 bits, in linear time."""


class CellBlocks(NamedTuple):
    """Rectangles of cells of a chunk: first and last row, first and last column of each, (k,)."""

    south: AnyArray
    north: AnyArray
    west: AnyArray
    east: AnyArray


@dataclass(frozen=True)
class Chunk:
    """A file of points, with what is known of it without reading them.

    Attributes
    ----------
    folder : Path
    file, part : int
        Which input the points are from, and which part of it they are.
    first : int
        Number of the chunk's first row, among the rows of all inputs.
    count : int
        Points in it.
    bounds : Bounds
        Of its points.
    shape : tuple of int
        Rows (from the south) and columns of the cells.
    """

    folder: Path
    file: int
    part: int
    first: int
    count: int
    bounds: Bounds
    shape: tuple[int, int]

    @property
    def path(self) -> Path:
        """Records of its points."""
        return self.folder / f"{self.file:06d}-{self.part:06d}.npy"

    @property
    def lattice(self) -> Bounds:
        """What the cells divide; a point outside of it is in the nearest one."""
        return self.bounds

    @property
    def firsts(self) -> Int64Array:
        """Numbers, ascending, from each of which to the next there are not too many points."""
        return np.array([self.first])

    @cached_property
    def offsets(self) -> Int64Array:
        """Where the points of each cell begin, (rows * columns + 1,) array."""
        found: Int64Array = np.load(self.path.with_suffix(".cells.npy"))
        return found

    @cached_property
    def _sums(self) -> Int64Array:
        """Points in the cells south-west of each corner of cells, (rows + 1, columns + 1) array."""
        rows, columns = self.shape
        found = np.zeros((rows + 1, columns + 1), np.int64)
        found[1:, 1:] = np.diff(self.offsets).reshape(self.shape).cumsum(axis=0).cumsum(axis=1)
        return found

    def locate(self, boxes: Float64Array) -> CellBlocks:
        """Return the cells that closed boxes meet; (k, 4), west, south, east, north."""
        own, (rows, columns) = self.lattice, self.shape
        return CellBlocks(
            *(_find_cells(boxes[:, k], own.ymin, own.ymax, rows) for k in (1, 3)),
            *(_find_cells(boxes[:, k], own.xmin, own.xmax, columns) for k in (0, 2)),
        )

    def count_points(self, blocks: CellBlocks) -> Int64Array:
        """Return how many points lie in the cells of each block."""
        south, north, west, east = (np.asarray(one, np.int64) for one in blocks)
        sums = self._sums
        inner = sums[north + 1, east + 1] - sums[south, east + 1]
        return np.asarray(inner - sums[north + 1, west] + sums[south, west])

    def list_parts(self) -> Iterator[Bounds]:
        """Yield boxes that together hold all points, and each not too many."""
        yield self.bounds

    def read_boxes(self, boxes: Float64Array) -> NumberedPoints:
        """Return the points of the cells that some closed boxes, (k, 4), meet, each once."""
        return self.read(self.list_slices(self.locate(boxes)))

    def read_near(self, center: Float64Array, radius: float) -> Iterator[NumberedPoints]:
        """Yield the points of cells within a distance of a place, the nearest cells first."""
        for cells in self._list_cells_near(center, radius, 1):
            yield self.read([self._slice(cell, cell + 1) for cell in cells.tolist()])

    def list_slices(self, blocks: CellBlocks) -> list[slice]:
        """Return where the points of the cells of blocks lie, those of each cell once."""
        edges = np.flatnonzero(np.diff(self._mark(blocks).view(np.int8), prepend=0, append=0))
        ends = self.offsets[edges].reshape(-1, 2).tolist()
        return [slice(start, stop) for start, stop in ends if start < stop]

    def _mark(self, blocks: CellBlocks) -> BoolArray:
        """Tell which cells are in any of some blocks, (rows * columns,) array."""
        rows, columns = self.shape
        south, north, west, east = (np.asarray(one, np.int64) for one in blocks)
        marks = np.zeros((rows + 1, columns + 1), np.int32)
        for row, column, step in (
            (south, west, 1),
            (south, east + 1, -1),
            (north + 1, west, -1),
            (north + 1, east + 1, 1),
        ):
            np.add.at(marks, (row, column), step)
        return (marks.cumsum(axis=0).cumsum(axis=1) > 0)[:rows, :columns].ravel()

    def _list_cells_near(
        self, center: Float64Array, radius: float, growth: int
    ) -> Iterator[Int64Array]:
        """Yield some filled cells at a time, ascending, and more each time if they grow."""
        box, (rows, columns) = self.lattice, self.shape
        gaps = []
        for low, extent, count, value in (
            (box.ymin, box.height, rows, center[1]),
            (box.xmin, box.width, columns, center[0]),
        ):
            starts = low + np.arange(count) * (extent / count)
            slack = extent * 2.0**-20
            gap = np.maximum(starts - value, value - (starts + extent / count)) - slack
            gaps.append(np.maximum(gap, 0.0))
        distances = np.hypot(gaps[0][:, None], gaps[1]).ravel()
        near = np.flatnonzero((distances <= radius) & (np.diff(self.offsets) > 0))
        near = near[np.argsort(distances[near], kind="stable")]
        start, step = 0, _CELLS_AT_A_TIME
        while start < len(near):
            yield np.sort(near[start : start + step])
            start, step = start + step, min(step * growth, _MOST_CELLS_AT_A_TIME)

    def _slice(self, start: int, stop: int) -> slice:
        return slice(int(self.offsets[start]), int(self.offsets[stop]))

    def read(self, slices: list[slice]) -> NumberedPoints:
        """Read parts of the file."""
        records = _map(self.path, self.path.stat().st_mtime_ns)
        count = sum(part.stop - part.start for part in slices)
        points, numbers = np.empty((count, 3)), np.empty(count, np.int64)
        start = 0
        for part in slices:
            end = start + part.stop - part.start
            found = records[part]
            points[start:end] = found["xyz"]
            numbers[start:end] = found["row"]
            start = end
        numbers += self.first
        return NumberedPoints(points, numbers)


@lru_cache(maxsize=_MAPPED)
def _map(path: Path, changed: int) -> AnyArray:
    """Map a file, those used last kept; one that was written anew is mapped anew."""
    del changed
    mapped: AnyArray = np.load(path, mmap_mode="r")
    return mapped


def write_chunk(
    folder: Path, file: int, part: int, points: Float64Array, numbers: Int64Array
) -> Chunk:
    """Write points in the order of their cells.

    Parameters
    ----------
    folder : Path
    file, part : int
    points : (n, 3) float64 array
        n >= 1.
    numbers : (n,) int64 array
        Ascending; less than 2^32 from the first to the last.

    Raises
    ------
    WriteError
    """
    bounds = Bounds.of(points)
    rows, columns = choose_shape(len(points), bounds, _MOST_CELLS)
    cells = _find_cells(points[:, 1], bounds.ymin, bounds.ymax, rows) * np.uint16(columns)
    cells += _find_cells(points[:, 0], bounds.xmin, bounds.xmax, columns)
    offsets = np.zeros(rows * columns + 1, np.int64)
    np.cumsum(np.bincount(cells, minlength=rows * columns), out=offsets[1:])
    order = np.argsort(cells, kind="stable")
    records = np.empty(len(points), _POINT)
    records["xyz"] = points[order]
    records["row"] = (numbers - numbers[0])[order]
    chunk = Chunk(folder, file, part, int(numbers[0]), len(points), bounds, (rows, columns))
    save_array(chunk.path.with_suffix(".cells.npy"), offsets)
    save_array(chunk.path, records)
    return chunk


def split_numbers(points: NumberedPoints) -> list[NumberedPoints]:
    """Return points in parts whose numbers are less than 2^32 apart: one, but for sparse rows."""
    parts, start = [], 0
    while start < len(points.numbers):
        stop = int(np.searchsorted(points.numbers, points.numbers[start] + 2**32))
        parts.append(points.choose(np.arange(start, stop)))
        start = stop
    return parts


def save_array(path: Path, values: AnyArray) -> None:
    """Write an array to a file of its own."""
    with replacing(path) as file:
        np.save(file, values)


def choose_shape(count: int, bounds: Bounds, most: int) -> tuple[int, int]:
    """Return rows and columns of cells that are about square, and at most so many.

    There are less than 2^16 of either.
    """
    wanted = min(most, max(1, count // _POINTS_OF_A_CELL))
    if bounds.width == 0.0 or bounds.height == 0.0:
        wanted = min(wanted, _MOST_CELLS)
        return (1, wanted) if bounds.width else (wanted, 1)
    side = float(np.sqrt(wanted * bounds.width / bounds.height))
    columns = min(max(1, round(side)), wanted, _MOST_CELLS)
    return max(1, min(wanted // columns, _MOST_CELLS)), columns


def find_cells(points: Float64Array, lattice: Bounds, shape: tuple[int, int]) -> Int64Array:
    """Return the number of the cell of each point, row by row from the south-west."""
    rows = _find_cells(points[:, 1], lattice.ymin, lattice.ymax, shape[0])
    columns = _find_cells(points[:, 0], lattice.xmin, lattice.xmax, shape[1])
    return rows.astype(np.int64) * shape[1] + columns


def _find_cells(values: Float64Array, low: float, high: float, count: int) -> AnyArray:
    """Return the cell of each value along one side, the nearest one for values outside.

    Rounding is monotonic: of two values the larger never has the lower cell.
    """
    if count == 1 or high <= low:
        return np.zeros(len(values), np.uint16)
    steps = (np.clip(values, low, high) - low) / (high - low) * count
    return np.minimum(steps, count - 1).astype(np.uint16)
