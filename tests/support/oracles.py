"""Second opinions for the tests: slow, plain, exact, and written without the code under test."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

import numpy as np

Number = Fraction | int
Place = tuple[Number, Number]


def sign(value: Number) -> int:
    return (value > 0) - (value < 0)


def number(value: float) -> Number:
    value = float(value)
    return int(value) if value.is_integer() else Fraction(value)


def place(point: Sequence[float]) -> Place:
    """The first two coordinates, exactly."""
    return number(point[0]), number(point[1])


def as_integers(*places: Place) -> Sequence[Place]:
    """The places, all multiplied by one number: signs stay as they are, and come much quicker."""
    if all(isinstance(one, int) for xy in places for one in xy):
        return places
    scale = math.lcm(*(one.denominator for xy in places for one in xy))
    return [
        (x.numerator * (scale // x.denominator), y.numerator * (scale // y.denominator))
        for x, y in places
    ]


def orientation(a: Place, b: Place, c: Place) -> int:
    """+1 if c lies left of the line from a to b, -1 right, 0 on it."""
    a, b, c = as_integers(a, b, c)
    return sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def are_collinear(points: Iterable[Sequence[float]]) -> bool:
    """Tell if the points are too few, or all on one line: what no TIN can be made of."""
    places = sorted({place(p) for p in points})
    return not places or not any(orientation(places[0], places[-1], p) for p in places)


def in_circle(a: Place, b: Place, c: Place, d: Place) -> int:
    """+1 if d lies inside the circle through counter-clockwise a, b, c, by the full determinant.

    Heights are x^2 + y^2 from the origin, not from d: another formula than the kernel's.
    """
    places = as_integers(a, b, c, d)
    return sign(_lifted_determinant([(x, y, x * x + y * y) for x, y in places]))


def _lifted_determinant(rows: Sequence[tuple[Number, Number, Number]]) -> Number:
    (ax, ay, az), (bx, by, bz), (cx, cy, cz), (dx, dy, dz) = rows

    def flat(px, py, qx, qy, rx, ry):  # type: ignore[no-untyped-def]
        return (qx - px) * (ry - py) - (qy - py) * (rx - px)

    return (
        az * flat(bx, by, cx, cy, dx, dy)
        - bz * flat(ax, ay, cx, cy, dx, dy)
        + cz * flat(ax, ay, bx, by, dx, dy)
        - dz * flat(ax, ay, bx, by, cx, cy)
    )


def in_circle_by_rule(a: Place, b: Place, c: Place, d: Place) -> bool:
    """As in_circle, ties broken: heights are raised by infinitesimals in lexicographic order.

    The raise of the lexicographically last point outweighs all others, so it alone is added, as
    a whole unit, to a determinant that is otherwise zero.
    """
    side = in_circle(a, b, c, d)
    if side:
        return side > 0
    last = max(a, b, c, d)
    rows = [(p[0], p[1], int(p == last)) for p in (a, b, c, d)]
    return _lifted_determinant(rows) > 0


def counter_clockwise_triples(places: list[Place]) -> Iterator[tuple[int, int, int]]:
    """Walk all triples of places that are not collinear, the smallest index first."""
    for i, j, k in itertools.combinations(range(len(places)), 3):
        turn = orientation(places[i], places[j], places[k])
        if turn != 0:
            yield (i, j, k) if turn > 0 else (i, k, j)


def delaunay(points: Sequence[Sequence[float]]) -> set[tuple[int, int, int]]:
    """Every triple whose circle holds no other point, by brute force over all of them.

    Triples are counter-clockwise, smallest index first; points must be distinct.
    """
    places = [place(p) for p in points]
    found = set()
    for triple in counter_clockwise_triples(places):
        a, b, c = (places[v] for v in triple)
        others = (p for v, p in enumerate(places) if v not in triple)
        if not any(in_circle_by_rule(a, b, c, p) for p in others):
            found.add(triple)
    return found


def canonical(triangles: Iterable[Sequence[int]]) -> set[tuple[int, int, int]]:
    """Triangles turned so that the smallest index comes first; fails on repeated ones."""
    turned = []
    for triangle in triangles:
        a, b, c = (int(v) for v in triangle)
        turned.append(min((a, b, c), (b, c, a), (c, a, b)))
    assert len(set(turned)) == len(turned)
    return set(turned)


def hull_points(points: Sequence[Sequence[float]]) -> set[int]:
    """Points on the boundary of the convex hull, those inside its edges too, by definition."""
    places = [place(p) for p in points]
    on_hull = set()
    for i, j in itertools.permutations(range(len(places)), 2):
        turns = [orientation(places[i], places[j], p) for p in places]
        if min(turns) >= 0:
            on_hull.update(v for v, turn in enumerate(turns) if turn == 0)
    return on_hull


def hull_size(points: Iterable[Sequence[float]]) -> int:
    """Number of distinct points on the convex hull's boundary, by Andrew's monotone chain."""
    places = sorted({place(p) for p in points})
    lower, upper = _chain(places), _chain(places[::-1])
    return len(set(lower) | set(upper))


def _chain(places: Sequence[Place]) -> list[Place]:
    kept: list[Place] = []
    for p in places:
        while len(kept) >= 2 and orientation(kept[-2], kept[-1], p) < 0:
            kept.pop()
        kept.append(p)
    return kept


def ranked_triangles(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Triangles by the lexicographic ranks of their vertices, in one order for every numbering."""
    rank = np.empty(len(points), np.int64)
    rank[np.lexsort((points[:, 1], points[:, 0]))] = np.arange(len(points))
    ranks = rank[triangles]
    first = ranks.argmin(axis=1)[:, None]
    ranks = np.take_along_axis(ranks, (first + np.arange(3)) % 3, axis=1)
    return ranks[np.lexsort(ranks.T[::-1])]
