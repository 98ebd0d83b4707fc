"""Second opinions on constrained triangulations: by definition, and by flips, exact and slow."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from support.line_oracle import is_inside
from support.oracles import (
    Place,
    counter_clockwise_triples,
    in_circle_by_rule,
    orientation,
    place,
)

Segment = tuple[int, int]
Triple = tuple[int, int, int]

__all__ = [
    "Case",
    "by_flips",
    "clipped",
    "constrained_delaunay",
    "random_cases",
    "random_triangulation",
]

UTM = (500_000.0, 4_000_000.0)


class Case(NamedTuple):
    """Distinct points, and segments that neither cross nor run through a point."""

    points: list[tuple[float, float]]
    segments: list[Segment]


# ------------------------------------------------------------------ by definition


def constrained_delaunay(
    points: Sequence[Sequence[float]], segments: Sequence[Segment]
) -> set[Triple]:
    """Every triangle of the convex hull's constrained Delaunay triangulation, by definition.

    Its inside is crossed by no segment, and its circle (ties broken as in ``in_circle_by_rule``)
    holds no other point that can be seen from inside the triangle past the segments. Triples are
    counter-clockwise, smallest index first. Good to some 14 points.
    """
    places = [place(p) for p in points]
    walls = [(places[a], places[b]) for a, b in segments]
    found = set()
    for triple in counter_clockwise_triples(places):
        corners = [places[v] for v in triple]
        inside = [
            p for v, p in enumerate(places) if v not in triple and in_circle_by_rule(*corners, p)
        ]
        if any(_is_cut(corners, wall) for wall in walls):
            continue
        if not any(_is_seen(p, corners, places, walls) for p in inside):
            found.add(triple)
    return found


def _is_cut(corners: list[Place], wall: tuple[Place, Place]) -> bool:
    """Tell if a segment crosses a side.

    One that ends inside or on a side does so in a point that is seen in the circle.
    """
    sides = zip(corners, [*corners[1:], corners[0]], strict=True)
    return any(_cross(*wall, *side) for side in sides)


def _cross(a: Place, b: Place, c: Place, d: Place) -> bool:
    """Tell if the open segments a-b and c-d cross."""
    return (
        orientation(a, b, c) * orientation(a, b, d) < 0
        and orientation(c, d, a) * orientation(c, d, b) < 0
    )


def _is_seen(
    p: Place, corners: list[Place], places: list[Place], walls: list[tuple[Place, Place]]
) -> bool:
    """Tell if p can be seen from anywhere inside the triangle.

    What hides the inside changes only in the directions from p to points. So one ray between each
    two such directions that follow each other is enough, to its middle within the triangle.
    """
    x, y = (Fraction(sum(corner[axis] for corner in corners)) / 3 for axis in (0, 1))
    if not any(_may_hide(*wall, p, (x, y)) for wall in walls):
        return True
    for dx, dy in _between([(q[0] - p[0], q[1] - p[1]) for q in places if q != p]):
        target = _middle_within(p, (p[0] + dx, p[1] + dy), corners)
        if target is not None and not any(_cross(p, target, *wall) for wall in walls):
            return True
    return False


def _may_hide(a: Place, b: Place, p: Place, q: Place) -> bool:
    """Tell if the closed segments a-b and p-q may have a place in common."""
    return (
        orientation(a, b, p) * orientation(a, b, q) <= 0
        and orientation(p, q, a) * orientation(p, q, b) <= 0
    )


def _between(directions: list[Place]) -> Iterator[Place]:
    """One direction strictly between each two neighbours all round; halves count as neighbours."""
    turned = directions + [(-x, -y) for x, y in directions] + [(1, 0), (0, 1), (-1, 0), (0, -1)]

    def rank(v: Place) -> tuple[int, Fraction]:
        x, y = v
        quarter = 0 if x > 0 and y >= 0 else 1 if x <= 0 < y else 2 if x < 0 else 3
        for _ in range(quarter):
            x, y = y, -x
        return quarter, Fraction(y) / Fraction(x)

    unit = {rank(v): v for v in turned}
    ordered = [unit[key] for key in sorted(unit)]
    for (ax, ay), (bx, by) in zip(ordered, [*ordered[1:], ordered[0]], strict=True):
        a, b = abs(ax) + abs(ay), abs(bx) + abs(by)
        yield ax * b + bx * a, ay * b + by * a


def _middle_within(p: Place, q: Place, corners: list[Place]) -> Place | None:
    """The middle of what the ray from p through q has inside the triangle; q is not on a corner."""
    shares = []
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        if orientation(p, q, a) * orientation(p, q, b) < 0:
            ux, uy, vx, vy = q[0] - p[0], q[1] - p[1], b[0] - a[0], b[1] - a[1]
            numerator = (a[0] - p[0]) * vy - (a[1] - p[1]) * vx
            shares.append(Fraction(numerator) / Fraction(ux * vy - uy * vx))
    if not shares or max(shares) <= 0:
        return None
    middle = (max(min(shares), Fraction(0)) + max(shares)) / 2
    return p[0] + middle * (q[0] - p[0]), p[1] + middle * (q[1] - p[1])


# ----------------------------------------------------------------------- by flips


def by_flips(case: Case, rng: np.random.Generator) -> set[Triple]:
    """The same by another way: flip any triangulation that holds the segments until none helps."""
    places = [place(p) for p in case.points]
    fixed = {frozenset(segment) for segment in case.segments}
    triangles = random_triangulation(case, rng)
    while True:
        flip = next(_helpful_flips(places, triangles, fixed), None)
        if flip is None:
            return triangles
        old, new = flip
        triangles = (triangles - old) | new


def _helpful_flips(
    places: list[Place], triangles: set[Triple], fixed: set[frozenset[int]]
) -> Iterator[tuple[set[Triple], set[Triple]]]:
    left_of = {(t[k], t[(k + 1) % 3]): t for t in triangles for k in range(3)}
    for (a, b), one in left_of.items():
        other = left_of.get((b, a))
        if other is None or frozenset((a, b)) in fixed:
            continue
        (c,), (d,) = set(one) - {a, b}, set(other) - {a, b}
        if in_circle_by_rule(*(places[v] for v in one), places[d]):
            yield {one, other}, {_turned((a, d, c)), _turned((d, b, c))}


def _turned(triangle: Triple) -> Triple:
    at = triangle.index(min(triangle))
    return triangle[at], triangle[(at + 1) % 3], triangle[(at + 2) % 3]


def random_triangulation(case: Case, rng: np.random.Generator) -> set[Triple]:
    """Segments, then any edges in random order that cross none before: no more fit."""
    places = [place(p) for p in case.points]
    edges = list(case.segments)
    pairs = list(itertools.combinations(range(len(places)), 2))
    rng.shuffle(pairs)
    for a, b in pairs:
        if not _is_blocked(places, (a, b), edges):
            edges.append((a, b))
    joined = {frozenset(edge) for edge in edges}
    found = set()
    for i, j, k in itertools.combinations(range(len(places)), 3):
        turn = orientation(places[i], places[j], places[k])
        if turn and {frozenset((i, j)), frozenset((j, k)), frozenset((k, i))} <= joined:
            triple = (i, j, k) if turn > 0 else (i, k, j)
            corners = [places[v] for v in triple]
            others = (p for v, p in enumerate(places) if v not in triple)
            if not any(is_inside(p, [corners]) >= 0 for p in others):
                found.add(triple)
    return found


def _is_blocked(places: list[Place], pair: Segment, edges: Sequence[Segment]) -> bool:
    """Tell if a pair crosses an edge, is one, or runs through a point."""
    a, b = places[pair[0]], places[pair[1]]
    if frozenset(pair) in map(frozenset, edges):
        return True
    if any(_cross(a, b, places[c], places[d]) for c, d in edges):
        return True
    others = (p for v, p in enumerate(places) if v not in pair)
    return any(orientation(a, b, p) == 0 and min(a, b) < p < max(a, b) for p in others)


# --------------------------------------------------------------------------- cases


def clipped(
    points: Sequence[Sequence[float]],
    triangles: set[Triple],
    boundary: Sequence[Sequence[int]] = (),
    holes: Sequence[Sequence[int]] = (),
) -> set[Triple]:
    """Triangles whose centroid lies in an odd number of boundary rings and in no hole.

    Rings are vertex numbers; without a boundary all but the holes is kept.
    """
    places = [place(p) for p in points]
    outer, inner = ([[places[v] for v in ring] for ring in rings] for rings in (boundary, holes))

    def is_kept(triangle: Triple) -> bool:
        x, y = (sum(Fraction(places[v][axis]) for v in triangle) / 3 for axis in (0, 1))
        in_hole = any(is_inside((x, y), [ring]) > 0 for ring in inner)
        return not in_hole and (not outer or is_inside((x, y), outer) > 0)

    return {triangle for triangle in triangles if is_kept(triangle)}


def random_cases(
    seed: int, count: int, *, most_points: int = 10, most_segments: int = 12
) -> Iterator[Case]:
    """Cases, every other one on a small integer grid, the others at UTM coordinates."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        points = _random_points(rng, int(rng.integers(4, most_points + 1)), is_grid=number % 2 == 0)
        places = [place(p) for p in points]
        pairs = list(itertools.combinations(range(len(points)), 2))
        rng.shuffle(pairs)
        segments: list[Segment] = []
        for a, b in pairs[: int(rng.integers(0, most_segments + 1))]:
            if not _is_blocked(places, (a, b), segments):
                segments.append((int(a), int(b)))
        yield Case(points, segments)


def _random_points(
    rng: np.random.Generator, count: int, *, is_grid: bool
) -> list[tuple[float, float]]:
    """Distinct points that are not all collinear."""
    while True:
        if is_grid:
            xy = rng.integers(0, rng.integers(2, 6), (count, 2)).astype(float)
        else:
            xy = np.round(rng.random((count, 2)) * 10, 3) + UTM
        points = sorted({(x, y) for x, y in xy.tolist()}, key=lambda _: rng.random())
        places = [place(p) for p in points]
        if any(orientation(*three) for three in itertools.combinations(places, 3)):
            return points
