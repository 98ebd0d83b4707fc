"""The editor behind a TIN whose edits reach no line: a mesh that is changed in place.

The triangulation of points and lines is unique, so where lines are not touched it is the one that
a fresh build gives. An edit that fails, or that comes near a line, leaves the mesh as it was.
"""

from __future__ import annotations

from array import array
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from ...base.sentences import coordinate, height
from .. import _kernel
from ..building import Version, choose_elevations, merge_rows
from ..report import Edit, Report
from ..triangulation import Triangulation
from .accounts import account_for_removed, add_chain, renumber_vertices, replace_merges
from .changes import Change, Done, add_lines, make_flipped_edge, require_inner

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import DuplicatePolicy
    from ..building import BuildInputs
    from ..constraints import Breakline
    from .changes import NumberedInputs

_Mesh = tuple["Int32Array", "Int32Array", "BoolArray"]
"""Triangles, neighbours and fixed edges, vertices called by their slots, in canonical order."""

_INSERT, _REMOVE, _MOVE, _ = range(4)
"""Kinds of edits, as the core numbers them."""

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
    has_elevations = np.isfinite(lines.priorities).all() and np.isfinite(lines.elevations).all()
    is_simple = options.snap == 0.0 and has_all_rows and not options.conforming
    return bool(is_simple and has_elevations and not build_inputs.is_clipped)


def _are_uncut(version: Version, build_inputs: BuildInputs) -> bool:
    """Tell whether all lines are breaklines, and run through their given vertices and no others.

    Then a build fixes them as they are given, and a further one that meets none changes nothing.
    """
    given, lines = build_inputs.lines, version.lines
    is_same = all(kind in ("hard", "soft") for kind in given.kinds) and np.array_equal(
        given.offsets, lines.offsets
    )
    points = version.triangulation.points
    return is_same and np.array_equal(given.xy, points[lines.vertices, :2])


class Editor:
    """Mesh and numbers of a TIN that is being edited.

    Vertices are called by slots here, numbers that never change. Those of the version come first:
    of its rows, then of its lines; those that are inserted follow. A TIN's own numbers put the
    inserted ones between the two, and close the gaps that removed ones leave.

    The version is neither clipped nor has it vertices that have been left out; ``inputs`` are its
    own. ``edited`` are the vertices as they are; there is no mesh of the triangles until these
    change.
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
        self.edited = _kernel.EditedMesh(surface.points, self._n_rows, self._n_base)
        self._unchanged: _Mesh | None = surface.triangles, surface.neighbors, surface.constrained
        self._own_rows: list[int] = []  # of each slot that was made since
        self._more_rows: dict[int, list[int]] = {}
        self._new_slots = array("i")  # of each row that came since
        self._has_lines = False
        if self._n_rows < self._n_base or len(version.lines) > 0:
            self._keep_clear(surface.points)
        self._has_uncut_lines = _are_uncut(version, inputs.build_inputs)

    # ------------------------------------------------------------------ numbers

    @property
    def count(self) -> int:
        """Number of vertices."""
        return self.edited.count

    def _open(self) -> _kernel.EditedMesh:
        """Return the vertices, with their triangles, to be changed."""
        if self._unchanged is not None:
            self.edited.open(*self._unchanged)
            self._unchanged = None
        return self.edited

    @property
    def _mesh(self) -> _kernel.Mesh:
        return self._open().mesh

    def _find_rows_at(self, slot: int) -> list[int]:
        more = self._more_rows.get(slot, [])
        if slot < self._n_rows:
            return self._base_rows.at(slot) + more
        return more if slot < self._n_base else [self._own_rows[slot - self._n_base], *more]

    # -------------------------------------------------------------------- edits

    def insert(
        self, xyz: Float64Array, policy: DuplicatePolicy, lines: Sequence[Breakline] = ()
    ) -> Done:
        """Insert rows of points.

        Raises
        ------
        PointsError
            If vertices are there, and the policy is "error".
        """
        if lines:
            raise NotLocal
        before = self.edited, self._unchanged
        first = self.edited.slots
        # whether growing all points anew is quicker than inserting so many
        count = len(xyz)
        is_worth_it = count > _LARGE_BATCH and count * _LARGE_SHARE > self.count
        is_large = is_worth_it and self.count == self.edited.slots and not self._has_lines
        slots = self._grow_with(xyz) if is_large else self._open().insert(xyz)
        own = np.arange(first, first + len(xyz), dtype=np.int32)
        is_new = slots == own
        elevations: dict[int, float] = {}  # of vertices at which further rows come to stand
        try:
            if not is_new.all():
                if self._is_strict or (slots > own).any():  # a build refuses, or keeps a later row
                    raise NotLocal
                for row in np.flatnonzero(~is_new).tolist():
                    slot = int(slots[row])
                    here = elevations.get(slot, self.edited.point(slot)[2])
                    elevations[slot] = merge_elevations(here, float(xyz[row, 2]), policy)
            self._require_free(slots)
        except (PointsError, NotLocal):
            if is_large:
                self.edited, self._unchanged = before
            else:
                self._take_back(slots[is_new])
                self._own_rows.extend([-1] * len(xyz))
            raise
        return Done(
            self._enter(xyz, slots, is_new, elevations), result=self.edited.numbers_of(slots)
        )

    def _keep_clear(self, points: Float64Array) -> None:
        """From now on vertices must keep a distance from lines."""
        self._has_lines = True
        self._least = _ROUNDINGS * float(np.spacing(np.abs(points[:, :2]).max()))
        self.edited.keep_clear(self._least)

    def _require_free(self, slots: Int32Array) -> None:
        """Refuse vertices on lines, or near one."""
        for slot in set(slots.tolist()) if self._has_lines else ():
            if not self._open().is_clear(slot):
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
        triangles = growth.triangles
        self.edited = _kernel.EditedMesh(rows, 0, 0)
        if not is_kept.all():
            triangles = np.flatnonzero(is_kept).astype(np.int32)[triangles]
            self.edited.leave_empty(np.flatnonzero(~is_kept).astype(np.int32))
        self._unchanged = triangles, growth.neighbors, np.zeros(triangles.shape, np.bool_)
        return slots[first:]

    def remove(self, vertices: Int64Array) -> Done:
        """Remove vertices and the rows there."""
        slots = self.edited.slots_of(vertices)
        self._require_free(slots)
        gone: list[int] = []
        edited = self._open()
        for slot in slots.tolist():
            if not edited.empty(slot):
                for other in gone:
                    edited.fill(other, *edited.point(other)[:2])
                raise PointsError(
                    "No triangle would be left: three vertices not in line must stay."
                )
            gone.append(slot)
        rows = [row for slot in gone for row in self._find_rows_at(slot)]
        return Done(Change(removed=np.array(rows, np.int64)))

    def move(self, vertices: Int64Array, point: Float64Array) -> Done:
        """Move a vertex and the rows there.

        Raises
        ------
        PointsError
            If another vertex stands there, or no triangle would be left.
        """
        slots = self.edited.slots_of(vertices)
        (slot,) = slots.tolist()
        if self._has_lines and self._open().has_fixed_edge(slot):
            raise NotLocal
        x, y, z = point.tolist()
        if self.edited.point(slot)[:2] != (x, y):
            self._move_in_plane(slots, x, y)
        self.edited.put_elevation(slot, z)
        return Done(self._move_rows(slot, point))

    def _move_in_plane(self, slots: Int32Array, x: float, y: float) -> None:
        self._require_free(slots)
        (slot,) = slots.tolist()
        edited, before = self._open(), self.edited.point(slot)[:2]
        if not edited.empty(slot):
            raise PointsError(
                "The vertex cannot be moved while all others are in line: insert a point first."
            )
        found = edited.fill(slot, x, y)
        if found != slot:
            edited.fill(slot, *before)
            raise explain_occupied(int(edited.numbers_of(np.array([found], np.int32))[0]), x, y)
        try:
            self._require_free(slots)
        except NotLocal:
            self._take_back(slots)
            edited.fill(slot, *before)
            raise

    def set_elevations(self, vertices: Int64Array, elevations: list[float]) -> Done:
        """Give vertices, and the rows there, other elevations."""
        slots = self.edited.slots_of(vertices).tolist()
        if self._has_lines and any(map(self._open().has_fixed_edge, slots)):
            raise NotLocal
        return Done(_join_changes(list(map(self._put_elevation, slots, elevations))))

    def _put_elevation(self, slot: int, elevation: float) -> Change:
        self.edited.put_elevation(slot, elevation)
        return self._move_rows(slot, np.array(self.edited.point(slot)))

    def _move_rows(self, slot: int, point: Float64Array) -> Change:
        rows = np.array(self._find_rows_at(slot), np.int64)
        points = point[None] if len(rows) == 1 else np.tile(point, (len(rows), 1))
        return Change(moved=rows, points=points)

    def flip(self, ends: Int64Array) -> Done:
        """Put the other diagonal of the two triangles at an edge in its place, as a soft line.

        Raises
        ------
        PointsError
            If there is no such inner edge, or the triangles are no convex quadrilateral.
        """
        a, b = self.edited.slots_of(ends).tolist()
        if not self._has_uncut_lines or b in self._mesh.fixed_neighbors(a).tolist():
            raise NotLocal
        beside = self._mesh.corners_beside(a, b).tolist()
        require_inner(beside)
        line = make_flipped_edge(np.array([self.edited.point(slot) for slot in (a, b, *beside)]))
        self._mesh.force(np.array([beside], np.int32))
        self._lines = add_chain(self._lines, beside, line)
        self._keep_clear(self.edited.points())
        return Done(Change(lines=(partial(add_lines, added=[line]),)))

    # ------------------------------------------------------------------ the log

    def take_log(self) -> Iterator[tuple[Edit, Change]]:
        """Yield the edits that the core did on its own since it was last asked, in order."""
        for edit, kind, slot, point in take_log(self.edited):
            if kind == _INSERT:
                self._own_rows.append(self._n_first_rows + len(self._new_slots))
                self._new_slots.append(slot)
                yield edit, Change(added=point[None])
            elif kind == _REMOVE:
                yield edit, Change(removed=np.array(self._find_rows_at(slot), np.int64))
            else:
                yield edit, self._move_rows(slot, point)

    # ------------------------------------------------------------------- result

    def make_version(self, inputs: Callable[[], NumberedInputs]) -> Version:
        """Return what the edits led to; ``inputs()`` are those of now, asked for if needed."""
        number = self.edited.numbers()
        if self._unchanged is None:
            triangles, neighbors, constrained = self.edited.mesh.arrays(self._threads)
        else:
            triangles, neighbors, constrained = self._unchanged
            if self.count < self.edited.slots:
                triangles = number[triangles]
        if self._n_rows < self._n_base < self.edited.slots:  # vertices of lines are the last ones
            triangles = number[number >= 0][triangles]
        surface = Triangulation(self.edited.points(), triangles, neighbors, constrained)
        slot_of_row = np.append(self._vertex_of_row, np.array(self._new_slots, np.int32))
        vertex_of_row = np.append(number, np.int32(-1))[slot_of_row]
        lines, base = self._lines, self._report
        if self._has_lines:
            lines = replace(lines, vertices=number[lines.vertices])
        counts = len(vertex_of_row), len(surface.points), len(surface.triangles)
        report = account_for_removed(renumber_vertices(base, number, *counts), vertex_of_row)
        n_merged = self.count - (self._n_base - self._n_rows)
        report = replace_merges(report, _gather_merges(vertex_of_row, n_merged, inputs))
        if self._has_lines:  # some that meet no others have been added
            labels = tuple(inputs().build_inputs.lines.labels())
            report = replace(report, n_lines=len(labels), line_labels=labels)
        return Version(triangulation=surface, vertex_of=vertex_of_row, lines=lines, report=report)


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


def take_log(edited: _kernel.EditedMesh) -> Iterator[tuple[Edit, int, int, Float64Array]]:
    """Yield the edits that were logged, in order; the log is empty then.

    Yields
    ------
    Edit
        As the caller gave it.
    kind, slot : int
    point : (3,) float64 array
        Where the vertex is then; nowhere, and not to be looked at, once it is removed.
    """
    numbers, given = edited.take_log()
    points = given + 0.0  # no -0.0
    for (kind, vertex, slot), xyz, point in zip(
        numbers.tolist(), given.tolist(), points, strict=True
    ):
        if kind == _INSERT:
            edit = Edit("insert", {"points": [xyz], "duplicates": "last"})
        elif kind == _REMOVE:
            edit = Edit("remove", {"vertices": vertex})
        elif kind == _MOVE:
            edit = Edit("move", {"vertex": vertex, "point": xyz})
        else:
            edit = Edit("set_elevation", {"vertices": vertex, "z": xyz[2]})
        yield edit, kind, slot, point


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
    """Return the elevation of a vertex at which a point is inserted."""
    if policy == "error":
        raise PointsError(
            f"A vertex with elevation {height(old)} stands where one with {height(new)} is "
            "to be inserted: "
            '`duplicates="error"` allows none.'
        )
    return float(choose_elevations(np.array([old, new]), np.array([0, 2]), policy)[0])


def explain_occupied(vertex: int, x: float, y: float) -> PointsError:
    """Return the error for a place at which a vertex stands already."""
    return PointsError(
        f"Vertex {vertex} stands at x {coordinate(x)}, y {coordinate(y)} already: two "
        "vertices need two places."
    )
