"""Polylines with arcs as polylines whose vertices lie on the arcs."""

from __future__ import annotations

import math
from typing import Any

__all__ = ["FRAME_POINT", "follow_bulges"]

FRAME_POINT = 16
"""Flag of a vertex that is a control point of a smoothed polyline, and not on it."""

_MOST_CHORDS = 100_000
"""Of one arc; more are asked for by a tolerance that is far too small."""

Row = tuple[float, float, float]


def follow_bulges(entity: Any, kind: str, distance: float) -> list[Row]:
    """Return the vertices of a plane polyline, those of its arcs near enough.

    Parameters
    ----------
    entity : LWPolyline or Polyline
    kind : str
    distance : float
        How far an arc may lie from its chords.
    """
    if kind == "LWPOLYLINE":
        rows = [(x, y, bulge) for x, y, bulge in entity.get_points("xyb")]
        elevation, is_closed = float(entity.dxf.elevation), bool(entity.closed)
    else:
        rows = [
            (*vertex.dxf.location.vec2, vertex.dxf.get("bulge", 0.0))
            for vertex in entity.vertices
            if not vertex.dxf.get("flags", 0) & FRAME_POINT
        ]
        height = entity.dxf.elevation.z if entity.dxf.hasattr("elevation") else 0.0
        elevation = height or entity.vertices[0].dxf.location.z
        is_closed = bool(entity.is_closed)
    places: list[tuple[float, float]] = []
    ends = [*rows[1:], rows[0]] if is_closed else rows[1:]
    for (x, y, bulge), (x_end, y_end, _) in zip(rows, ends, strict=False):
        places.append((x, y))
        places += _follow_arc((x, y), (x_end, y_end), bulge, distance)
    places.append(rows[0][:2] if is_closed else rows[-1][:2])
    flat = [(x, y, elevation) for x, y in places]
    return [place.xyz for place in entity.ocs().points_to_wcs(flat_vectors(flat))]


def flat_vectors(rows: list[Row]) -> Any:
    """Return rows as ezdxf's vectors."""
    from ezdxf.math import Vec3

    return Vec3.list(rows)


def _follow_arc(
    start: tuple[float, float], end: tuple[float, float], bulge: float, distance: float
) -> list[tuple[float, float]]:
    """Return the points within an arc; its bulge is the tangent of a quarter of its angle."""
    chord = math.dist(start, end)
    if bulge == 0 or chord == 0:
        return []
    angle = 4 * math.atan(bulge)
    radius = chord / (2 * math.sin(abs(angle) / 2)) if abs(bulge) < 1e8 else math.inf
    count = _count_chords(radius, abs(angle), distance)
    middle_x, middle_y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    away = (1 - bulge * bulge) / (4 * bulge)  # of the centre from the chord, in chords
    x = middle_x - away * (end[1] - start[1])
    y = middle_y + away * (end[0] - start[0])
    first = math.atan2(start[1] - y, start[0] - x)
    return [
        (
            x + radius * math.cos(first + angle * k / count),
            y + radius * math.sin(first + angle * k / count),
        )
        for k in range(1, count)
    ]


def _count_chords(radius: float, angle: float, distance: float) -> int:
    if not math.isfinite(radius) or distance >= radius:
        return max(2, math.ceil(angle / (math.pi / 2)))
    step = 2 * math.acos(1 - distance / radius)
    return min(max(2, math.ceil(angle / step)) if step > 0 else _MOST_CHORDS, _MOST_CHORDS)
