"""Corners of Voronoi cells in whole numbers: exact until they are rounded, once, at the end.

Coordinates in doubles become whole numbers by one common power of two, so that half-planes, their
corners (homogeneous: X, Y, W) and every comparison of them are exact in Python's own integers. A
corner's coordinates are the doubles nearest to the true ones; whoever computes them, from whichever
cells, finds the same doubles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import Float64Array, Int32Array
    from ...base.types import Bounds

_MANTISSA_BITS = 53

Point = tuple[int, int]
Corner = tuple[int, int, int]


class HalfPlane(NamedTuple):
    """The places with ``a x + b y <= c``; (a, b) points out of it."""

    a: int
    b: int
    c: int

    def holds(self, corner: Corner) -> bool:
        """Tell whether a corner lies strictly inside."""
        x, y, w = corner
        return self.a * x + self.b * y < self.c * w

    def meet(self, following: HalfPlane) -> Corner:
        """Return where the border meets that of the next half-plane counter-clockwise."""
        a, b, c = self
        d, e, f = following
        return c * e - f * b, a * f - d * c, a * e - d * b


class ExactPlane:
    """Places, (n, 2), and a box that holds them all, in whole numbers."""

    def __init__(self, xy: Float64Array, box: Bounds) -> None:
        self._mantissas, self._exponents = np.frexp(xy)
        walls = np.array([[box.xmin, box.ymin], [box.xmax, box.ymax]])
        mantissas, exponents = np.frexp(walls)
        lowest = min(int(self._exponents.min()), int(exponents.min()))
        self._shift = _MANTISSA_BITS - lowest
        self._lowest = lowest
        self._points: dict[int, Point] = {}
        self._low, self._high = (
            self._scale_to_whole(*row) for row in zip(mantissas, exponents, strict=True)
        )

    def point(self, vertex: int) -> Point:
        """Return a vertex's coordinates in whole numbers."""
        known = self._points.get(vertex)
        if known is None:
            known = self._scale_to_whole(self._mantissas[vertex], self._exponents[vertex])
            self._points[vertex] = known
        return known

    def _scale_to_whole(self, mantissas: Float64Array, exponents: Int32Array) -> Point:
        x, y = (
            int(mantissa * 2**_MANTISSA_BITS) << (exponent - self._lowest if mantissa else 0)
            for mantissa, exponent in zip(mantissas.tolist(), exponents.tolist(), strict=True)
        )
        return x, y

    def centre(self, a: int, b: int, c: int) -> tuple[float, float] | None:
        """Return the circumcentre of a triangle, counter-clockwise; None if not within the box."""
        origin = self.point(a)
        sides = (_bisect(origin, self.point(vertex)) for vertex in (b, c))
        corner = next(sides).meet(next(sides))
        is_inside = all(wall.holds(corner) for wall in self._find_walls(origin))
        return self._round(origin, corner) if is_inside else None

    def cell(self, vertex: int, neighbors: Iterable[int]) -> list[tuple[float, float]]:
        """Return the corners of a vertex's cell within the box, counter-clockwise.

        ``neighbors`` are those of the Delaunay triangulation, counter-clockwise.
        """
        origin = self.point(vertex)
        sides = [_bisect(origin, self.point(other)) for other in neighbors]
        corners = _intersect(_sort_by_direction(sides, self._find_walls(origin)))
        return [self._round(origin, corner) for corner in corners]

    def _find_walls(self, origin: Point) -> tuple[HalfPlane, ...]:
        x, y = origin
        return (
            HalfPlane(1, 0, self._high[0] - x),
            HalfPlane(0, 1, self._high[1] - y),
            HalfPlane(-1, 0, x - self._low[0]),
            HalfPlane(0, -1, y - self._low[1]),
        )

    def _round(self, origin: Point, corner: Corner) -> tuple[float, float]:
        """Return the nearest doubles; dividing whole numbers rounds once, to nearest."""
        x, y, w = corner
        divisor, factor = w, 1
        if self._shift >= 0:
            divisor = w << self._shift
        else:
            factor = 1 << -self._shift
        return (origin[0] * w + x) * factor / divisor, (origin[1] * w + y) * factor / divisor


def _bisect(origin: Point, other: Point) -> HalfPlane:
    """Return the places nearer to the origin than to another, relative to the origin."""
    x, y = other[0] - origin[0], other[1] - origin[1]
    return HalfPlane(2 * x, 2 * y, x * x + y * y)


def _intersect(half_planes: list[HalfPlane]) -> list[Corner]:
    """Intersect half-planes that hold (0, 0) and have a bounded part of some area in common.

    They come sorted by direction. Each drops those before it that it makes needless, and then the
    last and the first do so to each other: a queue open at both ends. What only touches the common
    part, in a corner, is dropped, too.
    """
    kept: list[HalfPlane] = []
    corners: list[Corner] = []  # each of a half-plane with the one before
    first = 0
    for new in half_planes:
        while len(corners) > first and not new.holds(corners[-1]):
            kept.pop()
            corners.pop()
        while len(corners) > first and not new.holds(corners[first]):
            first += 1
        if kept:
            corners.append(kept[-1].meet(new))
        kept.append(new)
    while len(corners) > first + 1 and not kept[first].holds(corners[-1]):
        kept.pop()
        corners.pop()
    while len(corners) > first + 1 and not kept[-1].holds(corners[first]):
        first += 1
    return [*corners[first:], kept[-1].meet(kept[first])]


def _sort_by_direction(sides: list[HalfPlane], walls: Iterable[HalfPlane]) -> list[HalfPlane]:
    """Return all by direction, from west on; of a side and a wall in one direction the narrower.

    Sides come counter-clockwise, of different directions, the first one any.
    """
    octants = [_find_octant(side) for side in sides]
    begin = next((k for k in range(1, len(sides)) if octants[k] < octants[k - 1]), 0)
    by_octant: list[list[HalfPlane]] = [[] for _ in range(8)]
    for k in range(begin - len(sides), begin):
        by_octant[octants[k]].append(sides[k])
    for wall in walls:
        row = by_octant[_find_octant(wall)]
        if not row or wall.c * abs(row[0].a + row[0].b) < row[0].c:
            row[:] = [wall]
    return [one for row in by_octant for one in row]


def _find_octant(one: HalfPlane) -> int:
    """Return 0 for west, 2 for south, 4 for east, 6 for north, and odd numbers between them."""
    a, b, _ = one
    if b == 0:
        return 0 if a < 0 else 4
    if a == 0:
        return 2 if b < 0 else 6
    if b < 0:
        return 1 if a < 0 else 3
    return 5 if a > 0 else 7
