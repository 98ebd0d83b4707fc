"""Rows: the breaks of all surfaces along the same segments; runs: parts of lines without a gap."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.topology import NO_NEIGHBOR, find_offsets
from ..surface import CROSSED
from .rims import trace_to_rim

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array, StrArray
    from ..surface import Breaks, Segments
    from .surfaces import Surfaces

_FIRST, _LAST = -1, np.iinfo(np.int64).max
"""Turns of the ends of segments, which are the same row for all, whatever else is there."""


class Places(NamedTuple):
    """Places on segments."""

    segments: Int64Array
    """(n,)."""
    stations: Float64Array
    """(n,)."""
    xy: Float64Array
    """(n, 2)."""


class Rows(NamedTuple):
    """Rows along lines; a kink, where two segments of a line meet, is one row."""

    places: Places
    is_last: BoolArray
    """(n,), whether the row is the last of its line."""
    elevations: Float64Array
    """(n, k), of each surface; NaN where it is not."""
    crossed: StrArray
    """(n, k), what each surface has there: a word of ``CROSSED``, "gap", or "" if nothing."""
    triangles: Int32Array
    """(n, k), of each surface, from here to the next row; -1 where there is none."""

    @property
    def is_gap(self) -> BoolArray:
        """Whether a surface is missing from each row to the next one, (n, k)."""
        is_gap: BoolArray = (self.triangles == NO_NEIGHBOR) & ~self.is_last[:, None]
        return is_gap

    @property
    def steps(self) -> Float64Array:
        """Difference of station to the next row, 0 at the last one of a line."""
        stations = self.places.stations
        return np.where(self.is_last, 0.0, np.roll(stations, -1) - stations)


def cut_rows(
    surfaces: Surfaces,
    segments: Segments,
    extra: Places | None = None,
    *,
    is_computed: bool = False,
) -> Rows:
    """Follow segments over surfaces, with rows at further places within segments.

    There is a row wherever any surface has a break. Between two rows in a row of a line that both
    have an elevation of a surface, the surface is the straight line between them: a gap from one
    break to the next gets a row in its middle. Ends of segments that are ``is_computed`` have been
    rounded.
    """
    traced = [
        trace_to_rim(tin, segments, is_computed=is_computed).scale_elevations(factor)
        for tin, factor in zip(surfaces.tins, surfaces.factors, strict=True)
    ]
    sources = [
        Places(breaks.segments, segments.stations(breaks.segments, breaks.ratios), breaks.xy)
        for breaks in traced
    ]
    if extra is not None:
        sources.append(extra)
    turns = [_number_turns(breaks, places) for breaks, places in zip(traced, sources, strict=False)]
    turns += [np.zeros(len(extra.xy), np.int64)] if extra is not None else []
    places, own = _merge(sources, turns, segments)
    is_end = np.append(np.diff(places.segments) != 0, True)
    is_continued = segments.is_continued[places.segments]
    keep, is_last = ~(is_end & is_continued), is_end & ~is_continued  # a kink is one row
    before = np.stack([np.maximum.accumulate(one) for one in own[: len(traced)]], axis=1)
    rows = Rows(
        places,
        is_last,
        np.stack([_interpolate_places(b, own[k], places.xy) for k, b in enumerate(traced)], axis=1),
        np.stack([_name_crossed(b, own[k]) for k, b in enumerate(traced)], axis=1),
        np.stack([b.triangles[before[:, k]] for k, b in enumerate(traced)], axis=1),
    )
    return _mark_gaps(_choose(rows, keep), traced, before[keep])


def _choose(rows: Rows, chosen: BoolArray) -> Rows:
    if chosen.all():
        return rows
    places = Places._make(array[chosen] for array in rows.places)
    return Rows._make([places, *(array[chosen] for array in rows[1:])])


def _number_turns(breaks: Breaks, places: Places) -> Int64Array:
    """Count breaks of a segment that fall together when rounded, so that none is lost."""
    is_new = np.ones(len(places.xy), np.bool_)
    is_new[1:] = (np.diff(places.xy, axis=0) != 0).any(axis=1) | (np.diff(places.segments) != 0)
    number = np.arange(len(is_new))
    turns = number - np.maximum.accumulate(np.where(is_new, number, 0))
    segment_ends = np.append(np.diff(breaks.segments) != 0, True)
    turns[np.roll(segment_ends, 1)] = _FIRST
    turns[segment_ends] = _LAST
    return turns


def _merge(
    sources: Sequence[Places], turns: Sequence[Int64Array], segments: Segments
) -> tuple[Places, list[Int64Array]]:
    """Sort places along their segments, those of several sources together.

    Returns them, and for each source the number that each place has in it; -1 if it is none of its
    own. Rounding keeps the order of a station, of an easting and of a northing along a segment, but
    may make them equal: they are compared one after the other, and only what is equal in all is
    one.
    """
    if len(sources) == 1:
        return sources[0], [np.arange(len(sources[0].xy))]
    segment, station, xy = (np.concatenate(arrays) for arrays in zip(*sources, strict=True))
    turn = np.concatenate(turns)
    forward = np.sign(segments.ends - segments.starts)[segment] * xy
    order = np.lexsort((turn, forward[:, 1], forward[:, 0], station, segment))
    segment, station, xy, turn = segment[order], station[order], xy[order], turn[order]
    is_new = np.ones(len(order), np.bool_)
    is_new[1:] = (np.diff(xy, axis=0) != 0).any(axis=1)
    is_new[1:] |= (np.diff(segment) != 0) | (turn[1:] != turn[:-1])
    group = np.empty(len(order), np.int64)
    group[order] = np.cumsum(is_new) - 1
    places = Places(segment[is_new], station[is_new], xy[is_new])
    own, begin = [], 0
    for source in sources:
        numbers = np.full(len(places.xy), -1)
        numbers[group[begin : begin + len(source.xy)]] = np.arange(len(source.xy))
        own.append(numbers)
        begin += len(source.xy)
    return places, own


def _interpolate_places(breaks: Breaks, own: Int64Array, xy: Float64Array) -> Float64Array:
    found = breaks.elevations[own]
    foreign = np.flatnonzero(own < 0)
    if len(foreign):
        before = np.maximum.accumulate(own)[foreign]
        found[foreign] = breaks.interpolate_after(before, xy[foreign])
    return found


def _name_crossed(breaks: Breaks, own: Int64Array) -> StrArray:
    words = np.array([*CROSSED, ""])
    return words[np.where(own >= 0, breaks.crossed[own], -1)]


def _mark_gaps(rows: Rows, traced: Sequence[Breaks], before: Int64Array) -> Rows:
    """Add a row in the middle of every gap that has elevations at both ends and no row between."""
    has = ~np.isnan(rows.elevations)
    both = has & np.roll(has, -1, axis=0) & rows.is_gap
    xy = rows.places.xy
    at = np.flatnonzero(both.any(axis=1) & (np.roll(xy, -1, axis=0) != xy).any(axis=1))
    if len(at) == 0:
        return rows
    middle = Places(
        rows.places.segments[at],
        0.5 * rows.places.stations[at] + 0.5 * rows.places.stations[at + 1],
        0.5 * xy[at] + 0.5 * xy[at + 1],
    )
    elevations = [b.interpolate_after(before[at, k], middle.xy) for k, b in enumerate(traced)]
    crossed = np.where(rows.is_gap[at], "gap", "")
    return Rows(
        Places(
            *(np.insert(a, at + 1, b, axis=0) for a, b in zip(rows.places, middle, strict=True))
        ),
        np.insert(rows.is_last, at + 1, False),
        np.insert(rows.elevations, at + 1, np.stack(elevations, axis=1), axis=0),
        np.insert(rows.crossed, at + 1, crossed, axis=0),
        np.insert(rows.triangles, at + 1, rows.triangles[at], axis=0),
    )


class Runs(NamedTuple):
    """Lines without gaps."""

    coordinates: Float64Array
    """(n, 3)."""
    offsets: Int64Array
    """(r + 1,), run i is ``coordinates[offsets[i]:offsets[i + 1]]``."""
    first_rows: Int64Array
    """(r,), the row where each begins."""


def find_runs(rows: Rows, k: int = 0) -> Runs:
    """Return the runs of surface ``k``; where a line only touches it there is none."""
    goes_on = ~rows.is_gap[:, k] & ~rows.is_last
    comes_on = np.append(False, goes_on[:-1])
    chosen = np.flatnonzero(goes_on | comes_on)
    is_first = ~comes_on[chosen]
    firsts = np.flatnonzero(is_first)
    xyz = np.column_stack([rows.places.xy[chosen], rows.elevations[chosen, k]])
    return Runs(xyz, find_offsets(np.diff(np.append(firsts, len(chosen)))), chosen[firsts])
