"""Edits that reach lines: a change of the inputs, of which the TIN is built anew."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import LinesError
from ...base.sentences import coordinate, height
from .accounts import describe_crossings
from .changes import (
    FLIP,
    Change,
    Done,
    add_lines,
    count_breaklines,
    drop_lines,
    drop_vertices,
    has_own_elevations,
    make_flipped_edge,
    put_vertices,
    require_inner,
    set_elevations,
)
from .mesh_editor import explain_occupied, merge_elevations

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...base.policies import CrossingPolicy, DuplicatePolicy
    from ..building import Version
    from ..constraints import Breakline
    from .changes import NumberedInputs


class Rebuild:
    """Builds the TIN of changed inputs beside the one that is there, for one edit.

    ``now()`` is what is there, the build of ``inputs``.
    """

    def __init__(self, now: Callable[[], Version], inputs: NumberedInputs) -> None:
        self._now, self._inputs = now, inputs

    @property
    def count(self) -> int:
        """Number of vertices."""
        return len(self._now().triangulation.points)

    def insert(
        self, xyz: Float64Array, policy: DuplicatePolicy, lines: Sequence[Breakline] = ()
    ) -> Done:
        """Add rows of points, and breaklines."""
        surface = self._now().triangulation
        there = surface.vertices_at(xyz[:, :2])
        own = np.where(there < 0, np.nan, surface.points[there, 2])
        z = _merge_new_elevations(xyz, own, policy)
        change, _ = self._change_elevations(there[there >= 0], z[there >= 0])
        change = change._replace(added=np.column_stack([xyz[:, :2], z]))
        if lines:
            change = change._replace(lines=(*change.lines, partial(add_lines, added=lines)))
        inputs = self._inputs.after([change])
        found, all_lines = inputs.build(), inputs.build_inputs.lines
        count = count_breaklines(all_lines)
        crossings = [
            sentence
            for number in range(count - len(lines), count)
            for sentence in describe_crossings(found.report, all_lines.label(number))
        ]
        result = found.vertex_of[len(found.vertex_of) - len(xyz) :]
        return Done(change, found, result, tuple(dict.fromkeys(crossings)))

    def remove(self, vertices: Int64Array) -> Done:
        """Remove the rows at vertices, and the vertices of lines there."""
        rows, on_lines = self._find_given(vertices, "removed")
        lines = (partial(drop_vertices, rows=on_lines),) if len(on_lines) else ()
        change = Change(removed=rows, lines=lines)
        return Done(change, self._build(change))

    def move(self, vertices: Int64Array, point: Float64Array) -> Done:
        """Move the rows at a vertex, and the vertices of lines there."""
        (there,) = self._now().triangulation.vertices_at(point[None, :2]).tolist()
        if there >= 0 and there != vertices[0]:
            raise explain_occupied(there, *point[:2].tolist())
        rows, on_lines = self._find_given(vertices, "moved")
        lines = (partial(put_vertices, rows=on_lines, point=point),) if len(on_lines) else ()
        change = Change(moved=rows, points=np.tile(point, (len(rows), 1)), lines=lines)
        found = self._build(change)
        _require_elevations(found, point[None])
        return Done(change, found)

    def _find_given(self, vertices: Int64Array, what: str) -> tuple[Int64Array, Int64Array]:
        """Return the rows at vertices, and the vertices of lines; refuse one that has neither."""
        version, inputs = self._now(), self._inputs
        rows = np.flatnonzero(np.isin(version.vertex_of, vertices))
        of_lines = inputs.find_line_vertices(version)
        on_lines = np.flatnonzero(np.isin(of_lines, vertices))
        given = np.append(version.vertex_of[rows], of_lines[on_lines])
        made = vertices[~np.isin(vertices, given)]
        if len(made):
            raise LinesError(
                f"Vertex {int(made[0])} cannot be {what} on its own: it was made where lines "
                "cross, are laid on the surface or are split, and goes with them."
            )
        return rows, on_lines

    def set_elevations(self, vertices: Int64Array, elevations: list[float]) -> Done:
        """Set those of rows and lines; at a vertex of neither, a row is added."""
        change, is_given = self._change_elevations(vertices, np.array(elevations))
        wanted = self._now().triangulation.points.copy()
        wanted[vertices, 2] = elevations
        change = change._replace(added=wanted[np.unique(vertices[~is_given])])
        found = self._build(change)
        _require_elevations(found, wanted[np.unique(vertices)])
        return Done(change, found)

    def _change_elevations(
        self, vertices: AnyArray, elevations: Float64Array
    ) -> tuple[Change, AnyArray]:
        """Give the rows and the lines at vertices other elevations; tell which vertices have any.

        Those of lines that are draped have none.
        """
        version, inputs = self._now(), self._inputs
        n_vertices, lines = len(version.triangulation.points), inputs.build_inputs.lines
        elevation_of = np.full(n_vertices + 1, np.nan)  # the last is of no vertex
        elevation_of[vertices] = elevations
        wanted = elevation_of[version.vertex_of]
        rows = np.flatnonzero(~np.isnan(wanted))
        points = inputs.build_inputs.points[inputs.find(rows)]
        points[:, 2] = wanted[rows]
        line_vertices = inputs.find_line_vertices(version)
        of_lines = elevation_of[line_vertices]
        on_lines = np.flatnonzero(~np.isnan(of_lines) & has_own_elevations(lines))
        set_those = partial(set_elevations, rows=on_lines, elevations=of_lines[on_lines])
        change = Change(moved=rows, points=points, lines=(set_those,) if len(on_lines) else ())
        given = np.append(version.vertex_of, line_vertices[~np.isnan(lines.elevations)])
        return change, np.isin(vertices, given)

    def flip(self, ends: Int64Array) -> Done:
        """Add the other diagonal as a soft line, or drop the line that the edge is."""
        a, b = ends.tolist()
        version = self._now()
        surface, lines = version.triangulation, version.lines
        holds = (surface.triangles == a).any(axis=1) & (surface.triangles == b).any(axis=1)
        beside = np.flatnonzero(holds)
        require_inner(beside.tolist())
        is_along = (np.sort(lines.segments(), axis=1) == sorted((a, b))).all(axis=1)
        own = lines.segment_chains()[is_along].tolist()
        if not all(lines.names[line] == FLIP for line in own):
            raise LinesError("The edge is one of a line, which must stay.")
        corners = surface.triangles[beside]
        runs = ((corners == a) & (np.roll(corners, -1, axis=1) == b)).any(axis=1)  # its left side
        corners = corners[np.argsort(~runs)]
        left, right = corners[(corners != a) & (corners != b)].tolist()
        if own:
            sources = sorted({int(lines.sources[line]) for line in own})
            change = Change(lines=(partial(drop_lines, numbers=tuple(sources)),))
        else:
            flipped = make_flipped_edge(surface.points[[a, b, left, right]])
            change = Change(lines=(partial(add_lines, added=[flipped]),))
        return Done(change, self._build(change))

    def add_breakline(self, line: Breakline, crossing: CrossingPolicy) -> Done:
        """Add a breakline behind the others."""
        change = Change(lines=(partial(add_lines, added=[line]),))
        inputs = self._inputs.after([change])
        found, lines = inputs.build(), inputs.build_inputs.lines
        number = count_breaklines(lines) - 1
        crossings = describe_crossings(found.report, lines.label(number))
        if crossings and crossing == "error":
            raise LinesError(f'{crossings[0][:-1]}: `crossing="error"` allows none.')
        made = zip(found.lines.kinds, found.lines.sources.tolist(), strict=True)
        is_there = any(kind in ("hard", "soft") and own == number for kind, own in made)
        if line.is_draped and not is_there:
            raise LinesError("The draped line lies outside the surface.")
        return Done(change, found, notes=tuple(crossings))

    def remove_breakline(self, number: int) -> Done:
        """Drop a breakline."""
        if not 0 <= number < count_breaklines(self._inputs.build_inputs.lines):
            raise LinesError(f"There is no breakline {number}.")
        change = Change(lines=(partial(drop_lines, numbers=(number,)),))
        return Done(change, self._build(change))

    def _build(self, change: Change) -> Version:
        return self._inputs.after([change]).build()


def _merge_new_elevations(
    xyz: Float64Array, own: Float64Array, policy: DuplicatePolicy
) -> Float64Array:
    """Return the elevation that each new row has in the end, given those of vertices there."""
    z = xyz[:, 2].copy()
    _, place = np.unique(xyz[:, :2], axis=0, return_inverse=True)
    place = place.reshape(-1)
    is_alone = (np.bincount(place)[place] == 1) & np.isnan(own)
    elevations: dict[int, float] = {}
    for row in np.flatnonzero(~is_alone).tolist():
        here = elevations.get(int(place[row]), float(own[row]))
        elevations[int(place[row])] = (
            float(z[row]) if np.isnan(here) else merge_elevations(here, float(z[row]), policy)
        )
    for row in np.flatnonzero(~is_alone).tolist():
        z[row] = elevations[int(place[row])]
    return z


def _require_elevations(found: Version, wanted: Float64Array) -> None:
    """Refuse an elevation that a water body or a line of higher priority overrules."""
    there = found.triangulation.vertices_at(wanted[:, :2])
    points = found.triangulation.points[there]
    wrong = np.flatnonzero((there >= 0) & (points[:, 2] != wanted[:, 2]))
    if len(wrong):
        x, y, z = points[wrong[0]].tolist()
        raise LinesError(
            f"The vertex at x {coordinate(x)}, y {coordinate(y)} stays at elevation "
            f"{height(z)}: what counts more there, "
            "such as water, has it."
        )
