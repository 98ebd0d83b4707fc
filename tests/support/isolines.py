"""Contours the plain way, in fractions: every triangle and level on its own."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

Place = tuple[Fraction, Fraction]


def fractions_of(points: Any) -> list[tuple[Fraction, Fraction, Fraction]]:
    return [tuple(Fraction(float(c)) for c in point) for point in points]


def crossing(a: Any, b: Any, level: Fraction) -> Place:
    share = (level - a[2]) / (b[2] - a[2])
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])


def level_segments(points: Any, triangles: Any, level: float) -> Counter[tuple[Place, Place]]:
    """Return the directed segments of a level, the higher side left; those forth and back cancel.

    A vertex at the level counts as above it.
    """
    exact, height = fractions_of(points), Fraction(float(level))
    found: Counter[tuple[Place, Place]] = Counter()
    for triangle in triangles:
        corners = [exact[v] for v in triangle]
        start = end = None
        for k in range(3):
            a, b = corners[k], corners[(k + 1) % 3]
            if a[2] >= height > b[2]:
                start = crossing(a, b, height)
            if b[2] >= height > a[2]:
                end = crossing(a, b, height)
        if start is not None and start != end:
            found[start, end] += 1
    return _cancelled(found)


def _cancelled(found: Counter[tuple[Place, Place]]) -> Counter[tuple[Place, Place]]:
    kept: Counter[tuple[Place, Place]] = Counter()
    for start, end in found:
        kept[start, end] = 1 if found[end, start] == 0 else 0
    return +kept


def rounded(place: Any) -> tuple[float, float]:
    return round(float(place[0]), 9) + 0.0, round(float(place[1]), 9) + 0.0


def rounded_segments(segments: Any) -> Counter[Any]:
    return Counter(
        (rounded(start), rounded(end)) for (start, end), n in segments.items() for _ in range(n)
    )


def segments_of_lines(features: Any, level: float) -> Counter[Any]:
    """Return the directed segments of the lines of a level."""
    (offsets,) = features.offsets
    found: Counter[Any] = Counter()
    for k in np.flatnonzero(features.columns["elevation"] == level):
        line = features.coordinates[offsets[k] : offsets[k + 1]]
        found.update(pairwise(rounded(place) for place in line))
    return found


def area_between(corners: Any, low: Fraction | None, high: Fraction | None) -> Fraction:
    """Return the area of the part of a triangle from one elevation up to another."""
    polygon = [tuple(Fraction(float(c)) for c in corner) for corner in corners]
    if len({corner[2] for corner in polygon}) == 1:  # level: it belongs to the band above
        z = polygon[0][2]
        return shoelace(polygon) if _is_within(z, low, high) else Fraction(0)
    if low is not None:
        polygon = clipped(polygon, low, 1)
    if high is not None:
        polygon = clipped(polygon, high, -1)
    return shoelace(polygon)


def _is_within(z: Fraction, low: Fraction | None, high: Fraction | None) -> bool:
    return (low is None or z >= low) and (high is None or z < high)


def clipped(polygon: Any, level: Fraction, side: int) -> Any:
    kept = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        if side * (a[2] - level) >= 0:
            kept.append(a)
        if (a[2] - level) * (b[2] - level) < 0:
            kept.append((*crossing(a, b, level), level))
    return kept


def shoelace(polygon: Any) -> Fraction:
    pairs = zip(polygon, polygon[1:] + polygon[:1], strict=True)
    return sum((a[0] * b[1] - b[0] * a[1] for a, b in pairs), Fraction(0)) / 2
