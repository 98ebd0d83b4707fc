"""Second opinions on lines: contacts and parity in rational arithmetic, pair by pair."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from fractions import Fraction

import numpy as np

from support.oracles import Place, orientation, place

Segment = tuple[int, int]

__all__ = ["crossings", "is_inside", "meeting_place", "places_of", "steps_of", "touches"]


def places_of(xy: Iterable[Sequence[float]]) -> list[Place]:
    return [place(row) for row in np.asarray(xy).tolist()]


def crossings(places: Sequence[Place], segments: Sequence[Segment]) -> list[list[int]]:
    """Pairs whose open interiors meet in one place, by the sides of all four ends."""

    def parts(p, q, r, s):  # type: ignore[no-untyped-def]
        return {orientation(p, q, r), orientation(p, q, s)} == {1, -1}

    found = []
    for (i, s), (j, t) in itertools.combinations(enumerate(segments), 2):
        (a, b), (c, d) = ((places[v] for v in pair) for pair in (s, t))
        if parts(a, b, c, d) and parts(c, d, a, b):
            found.append([i, j])
    return found


def touches(places: Sequence[Place], segments: Sequence[Segment]) -> list[list[int]]:
    """Pairs (segment, vertex) with the vertex strictly between the ends, by its parameter."""
    found = []
    for i, (first, second) in enumerate(segments):
        a, b = places[first], places[second]
        for v, p in enumerate(places):
            if a == b or orientation(a, b, p) != 0:
                continue
            axis = 0 if a[0] != b[0] else 1
            if 0 < Fraction(p[axis] - a[axis]) / Fraction(b[axis] - a[axis]) < 1:
                found.append([i, v])
    return found


def meeting_place(a: Place, b: Place, c: Place, d: Place) -> tuple[float, float]:
    """Where the lines a-b and c-d meet, each coordinate rounded once (Cramer's rule)."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]
    share = Fraction((c[0] - a[0]) * vy - (c[1] - a[1]) * vx) / Fraction(ux * vy - uy * vx)
    return float(a[0] + share * ux), float(a[1] + share * uy)


def is_inside(p: Place, rings: Iterable[Sequence[Place]]) -> int:
    """+1 if the ray north from p crosses the rings an odd number of times, 0 on a ring, else -1.

    Another direction than the kernel's.
    """
    count = 0
    for ring in rings:
        for a, b in zip(ring, [*ring[1:], *ring[:1]], strict=True):
            west, east = sorted([a, b])
            is_between = west[0] <= p[0] <= east[0] and (min(a[1], b[1]) <= p[1] <= max(a[1], b[1]))
            if is_between and orientation(a, b, p) == 0:
                return 0
            if west[0] <= p[0] < east[0]:
                count += orientation(west, east, p) < 0
    return 1 if count % 2 else -1


def steps_of(vertices: np.ndarray, offsets: np.ndarray) -> set[Segment]:
    """Undirected steps of all chains."""
    lines = [vertices[i:j].tolist() for i, j in itertools.pairwise(offsets)]
    return {(min(s), max(s)) for line in lines for s in itertools.pairwise(line)}
