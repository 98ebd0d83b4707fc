"""The editor behind a TIN that is changed in place: its mesh, its chains, its numbers.

The triangulation of points and lines is unique, so after any edits it is the one that a fresh
build gives. An operation that fails may leave the editor half-way: whoever calls it starts again
from the last model (:mod:`.editing`).
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from . import _kernel
from .chains import ChainTable, Step, as_pairs, step_of, with_middle
from .errors import LinesError, PointsError
from .growing import GrowingRows
from .live_mesh import LiveMesh
from .model import LineInfo, Model, lines_in, mesh_of
from .regions import Surface

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .lines import Lines

__all__ = ["FLIP", "Editor", "Refreshed"]

FLIP = "flip"
"""Name of the soft breakline that keeps a flipped edge."""

_MOST_CROSSINGS = 1_000_000

_LARGE_BATCH = 10_000
_LARGE_SHARE = 8
"""A batch of more than an eighth of the vertices is triangulated together with them."""


class Refreshed(NamedTuple):
    """The arrays of a TIN after edits, and the model that they come from."""

    surface: Surface
    lines: Lines
    vertex_of: NDArray[np.int32]
    model: Model


class Editor:
    """Points, lines and mesh of a TIN that is being edited.

    Vertices are called by slots here, numbers that never change; a TIN's own numbers close the
    gaps that removed vertices leave.

    Parameters
    ----------
    model : Model
    hull : Surface, optional
        Its triangulation, if that is at hand.
    threads : int
    """

    def __init__(self, model: Model, hull: Surface | None = None, *, threads: int = 1) -> None:
        self._threads = threads
        self._clip = model.clip
        self._points = GrowingRows(model.points)
        self._rows = GrowingRows(model.vertex_of)
        self._infos = list(model.infos)
        self._chains = ChainTable(model.pieces)
        self._removed: list[int] = []
        self._visible: NDArray[np.int32] | None = None
        if hull is None:
            self._live = LiveMesh.of(mesh_of(model.points, model.pieces, threads=threads))
        else:
            self._live = LiveMesh(model.points, hull.triangles, hull.neighbors, hull.constrained)

    # ------------------------------------------------------------------ numbers

    @property
    def is_clipped(self) -> bool:
        """Whether the surface is a part of the hull, so that only a refresh tells its vertices."""
        return not self._clip.is_none

    @property
    def count(self) -> int:
        """Number of vertices of the TIN (of a clipped one, when it was last refreshed)."""
        return self._live.count if self._visible is None else len(self._visible)

    @property
    def _mesh(self) -> _kernel.Mesh:
        return self._live.mesh

    def slots(self, vertices: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the slots of vertices of the TIN, which must exist."""
        if self._visible is not None:
            return self._visible[vertices]
        removed = self._removed
        if len(vertices) == 1:
            vertex = int(vertices[0])
            before = bisect_right(range(len(removed)), vertex, key=lambda j: removed[j] - j)
            return np.array([vertex + before], np.int32)
        gone = np.array(removed, np.int64)
        shift = np.searchsorted(gone - np.arange(len(gone)), vertices, side="right")
        return (vertices + shift).astype(np.int32)

    def numbers(self, slots: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return the vertices of an unclipped TIN that slots hold."""
        if len(slots) == 1:
            return slots - np.int32(bisect_left(self._removed, int(slots[0])))
        return slots - np.searchsorted(np.array(self._removed, np.int64), slots).astype(np.int32)

    def hull(self) -> Surface:
        """Return the triangulation of all vertices."""
        triangles, neighbors, fixed = self._live.arrays(self._threads)
        return Surface(self._points.values()[self._live.alive()], triangles, neighbors, fixed)

    def refreshed(self) -> Refreshed:
        """Make the arrays of the TIN."""
        hull = self.hull()
        alive = self._live.alive()
        number = np.where(alive, np.cumsum(alive) - 1, -1).astype(np.int32)
        model = Model(
            points=hull.points,
            pieces=self._chains.pieces().renumbered(number),
            infos=tuple(self._infos),
            clip=self._clip,
            vertex_of=np.append(number, np.int32(-1))[self._rows.values()],
        )
        surface, number_of = model.surface(hull)
        if self.is_clipped:
            self._visible = np.flatnonzero(alive)[number_of >= 0].astype(np.int32)
        return Refreshed(
            surface,
            lines_in(model.pieces, model.infos, number_of, surface, is_whole=surface is hull),
            np.append(number_of, np.int32(-1))[model.vertex_of],
            model,
        )

    # ------------------------------------------------------------------- points

    def insert(self, xyz: NDArray[np.float64], policy: str) -> NDArray[np.int32]:
        """Insert rows of points; return their slots."""
        slots = self._insert(xyz, policy)
        self._rows.extend(slots)
        return slots

    def _insert(self, xyz: NDArray[np.float64], policy: str) -> NDArray[np.int32]:
        first = self._live.slots
        if self._is_large(len(xyz)):
            slots = self._grow_with(xyz)
        else:
            slots = self._mesh.insert(np.ascontiguousarray(xyz[:, :2]))
        is_new = slots == np.arange(first, first + len(xyz))
        self._points.extend(xyz)
        self._removed.extend((first + np.flatnonzero(~is_new)).tolist())
        for row in np.flatnonzero(~is_new).tolist():
            there = int(slots[row])
            old, new = float(self._points.at(there)[2]), float(xyz[row, 2])
            self._set_height(there, _merged_height(old, new, policy))
        if self._chains:
            for slot in slots[is_new].tolist():
                self._join_step_at(slot)
        return slots

    def _is_large(self, count: int) -> bool:
        """Tell whether growing all points anew is quicker than inserting so many."""
        is_worth_it = count > _LARGE_BATCH and count * _LARGE_SHARE > self._live.count
        return is_worth_it and not self._removed and not self._chains

    def _grow_with(self, xyz: NDArray[np.float64]) -> NDArray[np.int32]:
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

    def _join_step_at(self, slot: int) -> None:
        """Take a vertex that came to lie on a fixed edge into the lines there."""
        if self._mesh.has_fixed_edge(slot):
            a, b = self._mesh.fixed_neighbors(slot).tolist()
            self._chains.split(step_of(a, b), slot)

    def remove(self, slots: NDArray[np.int32]) -> None:
        """Remove vertices; the lines through them run straight on.

        Raises
        ------
        PointsError
            If no triangle would be left.
        LinesError
            If a line would vanish, or cross another.
        """
        for slot in slots.tolist():
            self._remove(slot)
            insort(self._removed, slot)

    def _remove(self, slot: int) -> None:
        new: list[Step] = []
        for chain in self._chains.at(slot) if self._chains else ():
            vertices = self._chains.vertices(chain)
            rest = _without(vertices, slot)
            if len(rest) < (4 if vertices[0] == vertices[-1] else 2):
                raise LinesError(
                    "A line would vanish with the vertex: remove_breakline removes a line."
                )
            gone, more = self._chains.change(chain, rest)
            self._release(gone)
            new += more
        if not self._mesh.remove(np.array([slot], np.int32)):
            raise PointsError("No triangle would be left: three vertices not in line must stay.")
        for step in new:
            self._force(step)

    def move(self, slot: int, point: NDArray[np.float64]) -> None:
        """Move a vertex, and the lines with it.

        Raises
        ------
        PointsError
            If another vertex stands there, or no triangle would be left.
        LinesError
            If a line would cross another.
        """
        if (self._points.at(slot)[:2] != point[:2]).any():
            held = [step_of(slot, other) for other in self._mesh.fixed_neighbors(slot).tolist()]
            self._release(held)
            if not self._mesh.remove(np.array([slot], np.int32)):
                raise PointsError(
                    "The vertex cannot be moved while all others are in line: insert a point first."
                )
            found = self._mesh.put(slot, float(point[0]), float(point[1]))
            if found != slot:
                raise PointsError(
                    f"Vertex {int(self.numbers(np.array([found], np.int32))[0])} stands at "
                    f"x {point[0]:g}, y {point[1]:g} already: two vertices need two places."
                )
            self._join_step_at(slot)
            for step in held:
                self._force(step)
        self._points.put(slot, point)

    def set_z(self, slots: NDArray[np.int32], z: NDArray[np.float64]) -> None:
        """Give vertices other heights."""
        heights = np.broadcast_to(z, len(slots)).tolist()
        for slot, height in zip(slots.tolist(), heights, strict=True):
            self._set_height(slot, height)

    def _set_height(self, slot: int, height: float) -> None:
        point = self._points.at(slot).copy()
        point[2] = height
        self._points.put(slot, point)

    # -------------------------------------------------------------------- lines

    def flip(self, a: int, b: int) -> None:
        """Swap the diagonal of the two triangles at an edge, and keep it as a soft breakline.

        Raises
        ------
        PointsError
            If there is no such inner edge, or the two triangles are no convex quadrilateral.
        LinesError
            If it is the edge of a line.
        """
        beside = self._mesh.corners_beside(a, b).tolist()
        if not beside:
            raise PointsError("Only an edge between two triangles can be flipped.")
        own = self._chains.lines_of_step(step_of(a, b)) if self._chains else []
        if own:
            if not all(self._infos[line].name == FLIP for line in own):
                raise LinesError("The edge is one of a line, which must stay.")
            for line in own:
                self._drop_line(line)
            return
        left, right = beside
        quad = np.ascontiguousarray(self._points.take([a, right, b, left])[:, :2])
        following = np.roll(quad, -1, axis=0), np.roll(quad, -2, axis=0)
        if _kernel.orientation(quad, *following).min() <= 0:
            raise PointsError("The two triangles at the edge are no convex quadrilateral.")
        line = self._new_line(LineInfo("soft", self._next_source(), FLIP))
        self._add_chain(line, [left, right])

    def add_line(self, xyz: NDArray[np.float64], info: LineInfo, *, splits: bool) -> list[str]:
        """Add a breakline with heights; return what it met, a sentence each.

        Raises
        ------
        LinesError
            If it crosses another and ``splits`` is false.
        """
        slots = self._insert(xyz, "last")
        line = self._new_line(info._replace(source=self._next_source()))
        met: list[str] = []
        way = [int(slots[0])]
        ahead = [int(slot) for slot in slots[:0:-1]]
        for _ in range(_MOST_CROSSINGS):
            if not ahead:
                self._chains.add(line, way)
                return met
            crossing = self._first_crossing(way[-1], ahead[-1])
            if crossing is None:
                self._extend(way, ahead.pop())
            else:
                ahead.append(self._cross(line, way, ahead[-1], crossing, splits, met))
        raise LinesError("The line crosses others at too many places.")

    def _extend(self, way: list[int], to: int) -> None:
        """Go on to a vertex, where nothing is in the way but vertices."""
        if way[-1] == to:
            return
        passed, blocked = self._mesh.force(as_pairs([(way[-1], to)]))
        if len(blocked):
            raise LinesError("A line would cross another one where they have no vertex.")
        way += [*passed[1::2].tolist(), to]

    def remove_line(self, source: int) -> None:
        """Remove a breakline; its vertices stay as points.

        Raises
        ------
        LinesError
            If there is no such breakline.
        """
        lines = [
            line
            for line, info in enumerate(self._infos)
            if info.kind in ("hard", "soft") and info.source == source
        ]
        chains = [chain for line in lines for chain in self._chains.of_line(line)]
        if not chains:
            raise LinesError(f"There is no breakline {source}.")
        for line in lines:
            self._drop_line(line)

    def _next_source(self) -> int:
        own = [info.source for info in self._infos if info.kind in ("hard", "soft")]
        return max(own, default=-1) + 1

    def _new_line(self, info: LineInfo) -> int:
        self._infos.append(info)
        return len(self._infos) - 1

    def _drop_line(self, line: int) -> None:
        for chain in self._chains.of_line(line):
            self._release(self._chains.drop(chain))

    def _add_chain(self, line: int, vertices: Sequence[int]) -> None:
        for step in self._chains.add(line, vertices):
            self._force(step)

    def _first_crossing(self, a: int, b: int) -> Step | None:
        met = self._mesh.crossed(np.array([[a, b]], np.int32), True)
        return (int(met[1]), int(met[2])) if len(met) else None

    def _cross(
        self, line: int, way: list[int], to: int, other: Step, splits: bool, met: list[str]
    ) -> int:
        """Make a vertex where the next step of a new line crosses one; return it."""
        c, d = other
        ends = self._points.take([way[-1], to, c, d])
        four = np.ascontiguousarray(ends[:, :2])
        pairs = np.array([[0, 1]], np.int32)
        place = _kernel.intersections(four, np.array([[0, 1], [2, 3]], np.int32), pairs)[0]
        own = _height_at(ends[:2], place)
        theirs = _height_at(ends[2:], place)
        rivals = self._chains.lines_of_step(step_of(c, d))
        highest = max((self._infos[rival].priority for rival in rivals), default=np.inf)
        taken = own if self._infos[line].priority > highest else theirs
        sentence = (
            f"crosses {'another line' if rivals else 'itself'} at x {place[0]:.6f}, "
            f"y {place[1]:.6f}: its height there is {own:g}, the other's {theirs:g}"
        )
        if not splits:
            raise LinesError(f'The breakline {sentence}; crossing="error" allows none.')
        met.append(f"The breakline {sentence}; {taken:g} was taken.")
        self._release([step_of(c, d)])
        slot = int(self._insert(np.array([[*place, taken]]), "first")[0])
        self._chains.split(step_of(c, d), slot)
        way[:] = with_middle(way, step_of(c, d), slot)
        for end in (c, d):
            self._force(step_of(end, slot))
        return slot

    # -------------------------------------------------------------------- edges

    def _release(self, steps: Sequence[Step]) -> None:
        if steps:
            self._mesh.release(as_pairs(steps))

    def _force(self, step: Step) -> None:
        """Fix the edges along a step; vertices on it are taken into its lines."""
        passed, blocked = self._mesh.force(as_pairs([step]))
        if len(blocked):
            raise LinesError("A line would cross another one where they have no vertex.")
        a, b = step
        for slot in passed[1::2].tolist():
            self._chains.split(step_of(a, b), slot)
            a = slot


def _merged_height(old: float, new: float, policy: str) -> float:
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
        "mean": min(old, new) + abs(old - new) / 2,
    }[policy]


def _without(vertices: list[int], gone: int) -> list[int]:
    """Return a chain without a vertex; a closed one stays closed."""
    rest = [vertex for vertex in vertices if vertex != gone]
    rest = [v for i, v in enumerate(rest) if i == 0 or rest[i - 1] != v]
    if vertices[0] == vertices[-1] and rest and rest[0] != rest[-1]:
        rest.append(rest[0])
    return rest


def _height_at(ends: NDArray[np.float64], place: NDArray[np.float64]) -> float:
    """Return the height on a step at a place near it."""
    whole, part = ends[1, :2] - ends[0, :2], place - ends[0, :2]
    share = min(max(float(part @ whole / (whole @ whole)), 0.0), 1.0)
    return float(ends[0, 2] + share * (ends[1, 2] - ends[0, 2]))
