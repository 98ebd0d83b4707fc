"""The editor behind a TIN whose edits reach no line: a mesh that is changed in place.

The triangulation of points and lines is unique, so where lines are not touched it is the one that
a fresh build gives. An edit that fails, or that comes near a line, leaves the mesh as it was.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import PointsError
from .. import _kernel
from ..building.duplicates import merge_rows
from ..report import Report
from ..triangulation import Triangulation
from .changes import AddLine, Change
from .flipping import are_uncut, make_flipped_edge, require_inner
from .lazy_mesh import LiveMesh
from .row_buffer import GrowingRows
from .state import State

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...policies import DuplicatePolicy
    from ..building.inputs import BuildInputs
    from .changes import NumberedInputs

__all__ = ["Editor", "NotLocal", "explain_occupied", "is_local", "merge_elevations"]

_LARGE_BATCH = 10_000
_LARGE_SHARE = 8
"""A batch of more than an eighth of the vertices is triangulated together with them."""

_ROUNDINGS = 1024.0
"""Units in the last place of the largest coordinate: nearer to a line, all is built anew. A
crossing is rounded by one unit, and each later one that depends on it by one more."""


class NotLocal(Exception):
    """The edit reaches a line, so that all must be built anew. Nothing has changed."""


def is_local(build_inputs: BuildInputs) -> bool:
    """Tell whether an edit away from the lines changes the triangulation there alone."""
    lines, options = build_inputs.lines, build_inputs.options
    has_all_rows = not build_inputs.erase and build_inputs.is_masked is None
    is_simple = options.snap == 0.0 and has_all_rows and not build_inputs.conforming
    has_own_elevations = bool(
        np.isfinite(lines.priorities).all() and np.isfinite(lines.elevations).all()
    )
    return is_simple and has_own_elevations and not build_inputs.is_clipped


class _Counts(NamedTuple):
    """How many vertices are there, in the order of their numbers."""

    rows: int
    inserted: int
    lines: int


class Editor:
    """Mesh and numbers of a TIN that is being edited.

    Vertices are called by slots here, numbers that never change. Those of the state come first: of
    its rows, then of its lines; those that are inserted follow. A TIN's own numbers put the
    inserted ones between the two, and close the gaps that removed ones leave.

    Parameters
    ----------
    state : State
        Neither clipped nor with vertices that have been left out.
    inputs : NumberedInputs
        Of the state.
    """

    def __init__(self, state: State, inputs: NumberedInputs) -> None:
        surface = state.triangulation
        self._vertex_of_row, self._lines = state.vertex_of_row, state.lines
        self._report = state.report
        self._n_first_rows = inputs.n_rows
        self._is_strict = inputs.build_inputs.options.duplicates == "error"
        self._threads = inputs.build_inputs.options.threads
        self._live = LiveMesh(
            surface.points, surface.triangles, surface.neighbors, surface.constrained
        )
        self._points = GrowingRows(surface.points)
        self._removed: list[int] = []
        self._n_base = len(surface.points)
        self._base_rows = _group_rows_by_vertex(state.vertex_of_row)
        self._n_rows = self._base_rows.n_vertices
        self._own_rows: list[int] = []  # of each slot that was made since
        self._more_rows: dict[int, list[int]] = {}
        self._new_slots = GrowingRows(np.empty(0, np.int32))
        self._n_new = 0
        self._has_lines = self._n_rows < self._n_base or len(state.lines) > 0
        self._has_uncut_lines = are_uncut(state, inputs.build_inputs)

    # ------------------------------------------------------------------ numbers

    @property
    def count(self) -> int:
        """Number of vertices."""
        return self._live.count

    @property
    def _mesh(self) -> _kernel.Mesh:
        return self._live.mesh

    def _count(self) -> _Counts:
        rows = self._n_rows - bisect_left(self._removed, self._n_base)
        lines = self._n_base - self._n_rows
        return _Counts(rows, self._live.count - rows - lines, lines)

    def slots(self, vertices: Int64Array) -> Int32Array:
        """Return the slots of vertices, which must exist."""
        if self._n_rows < self._n_base:
            rows, inserted, lines = self._count()
            back = np.where(vertices < rows + inserted, lines, -inserted)
            vertices = vertices + np.where(vertices < rows, 0, back)
        removed = self._removed
        if len(vertices) == 1:
            vertex = int(vertices[0])
            before = bisect_right(range(len(removed)), vertex, key=lambda j: removed[j] - j)
            return np.array([vertex + before], np.int32)
        gone = np.array(removed, np.int64)
        shift = np.searchsorted(gone - np.arange(len(gone)), vertices, side="right")
        return (vertices + shift).astype(np.int32)

    def numbers(self, slots: Int32Array) -> Int32Array:
        """Return the vertices that slots hold."""
        if len(slots) == 1:
            found = slots - np.int32(bisect_left(self._removed, int(slots[0])))
        else:
            gone = np.array(self._removed, np.int64)
            found = slots - np.searchsorted(gone, slots).astype(np.int32)
        return self._reorder(found)

    def _reorder(self, ranks: Int32Array) -> Int32Array:
        """Return the numbers of vertices that are numbered by slot, without gaps."""
        if self._n_rows == self._n_base:
            return ranks
        rows, inserted, lines = self._count()
        on = np.where(ranks < rows + lines, np.int32(inserted), np.int32(-lines))
        return ranks + np.where(ranks < rows, np.int32(0), on)

    def _find_rows_at(self, slot: int) -> list[int]:
        more = self._more_rows.get(slot, [])
        if slot < self._n_rows:
            return self._base_rows.at(slot) + more
        return more if slot < self._n_base else [self._own_rows[slot - self._n_base], *more]

    # -------------------------------------------------------------------- edits

    def insert(self, xyz: Float64Array, policy: DuplicatePolicy) -> tuple[Int32Array, Change]:
        """Insert rows of points; return their slots.

        Raises
        ------
        PointsError
            If vertices are there, and the policy is "error".
        """
        before = self._live
        first = before.slots
        is_large = self._is_large(len(xyz))
        slots = self._grow_with(xyz) if is_large else self._insert_into_mesh(xyz)
        is_new = slots == np.arange(first, first + len(xyz), dtype=np.int32)
        try:
            elevations: dict[int, float] = {}
            if not is_new.all():
                self._require_in_order(slots, first)
                old = np.flatnonzero(~is_new).tolist()
                elevations = self._merge_all_elevations(xyz, slots, old, policy)
            if self._has_lines:
                self._require_clear(slots)
        except (PointsError, NotLocal):
            if is_large:
                self._live = before
            else:
                self._take_back(slots[is_new])
                self._keep_empty(xyz, first)
            raise
        return slots, self._enter(xyz, slots, is_new, elevations)

    def _insert_into_mesh(self, xyz: Float64Array) -> Int32Array:
        return self._mesh.insert(np.ascontiguousarray(xyz[:, :2]))

    def _require_in_order(self, slots: Int32Array, first: int) -> None:
        """Leave rows at one place to a build if it refuses them, or if not the first is kept."""
        is_late = slots > np.arange(first, first + len(slots))
        if is_late.any() or self._is_strict:
            raise NotLocal

    def _merge_all_elevations(
        self,
        xyz: Float64Array,
        slots: Int32Array,
        old: list[int],
        policy: DuplicatePolicy,
    ) -> dict[int, float]:
        """Return the elevations of vertices at which further rows come to stand."""
        elevations: dict[int, float] = {}
        first = self._live.slots - len(xyz)
        for row in old:
            slot = int(slots[row])
            here = self._points.at(slot)[2] if slot < first else xyz[slot - first, 2]
            here = elevations.get(slot, float(here))
            elevations[slot] = merge_elevations(here, float(xyz[row, 2]), policy)
        return elevations

    def _require_clear(self, slots: Int32Array) -> None:
        for slot in set(slots.tolist()):
            self._require_free(slot)

    @cached_property
    def _least(self) -> float:
        """The least distance from lines."""
        return _ROUNDINGS * float(np.spacing(np.abs(self._points.values()[:, :2]).max()))

    def _require_free(self, slot: int) -> None:
        """Refuse a vertex on a line, or near one."""
        if self._mesh.has_fixed_edge(slot) or not self._mesh.clearance(slot) > self._least:
            raise NotLocal

    def _take_back(self, slots: Int32Array) -> None:
        """Remove vertices that were inserted, also from fixed edges."""
        for slot in slots.tolist():
            ends = self._mesh.fixed_neighbors(slot)
            pairs = np.stack([np.full_like(ends, slot), ends], axis=1)
            self._mesh.release(pairs)
            self._mesh.remove(np.array([slot], np.int32))
            if len(ends):
                self._mesh.force(np.ascontiguousarray(ends[None, :]))

    def _keep_empty(self, xyz: Float64Array, first: int) -> None:
        self._points.extend(xyz)
        self._own_rows.extend([-1] * len(xyz))
        self._removed.extend(range(first, first + len(xyz)))

    def _enter(
        self,
        xyz: Float64Array,
        slots: Int32Array,
        is_new: BoolArray,
        elevations: dict[int, float],
    ) -> Change:
        first = len(self._points)
        self._points.extend(xyz)
        row = self._n_first_rows + self._n_new
        self._own_rows.extend(range(row, row + len(xyz)))
        moved = []
        if elevations:
            for i in np.flatnonzero(~is_new).tolist():
                self._more_rows.setdefault(int(slots[i]), []).append(row + i)
            self._removed.extend((first + np.flatnonzero(~is_new)).tolist())
            moved = [self._put_elevation(slot, elevation) for slot, elevation in elevations.items()]
        self._new_slots.extend(slots)
        self._n_new += len(xyz)
        if not elevations:
            return Change(added=xyz)
        added = xyz.copy()
        for slot, elevation in elevations.items():
            added[slots == slot, 2] = elevation
        return _join_changes(moved)._replace(added=added)

    def _is_large(self, count: int) -> bool:
        """Tell whether growing all points anew is quicker than inserting so many."""
        is_worth_it = count > _LARGE_BATCH and count * _LARGE_SHARE > self._live.count
        return is_worth_it and not self._removed and not self._has_lines

    def _grow_with(self, xyz: Float64Array) -> Int32Array:
        """Triangulate the points that are there and those that come; return slots of the latter.

        A slot is made for every row, as if each had been inserted, and stays empty where a vertex
        was there already.
        """
        first = self._live.slots
        rows = np.concatenate([self._points.values(), xyz])
        growth = _kernel.grow(rows, threads=self._threads)
        own = np.arange(len(rows), dtype=np.int32)
        slots = own if growth.kept_row is None else growth.kept_row
        is_kept = slots == own
        vertex = np.flatnonzero(is_kept).astype(np.int32)
        self._live = LiveMesh(
            rows,
            growth.triangles if is_kept.all() else vertex[growth.triangles],
            growth.neighbors,
            np.zeros(growth.triangles.shape, np.bool_),
            is_kept,
        )
        return slots[first:]

    def remove(self, slots: Int32Array) -> Change:
        """Remove vertices and the rows there.

        Raises
        ------
        PointsError
            If no triangle would be left.
        """
        if self._has_lines:
            self._require_clear(slots)
        gone: list[int] = []
        for i, slot in enumerate(slots.tolist()):
            if not self._mesh.remove(slots[i : i + 1]):
                self._put_back(gone)
                raise PointsError(
                    "No triangle would be left: three vertices not in line must stay."
                )
            gone.append(slot)
        rows = [row for slot in gone for row in self._find_rows_at(slot)]
        for slot in gone:
            insort(self._removed, slot)
        return Change(removed=np.array(rows, np.int64))

    def _put_back(self, slots: Sequence[int]) -> None:
        for slot in slots:
            x, y = self._points.at(slot)[:2].tolist()
            self._mesh.put(slot, x, y)

    def move(self, slot: int, point: Float64Array) -> Change:
        """Move a vertex and the rows there.

        Raises
        ------
        PointsError
            If another vertex stands there, or no triangle would be left.
        """
        if self._has_lines and self._mesh.has_fixed_edge(slot):
            raise NotLocal
        if (self._points.at(slot)[:2] != point[:2]).any():
            self._move_in_plane(slot, float(point[0]), float(point[1]))
        self._points.put(slot, point)
        return self._move_rows(slot, point)

    def _move_in_plane(self, slot: int, x: float, y: float) -> None:
        if self._has_lines:
            self._require_free(slot)
        if not self._mesh.remove(np.array([slot], np.int32)):
            raise PointsError(
                "The vertex cannot be moved while all others are in line: insert a point first."
            )
        found = self._mesh.put(slot, x, y)
        if found != slot:
            self._put_back([slot])
            raise explain_occupied(int(self.numbers(np.array([found], np.int32))[0]), x, y)
        if self._has_lines:
            try:
                self._require_free(slot)
            except NotLocal:
                self._take_back(np.array([slot], np.int32))
                self._put_back([slot])
                raise

    def set_elevations(self, slots: Int32Array, elevations: list[float]) -> Change:
        """Give vertices, and the rows there, other elevations."""
        if self._has_lines and any(map(self._mesh.has_fixed_edge, slots.tolist())):
            raise NotLocal
        return _join_changes(
            [
                self._put_elevation(slot, elevation)
                for slot, elevation in zip(slots.tolist(), elevations, strict=True)
            ]
        )

    def _put_elevation(self, slot: int, elevation: float) -> Change:
        point = self._points.at(slot).copy()
        point[2] = elevation
        self._points.put(slot, point)
        return self._move_rows(slot, point)

    def _move_rows(self, slot: int, point: Float64Array) -> Change:
        rows = np.array(self._find_rows_at(slot), np.int64)
        points = point[None] if len(rows) == 1 else np.tile(point, (len(rows), 1))
        return Change(moved=rows, points=points)

    def flip(self, a: int, b: int) -> Change:
        """Put the other diagonal of the two triangles at an edge in its place, as a soft line.

        Raises
        ------
        PointsError
            If there is no such inner edge, or the triangles are no convex quadrilateral.
        """
        if not self._has_uncut_lines or b in self._mesh.fixed_neighbors(a).tolist():
            raise NotLocal
        beside = self._mesh.corners_beside(a, b).tolist()
        require_inner(beside)
        line = make_flipped_edge(self._points.take([a, b, *beside]))
        self._mesh.force(np.array([beside], np.int32))
        self._lines, self._has_lines = self._lines.with_breakline(beside, line), True
        return Change(lines=(AddLine(line),))

    # ------------------------------------------------------------------- result

    def state(self, inputs: Callable[[], NumberedInputs]) -> State:
        """Return what the edits led to; ``inputs()`` are those of now, asked for if needed."""
        alive = self._live.alive()
        number = self._reorder(np.cumsum(alive, dtype=np.int32) - np.int32(1))
        number = np.where(alive, number, np.int32(-1))
        surface = self._make_triangulation(alive)
        slot_of_row = np.append(self._vertex_of_row, self._new_slots.values())
        vertex_of_row = np.append(number, np.int32(-1))[slot_of_row]
        lines, base = self._lines, self._report
        if self._has_lines:
            lines = lines.renumber(number)
        report = base.renumber(
            number, len(vertex_of_row), len(surface.points), len(surface.triangles)
        )
        report = report.with_removed(vertex_of_row).with_merges(
            _gather_merges(vertex_of_row, self._count(), inputs)
        )
        if self._has_lines:
            report = report.with_lines(inputs().build_inputs.lines.labels())
        return State(surface, vertex_of_row, lines, report, None)

    def _make_triangulation(self, alive: BoolArray) -> Triangulation:
        triangles, neighbors, constrained = self._live.arrays(self._threads)
        points = self._points.values()[alive]
        rows, inserted, lines = self._count()
        if lines and inserted:
            between = rows + lines
            points = np.concatenate([points[:rows], points[between:], points[rows:between]])
            triangles = self._reorder(np.arange(len(points), dtype=np.int32))[triangles]
        return Triangulation(
            points=points, triangles=triangles, neighbors=neighbors, constrained=constrained
        )


class _RowsByVertex(NamedTuple):
    """The rows of each vertex that has any; ``rows`` is None where row and vertex are the same."""

    n_vertices: int
    rows: Int64Array | None
    offsets: Int64Array | None

    def at(self, vertex: int) -> list[int]:
        if self.rows is None or self.offsets is None:
            return [vertex]
        found: list[int] = self.rows[self.offsets[vertex] : self.offsets[vertex + 1]].tolist()
        return found


def _group_rows_by_vertex(vertex_of_row: Int32Array) -> _RowsByVertex:
    count = int(vertex_of_row.max()) + 1 if len(vertex_of_row) else 0
    if count == len(vertex_of_row):
        return _RowsByVertex(count, None, None)
    order = np.argsort(vertex_of_row, kind="stable")
    offsets = np.searchsorted(vertex_of_row[order], np.arange(count + 1))
    return _RowsByVertex(count, order, offsets)


def _gather_merges(
    vertex_of_row: Int32Array, counts: _Counts, inputs: Callable[[], NumberedInputs]
) -> Report | None:
    """Return the account of rows that share a vertex, as a build gives it; None for none."""
    rows = np.flatnonzero(vertex_of_row >= 0)
    if len(rows) == counts.rows + counts.inserted:
        return None
    vertex = vertex_of_row[rows]
    shares = np.flatnonzero(np.bincount(vertex)[vertex] > 1)  # the others are no matter
    rows, vertex = rows[shares], vertex[shares]
    vertices, first, group = np.unique(vertex, return_index=True, return_inverse=True)
    build_inputs = inputs().build_inputs
    kept_row = first[group.reshape(-1)].astype(np.int32)
    account = merge_rows(
        build_inputs.points[shares], kept_row, build_inputs.options.duplicates
    ).account
    account["merged_vertices"] = vertices[account["merged_vertices"]]
    return Report(
        n_rows=0,
        n_vertices=0,
        n_triangles=0,
        **(account | {"merged_rows": rows[account["merged_rows"]].astype(np.int32)}),
    )


def _join_changes(changes: list[Change]) -> Change:
    if len(changes) == 1:
        return changes[0]
    if not changes:
        return Change()
    return Change(
        moved=np.concatenate([change.moved for change in changes]),
        points=np.concatenate([change.points for change in changes]),
    )


def merge_elevations(old: float, new: float, policy: DuplicatePolicy) -> float:
    """Return the elevation of a vertex at which a point is inserted.

    Raises
    ------
    PointsError
        If the policy is "error".
    """
    if policy == "error":
        raise PointsError(
            f"A vertex with elevation {old:g} stands where one with {new:g} is to be inserted: "
            'duplicates="error" allows none.'
        )
    return {
        "first": old,
        "last": new,
        "lowest": min(old, new),
        "highest": max(old, new),
        "mean": old / 2 + new / 2
        if abs(old - new) == np.inf
        else min(old, new) + abs(old - new) / 2,
    }[policy]


def explain_occupied(vertex: int, x: float, y: float) -> PointsError:
    """Return the error for a place at which a vertex stands already."""
    return PointsError(
        f"Vertex {vertex} stands at x {x:g}, y {y:g} already: two vertices need two places."
    )
