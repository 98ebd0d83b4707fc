"""The vertices and triangles of all tiles as files, in the order that they have in memory.

Nothing here holds more than a range of vertices, or of what belongs to them, at a time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..base.errors import CheckError, OptionError, PointsError
from ..io import find_format
from ..io.mesh.ply import write_blocks
from ..tin.tiling import DEEPEST, Cells, choose_crowd, sort_in_cells, sort_stars, turn_to_first
from .numbering import NUMBER

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from ..base.arrays import AnyArray, Float64Array, Int64Array

_PLACE = np.dtype("<i4")
_COORDINATE = np.dtype("<f8")
_MOST_BINS = 1 << 16
MOST_AT_A_TIME = 1 << 21
"""Vertices that are sorted at a time."""

WRITERS = {"ply": write_blocks}
"""Writers that take a surface block by block, by the names of their formats."""


def find_writable(name: str) -> str:
    """Return the name of a format that is written block by block, or refuse another one.

    Raises
    ------
    OptionError
        If all of the surface is needed at a time.
    """
    chosen = find_format(name, "write").name
    if chosen not in WRITERS:
        able = ", ".join(WRITERS)
        raise OptionError(
            "format",
            name,
            f"{able} where a surface in tiles becomes one file: others need all of it at a time",
        )
    return chosen


def require_numbers(count: int) -> None:
    """Refuse more vertices than a file can number.

    Raises
    ------
    PointsError
    """
    most = np.iinfo(_PLACE).max
    if count > most:
        raise PointsError(
            f"The surface has {count:,} vertices or more, and one file numbers up to {most:,}."
        )


def read_blocks(path: Path, dtype: str) -> Iterator[AnyArray]:
    """Yield the rows of a file of threes, (k, 3)."""
    with path.open("rb") as file:
        while len(block := np.fromfile(file, dtype, 3 * MOST_AT_A_TIME)):
            yield block.reshape(-1, 3)


def place_points(folder: Path, count: int, tiles: Iterable[tuple[Path, Path]]) -> Float64Array:
    """Write the vertices of all tiles in the order of their numbers, and return them as a file.

    Parameters
    ----------
    folder : Path
    count : int
    tiles : iterable of (Path, Path)
        Of each the files of the numbers and of the coordinates of vertices: each vertex is in one.

    Raises
    ------
    PointsError
        If there are more vertices than a file can number.
    CheckError
        If a vertex is in no tile.
    """
    require_numbers(count)
    points: Float64Array = np.memmap(folder / "points", _COORDINATE, "w+", shape=(count, 3))
    placed = 0
    for numbers, coordinates in tiles:
        rows = np.fromfile(numbers, NUMBER)
        points[rows] = np.fromfile(coordinates, _COORDINATE).reshape(-1, 3)
        placed += len(rows)
    if placed != count:
        raise CheckError(f"{placed:,} of {count:,} vertices lie in tiles.")
    return points


class _Bin(NamedTuple):
    """Vertices in neighbouring cells: from one to before another."""

    numbers: AnyArray
    first: int
    end: int


class Sweep:
    """The order in which memory sweeps the vertices, on which the order of triangles depends.

    Parameters
    ----------
    points : (n, 3) float64 array
        May be a file.
    folder : Path
        Where files are kept.
    most : int
        Vertices that are sorted at a time; no more than those of a file.

    Attributes
    ----------
    order : (n,) int32 array
        Vertices in this order, a file.
    places : (n,) int32 array
        Their places in it, a file.
    """

    def __init__(self, points: Float64Array, folder: Path, most: int = MOST_AT_A_TIME) -> None:
        self._points, self._folder, self._most = points, folder, most
        self._made = 0
        shape = (len(points),)
        self.order: AnyArray = np.memmap(folder / "order", _PLACE, "w+", shape=shape)
        self.places: AnyArray = np.memmap(folder / "places", _PLACE, "w+", shape=shape)
        self._fill()

    def locate(self, places: Int64Array) -> Float64Array:
        """Return the eastings and northings of vertices by their places."""
        return np.ascontiguousarray(self._points[self.order[places], :2])

    def _fill(self) -> None:
        every = np.memmap(self._name(), _PLACE, "w+", shape=self.order.shape)
        for part in self._cut(every):
            every[part] = np.arange(part.start, part.stop)
        top = self._fit(every)
        bins = self._bin(every, top, 0, int(top.counts[0]))
        squares = sum(self._sum_squares(one, top) for one in bins)
        crowd = choose_crowd(squares, len(every))
        at = 0
        for one in bins:
            for numbers in self._sort(one, top, crowd, 0):
                self.order[at : at + len(numbers)] = numbers
                self.places[numbers] = np.arange(at, at + len(numbers))
                at += len(numbers)

    def _cut(self, values: AnyArray) -> Iterator[slice]:
        for start in range(0, len(values), self._most):
            yield slice(start, min(start + self._most, len(values)))

    def _name(self) -> Path:
        self._made += 1
        return self._folder / f"bin{self._made}"

    def _take(self, numbers: AnyArray) -> Float64Array:
        return np.ascontiguousarray(self._points[numbers, :2])

    def _fit(self, numbers: AnyArray) -> Cells:
        """Return cells that fit some vertices."""
        low, high = np.full(2, np.inf), np.full(2, -np.inf)
        for part in self._cut(numbers):
            xy = self._take(numbers[part])
            low, high = np.minimum(low, xy.min(axis=0)), np.maximum(high, xy.max(axis=0))
        return Cells.fitted(low[None], high[None], np.array([len(numbers)]))

    def _bin(self, numbers: AnyArray, cells: Cells, first: int, end: int) -> list[_Bin]:
        """Divide vertices by their cells, from one to before another, into bins that are small."""
        width = -(-(end - first) // _MOST_BINS)
        counts = np.zeros(-(-(end - first) // width), np.int64)
        for part in self._cut(numbers):
            at = (cells.locate(self._take(numbers[part])) - first) // width
            counts += np.bincount(at, minlength=len(counts))
        sums = np.cumsum(counts)
        stops: list[int] = []
        before = 0
        while not stops or stops[-1] < len(counts):
            start = stops[-1] if stops else 0
            stop = max(int(np.searchsorted(sums, before + self._most, "right")), start + 1)
            stops.append(stop)
            before = int(sums[stop - 1])
        names = [self._name() for _ in stops]
        for part in self._cut(numbers):
            some = numbers[part]
            at = (cells.locate(self._take(some)) - first) // width
            bin_of = np.searchsorted(stops, at, "right")
            order = np.argsort(bin_of, kind="stable")
            for k, rows in _group(bin_of[order], order):
                with names[k].open("ab") as file:
                    file.write(np.ascontiguousarray(some[rows]).data)
        edges = [first + width * stop for stop in [0, *stops[:-1]]] + [end]
        return [
            _Bin(np.memmap(name, _PLACE, "r"), *edges[k : k + 2])
            for k, name in enumerate(names)
            if name.exists()
        ]

    def _sum_squares(self, one: _Bin, cells: Cells) -> float:
        """Return the sum of the squares of the numbers of vertices in cells."""
        if len(one.numbers) <= self._most:
            counts = np.unique(cells.locate(self._take(one.numbers)), return_counts=True)[1]
        else:
            counts = np.zeros(one.end - one.first, np.int64)
            for part in self._cut(one.numbers):
                at = cells.locate(self._take(one.numbers[part])) - one.first
                counts += np.bincount(at, minlength=len(counts))
        return float((counts.astype(np.float64) ** 2).sum())

    def _sort(self, one: _Bin, cells: Cells, crowd: int, depth: int) -> Iterator[AnyArray]:
        """Yield the vertices of a bin in order."""
        numbers, first, end = one
        is_cell = end - first == 1
        if len(numbers) <= max(self._most, crowd) or (is_cell and depth == DEEPEST):
            xy = self._take(numbers)
            yield numbers[sort_in_cells(xy, cells.locate(xy), crowd, depth=depth)]
            return
        if is_cell:
            cells, depth = self._fit(numbers), depth + 1
            first, end = 0, int(cells.counts[0])
        for part in self._bin(numbers, cells, first, end):
            yield from self._sort(part, cells, crowd, depth)


def _group(keys: AnyArray, rows: AnyArray) -> Iterator[tuple[int, AnyArray]]:
    """Yield the rows of each key, which ascend."""
    starts = np.flatnonzero(np.append(True, keys[1:] != keys[:-1])[: len(keys)])
    for start, stop in zip(starts, [*starts[1:], len(keys)], strict=True):
        yield int(keys[start]), rows[start:stop]


def write_turned(path: Path, triangles: Int64Array, sweep: Sweep) -> None:
    """Write the triangles of a tile from their first vertex on, by their places in the sweep."""
    turned = turn_to_first(sweep.places[triangles].astype(np.int64))
    with path.open("wb") as file:
        file.write(turned.astype(_PLACE).data)


def merge_triangles(
    paths: Sequence[Path], sweep: Sweep, *, most: int = MOST_AT_A_TIME
) -> Iterator[AnyArray]:
    """Yield the triangles of all tiles in the order that they have in memory, (k, 3), by numbers.

    Parameters
    ----------
    paths : sequence of Path
        Of :func:`write_turned`.
    sweep : Sweep
    most : int
        First vertices that are taken at a time.
    """
    edges = np.append(np.arange(0, len(sweep.order), most), len(sweep.order))
    files = [np.memmap(path, _PLACE, "r").reshape(-1, 3) for path in paths]
    ends = [np.searchsorted(one[:, 0], edges) for one in files]
    for k in range(len(edges) - 1):
        parts = [one[at[k] : at[k + 1]] for one, at in zip(files, ends, strict=True)]
        found = sort_stars(np.concatenate(parts).astype(np.int64), sweep.locate)
        yield sweep.order[found]
