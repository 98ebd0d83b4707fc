"""Follow the chains of a TIN along the lines that were given, and note what must be proved."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot
from operator import itemgetter
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from ..constraints import Lines, LineSet

UNSEEN_CUTS = 16
"""Cuts that are allowed for in a part of a line that is left out."""

Point = list[float]
Between = tuple[int, int, int]
"""Position of a vertex that is none of its line, and the rows of the line's before and after."""
Passing = Literal["first", "nearest", "last", "beyond"]
"""Which of successive vertices within ``snap`` became one of the line's: one of the next chain's
(``"beyond"``) where they end a chain."""
_PASSINGS: tuple[Passing, ...] = get_args(Passing)


class Walk(NamedTuple):
    """What was met on the way."""

    between: Int64Array
    """(k, 3), vertices that are none of their line, in order: number, and the rows of the line's
    vertices before and after."""
    gap_rows: list[int]
    """Rows of the line's vertices behind which a part is left out."""
    gap_points: list[Point]
    gap_lines: list[int]
    """Vertices left out and middles between them, and their lines."""
    end_vertices: list[int]
    end_lines: list[int]
    """Where chains begin or end, but not their line."""
    lost: list[int]
    """Lines with a chain that is not found on them."""


def walk_along(xy: Float64Array, lines: Lines, given: LineSet, *, snap: float, unit: float) -> Walk:
    """Follow the chains of every given line.

    ``xy`` are the vertices of the TIN, (n, 2). A vertex of a line may have been moved by ``snap``,
    a line by ``unit`` with each cut.
    """
    walker = _Walker(lines.vertices.tolist(), xy[lines.vertices].tolist(), given, snap, unit)
    chains: dict[tuple[str, int], list[range]] = {}
    spans = [range(*span) for span in pairwise(lines.offsets.tolist())]
    for key, span in zip(zip(lines.kinds, lines.sources.tolist(), strict=True), spans, strict=True):
        chains.setdefault(key, []).append(span)
    for line, key in enumerate(zip(given.kinds, given.sources.tolist(), strict=True)):
        walker.follow(line, chains.get(key, []))
    return walker.walk


class _Course(NamedTuple):
    """How a chain may run along its line."""

    begin: int
    end: int
    """Numbers of the line's vertices passed first, or just before, and last."""
    between: list[Between]
    deviation: float
    """How far it leaves the line, or goes back."""
    is_close: bool
    is_kept: bool
    """Whether it is as near to the line as the cuts seen allow, or with unseen ones, too."""


class _Walker:
    """Keeps to the earliest way along a line that its chains can have taken.

    ``at`` counts the line's vertices, without repetitions: a chain has passed number ``at`` and
    not yet the next one. Chains are ranges of positions among the vertices of all chains.
    """

    def __init__(
        self,
        vertices: list[int],
        points: list[Point],
        given: LineSet,
        snap: float,
        unit: float,
    ) -> None:
        self._vertices = vertices
        self._points = points
        self._xy = given.xy
        self._given: list[Point] = given.xy.tolist()
        self._offsets: list[int] = given.offsets.tolist()
        self._snap = snap
        self._unit = unit
        self._between: list[Between] = []
        self._gaps = Walk(np.empty((0, 3), np.int64), [], [], [], [], [], [])

    @property
    def walk(self) -> Walk:
        """All that was met."""
        between = np.array(self._between, np.int64).reshape(-1, 3)
        between[:, 0] = np.array(self._vertices, np.int64)[between[:, 0]]
        return self._gaps._replace(between=between)

    def follow(self, line: int, chains: list[range]) -> None:
        """Follow the chains of one line."""
        rows = self._find_rows(line)
        if not chains and self._is_point(rows):
            return
        courses = self._find_courses(rows, chains)
        if courses is None:
            self._gaps.lost.append(line)
            return
        at, here = 0, None
        for chain, course in zip(chains, courses, strict=True):
            if here is not None or not self._is_at(self._points[chain[0]], rows[0]):
                self._pass_gap(line, rows[at : course.begin + 1], here, chain[0])
            self._between += course.between
            at, here = course.end, chain[-1]
        if here is None or at < len(rows) - 1:
            self._pass_gap(line, rows[at:], here, None)

    def _find_courses(self, rows: list[int], chains: list[range]) -> list[_Course] | None:
        """Find courses for all chains, as near to the line as cuts allow; None if there are none.

        What a chain begins behind, and which vertex within ``snap`` became one of the line's, may
        have several answers, and the next chains tell which are wrong. One way along the line
        proves that the chains follow it, whichever was taken.
        """
        courses: list[_Course] = []
        tried: set[tuple[int, int]] = set()
        waiting = [self._try_courses(rows, 0, None, chains[0])] if chains else []
        while waiting:
            n = len(waiting)
            course = next(waiting[-1], None)
            del courses[n - 1 :]
            if course is None:
                waiting.pop()
            elif (n, course.end) not in tried:
                tried.add((n, course.end))
                courses.append(course)
                if n == len(chains):
                    return courses
                waiting.append(self._try_courses(rows, course.end, chains[n - 1][-1], chains[n]))
        return None if chains else []

    def _find_rows(self, line: int) -> list[int]:
        """Return the rows of a line, without repeated places."""
        rows = range(self._offsets[line], self._offsets[line + 1])
        given = self._given
        return [row for row in rows if row == rows[0] or given[row] != given[row - 1]]

    def _is_point(self, rows: list[int]) -> bool:
        """Tell if snapping may have made one place of a line."""
        first = self._given[rows[0]]
        return all(_measure_distance(first, self._given[row]) <= 2 * self._snap for row in rows)

    def _is_at(self, point: Point, row: int) -> bool:
        given = self._given[row]
        return point == given or (self._snap > 0 and _measure_distance(point, given) <= self._snap)

    def _try_courses(
        self, rows: list[int], at: int, here: int | None, chain: range
    ) -> Iterator[_Course]:
        """Yield courses of a chain behind ``at``, the likeliest first."""
        begins = self._find_entries(rows, at, here, chain)
        likely = next(begins, None)
        if likely is None:
            return
        course = self._walk_to_end(rows, likely, chain, is_first=here is None)
        if course.is_close:
            yield course
        ways = [(course.deviation, course.begin, course)]
        for begin in begins:
            for passing in _PASSINGS if self._snap > 0 else _PASSINGS[:1]:
                course = self._walk_to_end(
                    rows, begin, chain, is_first=here is None, passing=passing
                )
                ways.append((course.deviation, course.begin, course))
        ways = [way for way in ways if way[2].is_kept]
        yield from (course for *_, course in sorted(ways, key=itemgetter(0, 1)))

    def _find_entries(
        self, rows: list[int], at: int, here: int | None, chain: range
    ) -> Iterator[int]:
        """Yield behind which vertices a chain may begin, the likeliest first, then all."""
        if here is None and self._begins_with(rows, chain):
            yield 0
        # how far from each segment a chain's first step is; inf if it goes back there
        first, second = (np.array([self._points[position]]) for position in chain[:2])
        a, b = self._xy[rows[at:-1]], self._xy[rows[at + 1 :]]
        off = np.maximum(distance(first, a, b), distance(second, a, b))
        begin, end = _project(first, a, b), _project(second, a, b)
        off[end < begin - self._unit] = np.inf
        if here is not None and len(begin):  # not behind the end of the chain before; both may move
            passed = _project(np.array(self._points[here]), a[:1], b[:1]) - 2 * self._unit
            off[:1][begin[:1] < passed] = np.inf
        best = off.min(initial=np.inf)
        allowed = (1 + UNSEEN_CUTS + len(chain)) * self._unit
        if best > allowed:
            return
        fits = at + np.flatnonzero(off <= max(best, 2 * self._unit))
        worst = np.zeros(len(fits))
        if len(fits) > 1:
            worst = np.array(
                [self._walk_to_end(rows, n, chain, is_first=False).deviation for n in fits.tolist()]
            )
        yield int(fits[np.argmax(worst <= worst.min() + self._unit)])
        yield from (at + np.flatnonzero(off <= allowed)).tolist()

    def _measure(self, between: list[Between]) -> tuple[Float64Array, Float64Array, Int64Array]:
        """Return how far vertices are off their line, and back of the one before; its rows."""
        positions, before, after = np.array(between, np.int64).reshape(-1, 3).T
        points = np.array([self._points[position] for position in positions]).reshape(-1, 2)
        a, b = self._xy[before], self._xy[after]
        back = np.zeros(len(before))
        back[1:] = np.where(np.diff(before) == 0, -np.diff(_project(points, a, b)), 0.0)
        return distance(points, a, b), back, before

    def _begins_with(self, rows: list[int], chain: range) -> bool:
        """Tell if a chain begins where its line does, and in the same direction."""
        if not self._is_at(self._points[chain[0]], rows[0]):
            return False
        (ax, ay), (bx, by) = self._given[rows[0]], self._given[rows[1]]
        x, y = self._points[chain[1]]
        across = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        is_ahead = (bx - ax) * (x - ax) + (by - ay) * (y - ay) > 0
        # m vertices between two of the line's are within m + 1 units (see check_given); the chain
        # has m <= len(chain) - 1 behind this one. It is only asked where the chain begins: that it
        # keeps to the line is judged by the vertices that there are between each two.
        allowed = len(chain) * self._unit
        return is_ahead and abs(across) <= allowed * hypot(bx - ax, by - ay)

    def _walk_to_end(
        self,
        rows: list[int],
        begin: int,
        chain: range,
        *,
        is_first: bool,
        passing: Passing = "first",
    ) -> _Course:
        """Walk a chain to its end, and tell how well it keeps to the line."""
        end, between = self._align(rows, begin, chain, passing=passing)
        off, back, before = self._measure(between)
        row = before - rows[begin]
        cuts = np.bincount(row, minlength=rows[end] - rows[begin] + 1)
        unseen = np.zeros_like(cuts)
        if not (is_first and self._is_at(self._points[chain[0]], rows[0])):
            unseen[0] = UNSEEN_CUTS
        if end < len(rows) - 1:
            unseen[-1] = UNSEEN_CUTS
        allowed = self._unit * (1 + np.stack([cuts, cuts + unseen])[:, row])
        is_within = (off <= allowed) & (back <= 2 * allowed)
        deviation = float(max(off.max(initial=0.0), back.max(initial=0.0)))
        is_close, is_kept = (bool(rows_within.all()) for rows_within in is_within)
        return _Course(begin, end, between, deviation, is_close, is_kept)

    def _align(
        self, rows: list[int], at: int, chain: range, *, passing: Passing
    ) -> tuple[int, list[Between]]:
        """Return what a chain passes last of its line's own vertices, and what lies between."""
        points, last = self._points, len(rows) - 1
        is_passed = self._is_at(points[chain[0]], rows[at])
        between = []
        for position in chain:
            while at < last and self._is_at(points[position], rows[at + 1]):
                if self._is_later(position, chain[-1], rows[at + 1], passing):
                    break
                at, is_passed = at + 1, True
            if not is_passed:
                before = min(at, last - 1)
                between.append((position, rows[before], rows[before + 1]))
            is_passed = False
        return at, between

    def _is_later(self, position: int, end: int, row: int, passing: Passing) -> bool:
        """Tell if one of the line's vertices is to be passed behind this one of the chain."""
        if position == end:
            return passing == "beyond"
        given, after = self._given[row], self._points[position + 1]
        if passing == "nearest":
            return _measure_distance(after, given) < _measure_distance(
                self._points[position], given
            )
        return passing in ("last", "beyond") and self._is_at(after, row)

    def _pass_gap(self, line: int, rows: Sequence[int], here: int | None, then: int | None) -> None:
        """Note the part of a line from one chain to the next, or from or to its ends."""
        ends = [self._points[position] for position in (here, then) if position is not None]
        left_out = list(rows[here is not None :])
        while left_out and here is not None and self._is_at(ends[0], left_out[0]):
            del left_out[0]
        while left_out and then is not None and self._is_at(ends[-1], left_out[-1]):
            del left_out[-1]
        nodes = [*ends[: here is not None], *(self._given[row] for row in left_out)]
        nodes += ends[len(ends) - (then is not None) :]
        if len(nodes) < 2 or (not left_out and nodes[0] == nodes[1]):
            return
        gaps = self._gaps
        gaps.gap_rows.extend(rows)
        points = [
            *(self._given[row] for row in left_out),
            *([p[0] / 2 + q[0] / 2, p[1] / 2 + q[1] / 2] for p, q in pairwise(nodes)),
        ]
        gaps.gap_points.extend(points)
        gaps.gap_lines.extend([line] * len(points))
        for position in (here, then):
            if position is not None:
                gaps.end_vertices.append(self._vertices[position])
                gaps.end_lines.append(line)


# -------------------------------------------------------------------- measures


def _measure_distance(p: Point, q: Point) -> float:
    return hypot(p[0] - q[0], p[1] - q[1])


def _project(p: Float64Array, a: Float64Array, b: Float64Array) -> Float64Array:
    """Return how far along the segments a-b the feet of p are."""
    foot: Float64Array = ((p - a) * (b - a)).sum(axis=1) / np.hypot(*(b - a).T)
    return foot


def distance(p: Float64Array, a: Float64Array, b: Float64Array) -> Float64Array:
    """Measure from places to segments a-b, (k, 2) arrays."""
    u, v = b - a, p - a
    square = (u * u).sum(axis=1)
    share = np.clip((u * v).sum(axis=1) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    across = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / np.sqrt(np.where(square, square, 1.0))
    to_end = np.hypot(*(v - share[:, None] * u).T)
    measured: Float64Array = np.where((share > 0) & (share < 1), across, to_end)
    return measured
