"""Read points part by part: chunks of a file of any size, what its header says, those of a box."""

from __future__ import annotations

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from contextvars import Context, copy_context
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..base.checks import require_count
from ..base.errors import OptionError, ReadError
from ..base.notes import naming_file
from ..base.sentences import FILE
from ..tin import Bounds
from .isolated import open_ordinary_file, unpack
from .reading import (
    ask,
    blaming,
    is_folder,
    list_tiles,
    prepare_call,
    read,
    require_paths,
    require_unit,
)
from .registry import (
    PointChunk,
    SourceHeader,
    StreamEnd,
    StreamHead,
    join_chunks,
    make_source_header,
    yield_survey,
)
from .reprojection import checking_crs

if TYPE_CHECKING:
    import os
    from collections.abc import Generator, Iterator, Mapping, Sequence
    from types import TracebackType
    from typing import Self

    from ..base.crs import CRS, CrsLike, Unit, UnitLike
    from .reading import Asked, Call
    from .registry import Blocks

_LARGEST_WHOLE = 1 << 28
"""Bytes of a file that is read whole before its points are given, as its format has no parts."""


def stream_points(
    path: str | os.PathLike[str],
    *,
    chunk_points: int = 1_000_000,
    format: str | None = None,  # noqa: A002 - as in read
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    check_crs: bool = True,
    **options: Any,
) -> PointStream:
    """Read the points of a file chunk by chunk, in memory that does not grow with the file.

    Parameters
    ----------
    path : path-like
        A file, or a folder of lidar tiles.
    chunk_points : int
        Points of each chunk; the last has the rest.
    format, crs, elevation_unit, check_crs, **options
        As of :func:`tinsmith.read`.

    Returns
    -------
    PointStream
        Its chunks one behind the other are the points of :func:`tinsmith.read`, bit for bit.

    Raises
    ------
    ReadError
        If the file is larger than 256 MB and of a format that is read only whole, or holds
        triangles or lines; else as :func:`tinsmith.read`.
    OptionError
        If ``chunk_points`` is no whole number above 0.
    FormatError, CrsError, MissingExtraError
        As :func:`tinsmith.read`. What shows only further on in the file is refused when its chunk
        is reached, what contradicts all points together at their end.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
    >>> with TemporaryDirectory() as folder:
    ...     path = ts.write(survey, Path(folder, "points.csv"))
    ...     with stream_points(path, chunk_points=2) as stream:
    ...         [len(chunk) for chunk in stream]
    [2, 1]
    """
    require_count("chunk_points", chunk_points)
    (file,) = require_paths([path])
    asked = ask(format=format, crs=crs, elevation_unit=elevation_unit, **options)
    return PointStream(_stream_path(file, asked, check_crs), int(chunk_points))


class PointStream:
    """The points of a file as chunks, an iterator that is used once; see :func:`stream_points`.

    Parameters
    ----------
    blocks : generator
        What :mod:`tinsmith.io.registry.chunks` tells of.
    chunk_points : int

    Notes
    -----
    A thread reads on while the caller works on a chunk. As a context manager it ends the child
    process that reads, and removes what was unpacked, at the end of the block; else when all chunks
    have been taken, or by :meth:`close`.
    """

    def __init__(self, blocks: Blocks, chunk_points: int) -> None:
        self._blocks = _ReadAhead(blocks)
        self._chunk_points = chunk_points
        self._waiting: deque[PointChunk] = deque()
        self._n_waiting = 0
        self._head = StreamHead(None, None)
        self._end: StreamEnd | None = None
        self._take_block()

    @property
    def crs(self) -> CRS | None:
        """CRS of the points."""
        return self._head.crs

    @property
    def elevation_unit(self) -> Unit | None:
        """Unit of their elevations; None if it is not known."""
        return self._head.elevation_unit

    @property
    def notes(self) -> list[str]:
        """What the reader assumed, in sentences; known at the end."""
        return list(self._require_end().notes)

    @property
    def skipped(self) -> dict[str, int]:
        """What the reader left out and how often; known at the end."""
        return dict(self._require_end().skipped)

    @property
    def end(self) -> StreamEnd:
        """All that the reader tells; known at the end."""
        return self._require_end()

    @property
    def has_voids(self) -> bool:
        """Whether the surface ends at voids of a raster, ``extent`` of a survey; known at the end.

        Points do not tell it: a surface of them alone spans the voids.
        """
        return self._require_end().has_voids

    @property
    def lattice(self) -> tuple[int, int] | None:
        """Cells of a row of a raster, and the step from one that is taken to the next.

        The rows of points are numbers of cells. None of other files; known at the end.
        """
        return self._require_end().lattice

    def _require_end(self) -> StreamEnd:
        if self._end is None or self._n_waiting:
            raise ReadError("Notes of a stream are known once all of its chunks have been taken.")
        return self._end

    def __iter__(self) -> PointStream:
        return self

    def __next__(self) -> PointChunk:
        while self._n_waiting < self._chunk_points and self._end is None:
            self._take_block()
        if not self._n_waiting:
            raise StopIteration
        return self._take_points(min(self._chunk_points, self._n_waiting))

    def _take_block(self) -> None:
        """Take what comes next, until it is points or the end."""
        for item in self._blocks:
            if isinstance(item, StreamHead):
                self._head = item
            elif isinstance(item, StreamEnd):
                self._end = item
            elif len(item):
                self._waiting.append(item)
                self._n_waiting += len(item)
            else:
                continue
            if not isinstance(item, StreamHead):
                return

    def _take_points(self, count: int) -> PointChunk:
        parts = []
        self._n_waiting -= count
        while count:
            first = self._waiting.popleft()
            if len(first) > count:
                self._waiting.appendleft(first.take(slice(count, None)))
                first = first.take(slice(count))
            parts.append(first)
            count -= len(first)
        return join_chunks(parts)

    def close(self) -> None:
        """End reading, before all chunks have been taken too."""
        self._blocks.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


class _ReadAhead:
    """Items of a generator and what it returns, one of them made ahead by a thread.

    The generator runs in a context of its own: the file that its errors name, and whether CRSs are
    checked, are not those of the caller between two chunks.
    """

    def __init__(self, blocks: Blocks) -> None:
        self._items = _with_end(blocks)
        self._context: Context = copy_context()
        self._thread = ThreadPoolExecutor(1)
        self._coming = self._begin()

    def _begin(self) -> Future[Any]:
        return self._thread.submit(lambda: self._context.run(next, self._items, None))

    def __iter__(self) -> Iterator[StreamHead | PointChunk | StreamEnd]:
        return self

    def __next__(self) -> StreamHead | PointChunk | StreamEnd:
        try:
            item = self._coming.result()
        except BaseException:
            self.close()
            raise
        if item is None:
            raise StopIteration
        if isinstance(item, StreamEnd):
            self.close()
        else:
            self._coming = self._begin()
        return cast("StreamHead | PointChunk | StreamEnd", item)

    def close(self) -> None:
        """End the generator, once what is on the way has come."""
        self._thread.submit(lambda: self._context.run(self._items.close)).result()
        self._thread.shutdown()
        self.close = _do_nothing  # type: ignore[method-assign]


def _do_nothing() -> None:
    """Nothing is open any more."""


def _with_end(blocks: Blocks) -> Generator[StreamHead | PointChunk | StreamEnd, None, None]:
    end = yield from blocks
    yield end


# --------------------------------------------------------------------------- the blocks


def _stream_path(file: Path, asked: Asked, check_crs: bool) -> Blocks:
    with checking_crs(check_crs):
        if is_folder(file) and list_tiles(file, asked.format):
            return (yield from _slice_whole(file, file, asked, "a folder"))
        with naming_file(file), open_ordinary_file(file) as local, unpack(local) as inner:
            call = prepare_call(inner, asked)
            if call.format.stream is None:
                blocks = _slice_whole(inner, file, asked, call.format.name)
            else:
                blocks = _stream_file(call, inner, asked.options)
            end = yield from blocks
    if inner == file:
        return end
    notes = [note.replace(inner.name, file.name) for note in end.notes]
    return replace(end, notes=notes)


def _stream_file(call: Call, file: Path, options: Mapping[str, Any]) -> Blocks:
    """Let the format's own generator read a file."""
    with blaming(call.format, file):
        blocks = call.format.load("stream")(file, **call.options)
        while True:
            try:
                item = next(blocks)
            except StopIteration as stop:
                return cast("StreamEnd", stop.value)
            if isinstance(item, StreamHead):
                require_unit(item.crs, call.stated, options)
            yield item


def _slice_whole(file: Path, named: Path, asked: Asked, kind: str) -> Blocks:
    """Read a file that is not large whole, and give its points at once."""
    size = _measure_size(file)
    if size > _LARGEST_WHOLE:
        raise ReadError(
            f"'{named}' has {size / 1e6:,.0f} MB, and {kind} is read only whole, up to "
            f"{_LARGEST_WHOLE / 1e6:,.0f} MB: write the points as LAZ, GeoParquet or CSV.",
            path=named,
        )
    how = {**asked.declared, **asked.options}
    return (yield from yield_survey(read(file, format=asked.format, **how)))


def _measure_size(file: Path) -> int:
    if not file.is_dir():
        return file.stat().st_size
    return sum(one.stat().st_size for one in file.rglob("*") if one.is_file())


# ------------------------------------------------------------------ headers and boxes


def describe_source(
    path: str | os.PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 - as in read
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    check_crs: bool = True,
    **options: Any,
) -> SourceHeader:
    """Tell what the headers of a file say of its points, without reading them.

    Parameters
    ----------
    path : path-like
    format, crs, elevation_unit, check_crs, **options
        As of :func:`tinsmith.read`.

    Returns
    -------
    SourceHeader
        Of a file whose format has no such headers, only its format, size and time.

    Raises
    ------
    ReadError, FormatError, CrsError, OptionError, MissingExtraError
        As :func:`tinsmith.read`, as far as headers tell.
    """
    (file,) = require_paths([path])
    asked = ask(format=format, crs=crs, elevation_unit=elevation_unit, **options)
    with _opened(file, asked, check_crs) as (inner, call):
        if call.format.describe is None or inner != file:
            return make_source_header(file, call.format.name)
        found: SourceHeader = call.format.load("describe")(inner, **call.options)
        require_unit(found.crs, call.stated, asked.options)
        return found


def read_box(
    path: str | os.PathLike[str],
    bounds: Bounds | Sequence[float],
    *,
    format: str | None = None,  # noqa: A002 - as in read
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    check_crs: bool = True,
    **options: Any,
) -> PointChunk:
    """Read the points of a box where they are in the file, without reading the others.

    Parameters
    ----------
    path : path-like
        A file of which :func:`describe_source` says that it ``has_boxes``.
    bounds : Bounds or (4,) sequence of float
        West, south, east, north in the CRS of the points; the edges belong to it.
    format, crs, elevation_unit, check_crs, **options
        As of :func:`tinsmith.read`.

    Returns
    -------
    PointChunk
        The points of :func:`tinsmith.read` that lie in the box, bit for bit, with their rows.
        Nothing is left out otherwise, and no point in the box is no error.

    Raises
    ------
    ReadError
        If the file has no order in space, or its points are elsewhere than that order says.
    OptionError
        If ``bounds`` are none, or an option counts points over the whole file.
    """
    (file,) = require_paths([path])
    try:
        box = bounds if isinstance(bounds, Bounds) else Bounds(*map(float, bounds))
    except (TypeError, ValueError):
        box = Bounds(np.nan, np.nan, np.nan, np.nan)
    if not (box.xmin <= box.xmax and box.ymin <= box.ymax):
        raise OptionError("bounds", bounds, "Bounds, or four numbers: west, south, east, north")
    asked = ask(format=format, crs=crs, elevation_unit=elevation_unit, **options)
    with _opened(file, asked, check_crs) as (inner, call):
        if call.format.read_box is None or inner != file:
            raise ReadError(f"{FILE} has no order in space: its points cannot be read by box.")
        found: PointChunk = call.format.load("read_box")(inner, box, **call.options)
        return found


@contextmanager
def _opened(file: Path, asked: Asked, check_crs: bool) -> Iterator[tuple[Path, Call]]:
    with ExitStack() as stack:
        stack.enter_context(checking_crs(check_crs))
        stack.enter_context(naming_file(file))
        inner = stack.enter_context(unpack(stack.enter_context(open_ordinary_file(file))))
        call = prepare_call(inner, asked)
        stack.enter_context(blaming(call.format, inner))
        yield inner, call
