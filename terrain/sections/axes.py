"""Axes: centrelines that sections are square to, polylines or an alignment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_number
from ...base.errors import LinesError, OptionError
from ...base.georeference import require_same_crs
from ..surface import Segments, as_features, as_segments
from .alignments import Alignment

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...base.crs import CRS
    from ...base.results import Features

_FINEST = 1e-6
"""Share of a line's length to which stations must be told apart."""

CHORD = 1e-3
"""CRS units: how far the curves of an alignment may lie from the chords along which it is cut."""


class Places(NamedTuple):
    """Where cross sections meet their centrelines."""

    lines: Int64Array
    """(s,), the centreline of each."""
    stations: Float64Array
    """(s,)."""
    middles: Float64Array
    """(s, 2)."""
    tangents: Float64Array
    """(s, 2), unit vectors along the centrelines, at a vertex the mean of both."""


class Axis(NamedTuple):
    """Centrelines: segments of polylines, or chords of an alignment, by their stations."""

    segments: Segments
    alignment: Alignment | None
    crs: CRS | None
    """Of the surfaces."""
    notes: tuple[str, ...]

    @property
    def rounding(self) -> float:
        """How far stations may be off because coordinates are rounded."""
        own = 0.0 if self.alignment is None else self.alignment.rounding
        return max(own, self.segments.rounding)

    @property
    def ends(self) -> Float64Array:
        """(k, 2), the first and the last station of each line."""
        firsts, lasts = self._find_lines()
        return np.stack(
            [self.segments.start_stations[firsts], self.segments.end_stations[lasts]], axis=1
        )

    def _find_lines(self) -> tuple[Int64Array, Int64Array]:
        firsts = np.flatnonzero(np.append(True, np.diff(self.segments.lines) != 0))
        return firsts, np.append(firsts[1:], len(self.segments.lines)) - 1

    def measure(
        self, lines: Int64Array, stations: Float64Array
    ) -> tuple[Float64Array, Float64Array]:
        """Return places and directions, both (s, 2), at stations of lines."""
        if self.alignment is not None:
            return self.alignment.points_at(stations), self.alignment.tangents_at(
                stations, mean=True
            )
        segments = self.segments
        firsts, lasts = self._find_lines()
        segment = np.empty(len(lines), np.int64)
        for line in np.unique(lines).tolist():
            own = lines == line
            begins = segments.start_stations[firsts[line] : lasts[line] + 1]
            segment[own] = firsts[line] + np.searchsorted(begins, stations[own], side="right") - 1
        begin, end = segments.start_stations[segment], segments.end_stations[segment]
        share = ((stations - begin) / (end - begin))[:, None]
        start, stop = segments.starts[segment], segments.ends[segment]
        middle = np.where(share == 1.0, stop, start + share * (stop - start))
        return middle, _find_directions(segments, segment, stations)

    def write_stations(self, stations: Float64Array) -> dict[str, AnyArray]:
        """Return the column of what is written at stations, if that is something else."""
        if self.alignment is None or not self.alignment.equations:
            return {}
        return {"written_station": self.alignment.written_stations(stations)}

    def find_breaks(self, line: int) -> Float64Array:
        """Return the stations of a line where its direction changes, or a chord ends."""
        own = self.segments.lines == line
        return np.append(self.segments.start_stations[own], self.segments.end_stations[own][-1])


def as_axis(given: Any, crs: CRS | None, start: Any, what: str, product: str = "") -> Axis:
    """Return polylines or an alignment as an axis of a product of a surface.

    ``what`` is what one of them is called in sentences, ``product`` what runs along it.

    Raises LinesError, OptionError and CrsError as :func:`tinsmith.profile`.
    """
    if isinstance(given, Alignment):
        if start != 0.0:
            raise OptionError("start", start, allowed="0: an alignment has stations of its own")
        notes = require_same_crs(given.crs, crs, f"the {what}")
        return Axis(cut_alignment(given), given, crs, (*given.notes, *notes))
    features = as_features(given, what)
    them = f"the {what}s" if product else f"the {what}"
    notes = require_same_crs(features.crs, crs, them, is_plain=not hasattr(given, "crs"))
    segments = lines_to_segments(features, start, product or what)
    return Axis(segments, None, crs, (*features.notes, *notes))


def lines_to_segments(features: Features, start: Any, what: str) -> Segments:
    """Return the segments of features that are lines, their stations counted from ``start``.

    Raises LinesError if they are no lines, or one has no length. Raises OptionError if ``start`` is
    no number, or too large.
    """
    if features.kind != "lines":
        raise LinesError(f"A {what} runs along lines, and there are {features.kind}.")
    xy = np.ascontiguousarray(features.coordinates[:, :2]) + 0.0
    segments = as_segments(xy, features.offsets[0])
    begin = as_start(start, segments)
    return segments if begin == 0.0 else as_segments(xy, features.offsets[0], start=begin)


def as_start(value: Any, segments: Segments) -> float:
    """Return the station where lines begin, small enough for their stations to differ."""
    start = as_number("start", value, unit="in CRS units")
    lengths = segments.end_stations - segments.start_stations
    shortest = float(np.bincount(segments.lines, lengths).min())
    if not np.spacing(abs(start)) <= _FINEST * shortest:
        allowed = f"of a size at which stations along {shortest:.6g} can be told apart"
        raise OptionError("start", start, allowed=allowed)
    return start


def cut_alignment(alignment: Alignment) -> Segments:
    """Return the chords of an alignment, with its own stations."""
    stations = alignment.cut_into_chords(CHORD)
    places = alignment.points_at(stations)
    has_length = (places[1:] != places[:-1]).any(axis=1)
    return Segments(
        places[:-1][has_length],
        places[1:][has_length],
        stations[:-1][has_length],
        stations[1:][has_length],
        np.zeros(int(has_length.sum()), np.int64),
    )


def _find_directions(
    segments: Segments, segment: Int64Array, stations: Float64Array
) -> Float64Array:
    """Return unit vectors along the centreline, at its vertices the mean of both segments'."""
    along = segments.directions
    found = along[segment]
    is_kink = (stations == segments.start_stations[segment]) & (segment > 0)
    is_kink &= segments.is_continued[segment - 1]
    before = along[segment[is_kink] - 1]
    mean = before + found[is_kink]
    length = np.hypot(mean[:, 0], mean[:, 1])[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        found[is_kink] = np.where(length > 0.0, mean / length, before)
    return found
