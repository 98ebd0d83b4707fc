"""Descent: drops followed down a surface, all of them a step at a time."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...tin.topology import NO_NEIGHBOR, HalfEdges, find_boundary_vertices, sort_half_edges
from .falls import FINEST, measure_fall, round_share
from .vertices import NOWHERE, find_exits, sort_edges_at

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int64Array
    from .falls import Falls
    from .filling import Filling
    from .vertices import Exits

MOVING, PIT, FLAT, BOUNDARY = range(4)
"""How a drop fares: on its way, or ended; at a vertex or an edge that nothing descends from."""

_ROUNDING = 16 * 2.0**-53
"""Relative error of an elevation between two vertices, as doubles have it."""
_CLOSE = 1e-9
"""Shares of an edge that differ by less are compared in fractions."""


class Drops(NamedTuple):
    """Where drops are: at a vertex, or on an edge about to enter a triangle."""

    vertices: Int64Array
    """(k,), ``NOWHERE`` for drops on an edge."""
    triangles: Int64Array
    edges: Int64Array
    """Both (k,), the triangle that is entered, and across which of its edges."""
    shares: Float64Array
    """(k,), of that edge, from its start to the drop."""
    targets: Int64Array
    """(k,), the lower end of an edge that is followed, else ``NOWHERE``."""
    ends: Int8Array
    """(k,), ``MOVING``, or how they ended; one that ended on an edge is in the triangle before."""

    def choose(self, rows: Int64Array) -> Drops:
        """Return some of them."""
        return Drops._make(array[rows] for array in self)

    def put(self, rows: Any, found: Drops) -> None:
        """Write over some of them."""
        columns: tuple[Any, ...] = self
        for whole, part in zip(columns, found, strict=True):
            whole[rows] = part


def interpolate_edges(start: Float64Array, end: Float64Array, share: Float64Array) -> Float64Array:
    """Return places on edges, counted from the nearer end: the same for the edge in reverse."""
    step = end - start
    return np.where(share <= 0.5, start + share * step, end - (1.0 - share) * step)


def make_drops(count: int) -> Drops:
    """Return drops that are nowhere yet."""
    vertices, triangles, edges, targets = (np.full(count, NOWHERE) for _ in range(4))
    return Drops(vertices, triangles, edges, np.zeros(count), targets, np.zeros(count, np.int8))


class Walker:
    """Moves drops down a surface, on a filled one over its water.

    ``vertices`` are those that drops can leave, by default all; what is on an edge goes where it
    likes.

    Notes
    -----
    1. From a vertex a drop takes its exit (:func:`tinsmith.terrain.hydrology.vertices.find_exits`).
    2. In a triangle it follows the fall line. Whether that passes the corner opposite on the left
       or on the right is decided exactly; the place where it meets the edge is rounded once, and
       never to where it would not be lower than before. So every step descends, and ends.
    3. At an edge it enters the triangle beyond if that one falls away from the edge. Otherwise the
       edge is a channel, which it follows to the lower end.

    On a filled surface it goes on across water and level ground by its vertices. No drop ends there
    but at the boundary.
    """

    def __init__(
        self,
        falls: Falls,
        filling: Filling | None = None,
        vertices: Int64Array | None = None,
    ) -> None:
        self.falls, self.filling = falls, filling
        self.is_boundary = find_boundary_vertices(
            falls.triangles, falls.neighbors, len(falls.points)
        )
        self._level = falls.is_level
        self._vertices = vertices

    @cached_property
    def _half_edges(self) -> HalfEdges:
        """By start, of the triangles at the vertices that drops can leave."""
        triangles, count = self.falls.triangles, len(self.falls.points)
        if self._vertices is None:
            return sort_half_edges(triangles, count)
        return sort_edges_at(triangles, self._vertices, count)

    def step(self, drops: Drops) -> Drops:
        """Return drops, all of them moving, where they are after one step."""
        at_vertex = np.flatnonzero(drops.vertices != NOWHERE)
        on_edge = np.flatnonzero((drops.vertices == NOWHERE) & (drops.targets == NOWHERE))
        moved = make_drops(len(drops.vertices))
        moved.put(at_vertex, self._leave_vertices(drops.vertices[at_vertex]))
        moved.put(on_edge, self._cross_triangles(drops.choose(on_edge)))
        follows = drops.targets != NOWHERE
        moved.vertices[follows] = drops.targets[follows]
        return moved

    def locate(self, drops: Drops) -> Float64Array:
        """Return where drops are, (k, 3)."""
        points = self.falls.points
        at_vertex = drops.vertices != NOWHERE
        xyz = points[np.where(at_vertex, drops.vertices, 0)]
        on_edge = np.flatnonzero(~at_vertex)
        start, end = self.falls.ends(drops.triangles[on_edge], drops.edges[on_edge])
        share = drops.shares[on_edge, None]
        xyz[on_edge] = interpolate_edges(points[start], points[end], share)
        return xyz

    def runs_level(self, drops: Drops) -> BoolArray:
        """Tell which drops go on over level ground of a filled surface."""
        filling = self.filling
        if filling is None:
            return np.zeros(len(drops.vertices), np.bool_)
        at_vertex = drops.vertices != NOWHERE
        goes = np.where(at_vertex, filling.nexts[drops.vertices], drops.targets)
        start, end = self.falls.ends(drops.triangles, drops.edges)
        start = np.where(at_vertex | (drops.triangles == NOWHERE), goes, start)
        end = np.where(at_vertex | (drops.triangles == NOWHERE), goes, end)
        z = self.falls.points[:, 2]
        is_level: BoolArray = (goes != NOWHERE) & (z[start] == z[end])
        return is_level

    # ------------------------------------------------------------------ from vertices

    def _leave_vertices(self, vertices: Int64Array) -> Drops:
        exits = self.find_exits(vertices)
        moved = make_drops(len(vertices))
        moved.vertices[:] = np.where(exits.vertices == NOWHERE, vertices, exits.vertices)
        stays = (exits.vertices == NOWHERE) & (exits.triangles == NOWHERE)
        moved.ends[stays] = np.where(exits.leaves[stays], BOUNDARY, PIT)
        rows = np.flatnonzero((exits.triangles != NOWHERE) & ~exits.leaves)
        triangles = exits.triangles[rows]
        edges = np.argmax(self.falls.triangles[triangles] == vertices[rows][:, None], axis=1)
        shares = self.falls.shares(triangles, edges)
        moved.put(rows, self.arrive(triangles, edges, shares))
        return moved

    def find_exits(self, vertices: Int64Array) -> Exits:
        """Find the way of water from vertices."""
        if self.filling is None:
            return find_exits(self.falls, self._half_edges, vertices, self.is_boundary)
        found = find_exits(
            self.falls, self._half_edges, vertices, self.is_boundary, self.filling.levels
        )
        crosses = self.filling.nexts[vertices] != NOWHERE
        found.vertices[crosses] = self.filling.nexts[vertices[crosses]]
        found.triangles[crosses], found.leaves[crosses] = NOWHERE, False
        return found

    # ------------------------------------------------------------------ in triangles

    def _cross_triangles(self, drops: Drops) -> Drops:
        """Follow the fall line from an edge of a triangle to another one."""
        triangles, edges, shares = drops.triangles, drops.edges, drops.shares
        signs = self.falls.signs[triangles]
        two = (signs > 0).sum(axis=1) == 2
        out, found = np.empty_like(edges), np.empty_like(shares)
        vertices = np.full(len(edges), NOWHERE)
        one = np.flatnonzero(~two)
        out[one], found[one] = self._follow_to_one(triangles[one], edges[one], shares[one])
        both = np.flatnonzero(two)
        out[both], found[both], vertices[both] = self._follow_to_two(
            triangles[both], edges[both], shares[both]
        )
        found = self._require_descent(drops, out, found)
        moved = self.arrive(triangles, out, found)
        hit = vertices != NOWHERE
        moved.vertices[hit], moved.targets[hit], moved.ends[hit] = vertices[hit], NOWHERE, MOVING
        return moved

    def _follow_to_one(
        self, triangles: Int64Array, edges: Int64Array, shares: Float64Array
    ) -> tuple[Int64Array, Float64Array]:
        """Where one edge drains, all fall lines go there."""
        out = np.argmax(self.falls.signs[triangles] > 0, axis=1)
        split = self.falls.shares(triangles, out)
        found = np.where(edges == (out + 1) % 3, 1.0 - shares * (1.0 - split), split * (1 - shares))
        return out, found

    def _follow_to_two(
        self, triangles: Int64Array, edges: Int64Array, shares: Float64Array
    ) -> tuple[Int64Array, Float64Array, Int64Array]:
        """Where two drain, the fall line through the corner between them parts the others."""
        split = self.falls.shares(triangles, edges)
        side = np.sign(shares - split)
        for row in np.flatnonzero(np.abs(shares - split) <= _CLOSE).tolist():
            side[row] = self._compare(int(triangles[row]), int(edges[row]), float(shares[row]))
        vertices = np.where(side == 0, self.falls.triangles[triangles, edges], NOWHERE)
        out = np.where(side < 0, (edges + 2) % 3, (edges + 1) % 3)
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.where(side < 0, 1.0 - shares / split, (1.0 - shares) / (1.0 - split))
        return out, np.clip(np.nan_to_num(found), 0.0, 1.0), vertices.astype(np.int64)

    def _compare(self, triangle: int, edge: int, share: float) -> int:
        """Tell on which side of the fall line through the corner opposite a share lies, exactly."""
        whole, part = (self._measure(triangle, (edge + turn) % 3) for turn in (0, 2))
        split = -part / whole
        found = Fraction(share)
        return 0 if share == round_share(float(split)) else 1 if found > split else -1

    def _measure(self, triangle: int, edge: int) -> Fraction:
        a, b, c = (int(self.falls.triangles[triangle, (edge + k) % 3]) for k in (1, 2, 0))
        return measure_fall(self.falls.points, a, b, c)

    # ------------------------------------------------------------------ that it descends

    def _require_descent(self, drops: Drops, out: Int64Array, found: Float64Array) -> Float64Array:
        """Return shares of the edges reached, all lower than before."""
        found = round_share(found)
        before, size = self._interpolate(drops.triangles, drops.edges, drops.shares)
        after, other = self._interpolate(drops.triangles, out, found)
        doubtful = before - after <= _ROUNDING * np.maximum(size, other)
        for row in np.flatnonzero(doubtful).tolist():
            triangle = int(drops.triangles[row])
            level = self._find_elevation(triangle, int(drops.edges[row]), float(drops.shares[row]))
            found[row] = self._lower(triangle, int(out[row]), float(found[row]), level)
        return found

    def _interpolate(
        self, triangles: Int64Array, edges: Int64Array, shares: Float64Array
    ) -> tuple[Float64Array, Float64Array]:
        low, high = (self.falls.points[end, 2] for end in self.falls.ends(triangles, edges))
        return low + shares * (high - low), np.maximum(np.abs(low), np.abs(high))

    def _find_elevation(self, triangle: int, edge: int, share: float) -> Fraction:
        ends = (int(self.falls.triangles[triangle, (edge + k) % 3]) for k in (1, 2))
        low, high = (Fraction(float(self.falls.points[end, 2])) for end in ends)
        return low + Fraction(share) * (high - low)

    def _lower(self, triangle: int, edge: int, share: float, level: Fraction) -> float:
        """Return the nearest share whose elevation is below a level."""
        ends = (int(self.falls.triangles[triangle, (edge + k) % 3]) for k in (1, 2))
        low, high = (Fraction(float(self.falls.points[end, 2])) for end in ends)
        if low == high or low + Fraction(share) * (high - low) < level:
            return share
        limit = (level - low) / (high - low)  # of the share at which the level is met
        rounded, step = float(round_share(float(limit))), -FINEST if low < high else FINEST
        while not low + Fraction(rounded) * (high - low) < level and 0.0 < rounded < 1.0:
            rounded += step
        return rounded

    # ------------------------------------------------------------------ at edges

    def arrive(self, triangles: Int64Array, edges: Int64Array, shares: Float64Array) -> Drops:
        """Return drops that come to an edge from within a triangle."""
        falls = self.falls
        moved = make_drops(len(edges))
        start, end = falls.ends(triangles, edges)
        other, its_edge = falls.cross(triangles, edges)
        beyond = np.where(other == NO_NEIGHBOR, np.int8(0), falls.signs[other, its_edge])
        z = falls.points[:, 2]
        lower = self._choose_end(start, end)
        enters = (beyond < 0) & (shares > 0.0) & (shares < 1.0)
        moved.triangles[:] = np.where(enters, other, triangles)
        moved.edges[:] = np.where(enters, its_edge, edges)
        moved.shares[:] = np.where(enters, 1.0 - shares, shares)
        stops = (z[start] == z[end]) | self._level[other]
        if self.filling is None:
            moved.ends[~enters & stops] = FLAT
        moved.ends[other == NO_NEIGHBOR] = BOUNDARY
        follows = ~enters & (moved.ends == MOVING)
        moved.targets[follows] = lower[follows]
        for share, vertex in ((0.0, start), (1.0, end)):
            hit = shares == share
            moved.vertices[hit], moved.targets[hit] = vertex[hit], NOWHERE
            moved.ends[hit] = MOVING
        return moved

    def _choose_end(self, start: Int64Array, end: Int64Array) -> Int64Array:
        """Return to which end of an edge water runs."""
        z = self.falls.points[:, 2]
        lower = np.where(z[start] < z[end], start, end)
        if self.filling is None:
            return lower
        is_level = self.filling.levels[start] == self.filling.levels[end]
        return np.where(is_level, self.filling.choose_way(start, end), lower)
