"""Numbered inputs: what an edited TIN is the build of, and how an edit changes it.

Rows have numbers that never change: those given come first, those inserted follow, and a removed
one leaves a gap. Lines are called by their place in the set.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import LinesError, PointsError
from ...base.types import Frozen
from .. import _kernel
from ..building import assemble
from ..constraints import ABOVE_ALL, Breakline, LineSet, gather_lines
from ..topology import find_offsets
from .accounts import renumber_rows

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..building import BuildInputs, Version

FLIP = "flip"
"""Name of the soft breakline that keeps a flipped edge."""

_NO_ROWS = np.empty(0, np.int64)
_NO_XYZ = np.empty((0, 3))


class Change(NamedTuple):
    """What an edit does to the inputs."""

    removed: Int64Array = _NO_ROWS
    """(r,), rows, by their lasting numbers."""
    moved: Int64Array = _NO_ROWS
    points: Float64Array = _NO_XYZ
    """(k,) rows, and (k, 3) where they are now."""
    added: Float64Array = _NO_XYZ
    """(a, 3), new rows."""
    lines: tuple[Callable[[LineSet], LineSet], ...] = ()
    """From the set of lines to a changed one, one after the other."""


class Done(NamedTuple):
    """What an edit did to the inputs, and where that led; None if the mesh tells."""

    change: Change
    version: Version | None = None
    result: Any = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class NumberedInputs(Frozen):
    """The inputs of an edited TIN, whose rows keep their numbers."""

    build_inputs: BuildInputs
    """Of the rows and lines that are there."""
    rows: Int64Array | None
    """(n,), the lasting number of each of its rows, ascending; None while none was removed."""
    n_rows: int
    """Rows that are or were there."""

    @classmethod
    def of(cls, build_inputs: BuildInputs) -> NumberedInputs:
        """Return the inputs of a TIN before its first edit."""
        return cls(build_inputs=build_inputs, rows=None, n_rows=len(build_inputs.points))

    def find(self, numbers: Int64Array) -> Int64Array:
        """Return the rows that have these lasting numbers."""
        if self.rows is None:
            return numbers
        return np.searchsorted(self.rows, numbers)

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
        own = slice(self.n_rows) if self.rows is None else self.rows
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
                lines = line_change(lines)
        rows = None
        if not is_there.all():
            rows = np.flatnonzero(is_there)
            points, is_masked = points[rows], is_masked[rows]
        masked = is_masked if is_masked.any() else None
        build_inputs = replace(self.build_inputs, points=points, is_masked=masked)
        if lines is not self.build_inputs.lines:
            build_inputs = build_inputs.with_lines(lines)
        return NumberedInputs(build_inputs=build_inputs, rows=rows, n_rows=n_rows)

    def build(self) -> Version:
        """Build the TIN of the inputs, whose rows have their lasting numbers."""
        built = assemble(self.build_inputs)
        if self.rows is None:
            return built
        vertex_of = np.full(self.n_rows, -1, np.int32)
        vertex_of[self.rows] = built.vertex_of
        report = renumber_rows(built.report, self.rows, self.n_rows)
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


def add_lines(lines: LineSet, *, added: Sequence[Breakline]) -> LineSet:
    """Return the lines with breaklines behind the others."""
    is_breakline = np.arange(len(lines.kinds)) < count_breaklines(lines)
    breaklines = [lines.choose(is_breakline), gather_lines(added, (), (), ())]
    return _number_lines(breaklines, lines.choose(~is_breakline))


def drop_lines(lines: LineSet, *, numbers: Sequence[int]) -> LineSet:
    """Return the lines without some breaklines."""
    stays = ~np.isin(np.arange(len(lines.kinds)), numbers)
    is_breakline = np.arange(len(lines.kinds)) < count_breaklines(lines)
    return _number_lines([lines.choose(is_breakline & stays)], lines.choose(~is_breakline))


def _number_lines(breaklines: Sequence[LineSet], others: LineSet) -> LineSet:
    """Return all lines, the breaklines numbered from 0."""
    together = LineSet.join([*breaklines, others])
    sources = together.sources.copy()
    count = len(together.kinds) - len(others.kinds)
    sources[:count] = np.arange(count, dtype=np.int32)
    return together._replace(table=together.table._replace(sources=sources))


def put_vertices(lines: LineSet, *, rows: Int64Array, point: Float64Array) -> LineSet:
    """Return the lines with vertices, by their rows in the set, at another place."""
    xy, elevations = lines.xy.copy(), lines.elevations.copy()
    xy[rows] = point[:2]
    elevations[rows[has_own_elevations(lines)[rows]]] = point[2]
    return lines._replace(xy=xy, elevations=elevations)


def set_elevations(lines: LineSet, *, rows: Int64Array, elevations: Float64Array) -> LineSet:
    """Return the lines with vertices, by their rows in the set, at other elevations."""
    changed = lines.elevations.copy()
    changed[rows] = elevations
    return lines._replace(elevations=changed)


def drop_vertices(lines: LineSet, *, rows: Int64Array) -> LineSet:
    """Return the lines straight on past vertices, by their rows; a closed one stays closed."""
    keep = np.ones(len(lines.xy), np.bool_)
    keep[rows] = False
    source = np.arange(len(lines.xy))
    for line in np.unique(lines.line_of[rows]).tolist():
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
    counts, rows = np.add.reduceat(keep, lines.offsets[:-1]), source[keep]
    return lines._replace(
        xy=lines.xy[rows], elevations=lines.elevations[rows], offsets=find_offsets(counts)
    )


def require_inner(beside: Sequence[int]) -> None:
    """Refuse to flip an edge that has not two triangles, given what is beside it."""
    if len(beside) != 2:
        raise PointsError("Only an edge between two triangles can be flipped.")


def make_flipped_edge(points: Float64Array) -> Breakline:
    """Return the edge that comes in the place of another one; refuse what is not convex.

    ``points`` are the ends of the edge, and the corners of the triangles left and right of it.
    """
    quad = np.ascontiguousarray(points[[0, 2, 1, 3], :2])
    following = (np.ascontiguousarray(np.roll(quad, -k, axis=0)) for k in (1, 2))
    turns = _kernel.orientation(quad, *following)
    if not ((turns > 0).all() or (turns < 0).all()):
        raise PointsError("The two triangles at the edge are no convex quadrilateral.")
    return Breakline(points[2:], kind="soft", name=FLIP)
