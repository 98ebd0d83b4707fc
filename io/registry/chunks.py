"""What a reader gives that reads a file part by part: chunks of points, and what is told of all."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import wraps
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from ...base.errors import ReadError
from ...base.sentences import FILE
from ...base.types import RowSources
from ...tin import TIN, Survey
from ..isolated import measure_free_memory

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.crs import CRS, Unit
    from ...tin import Bounds

_BYTES_PER_POINT = 24
_MOST_POINTS = 2**31 - 1
"""The vertices of a TIN are numbered with 32 bits."""

_SPARSE = 0.5
"""Share of the points below which those taken are copied, so that memory is given back."""


_NO_ROWS = np.empty(0, np.int64)


@dataclass(frozen=True, slots=True, eq=False)
class PointChunk:
    """Some points of a file.

    Attributes
    ----------
    points : (n, 3) float64 array
        In the CRS that is wanted.
    rows : (n,) int64 array
        Where they stand in the file, ascending: lines of a text counted from 1, else records,
        features or cells counted from 0, those that are left out included.
    attributes : dict of str to (n,) array
        Those of the tiles that the points are from, where tiles have different ones.
    """

    points: Float64Array
    rows: Int64Array
    attributes: dict[str, AnyArray]

    def __len__(self) -> int:
        return len(self.points)

    def take(self, part: Any) -> PointChunk:
        """Return some of the points, by a slice, numbers or a mask."""
        attributes = {name: values[part] for name, values in self.attributes.items()}
        return PointChunk(self.points[part], self.rows[part], attributes)


class StreamHead(NamedTuple):
    """What the points of a stream are measured in; it may come again before the first chunk."""

    crs: CRS | None
    elevation_unit: Unit | None
    most_points: int | None = None
    """How many there are at most; None if that is not known."""
    has_lines: bool = False
    """Whether rows are lines of a text, which the survey keeps as those of its points."""


@dataclass(frozen=True, slots=True)
class Counts:
    """Counts of points of which notes are made: those of several files add up.

    Attributes
    ----------
    describe : str
        ``"module:function"`` of a function that takes numbers and options, and returns notes.
    numbers : mapping of str to int
    options : mapping of str to object
        Plain values.
    """

    describe: str
    numbers: Mapping[str, int]
    options: Mapping[str, Any] = field(default_factory=dict)

    def add(self, other: Counts) -> Counts:
        """Return the counts of both."""
        names = dict.fromkeys([*self.numbers, *other.numbers])
        numbers = {name: self.numbers.get(name, 0) + other.numbers.get(name, 0) for name in names}
        return replace(self, numbers=numbers)

    def list_notes(self) -> list[str]:
        """Return the notes, sentences."""
        module, _, function = self.describe.partition(":")
        found: list[str] = getattr(import_module(module), function)(self.numbers, **self.options)
        return found


@dataclass(frozen=True, slots=True)
class StreamEnd:
    """What a reader tells once it has seen all points."""

    notes: Sequence[str] = ()
    skipped: Mapping[str, int] = field(default_factory=dict)
    more: Mapping[str, Any] = field(default_factory=dict)
    """Further attributes of the survey."""
    has_voids: bool = False
    """Whether the surface ends at voids between the points, which the points do not tell."""
    lattice: tuple[int, int] | None = None
    """Cells of a row of a raster, and the step from one that is taken to the next."""
    counts: Counts | None = None
    """Counts of which some of the notes are made, one behind the other."""


class NothingLeftError(ReadError):
    """A file that holds no point that is wanted.

    Attributes
    ----------
    end : StreamEnd
        What is told of the points that it holds.
    """

    def __init__(self, message: str, *, path: Path, end: StreamEnd) -> None:
        super().__init__(message, path=path)
        self.end = end


Blocks: TypeAlias = Generator["StreamHead | PointChunk", None, StreamEnd]
"""A head, chunks of sizes that the reader chooses, and the end as what the generator returns."""


@dataclass(frozen=True, slots=True)
class SourceHeader:
    """What the headers of a file say of its points.

    Attributes
    ----------
    path : Path
    format : str
    size : int
        Bytes of the file.
    mtime_ns : int
        When it was changed last, in nanoseconds.
    count : int, optional
        Points in the file, those included that options leave out; None if it does not say.
    bounds : Bounds, optional
        Of the points, in the CRS that is wanted, as the file says; None if it does not say.
    crs : CRS, optional
        The CRS that is wanted, else that of the file.
    elevation_unit : Unit, optional
    obstacle : str
        Why :func:`tinsmith.io.streaming.read_box` does not read it with these options, or for a
        box no less than for all of it; from "it" on: "has no octree". Empty if it does.
    records : str
        Version of the format, and format of its points, where there are several: "LAS 1.4, point
        format 6".
    notes : tuple of str
    """

    path: Path
    format: str
    size: int
    mtime_ns: int
    count: int | None = None
    bounds: Bounds | None = None
    crs: CRS | None = None
    elevation_unit: Unit | None = None
    obstacle: str = "has no index of where its points lie"
    records: str = ""
    notes: tuple[str, ...] = ()

    @property
    def has_boxes(self) -> bool:
        """Whether the points of a box are read without the others."""
        return not self.obstacle


def make_source_header(path: Path, name: str, **told: Any) -> SourceHeader:
    """Return the header of a file, or of the files of a folder, of a format."""
    files = [path] if not path.is_dir() else [one for one in path.rglob("*") if one.is_file()]
    stats = [one.stat() for one in files]
    size = sum(one.st_size for one in stats)
    changed = max((one.st_mtime_ns for one in stats), default=path.stat().st_mtime_ns)
    return SourceHeader(path, name, size, changed, **told)


def yield_survey(found: Survey | TIN) -> Blocks:
    """Give the points of a survey that was read at once."""
    if isinstance(found, TIN):
        raise ReadError(f"{FILE} holds a TIN, not points alone: read_tin reads it.")
    if found.has_lines:
        raise ReadError(f"{FILE} holds lines beside its points, and points alone are streamed.")
    yield StreamHead(found.crs, found.elevation_unit, len(found))
    sources = found.row_sources
    rows = np.arange(len(found)) if sources is None else sources.lines
    if len(rows) > 1 and not (np.diff(rows) > 0).all():
        rows = np.arange(len(found))
    yield PointChunk(found.points, rows, dict(found.attributes))
    return StreamEnd(found.notes, found.skipped, has_voids=len(found.extent) > 0)


def join_chunks(chunks: Sequence[PointChunk]) -> PointChunk:
    """Return chunks as one, empty if there are none; attributes that some lack are 0 there."""
    if len(chunks) == 1:
        return chunks[0]
    if not chunks:
        return PointChunk(np.empty((0, 3)), _NO_ROWS, {})
    names = dict.fromkeys(name for chunk in chunks for name in chunk.attributes)
    return PointChunk(
        np.concatenate([chunk.points for chunk in chunks]),
        np.concatenate([chunk.rows for chunk in chunks]),
        {name: _join_columns(chunks, name) for name in names},
    )


def _join_columns(chunks: Sequence[PointChunk], name: str) -> AnyArray:
    known = next(chunk.attributes[name] for chunk in chunks if name in chunk.attributes)
    columns = [
        chunk.attributes.get(name, np.zeros(len(chunk), known.dtype))
        for chunk in chunks
        if len(chunk)
    ]
    return np.concatenate(columns) if columns else known


def find_inside(points: Float64Array, bounds: Bounds) -> BoolArray:
    """Return which points, (n, 3), lie in a box or on its edges."""
    x, y = points[:, 0], points[:, 1]
    inside: BoolArray = (x >= bounds.xmin) & (x <= bounds.xmax)
    return inside & (y >= bounds.ymin) & (y <= bounds.ymax)


def gathering(stream: Callable[..., Blocks]) -> Callable[..., Survey]:
    """Return the reader that gathers what a streaming one gives.

    Parameters
    ----------
    stream : callable
        Takes the path and the options of the reader.
    """

    @wraps(stream)
    def read(path: Path, **options: Any) -> Survey:
        return gather(stream(path, **options), path)

    read.__name__ = "read"
    return read


def gather(blocks: Blocks, path: Path) -> Survey:
    """Return all that a reader gives as one survey."""
    gathered = _Gathered()
    head = StreamHead(None, None)
    while True:
        try:
            item = next(blocks)
        except StopIteration as stop:
            end: StreamEnd = stop.value
            break
        if isinstance(item, StreamHead):
            head = item
            gathered.reserve(head)
        else:
            gathered.append(item)
    points = gathered.points
    return Survey(
        points=points,
        attributes=gathered.finish_attributes(),
        row_sources=RowSources.of_file(path.name, gathered.rows) if head.has_lines else None,
        crs=head.crs,
        elevation_unit=head.elevation_unit,
        source=path.name,
        skipped=end.skipped,
        notes=end.notes,
        **end.more,
    )


class _Gathered:
    """Chunks one behind the other, in memory that is reserved once where their number is known."""

    def __init__(self) -> None:
        self._points = np.empty((0, 3))
        self._columns: dict[str, AnyArray] = {}
        self._has_lines = False
        self.rows = _NO_ROWS
        """Of chunks whose number was not known before."""
        self._chunks: list[PointChunk] | None = None
        self._count = 0

    def reserve(self, head: StreamHead) -> None:
        """Reserve room for all points, if there is memory for so many."""
        count, self._has_lines = head.most_points, head.has_lines
        if count is None:
            self._chunks = []
            return
        memory = measure_free_memory()
        if count > _MOST_POINTS or count * _BYTES_PER_POINT > memory:
            most = min(_MOST_POINTS, memory // _BYTES_PER_POINT)
            raise ReadError(
                f"{FILE} is said to have {count:,} points, and {most:,} are the most that can be "
                "read here: read a part of it (window), or tile after tile.",
            )
        self._points = np.empty((count, 3))  # the system gives memory to what is filled

    def append(self, chunk: PointChunk) -> None:
        """Add a chunk."""
        if self._chunks is not None:
            self._chunks.append(chunk if self._has_lines else replace(chunk, rows=_NO_ROWS))
            return
        end = self._count + len(chunk)
        self._points[self._count : end] = chunk.points
        for name, values in chunk.attributes.items():
            self._fill_column(name, values)
        self._count = end

    def _fill_column(self, name: str, values: AnyArray) -> None:
        start, column = self._count, self._columns.get(name)
        if column is None or column.dtype != np.result_type(column, values):
            dtype = values.dtype if column is None else np.result_type(column, values)
            wider = np.zeros(len(self._points), dtype)
            if column is not None:
                wider[:start] = column[:start]
            column = self._columns[name] = wider
        column[start : start + len(values)] = values

    @property
    def points(self) -> Float64Array:
        """Coordinates of all points."""
        if self._chunks is not None:
            joined = join_chunks(self._chunks)
            self._points, self._columns, self._count = joined.points, joined.attributes, len(joined)
            self.rows, self._chunks = joined.rows, None
        return self._shrink(self._points)

    def _shrink(self, values: AnyArray) -> AnyArray:
        part = values[: self._count]
        return part.copy() if self._count < _SPARSE * len(values) else part

    def finish_attributes(self) -> dict[str, AnyArray]:
        """Return the attributes of all points."""
        return {name: self._shrink(column) for name, column in self._columns.items()}
