"""Profiles in fractions: every break of a segment over triangles, by brute force."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

Place = tuple[Fraction, Fraction]
Corner = tuple[Fraction, Fraction, Fraction]


class Row(NamedTuple):
    """A break: its place, its elevation if there is surface, whether surface goes on after it."""

    ratio: Fraction
    x: Fraction
    y: Fraction
    elevation: Fraction | None
    goes_on: bool


def exact_rows(tin: Any, start: Any, end: Any) -> list[Row]:
    """Return the breaks of a segment, its ends among them."""
    a, b = _place(start), _place(end)
    corners = [tuple(_exact(row) for row in tin.points[list(t)]) for t in tin.triangles.tolist()]
    ratios = {Fraction(0), Fraction(1)}
    for triangle in corners:
        for p, q in pairwise((*triangle, triangle[0])):
            ratios |= {t for t in _meets(a, b, p, q) if 0 <= t <= 1}
    ordered = sorted(ratios)
    rows = []
    for k, t in enumerate(ordered):
        x, y = _at(a, b, t)
        middle = _at(a, b, (t + ordered[k + 1]) / 2) if k + 1 < len(ordered) else None
        goes_on = middle is not None and _elevation(corners, middle) is not None
        rows.append(Row(t, x, y, _elevation(corners, (x, y)), goes_on))
    return rows


def elevation_at(tin: Any, x: float, y: float) -> Fraction | None:
    """Return the exact elevation at a place, None outside."""
    corners = [tuple(_exact(row) for row in tin.points[list(t)]) for t in tin.triangles.tolist()]
    return _elevation(corners, (Fraction(x), Fraction(y)))


def _exact(row: Any) -> Corner:
    x, y, z = (Fraction(float(value)) for value in row)
    return x, y, z


def _place(given: Any) -> Place:
    return Fraction(float(given[0])), Fraction(float(given[1]))


def _at(a: Place, b: Place, t: Fraction) -> Place:
    return a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])


def _side(a: Any, b: Any, c: Any) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _meets(a: Place, b: Place, p: Any, q: Any) -> list[Fraction]:
    """Return where a-b meets p-q, both ends of what they share."""
    at_p, at_q = _side(a, b, p), _side(a, b, q)
    if at_p == 0 and at_q == 0:
        return [_share(a, b, p), _share(a, b, q)]
    if at_p * at_q > 0:
        return []
    t = at_p / (at_p - at_q)
    return [_share(a, b, (p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))]


def _share(a: Place, b: Place, p: Any) -> Fraction:
    axis = 0 if a[0] != b[0] else 1
    return (p[axis] - a[axis]) / (b[axis] - a[axis])


def _elevation(corners: list[Any], p: Place) -> Fraction | None:
    for u, v, w in corners:
        weights = _side(v, w, p), _side(w, u, p), _side(u, v, p)
        if min(weights) >= 0:
            total = sum(weights)
            return (
                sum((m * c[2] for m, c in zip(weights, (u, v, w), strict=True)), Fraction(0))
                / total
            )
    return None
