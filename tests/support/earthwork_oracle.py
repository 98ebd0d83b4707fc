"""Cut and fill between two TINs in fractions: every triangle of one against every one of the other.

Independent of the kernel: polygons are clipped by half-planes and integrated, nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

Place = tuple[Fraction, Fraction, Fraction]
"""Easting, northing, and the difference of the elevations."""


@dataclass
class Exact:
    """Areas and volumes, and the integral of the squared difference."""

    area: Fraction = Fraction(0)
    cut_area: Fraction = Fraction(0)
    fill_area: Fraction = Fraction(0)
    cut: Fraction = Fraction(0)
    fill: Fraction = Fraction(0)
    squares: Fraction = Fraction(0)

    def values(self) -> list[Fraction]:
        return [getattr(self, field.name) for field in fields(self)]


def exact_volume(tin: Any, other: Any) -> Exact:
    """Integrate ``other`` minus ``tin`` where both are."""
    total = Exact()
    ours, theirs = corners_of(tin), corners_of(other)
    low, high = boxes_of(other)
    for one, lowest, highest in zip(ours, *boxes_of(tin), strict=True):
        near = ((low < highest) & (high > lowest)).all(axis=1)  # the others share no area
        for k in np.flatnonzero(near).tolist():
            add_cell(total, one, theirs[k])
    return total


def boxes_of(tin: Any) -> tuple[Any, Any]:
    """Return the least and the largest coordinates of each triangle."""
    corners = tin.points[tin.triangles, :2]
    return corners.min(axis=1), corners.max(axis=1)


def exact_heights(tin: Any, height: Any) -> Exact:
    """Integrate a linear function of (x, y, z) over each triangle of a TIN."""
    total = Exact()
    for one in corners_of(tin):
        add_polygon(total, [(x, y, height(x, y, z)) for x, y, z in one])
    return total


def corners_of(tin: Any) -> list[list[Place]]:
    return [
        [tuple(map(Fraction, point)) for point in tin.points[corners].tolist()]  # type: ignore[misc]
        for corners in tin.triangles
    ]


def add_cell(total: Exact, one: list[Place], two: list[Place]) -> None:
    cell = [(x, y) for x, y, _ in one]
    for a, b in pairwise([*two, two[0]]):
        cell = clip(cell, lambda p, a=a, b=b: side(a, b, p))  # type: ignore[misc]
    if len(cell) >= 3:
        add_polygon(total, [(x, y, plane(two, x, y) - plane(one, x, y)) for x, y in cell])


def add_polygon(total: Exact, cell: list[Place]) -> None:
    total.area += area(cell)
    total.squares += integral(cell, squared=True)
    above, below = clip(cell, lambda p: p[2]), clip(cell, lambda p: -p[2])
    for part, sign in ((above, 1), (below, -1)):
        if len(part) < 3 or all(p[2] == 0 for p in part):
            continue
        name = "fill" if sign > 0 else "cut"
        setattr(total, f"{name}_area", getattr(total, f"{name}_area") + area(part))
        setattr(total, name, getattr(total, name) + sign * integral(part))


def clip(polygon: list[Any], value: Any) -> list[Any]:
    """Keep the part of a convex polygon where a linear function is not negative."""
    kept = []
    for p, q in pairwise([*polygon, *polygon[:1]]):
        at_p, at_q = value(p), value(q)
        if at_p >= 0:
            kept.append(p)
        if at_p * at_q < 0:
            share = at_p / (at_p - at_q)
            kept.append(tuple(a + share * (b - a) for a, b in zip(p, q, strict=True)))
    return kept


def side(a: Any, b: Any, p: Any) -> Fraction:
    return Fraction((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]))


def plane(corners: list[Place], x: Fraction, y: Fraction) -> Fraction:
    a, b, c = corners
    whole = side(a, b, c)
    weights = side(b, c, (x, y)), side(c, a, (x, y)), side(a, b, (x, y))
    return sum((w * p[2] for w, p in zip(weights, corners, strict=True)), Fraction(0)) / whole


def area(polygon: list[Any]) -> Fraction:
    return sum((side(polygon[0], p, q) for p, q in pairwise(polygon)), Fraction(0)) / 2


def integral(polygon: list[Place], *, squared: bool = False) -> Fraction:
    total = Fraction(0)
    for p, q in pairwise(polygon[1:]):
        a, b, c = polygon[0][2], p[2], q[2]
        doubled = side(polygon[0], p, q)
        if squared:
            total += doubled * (a * a + b * b + c * c + a * b + b * c + c * a) / 12
        else:
            total += doubled * (a + b + c) / 6
    return total
