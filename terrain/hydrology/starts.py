"""Starts: from a place anywhere on a surface to the first edge or vertex, exactly."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ..surface import cross_exactly
from .descent import FLAT, MOVING, Drops, Walker, make_drops
from .falls import measure_fall, round_share

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import TIN

_Place: TypeAlias = tuple[Fraction, Fraction]


def place_drops(tin: TIN, walker: Walker, xy: Float64Array) -> Drops:
    """Return drops at the first edge or vertex that they come to from places, (k, 2), on a TIN.

    What cannot move from where it is, on a level triangle or edge, has no triangle.
    """
    drops = make_drops(len(xy))
    triangles = tin.locate(xy).tolist()
    for row, (place, triangle) in enumerate(zip(xy.tolist(), triangles, strict=True)):
        start = _Start(walker, (Fraction(place[0]), Fraction(place[1])), triangle)
        drops.put(slice(row, row + 1), start.find_drop())
    return drops


class _Start:
    """A place in a triangle, its edges and corners included."""

    def __init__(self, walker: Walker, place: _Place, triangle: int) -> None:
        self._walker, self._place, self._triangle = walker, place, triangle
        falls = walker.falls
        self._corners = falls.triangles[triangle].tolist()
        self._points = [
            (Fraction(x), Fraction(y)) for x, y, _ in falls.points[self._corners].tolist()
        ]
        self._areas = [
            _turn(self._points[(k + 1) % 3], self._points[(k + 2) % 3], place) for k in range(3)
        ]

    def find_drop(self) -> Drops:
        """Return the one drop that falls here."""
        drop = make_drops(1)
        on = [k for k in range(3) if self._areas[k] == 0]
        if len(on) == 2:
            drop.vertices[0] = self._corners[3 - sum(on)]
            return drop
        return self._start_on_edge(drop, on[0]) if on else self._start_inside(drop)

    def _start_inside(self, drop: Drops) -> Drops:
        """Follow the fall line to the edge where it leaves the triangle."""
        signs = self._walker.falls.signs[self._triangle].tolist()
        if not any(signs):
            filling = self._walker.filling
            if filling is None:
                drop.ends[0] = FLAT
            else:
                drop.targets[:] = filling.choose_way(*np.array(self._corners)[:, None])
            return drop
        values = [self._measure(k) for k in range(3)]
        for k in range(3):
            if signs[k] <= 0:
                continue
            share = self._find_share(k, values)
            if 0 <= share <= 1:
                edge, rounded = k, round_share(float(share))
        return self._walker.arrive(*(np.array([one]) for one in (self._triangle, edge, rounded)))

    def _find_share(self, k: int, values: list[Fraction]) -> Fraction:
        """Return where the fall line meets the line of edge k, from corner k + 1 on.

        Along a fall line the share of corner k + 2 changes as ``values[k + 2]`` does, that of
        corner k as ``values[k]``, which becomes 0 there.
        """
        own, after = self._areas[k], self._areas[(k + 2) % 3]
        return (after - own * values[(k + 2) % 3] / values[k]) / sum(self._areas)

    def _start_on_edge(self, drop: Drops, k: int) -> Drops:
        """Enter the triangle that falls away from the edge, the steeper one, or follow the edge."""
        falls = self._walker.falls
        triangle, edge = np.array([self._triangle]), np.array([k])
        other, its_edge = falls.cross(triangle, edge)
        share = round_share(float(self._areas[(k + 2) % 3] / sum(self._areas)))
        if share in (0.0, 1.0):
            drop.vertices[0] = self._corners[(k + (1 if share == 0.0 else 2)) % 3]
            return drop
        sides = [(self._triangle, k, share)]
        if other[0] >= 0:
            sides.append((int(other[0]), int(its_edge[0]), 1.0 - share))
        away = [side for side in sides if falls.signs[side[0], side[1]] < 0]
        if away:
            chosen = max(away, key=lambda side: self._rate(*side[:2]))
            drop.triangles[0], drop.edges[0], drop.shares[0] = chosen
            return drop
        moved = self._walker.arrive(triangle, edge, np.array([share]))
        if moved.ends[0] != MOVING:
            drop.ends[0] = moved.ends[0]
            return drop
        return moved

    def _measure(self, k: int) -> Fraction:
        a, b, c = (self._corners[(k + turn) % 3] for turn in (1, 2, 0))
        return measure_fall(self._walker.falls.points, a, b, c)

    def _rate(self, triangle: int, edge: int) -> tuple[bool, Fraction]:
        """Return what makes a triangle below an edge the better way: no level water, steepness."""
        falls, filling = self._walker.falls, self._walker.filling
        apex, *ends = falls.triangles[triangle, [edge, edge - 2, edge - 1]].tolist()
        is_water = filling is not None and len(set(filling.levels[[apex, *ends]].tolist())) == 1
        east, north, area = cross_exactly(falls.points[falls.triangles[triangle]])
        return not is_water, (east * east + north * north) / area**2


def _turn(p: _Place, q: _Place, r: _Place) -> Fraction:
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
