"""Points that stay in their files: how many lie where, and those that were read last.

A file with an index in space (COPC, the windows of a raster, GeoParquet with bounds) need not be
copied. It is read once, to count the points of the cells of a lattice; later blocks of cells are
read by box where they are, and those used last are kept by each process. What comes back is held
against the counts, and the file against what it was.
"""

from __future__ import annotations

import json
from collections import OrderedDict
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.atomic import replacing
from ..base.errors import OptionError, ReadError
from ..base.types import Bounds
from ..io.streaming import read_box
from ..terrain.ground_filter import Candidates
from ..tin.tiling import NumberedPoints
from .chunks import ROWS_OF_A_FILE, Chunk, choose_shape, find_cells, save_array
from .running import Fingerprint

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from ..base.arrays import BoolArray, Float64Array, Int64Array
    from ..base.policies import GroundReturns
    from ..io.registry import PointChunk, SourceHeader

_MOST_CELLS = 2**20
"""Of a file; their counts take eight bytes each."""
_POINTS_OF_A_BLOCK = 16_000
"""About; fewer are read sooner, and oftener."""
_POINTS_OF_A_PART = 1_000_000
_HELD_POINTS = 2**21
"""Points of blocks that a process keeps."""
_BYTES_OF_A_POINT = 40
BYTES_HELD = _HELD_POINTS * _BYTES_OF_A_POINT
_WORTH_READING = 100_000
"""Points that are read along sooner than a second box is read."""
_SLACK = 2.0**-40
"""Of coordinates, by which a box is larger than its cells, for the rounding of their sides."""


def find_obstacle(header: SourceHeader) -> str:
    """Return why a file cannot be read in place, from "it" on; empty if it can."""
    if header.obstacle:
        return header.obstacle
    if header.bounds is None or header.count is None:
        return "tells no bounds of its points, or not how many there are"
    return ""


@dataclass(frozen=True)
class Choice:
    """A file, and which of its points are taken.

    Attributes
    ----------
    number : int
        Of the file among all.
    source : Fingerprint
    options : mapping
        Of the reader, plain values.
    where : mapping of str to sequence of float
        Values of attributes that points must have.
    candidates : {"last", "all"} or None
        Returns of a pulse, where only those points are wanted that may be ground.
    """

    number: int
    source: Fingerprint
    options: Mapping[str, Any] = field(default_factory=dict)
    where: Mapping[str, Sequence[float]] = field(default_factory=dict)
    candidates: GroundReturns | None = None

    def choose(self, found: PointChunk) -> PointChunk:
        """Return the points that have the wanted values of attributes.

        Raises
        ------
        OptionError
            If the points do not have an attribute.
        """
        if not self.where:
            return found
        chosen = np.ones(len(found), np.bool_)
        for name, values in self.where.items():
            if name not in found.attributes:
                there = ", ".join(found.attributes) or "none"
                raise OptionError("where", name, f"an attribute of the points: {there}")
            chosen &= np.isin(found.attributes[name], np.asarray(values))
        return found.take(chosen)

    def number_points(self, found: PointChunk) -> NumberedPoints:
        """Return points with their numbers among those of all files."""
        return NumberedPoints(found.points, found.rows + np.int64(self.number) * ROWS_OF_A_FILE)

    def read_box(self, box: Bounds) -> NumberedPoints:
        """Read the points of a closed box where they are.

        Raises
        ------
        ReadError
            If the file is not what it was, or is damaged.
        """
        self.source.require_same()
        found = self.choose(read_box(self.source.path, box, **self.options))
        if self.candidates is not None:
            may_be = Candidates(self.candidates).find(found.attributes, len(found))
            found = found.take(may_be)
        self.source.require_same()
        return self.number_points(found)


class Counting:
    """The counts of the points of a file by cells, as it is read from end to end.

    Parameters
    ----------
    lattice : Bounds
        That the header tells.
    count : int
        Points that it tells of.
    """

    def __init__(self, lattice: Bounds, count: int) -> None:
        self.lattice = lattice
        self.shape = choose_shape(count, lattice, _MOST_CELLS)
        self._counts = np.zeros(self.shape[0] * self.shape[1], np.int64)
        self._firsts: list[int] = []
        self._low = np.full(2, np.inf)
        self._high = np.full(2, -np.inf)

    def add(self, some: NumberedPoints) -> None:
        """Count some points, at least one."""
        places = some.points[:, :2]
        cells = find_cells(places, self.lattice, self.shape)
        self._counts += np.bincount(cells, minlength=len(self._counts))
        self._firsts.append(int(some.numbers[0]))
        self._low = np.minimum(self._low, places.min(axis=0))
        self._high = np.maximum(self._high, places.max(axis=0))

    def save(self, folder: Path, choice: Choice) -> list[FileInPlace]:
        """Write what was counted into a folder, and return the file; nothing without points.

        Raises
        ------
        WriteError
        """
        if not self._firsts:
            return []
        made = FileInPlace(
            folder,
            choice.number,
            0,
            self._firsts[0],
            int(self._counts.sum()),
            Bounds(*self._low.tolist(), *self._high.tolist()),
            self.shape,
        )
        offsets, rows, source = made.paths
        save_array(offsets, np.concatenate([[0], np.cumsum(self._counts)]))
        save_array(rows, np.array(self._firsts, np.int64))
        with replacing(source, binary=False) as file:
            json.dump({"choice": asdict(choice), "lattice": asdict(self.lattice)}, file)
        return [made]


class _Block(NamedTuple):
    """The points of a block of cells, with the cell of each."""

    points: NumberedPoints
    cells: Int64Array


class _Held:
    """Blocks that were used last, of all files that a process reads."""

    def __init__(self) -> None:
        self._blocks: OrderedDict[tuple[Any, int], _Block] = OrderedDict()
        self._count = 0
        self._lock = RLock()

    def find(self, file: Any, number: int) -> _Block | None:
        """Return a block of a file, if it is held."""
        with self._lock:
            found = self._blocks.get((file, number))
            if found is not None:
                self._blocks.move_to_end((file, number))
            return found

    def keep(self, file: Any, blocks: Mapping[int, _Block]) -> None:
        """Keep blocks of a file, and let those go that were used before all others."""
        with self._lock:
            for number, block in blocks.items():
                old = self._blocks.pop((file, number), None)
                self._count += len(block.cells) - (0 if old is None else len(old.cells))
                self._blocks[file, number] = block
            while self._count > _HELD_POINTS and self._blocks:
                self._count -= len(self._blocks.popitem(last=False)[1].cells)


_HELD = _Held()


@dataclass(frozen=True)
class FileInPlace(Chunk):
    """A file that is read where it is, with its points counted by cells.

    Attributes
    ----------
    folder, file, part, first, count, bounds, shape
        As of :class:`Chunk`, of all of its points that are taken.
    """

    @property
    def paths(self) -> tuple[Path, Path, Path]:
        """Files that were written: counts, numbers of rows, and which points are taken."""
        return (
            self.path.with_suffix(".cells.npy"),
            self.path.with_suffix(".rows.npy"),
            self.path.with_suffix(".json"),
        )

    @cached_property
    def _told(self) -> Mapping[str, Any]:
        told: Mapping[str, Any] = json.loads(self.paths[2].read_text(encoding="utf-8"))
        return told

    @cached_property
    def _choice(self) -> Choice:
        told = self._told["choice"]
        return Choice(**{**told, "source": Fingerprint(**told["source"])})

    @cached_property
    def _name(self) -> tuple[Path, int]:
        """Tells its blocks from those of another run in the same folder."""
        return self.path, self.paths[2].stat().st_mtime_ns

    @cached_property
    def lattice(self) -> Bounds:
        """What the cells divide; a point outside of it is in the nearest one."""
        return Bounds(**self._told["lattice"])

    @property
    def firsts(self) -> Int64Array:
        """Numbers, ascending, from each of which to the next there are not too many points."""
        found: Int64Array = np.load(self.paths[1])
        return found

    @property
    def _step(self) -> int:
        """Rows and columns of cells in a block."""
        rows, columns = self.shape
        return max(1, round(float(np.sqrt(_POINTS_OF_A_BLOCK * rows * columns / self.count))))

    def list_parts(self) -> Iterator[Bounds]:
        """Yield boxes that together hold all points, and each not too many."""
        for rectangle in self._divide(np.diff(self.offsets) > 0, 0, _POINTS_OF_A_PART):
            yield self._bound(rectangle)

    def read_boxes(self, boxes: Float64Array) -> NumberedPoints:
        """Return the points of the cells that some closed boxes, (k, 4), meet, each once."""
        return self._read_cells(self._mark(self.locate(boxes)))

    def read_near(self, center: Float64Array, radius: float) -> Iterator[NumberedPoints]:
        """Yield the points of cells within a distance of a place, the nearest cells first."""
        for cells in self._list_cells_near(center, radius, 2):
            is_met = np.zeros(len(self.offsets) - 1, np.bool_)
            is_met[cells] = True
            yield self._read_cells(is_met)

    # -------------------------------------------------------------------- blocks

    def _read_cells(self, is_met: BoolArray) -> NumberedPoints:
        """Return the points of some cells, (rows * columns,)."""
        is_met = is_met & (np.diff(self.offsets) > 0)
        wanted = np.unique(self._find_blocks(np.flatnonzero(is_met)))
        found = {number: _HELD.find(self._name, number) for number in wanted.tolist()}
        missing = [number for number, block in found.items() if block is None]
        if missing:
            is_missing = self._expand(np.array(missing))
            for rectangle in self._divide(is_missing, _WORTH_READING, self.count):
                read = self._read_rectangle(rectangle)
                found |= {number: read[number] for number in found.keys() & read.keys()}
                _HELD.keep(self._name, read)
        parts = [NumberedPoints.none()]
        for block in found.values():
            if block is None:
                raise AssertionError("a block of no rectangle")
            chosen = is_met[block.cells]
            parts.append(block.points if chosen.all() else block.points.choose(chosen))
        points, numbers = map(np.concatenate, zip(*parts, strict=True))
        return NumberedPoints(points, numbers)

    def _find_blocks(self, cells: Int64Array) -> Int64Array:
        """Return the number of the block of each cell."""
        rows, columns = np.divmod(cells, self.shape[1])
        across = -(-self.shape[1] // self._step)
        blocks: Int64Array = rows // self._step * across + columns // self._step
        return blocks

    def _expand(self, blocks: Int64Array) -> BoolArray:
        """Tell which cells are in any of some blocks."""
        step, (rows, columns) = self._step, self.shape
        up, across = -(-rows // step), -(-columns // step)
        is_met = np.zeros(up * across, np.bool_)
        is_met[blocks] = True
        wide = is_met.reshape(up, across).repeat(step, axis=0).repeat(step, axis=1)
        return wide[:rows, :columns].ravel()

    def _divide(self, is_met: BoolArray, free: int, most: int) -> Iterator[tuple[int, ...]]:
        """Yield rectangles of cells that hold all of some, each first and last row and column.

        A rectangle holds at most ``free`` points of other cells more than it holds of these, and
        at most ``most`` points, if it can be cut at the sides of blocks.
        """
        met, step = is_met.reshape(self.shape), self._step
        own = np.zeros((self.shape[0] + 1, self.shape[1] + 1), np.int64)
        counts = np.where(met, np.diff(self.offsets).reshape(self.shape), 0)
        own[1:, 1:] = counts.cumsum(axis=0).cumsum(axis=1)
        waiting = [(0, self.shape[0] - 1, 0, self.shape[1] - 1)]
        while waiting:
            south, north, west, east = waiting.pop()
            inner = met[south : north + 1, west : east + 1]
            rows, columns = (np.flatnonzero(inner.any(axis=axis)) for axis in (1, 0))
            if not len(rows):
                continue
            south, north = south + int(rows[0]), south + int(rows[-1])
            west, east = west + int(columns[0]), west + int(columns[-1])
            wanted, total = (
                int(sums[north + 1, east + 1] - sums[south, east + 1])
                - int(sums[north + 1, west] - sums[south, west])
                for sums in (own, self._sums)
            )
            is_fit = total <= 2 * wanted + free and total <= most
            rows_cut, columns_cut = (
                (low + high + 1) // 2 // step * step for low, high in ((south, north), (west, east))
            )
            can = south < rows_cut <= north, west < columns_cut <= east
            if is_fit or not any(can):
                yield south, north, west, east
            elif can[0] and (north - south >= east - west or not can[1]):
                waiting += [(rows_cut, north, west, east), (south, rows_cut - 1, west, east)]
            else:
                waiting += [
                    (south, north, columns_cut, east),
                    (south, north, west, columns_cut - 1),
                ]

    def _bound(self, rectangle: tuple[int, ...]) -> Bounds:
        """Return a closed box that holds all points of some cells, and maybe others."""
        south, north, west, east = rectangle
        box, (rows, columns), outer = self.lattice, self.shape, self.bounds
        x, y = box.width / columns, box.height / rows
        reach = _SLACK * float(np.abs([box.xmin, box.ymin, box.xmax, box.ymax]).max())
        return Bounds(
            min(box.xmin, outer.xmin) if west == 0 else box.xmin + west * x - reach,
            min(box.ymin, outer.ymin) if south == 0 else box.ymin + south * y - reach,
            max(box.xmax, outer.xmax) if east == columns - 1 else box.xmin + (east + 1) * x + reach,
            max(box.ymax, outer.ymax) if north == rows - 1 else box.ymin + (north + 1) * y + reach,
        )

    def _read_rectangle(self, rectangle: tuple[int, ...]) -> dict[int, _Block]:
        """Read the whole blocks of a rectangle of cells from the file."""
        step, (rows, columns) = self._step, self.shape
        south, west = (one // step * step for one in (rectangle[0], rectangle[2]))
        north = min((rectangle[1] // step + 1) * step, rows) - 1
        east = min((rectangle[3] // step + 1) * step, columns) - 1
        found = self._choice.read_box(self._bound((south, north, west, east)))
        cells = find_cells(found.points, self.lattice, self.shape)
        up, across = np.divmod(cells, columns)
        is_own = (up >= south) & (up <= north) & (across >= west) & (across <= east)
        if not is_own.all():
            found, cells = found.choose(is_own), cells[is_own]
        self._require_counts(cells, (south, north, west, east))
        blocks = self._find_blocks(cells)
        order = np.argsort(blocks, kind="stable")
        found, cells, blocks = found.choose(order), cells[order], blocks[order]
        starts = np.flatnonzero(np.diff(blocks, prepend=-1))
        ends = np.append(starts[1:], len(blocks))
        return {
            int(blocks[start]): _Block(found.choose(np.arange(start, end)), cells[start:end].copy())
            for start, end in zip(starts.tolist(), ends.tolist(), strict=True)
        }

    def _require_counts(self, cells: Int64Array, rectangle: tuple[int, ...]) -> None:
        """Refuse other points than were counted."""
        south, north, west, east = rectangle
        counts = np.bincount(cells, minlength=len(self.offsets) - 1).reshape(self.shape)
        known = np.diff(self.offsets).reshape(self.shape)
        part = slice(south, north + 1), slice(west, east + 1)
        if not np.array_equal(counts[part], known[part]):
            path = Path(self._choice.source.path)
            raise ReadError(
                f"'{path}' has other points in a box than in all of it: it was changed, or its "
                "index is wrong. Read it without `in_place`.",
                path=path,
            )
