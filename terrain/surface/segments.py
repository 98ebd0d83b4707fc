"""Segments: straight pieces of lines, with the station where each begins and ends."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import LinesError
from ...tin.topology import find_owners
from .roundings import find_rounding

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array


class Segments(NamedTuple):
    """Straight pieces, line after line; those of one line follow each other."""

    starts: Float64Array
    ends: Float64Array
    """Both (m, 2)."""
    start_stations: Float64Array
    end_stations: Float64Array
    """Both (m,)."""
    lines: Int64Array
    """(m,), the line that each belongs to, in ascending order."""

    @property
    def directions(self) -> Float64Array:
        """Unit vectors along them, (m, 2)."""
        steps = self.ends - self.starts
        return steps / np.hypot(steps[:, 0], steps[:, 1])[:, None]

    @property
    def is_continued(self) -> BoolArray:
        """Whether the next segment goes on where each ends."""
        is_continued = np.zeros(len(self.lines), np.bool_)
        is_continued[:-1] = np.diff(self.lines) == 0
        return is_continued

    @property
    def rounding(self) -> float:
        """How far stations may be off because coordinates are rounded."""
        return 2.0 * find_rounding(np.concatenate([self.starts, self.ends]))

    def stations(self, segment: Int64Array, ratio: Float64Array) -> Float64Array:
        """Return the stations of shares of the way along segments, between those of their ends."""
        first, last = self.start_stations[segment], self.end_stations[segment]
        between = first + ratio * (last - first)
        station = np.clip(between, np.minimum(first, last), np.maximum(first, last))
        return np.where(ratio == 1.0, last, station)


def as_segments(
    xy: Float64Array, offsets: Int64Array, *, start: float = 0.0, what: str = "line"
) -> Segments:
    """Return the segments of polylines, each line's stations counted from its first vertex.

    Line k is ``xy[offsets[k]:offsets[k + 1]]``, its first vertex has the station ``start``, and a
    line is called ``what`` in sentences. A vertex that repeats the one before it is passed over.
    Stations are the sums of the lengths of the segments, added one after the other, each rounded.
    Raises LinesError if a line has no length, or one that is too long for a number.
    """
    lines = find_owners(offsets)
    is_step = (lines[1:] == lines[:-1]) & (xy[1:] != xy[:-1]).any(axis=1)
    at = np.flatnonzero(is_step)
    if len(np.unique(lines[at])) < len(offsets) - 1:
        empty = int(np.setdiff1d(np.arange(len(offsets) - 1), lines[at])[0])
        place = tuple(xy[offsets[empty]].tolist())
        raise LinesError(
            f"A {what} has no length (number {empty}, at {place}): two vertices apart are needed.",
            lines=[empty],
        )
    steps = xy[at + 1] - xy[at]
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    is_first = np.append(True, np.diff(lines[at]) != 0)
    by_line = np.split(lengths, np.flatnonzero(is_first)[1:])
    ends = np.concatenate([np.cumsum(np.append(start, part))[1:] for part in by_line])
    begins = np.where(is_first, start, np.roll(ends, 1))
    return Segments(xy[at], xy[at + 1], begins, ends, lines[at])
