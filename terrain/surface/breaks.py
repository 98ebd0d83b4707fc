"""Segments: straight pieces of lines; breaks: where they cross the edges of one TIN."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import LinesError
from ...tin.topology import NO_NEIGHBOR, find_owners
from .roundings import find_rounding

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, Int64Array
    from ...tin import TIN
    from ...tin.triangulation import Triangulation

CROSSED = ("line", "vertex", "edge", "breakline", "boundary")
"""What a break can be: a vertex of the line inside a triangle or outside, and what it meets."""

_LINE, _VERTEX, _EDGE, _BREAKLINE, _BOUNDARY = range(len(CROSSED))


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


class Breaks(NamedTuple):
    """Breaks along segments, those of each from its start to its end."""

    segments: Int64Array
    """(n,), the segment of each."""
    ratios: Float64Array
    """(n,), share of the segment before it, 0 at the start and 1 at the end."""
    xy: Float64Array
    """(n, 2)."""
    elevations: Float64Array
    """(n,), NaN where there is no surface."""
    crossed: Int8Array
    """(n,), index into ``CROSSED``."""
    triangles: Int32Array
    """(n,), through which, or along an edge of which, the segment goes on; -1 where there is no
    surface.
    """
    vertices: Int32Array
    edges: Int32Array
    """Both (n,), what lies there: a vertex of the TIN, or an edge as three times its triangle plus
    the corner opposite; -1 for none.
    """

    def scale_elevations(self, factor: float) -> Breaks:
        """Return the breaks with elevations times a factor."""
        return self if factor == 1.0 else self._replace(elevations=self.elevations * factor)

    def interpolate_after(self, breaks: Int64Array, xy: Float64Array) -> Float64Array:
        """Interpolate elevations at places, (k, 2), between breaks, (k,), and those that follow.

        None of the breaks is the last of its segment. NaN where there is no surface. Counted from
        the nearer break, of two the same distance away from the western one, so that it is the same
        for the line in reverse.
        """
        before, after = self.xy[breaks], self.xy[breaks + 1]
        low, high = self.elevations[breaks], self.elevations[breaks + 1]
        along = np.abs(after - before)
        axis = np.where(along[:, 0] >= along[:, 1], 0, 1)[:, None]
        p, q, x = (np.take_along_axis(at, axis, 1)[:, 0] for at in (before, after, xy))
        to_p, to_q = np.abs(x - p), np.abs(q - x)
        is_from_p = (to_p < to_q) | ((to_p == to_q) & (p <= q))
        near, far = np.where(is_from_p, p, q), np.where(is_from_p, q, p)
        z, other = np.where(is_from_p, low, high), np.where(is_from_p, high, low)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            share = np.where(near == far, 0.5, (x - near) / (far - near))
            found = z + 2.0 * (share * (0.5 * other - 0.5 * z))
        found = np.clip(found, np.minimum(low, high), np.maximum(low, high))
        return np.where(self.triangles[breaks] == NO_NEIGHBOR, np.nan, found)


def trace_breaks(tin: TIN, segments: Segments) -> Breaks:
    """Follow segments over a TIN.

    Breaks are at each segment's ends, where it crosses an edge, passes a vertex, or enters or
    leaves the surface; decided by exact predicates. Places and elevations of crossings are the true
    ones rounded once, so they are the same for the reversed segment. Raises LinesError if a segment
    meets triangles that lie over each other.
    """
    surface = tin.triangulation
    traced = surface.locator.trace(
        np.ascontiguousarray(segments.starts), np.ascontiguousarray(segments.ends)
    )
    failed = traced.failed
    if failed >= 0:
        start, end = segments.starts[failed].tolist(), segments.ends[failed].tolist()
        raise LinesError(
            f"Triangles of the surface lie over each other between {tuple(start)} and "
            f"{tuple(end)}: one elevation is needed at each place; a check of the TIN tells more.",
            lines=[int(segments.lines[failed])],
        )
    edges = traced.edges
    crossed = np.full(len(edges), _LINE, np.int8)
    crossed[traced.vertices >= 0] = _VERTEX
    is_edge = edges >= 0
    crossed[is_edge] = _EDGE
    crossed[is_edge & surface.constrained.ravel()[edges]] = _BREAKLINE
    crossed[is_edge & (surface.neighbors.ravel()[edges] == NO_NEIGHBOR)] = _BOUNDARY
    found = Breaks(
        find_owners(traced.offsets),
        traced.ratios,
        traced.places,
        traced.elevations,
        crossed,
        traced.triangles,
        traced.vertices,
        edges,
    )
    return found._replace(triangles=_choose_triangles(surface, found))


def _choose_triangles(surface: Triangulation, breaks: Breaks) -> Int32Array:
    """Return the triangles of breaks; along an edge the one whose third corner comes first.

    So it does not matter how triangles are numbered, nor which way the segment runs.
    """
    chosen = breaks.triangles.copy()
    goes_on = np.append(breaks.segments[1:] == breaks.segments[:-1], False)
    rows = np.flatnonzero(goes_on & (chosen != NO_NEIGHBOR))
    triangles = chosen[rows]
    for k in range(3):
        ends = [surface.triangles[triangles, (k + j) % 3] for j in (1, 2)]
        is_along = _are_on_edge(surface, breaks, rows, ends)
        is_along &= _are_on_edge(surface, breaks, rows + 1, ends)
        at = np.flatnonzero(is_along & (surface.neighbors[triangles, k] != NO_NEIGHBOR))
        beyond = surface.neighbors[triangles[at], k]
        far = surface.triangles[beyond].sum(axis=1) - ends[0][at] - ends[1][at]
        own, other = (surface.points[v].T for v in (surface.triangles[triangles[at], k], far))
        is_first = (other[0] < own[0]) | ((other[0] == own[0]) & (other[1] < own[1]))
        chosen[rows[at[is_first]]] = beyond[is_first]
    return chosen


def _are_on_edge(
    surface: Triangulation, breaks: Breaks, rows: Int64Array, ends: Sequence[Int32Array]
) -> BoolArray:
    """Tell which breaks are at an end of an edge each, or on it."""
    vertices, edges = breaks.vertices[rows], breaks.edges[rows]
    start, end = ends
    corners = surface.triangles[edges // 3]
    own = [np.take_along_axis(corners, (edges[:, None] + j) % 3, axis=1)[:, 0] for j in (1, 2)]
    is_same = (np.minimum(*own) == np.minimum(start, end)) & (
        np.maximum(*own) == np.maximum(start, end)
    )
    is_end = (vertices >= 0) & ((vertices == start) | (vertices == end))
    return np.asarray(is_end | ((edges >= 0) & is_same))
