"""Points of a lidar file written again with other classes, in memory that does not grow."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.atomic import replacing
from ...base.errors import ReadError, WriteError
from ...base.progress import Progress
from ..registry import PointChunk
from .header import parse_header
from .writing import Scaling, choose_columns, make_header, require_crs, write_points

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from ...base.arrays import BoolArray, Float64Array, UInt8Array
    from ...base.crs import CRS


_GLOBAL_ENCODING = 6
"""Where the header has it; its first bit tells what times count from."""


@dataclass
class LabelledFile:
    """What was written of a file.

    Attributes
    ----------
    count : int
        Points; a file without any is not written.
    low, high : (3,) list of float
        Their bounds.
    classes : dict of int to int
        How many points there are of each class.
    """

    count: int = 0
    low: list[float] = field(default_factory=lambda: [np.inf] * 3)
    high: list[float] = field(default_factory=lambda: [-np.inf] * 3)
    classes: dict[int, int] = field(default_factory=dict)

    def add(self, points: Float64Array, classes: UInt8Array) -> None:
        """Account for further points."""
        self.count += len(points)
        self.low = np.minimum(self.low, points.min(axis=0)).tolist()
        self.high = np.maximum(self.high, points.max(axis=0)).tolist()
        counts = np.bincount(classes, minlength=256)
        for number in np.flatnonzero(counts).tolist():
            self.classes[number] = self.classes.get(number, 0) + int(counts[number])


def write_labelled(
    chunks: Iterable[PointChunk],
    source: Path,
    path: Path,
    label: Callable[[PointChunk], tuple[UInt8Array, BoolArray | None]],
    crs: CRS | None,
) -> LabelledFile:
    """Write the points of a lidar file with other classes, in their order.

    Parameters
    ----------
    chunks : iterable of PointChunk
        The points of the source, with all attributes.
    source : Path
        Its scales and offsets are used.
    path : Path
        ``.laz`` is compressed.
    label : callable
        Returns the classes of the points of a chunk, and which of them are written, None for all.
    crs : CRS or None
        Of the points.

    Raises
    ------
    ReadError
        If the source is damaged.
    WriteError
        If its points were converted, so that its whole numbers are not theirs, or as
        :func:`tinsmith.io.lidar.writing.write`.

    Notes
    -----
    The output is LAS 1.4 with all attributes of the source, and the CRS as WKT; the date is
    1970-01-01, so that the same points give the same bytes.
    """
    laspy = optional.load("laspy", f"Writing '{path.name}'")
    header = parse_header(source)
    scaling = Scaling(header.scales, header.offsets, np.zeros(3))
    made = LabelledFile()
    with ExitStack() as stack:
        output = _Output(laspy, path, stack, _find_gps_time(source))
        for chunk in chunks:
            classes, kept = label(chunk)
            attributes = {**chunk.attributes, "classification": classes}
            found = PointChunk(chunk.points, chunk.rows, attributes)
            if kept is not None:
                found = found.take(kept)
            if not len(found):
                continue
            _require_whole(found.points, scaling, source)
            output.write(found, scaling, crs)
            made.add(found.points, found.attributes["classification"])
    if made.count:
        require_crs(crs, path)
    return made


class _Output:
    """A file that is begun with the first points, and appears when all are written."""

    def __init__(self, laspy: Any, path: Path, stack: ExitStack, gps_time: int) -> None:
        self._laspy = laspy
        self._gps_time = gps_time
        self._path = path
        self._stack = stack
        self._writer: Any = None
        self._names: tuple[str, ...] = ()

    def write(self, chunk: PointChunk, scaling: Scaling, crs: CRS | None) -> None:
        """Write further points."""
        columns = choose_columns(chunk.attributes)
        if self._writer is None:
            file = self._stack.enter_context(replacing(self._path))
            header = make_header(self._laspy, scaling, columns, crs)
            header.global_encoding.gps_time_type = self._laspy.header.GpsTimeType(self._gps_time)
            is_compressed = self._path.suffix.lower() == ".laz"
            self._writer = self._stack.enter_context(
                self._laspy.LasWriter(file, header, do_compress=is_compressed, closefd=False)
            )
            self._names = tuple(columns)
        if tuple(columns) != self._names:
            raise ReadError(f"'{self._path.name}' would have points with different attributes.")
        write_points(self._laspy, self._writer, chunk.points, columns, Progress(None))


def _find_gps_time(source: Path) -> int:
    """Return what times count from: 0 the start of a week, 1 that of GPS less 10^9 seconds."""
    with source.open("rb") as file:
        file.seek(_GLOBAL_ENCODING)
        return file.read(1)[0] & 1


def _require_whole(points: Float64Array, scaling: Scaling, source: Path) -> None:
    """Refuse points that are not the whole numbers of their file: they were converted."""
    whole = np.rint((points - scaling.offsets) / scaling.scales)
    if not np.array_equal(whole * scaling.scales + scaling.offsets, points):
        raise WriteError(
            f"The points of '{source.name}' were converted to another CRS or unit, and its tiles "
            "keep the coordinates of their file: write it in that CRS first."
        )
