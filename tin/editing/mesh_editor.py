"""The editor behind a TIN whose edits reach no line: a mesh that is changed in place.

The triangulation of points and lines is unique, so where lines are not touched it is the one that
a fresh build gives. An edit that fails, or that comes near a line, leaves the mesh as it was.
"""

from __future__ import annotations

from array import array
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from ...base.sentences import coordinate, height
from .. import _kernel
from ..building.duplicates import merge_rows
from ..building.version import Version
from ..report import Edit, Report
from ..triangulation import Triangulation
from .changes import AddLine, Change
from .flipping import are_uncut, make_flipped_edge, require_inner
from .lazy_mesh import LiveMesh
from .single_edits import INSERT, REMOVE, take_log

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import DuplicatePolicy
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
    is_simple = options.snap == 0.0 and has_all_rows and not options.conforming
    has_own_elevations = bool(
        np.isfinite(lines.priorities).all() and np.isfinite(lines.elevations).all()
    )
    return is_simple and has_own_elevations and not build_inputs.is_clipped


class Editor:
    """Mesh and numbers of a TIN that is being edited.

    Vertices are called by slots here, numbers that never change. Those of the version come first:
    of its rows, then of its lines; those that are inserted follow. A TIN's own numbers put the
    inserted ones between the two, and close the gaps that removed ones leave.

    Parameters
    ----------
    version : Version
        Neither clipped nor with vertices that have been left out.
    inputs : NumberedInputs
        Of the version.
    """

    def __init__(self, version: Version, inputs: NumberedInputs) -> None:
        surface = version.triangulation
        self._vertex_of_row, self._lines = version.vertex_of, version.lines
        self._report = version.report
        self._n_first_rows = inputs.n_rows
        self._is_strict = inputs.build_inputs.options.duplicates == "error"
        self._threads = inputs.build_inputs.threads
        self._n_base = len(surface.points)
        self._base_rows = _group_rows_by_vertex(version.vertex_of)
        self._n_rows = self._base_rows.n_vertices
        self._live = LiveMesh(
            surface.points,
            surface.triangles,
            surface.neighbors,
            surface.constrained,
            lines=(self._n_rows, self._n_base),
        )
        self._own_rows: list[int] = []  # of each slot that was made since
        self._more_rows: dict[int, list[int]] = {}
        self._new_slots = array("i")  # of each row that came since
        self._has_lines = False
        if self._n_rows < self._n_base or len(version.lines) > 0:
            self._keep_clear(surface.points)
        self._has_uncut_lines = are_uncut(version, inputs.build_inputs)

    # ------------------------------------------------------------------ numbers

    @property
    def edited(self) -> _kernel.EditedMesh:
        """The vertices as they are."""
        return self._live.edited

    @property
    def count(self) -> int:
        """Number of vertices."""
        return self.edited.count

    @property
    def _mesh(self) -> _kernel.Mesh:
        return self._live.mesh

    def slots(self, vertices: Int64Array) -> Int32Array:
        """Return the slots of vertices, which must exist."""
        return self.edited.slots_of(vertices)

    def numbers(self, slots: Int32Array) -> Int32Array:
        """Return the vertices that slots hold."""
        return self.edited.numbers_of(slots)

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
        first = before.edited.slots
        is_large = self._is_large(len(xyz))
        slots = self._grow_with(xyz) if is_large else before.open().insert(xyz)
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
                self._own_rows.extend([-1] * len(xyz))
            raise
        return slots, self._enter(xyz, slots, is_new, elevations)

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
        for row in old:
            slot = int(slots[row])
            here = elevations.get(slot, self.edited.point(slot)[2])
            elevations[slot] = merge_elevations(here, float(xyz[row, 2]), policy)
        return elevations

    def _require_clear(self, slots: Int32Array) -> None:
        for slot in set(slots.tolist()):
            self._require_free(slot)

    def _keep_clear(self, points: Float64Array) -> None:
        """From now on vertices must keep a distance from lines."""
        self._has_lines = True
        self._least = _ROUNDINGS * float(np.spacing(np.abs(points[:, :2]).max()))
        self.edited.keep_clear(self._least)

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
            self.edited.empty(slot)
            if len(ends):
                self._mesh.force(np.ascontiguousarray(ends[None, :]))

    def _enter(
        self,
        xyz: Float64Array,
        slots: Int32Array,
        is_new: BoolArray,
        elevations: dict[int, float],
    ) -> Change:
        row = self._n_first_rows + len(self._new_slots)
        self._own_rows.extend(range(row, row + len(xyz)))
        moved = []
        if elevations:
            for i in np.flatnonzero(~is_new).tolist():
                self._more_rows.setdefault(int(slots[i]), []).append(row + i)
            moved = [self._put_elevation(slot, elevation) for slot, elevation in elevations.items()]
        self._new_slots.frombytes(slots.tobytes())
        if not elevations:
            return Change(added=xyz)
        added = xyz.copy()
        for slot, elevation in elevations.items():
            added[slots == slot, 2] = elevation
        return _join_changes(moved)._replace(added=added)

    def _is_large(self, count: int) -> bool:
        """Tell whether growing all points anew is quicker than inserting so many."""
        is_worth_it = count > _LARGE_BATCH and count * _LARGE_SHARE > self.count
        return is_worth_it and self.count == self.edited.slots and not self._has_lines

    def _grow_with(self, xyz: Float64Array) -> Int32Array:
        """Triangulate the points that are there and those that come; return slots of the latter.

        A slot is made for every row, as if each had been inserted, and stays empty where a vertex
        was there already.
        """
        first = self.edited.slots
        rows = np.concatenate([self.edited.points(), xyz])
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
            alive=is_kept,
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
        edited = self._live.open()
        for slot in slots.tolist():
            if not edited.empty(slot):
                self._put_back(gone)
                raise PointsError(
                    "No triangle would be left: three vertices not in line must stay."
                )
            gone.append(slot)
        rows = [row for slot in gone for row in self._find_rows_at(slot)]
        return Change(removed=np.array(rows, np.int64))

    def _put_back(self, slots: Sequence[int]) -> None:
        for slot in slots:
            self.edited.fill(slot, *self.edited.point(slot)[:2])

    def move(self, slot: int, point: Float64Array) -> Change:
        """Move a vertex and the rows there.

        Raises
        ------
        PointsError
            If another vertex stands there, or no triangle would be left.
        """
        if self._has_lines and self._mesh.has_fixed_edge(slot):
            raise NotLocal
        x, y, z = point.tolist()
        if self.edited.point(slot)[:2] != (x, y):
            self._move_in_plane(slot, x, y)
        self.edited.put_elevation(slot, z)
        return self._move_rows(slot, point)

    def _move_in_plane(self, slot: int, x: float, y: float) -> None:
        if self._has_lines:
            self._require_free(slot)
        edited, before = self._live.open(), self.edited.point(slot)[:2]
        if not edited.empty(slot):
            raise PointsError(
                "The vertex cannot be moved while all others are in line: insert a point first."
            )
        found = edited.fill(slot, x, y)
        if found != slot:
            edited.fill(slot, *before)
            raise explain_occupied(int(self.numbers(np.array([found], np.int32))[0]), x, y)
        if self._has_lines:
            try:
                self._require_free(slot)
            except NotLocal:
                self._take_back(np.array([slot], np.int32))
                edited.fill(slot, *before)
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
        self.edited.put_elevation(slot, elevation)
        return self._move_rows(slot, np.array(self.edited.point(slot)))

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
        line = make_flipped_edge(np.array([self.edited.point(slot) for slot in (a, b, *beside)]))
        self._mesh.force(np.array([beside], np.int32))
        self._lines = self._lines.with_breakline(beside, line)
        self._keep_clear(self.edited.points())
        return Change(lines=(AddLine(line),))

    # ------------------------------------------------------------------ the log

    def take_log(self) -> Iterator[tuple[Edit, Change]]:
        """Yield the edits that the core did on its own since it was last asked, in order."""
        for edit, kind, slot, point in take_log(self.edited):
            if kind == INSERT:
                yield edit, self._enter_one(slot, point)
            elif kind == REMOVE:
                yield edit, Change(removed=np.array(self._find_rows_at(slot), np.int64))
            else:
                yield edit, self._move_rows(slot, point)

    def _enter_one(self, slot: int, point: Float64Array) -> Change:
        self._own_rows.append(self._n_first_rows + len(self._new_slots))
        self._new_slots.append(slot)
        return Change(added=point[None])

    # ------------------------------------------------------------------- result

    def make_version(self, inputs: Callable[[], NumberedInputs]) -> Version:
        """Return what the edits led to; ``inputs()`` are those of now, asked for if needed."""
        number = self.edited.numbers()
        surface = self._make_triangulation()
        slot_of_row = np.append(self._vertex_of_row, np.array(self._new_slots, np.int32))
        vertex_of_row = np.append(number, np.int32(-1))[slot_of_row]
        lines, base = self._lines, self._report
        if self._has_lines:
            lines = lines.renumber(number)
        report = base.renumber(
            number, len(vertex_of_row), len(surface.points), len(surface.triangles)
        )
        report = report.with_removed(vertex_of_row).with_merges(
            _gather_merges(vertex_of_row, self.count - (self._n_base - self._n_rows), inputs)
        )
        if self._has_lines:
            report = report.with_lines(inputs().build_inputs.lines.labels())
        return Version(triangulation=surface, vertex_of=vertex_of_row, lines=lines, report=report)

    def _make_triangulation(self) -> Triangulation:
        triangles, neighbors, constrained = self._live.arrays(self._threads)
        if self._n_rows < self._n_base < self.edited.slots:  # vertices of lines are the last ones
            number = self.edited.numbers()
            triangles = number[number >= 0][triangles]
        return Triangulation(
            points=self.edited.points(),
            triangles=triangles,
            neighbors=neighbors,
            constrained=constrained,
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
    vertex_of_row: Int32Array, n_vertices: int, inputs: Callable[[], NumberedInputs]
) -> Report | None:
    """Return the account of rows that share one of so many vertices, as a build gives it."""
    rows = np.flatnonzero(vertex_of_row >= 0)
    if len(rows) == n_vertices:
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
            f"A vertex with elevation {height(old)} stands where one with {height(new)} is "
            "to be inserted: "
            '`duplicates="error"` allows none.'
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
        f"Vertex {vertex} stands at x {coordinate(x)}, y {coordinate(y)} already: two "
        "vertices need two places."
    )
