"""Numbered inputs: what an edited TIN is the build of, and how an edit changes it.

Rows have numbers that never change: those given come first, those inserted follow, and a removed
one leaves a gap. Lines are called by their place in the set.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from ...base.errors import LinesError
from ...base.types import Frozen
from .. import _kernel
from ..building.assembly import assemble
from ..constraints.breaklines import Breakline
from ..constraints.constraint_set import ABOVE_ALL, LineSet, gather_lines
from ..topology import find_offsets

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..building.inputs import BuildInputs
    from ..building.version import Version

__all__ = [
    "NO_ROWS",
    "NO_XYZ",
    "AddLine",
    "Change",
    "DropLines",
    "DropVertices",
    "LineChange",
    "NumberedInputs",
    "PutVertices",
    "SetElevations",
    "count_breaklines",
    "has_own_elevations",
]

NO_ROWS = np.empty(0, np.int64)
NO_XYZ = np.empty((0, 3))


class LineChange(Protocol):
    """A change of a set of lines."""

    def apply(self, lines: LineSet) -> LineSet:
        """Return the changed lines."""
        ...


class Change(NamedTuple):
    """What an edit does to the inputs.

    Attributes
    ----------
    removed : (r,) int64 array
        Rows, by their lasting numbers.
    moved, points : (k,) int64 array, (k, 3) float64 array
        Rows, and where they are now.
    added : (a, 3) float64 array
        New rows.
    lines : sequence of LineChange
        One after the other.
    """

    removed: Int64Array = NO_ROWS
    moved: Int64Array = NO_ROWS
    points: Float64Array = NO_XYZ
    added: Float64Array = NO_XYZ
    lines: tuple[LineChange, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class NumberedInputs(Frozen):
    """The inputs of an edited TIN, whose rows keep their numbers.

    Attributes
    ----------
    build_inputs : BuildInputs
        Of the rows and lines that are there.
    rows : (n,) int64 array
        The lasting number of each of its rows, ascending.
    n_rows : int
        Rows that are or were there.
    """

    build_inputs: BuildInputs
    rows: Int64Array
    n_rows: int

    @classmethod
    def of(cls, build_inputs: BuildInputs) -> NumberedInputs:
        """Return the inputs of a TIN before its first edit."""
        count = len(build_inputs.points)
        return cls(build_inputs=build_inputs, rows=np.arange(count), n_rows=count)

    def after(self, changes: Sequence[Change]) -> NumberedInputs:
        """Return the inputs after some changes.

        Raises
        ------
        LinesError
            If a line vanishes, or a ring crosses itself.
        """
        if not changes:
            return self
        n_rows = self.n_rows + sum(len(change.added) for change in changes)
        points, is_there = np.empty((n_rows, 3)), np.zeros(n_rows, np.bool_)
        own = self.rows if len(self.rows) < self.n_rows else slice(self.n_rows)
        points[own], is_there[own] = self.build_inputs.points, True
        is_masked = np.zeros(n_rows, np.bool_)
        if self.build_inputs.is_masked is not None:
            is_masked[own] = self.build_inputs.is_masked
        end, lines = self.n_rows, self.build_inputs.lines
        for change in changes:
            points[end : end + len(change.added)] = change.added
            is_there[end : end + len(change.added)] = True
            end += len(change.added)
            points[change.moved] = change.points
            is_there[change.removed] = False
            for line_change in change.lines:
                lines = line_change.apply(lines)
        if not is_there.all():
            points, is_masked = points[is_there], is_masked[is_there]
        masked = is_masked if is_masked.any() else None
        build_inputs = replace(self.build_inputs, points=points, is_masked=masked)
        if lines is not self.build_inputs.lines:
            build_inputs = build_inputs.with_lines(lines)
        return NumberedInputs(
            build_inputs=build_inputs, rows=np.flatnonzero(is_there), n_rows=n_rows
        )

    def build(self) -> Version:
        """Build the TIN of the inputs, whose rows have their lasting numbers.

        Raises
        ------
        PointsError, LinesError
            As :func:`tinsmith.triangulate`.
        """
        built = assemble(self.build_inputs)
        vertex_of = np.full(self.n_rows, -1, np.int32)
        vertex_of[self.rows] = built.vertex_of
        report = built.report.with_rows(self.rows, self.n_rows)
        return replace(built, vertex_of=vertex_of, report=report)

    def find_line_vertices(self, version: Version) -> Int32Array:
        """Return the vertex of each given vertex of the lines, -1 for none, in their build."""
        given = self.build_inputs.lines.xy
        if not len(given) or self.build_inputs.options.snap == 0.0:
            found = version.triangulation.vertices_at(given) if len(given) else np.empty(0)
            return found.astype(np.int32, copy=False)
        snapped = version.snapped or self.build().snapped
        if snapped is None or not len(snapped.xy):
            return np.full(len(given), -1, np.int32)
        xy, first = np.unique(snapped.xy, axis=0, return_index=True)
        found = _kernel.vertices_at(np.ascontiguousarray(xy), np.ascontiguousarray(given))
        return np.where(found < 0, np.int32(-1), snapped.vertices[first[found]])


# ------------------------------------------------------------------------- lines


def count_breaklines(lines: LineSet) -> int:
    """Count the breaklines; they come first."""
    is_other = [kind not in ("hard", "soft") for kind in lines.kinds]
    return is_other.index(True) if any(is_other) else len(is_other)


def has_own_elevations(lines: LineSet) -> BoolArray:
    """Tell which vertices of lines have elevations to change: not draped ones, nor water's."""
    is_level = (lines.priorities == ABOVE_ALL)[lines.line_of]
    has_own: BoolArray = ~np.isnan(lines.elevations) & ~is_level
    return has_own


class AddLine(NamedTuple):
    """A breakline behind the others."""

    breakline: Breakline

    def apply(self, lines: LineSet) -> LineSet:
        """Return the changed lines."""
        is_breakline = np.arange(len(lines.kinds)) < count_breaklines(lines)
        return _number_lines(
            [lines.choose(is_breakline), gather_lines([self.breakline], (), (), ())],
            lines.choose(~is_breakline),
        )


class DropLines(NamedTuple):
    """Breaklines that go."""

    numbers: tuple[int, ...]

    def apply(self, lines: LineSet) -> LineSet:
        """Return the changed lines."""
        stays = ~np.isin(np.arange(len(lines.kinds)), self.numbers)
        is_breakline = np.arange(len(lines.kinds)) < count_breaklines(lines)
        return _number_lines([lines.choose(is_breakline & stays)], lines.choose(~is_breakline))


class PutVertices(NamedTuple):
    """Vertices of lines, by their rows in the set, at another place."""

    rows: Int64Array
    point: Float64Array

    def apply(self, lines: LineSet) -> LineSet:
        """Return the changed lines."""
        xy, elevations = lines.xy.copy(), lines.elevations.copy()
        xy[self.rows] = self.point[:2]
        elevations[self.rows[has_own_elevations(lines)[self.rows]]] = self.point[2]
        return lines._replace(xy=xy, elevations=elevations)


class SetElevations(NamedTuple):
    """Vertices of lines, by their rows in the set, at other elevations."""

    rows: Int64Array
    elevations: Float64Array

    def apply(self, lines: LineSet) -> LineSet:
        """Return the changed lines."""
        elevations = lines.elevations.copy()
        elevations[self.rows] = self.elevations
        return lines._replace(elevations=elevations)


class DropVertices(NamedTuple):
    """Vertices of lines, by their rows in the set, that go; the lines run straight on."""

    rows: Int64Array

    def apply(self, lines: LineSet) -> LineSet:
        """Return the changed lines; a closed one stays closed."""
        keep = np.ones(len(lines.xy), np.bool_)
        keep[self.rows] = False
        source = np.arange(len(lines.xy))
        for line in np.unique(lines.line_of[self.rows]).tolist():
            first, last = int(lines.offsets[line]), int(lines.offsets[line + 1]) - 1
            is_closed = bool((lines.xy[first] == lines.xy[last]).all())
            left = np.flatnonzero(keep[first:last]) + first
            if len(left) + (not is_closed and bool(keep[last])) < (3 if is_closed else 2):
                raise LinesError(
                    f"{lines.title(line)} would vanish with the vertex: "
                    "remove_breakline removes a line."
                )
            if is_closed and not keep[last]:
                keep[last], source[last] = True, left[0]
        counts = np.add.reduceat(keep, lines.offsets[:-1])
        rows = source[keep]
        return lines._replace(
            xy=lines.xy[rows],
            elevations=lines.elevations[rows],
            offsets=find_offsets(counts),
        )


def _number_lines(breaklines: Iterable[LineSet], others: LineSet) -> LineSet:
    """Return all lines, the breaklines numbered from 0."""
    together = LineSet.join([*breaklines, others])
    sources = together.sources.copy()
    count = len(together.kinds) - len(others.kinds)
    sources[:count] = np.arange(count, dtype=np.int32)
    return together._replace(table=together.table._replace(sources=sources))
