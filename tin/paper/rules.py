"""The paper's rules for the third point of an edge: by the angle, by the distance, by both."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..predicates import Columns, in_circle

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array


class Choice(NamedTuple):
    """The point chosen, None if there is none, and the comparisons of points with circles."""

    point: int | None
    tests: int


Rule = Callable[[Columns, int, int, "Int64Array"], Choice]
"""Chooses the third point of an edge among the points qualified, all strictly left of it."""


def widest_angle(xy: Columns, p1: int, p2: int, qualified: Int64Array) -> Choice:
    """Choose the point that sees p1-p2 under the largest angle; of equals the first in the list.

    ``qualified`` are points strictly left of the edge, in ascending order. Whether P sees the edge
    under a larger angle than P' is whether P lies in the circle through p1, p2 and P'. Cotangents
    in doubles propose, exact tests decide.
    """
    widest = _find_widest(xy, p1, p2, qualified)
    return Choice(int(widest[0]) if len(widest) else None, max(len(qualified) - 1, 0))


def widest_angle_then_closest(xy: Columns, p1: int, p2: int, qualified: Int64Array) -> Choice:
    """Choose as :func:`widest_angle`; of equals the closest to p1-p2, of these the first.

    Points of one angle lie on one arc from p1 to p2. From either end up to its middle the distance
    to the edge grows, and so does that to its line: they order such points alike. Exact.
    """
    widest = _find_widest(xy, p1, p2, qualified).tolist()
    tests = max(len(qualified) - 1, 0)
    if len(widest) < 2:
        return Choice(widest[0] if widest else None, tests)
    return Choice(min(widest, key=lambda p: _measure_doubled_area(xy, p1, p2, p)), tests)


def _find_widest(xy: Columns, p1: int, p2: int, qualified: Int64Array) -> Int64Array:
    """Return the points that see p1-p2 under the largest angle, in the order of the list."""
    if len(qualified) == 0:
        return qualified
    cotangent = _measure_cotangents(xy, p1, p2, qualified)
    rivals = np.arange(len(qualified))
    while len(rivals):
        best = rivals[np.argmin(cotangent[rivals])]
        # points see p1-p2 under a wider angle than the best (+1), the same (0), or a narrower one
        others = np.delete(qualified, best)
        first, second, third = (np.full(len(others), p) for p in (p1, p2, qualified[best]))
        side = in_circle(xy, first, second, third, others)
        side = np.insert(side, best, 0)
        rivals = np.flatnonzero(side > 0)
    widest: Int64Array = qualified[side == 0]
    return widest


def _measure_doubled_area(xy: Columns, *corners: int) -> Fraction:
    """Return twice the area of a triangle: of several on one edge, the distances to its line."""
    (ax, bx, cx), (ay, by, cy) = (
        [Fraction(float(column[corner])) for corner in corners] for column in xy
    )
    return abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def closest_in_circle(xy: Columns, p1: int, p2: int, qualified: Int64Array) -> Choice:
    """Choose the point closest to p1-p2 in the circle whose diameter it is, or on it.

    The perpendicular from a point of that circle meets the edge itself, so the distances to the
    edge and to its line are the same. Of equals the first in the list is chosen; in doubles, as
    coordinates are given.
    """
    (ax, ay), (bx, by) = _measure_offsets(xy, p1, qualified), _measure_offsets(xy, p2, qualified)
    distance = np.abs(ax * by - ay * bx)
    is_in_circle = ax * bx + ay * by <= 0
    tests = len(qualified)
    if not is_in_circle.any():
        return Choice(None, tests)
    distance[~is_in_circle] = np.inf
    return Choice(int(qualified[np.argmin(distance)]), tests)


def closest_in_circle_or_widest_angle(
    xy: Columns, p1: int, p2: int, qualified: Int64Array
) -> Choice:
    """Choose as :func:`closest_in_circle`; if the circle is empty as :func:`widest_angle`."""
    in_circle = closest_in_circle(xy, p1, p2, qualified)
    if in_circle.point is not None:
        return in_circle
    anywhere = widest_angle(xy, p1, p2, qualified)
    return Choice(anywhere.point, in_circle.tests + anywhere.tests)


def _measure_cotangents(xy: Columns, p1: int, p2: int, points: Int64Array) -> Float64Array:
    """Cotangents of the angles under which points see p1-p2; a point nearly on it sees most."""
    (ax, ay), (bx, by) = _measure_offsets(xy, p1, points), _measure_offsets(xy, p2, points)
    cross = np.abs(ax * by - ay * bx)
    dot = ax * bx + ay * by
    flat = np.copysign(np.inf, dot)
    cotangent: Float64Array = np.divide(dot, cross, out=flat, where=cross > 0)
    return cotangent


def _measure_offsets(xy: Columns, origin: int, points: Int64Array) -> Columns:
    x, y = xy
    return x[points] - x[origin], y[points] - y[origin]
