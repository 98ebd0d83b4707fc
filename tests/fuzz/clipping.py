"""Clipped surfaces: the same surface inside polygons and outside them, and sound both times."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import shapely
from support.surfaces import stretch_triangles

import tinsmith as ts

from .campaign import Campaign, Case

_STEPS = 8
"""Of coordinates: a place may lie so far beside its triangle."""
_SHARE = 1e-9
"""Of a volume or an area that was summed in doubles."""


def generate(rng: np.random.Generator) -> Case:
    """A surface on a lattice or anywhere, and polygons on its very vertices, edges, or anywhere."""
    origin = [500_000.0, 4_000_000.0] if rng.random() < 0.5 else [0.0, 0.0]
    is_lattice = rng.random() < 0.6
    size = int(rng.integers(3, 9))
    if is_lattice:
        axes = np.arange(size + 1.0)
        xy = np.stack(np.meshgrid(axes, axes), axis=-1).reshape(-1, 2)
        xy = xy[rng.random(len(xy)) < rng.choice([1.0, 0.6])]
    else:
        xy = rng.uniform(0, size, (int(rng.integers(4, 60)), 2))
    z = rng.choice([rng.uniform(0, 3, len(xy)), rng.integers(0, 3, len(xy))])
    line = rng.integers(0, size + 1, (3, 2))
    return {
        "points": np.column_stack([xy + origin, z]).tolist(),
        "line": np.column_stack([line + origin, [1.0, 2.0, 1.5]]).tolist(),
        "has_line": bool(rng.random() < 0.5),
        "hole": bool(rng.random() < 0.3),
        "stretch": float(rng.choice([0.0, 0.0, 4.0, 0.3])),
        "polygons": [
            (np.array(ring) + origin).tolist()
            for ring in (_draw_ring(rng, size) for _ in range(rng.integers(1, 4)))
        ],
        "island": bool(rng.random() < 0.3),
        "places": rng.uniform(-0.1, 1.1, (40, 2)).tolist(),
    }


def _draw_ring(rng: np.random.Generator, size: int) -> Any:
    """Return a ring: a rectangle on the lattice or its half, a triangle of it, or a star."""
    kind = rng.integers(4)
    if kind < 2:
        low = rng.integers(-1, size, 2) / (1 + kind)
        high = low + rng.integers(1, size + 1, 2) / (1 + kind)
        return [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]]
    if kind == 2:
        return rng.integers(-1, size + 2, (3, 2)).astype(float)
    angles = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 9))))
    far = rng.uniform(0.05, 0.7, len(angles)) * size
    return size * rng.random(2) + far[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])


def examine(case: Case) -> str:
    """Clip inside and outside; compare with the surface, with volumes in regions, in fractions."""
    lines = [case["line"]] if case["has_line"] else []
    try:
        tin = ts.triangulate(case["points"], breaklines=lines, holes=_list_hole(case))
        if case["stretch"]:
            tin = stretch_triangles(tin, (1.0, case["stretch"]))
    except ts.TinsmithError:
        return "refused: TIN"
    polygons = [[np.array(ring)] for ring in case["polygons"]]
    if case["island"] and len(case["polygons"][0]) > 2:
        ring = polygons[0][0] + 0.0
        polygons[0].append(ring.mean(axis=0) + 0.3 * (ring - ring.mean(axis=0)))
    parts = {}
    for keep in ("inside", "outside"):
        try:
            parts[keep] = ts.clip(tin, polygons, keep=keep)
        except ts.LinesError as error:
            said = str(error)
            if "no sound polygon" in said or "has two corners" in said:
                return "refused: polygon"
            assert "outside the surface" in said or "cover the whole" in said, said
    for part in parts.values():
        _require_same_surface(tin, part, case)
    _require_whole(tin, parts, polygons)
    return " and ".join(parts) or "refused: nothing to clip"


def _list_hole(case: Case) -> list[Any]:
    corner = np.array(case["points"])[:, :2].min(axis=0) + 1.0
    return [np.add(corner, [[0, 0], [1, 0], [1, 1], [0, 1]])] if case["hole"] else []


def _step(tin: Any) -> float:
    return _STEPS * float(np.spacing(np.abs(tin.points[:, :2]).max()))


def _require_same_surface(tin: Any, part: Any, case: Case) -> None:
    """Require a sound TIN on the old surface, of the triangles that no polygon cuts."""
    ts.check(part).raise_if_failed()
    step = _step(tin)
    low, high = part.points[:, :2].min(axis=0), part.points[:, :2].max(axis=0)
    places = np.concatenate([low + (high - low) * case["places"], part.points[:, :2]])
    new, old = part.interpolate(places), tin.interpolate(places, extrapolate="nearest")
    steepest = float(np.max(ts.slope(tin, unit="ratio")))
    error = np.nan_to_num(np.abs(new - old))
    assert error.max() <= 1e-12 + 1e-12 * np.abs(old).max() + steepest * step, error.max()
    has_row = np.isin(np.arange(len(tin.points)), tin.vertex_of)
    rows = {tuple(row) for row in tin.points[has_row].tolist()}
    kept = part.vertex_of[part.vertex_of >= 0]
    assert len(set(kept.tolist())) == sum(tuple(row) in rows for row in part.points.tolist())


def _require_whole(tin: Any, parts: dict[str, Any], polygons: Any) -> None:
    """Require that both parts are the whole, and areas and volumes those of the regions."""
    area = sum(_measure(part) for part in parts.values())
    whole = _measure(tin)
    slack = Fraction(_step(tin)) * Fraction(float(tin.bounds.width + tin.bounds.height)) * 8
    if parts:
        assert abs(area - whole) <= slack, float(area - whole)
    cover = shapely.union_all([_make_polygon(rings) for rings in polygons])
    outline = shapely.union_all(shapely.polygons(tin.points[tin.triangles, :2]))
    shared = shapely.intersection(cover, outline)
    wanted = {"inside": shared.area, "outside": outline.area - shared.area}
    length = cover.length + outline.length
    for keep, part in parts.items():
        assert abs(float(_measure(part)) - wanted[keep]) <= _step(tin) * length + 1e-9, keep
        level = float(part.points[:, 2].min()) - 1.0
        cut = float(ts.volume(part, base=level)["cut"][0])
        if keep == "inside" and len(polygons) == 1:
            other = float(ts.volume(tin, base=level, regions=polygons)["cut"][0])
            assert abs(cut - other) <= _SHARE * (1 + abs(other)), (cut, other)
    if len(parts) == 2 and cover.within(outline.buffer(-1e-3)) and len(polygons) == 1:
        assert area == whole, "the parts do not meet exactly"


def _make_polygon(rings: Any) -> Any:
    made = shapely.Polygon(rings[0])
    for ring in rings[1:]:
        made = made.symmetric_difference(shapely.Polygon(ring))
    return made


def _measure(tin: Any) -> Fraction:
    """Return the area exactly."""
    doubled = Fraction(0)
    for corners in tin.points[tin.triangles][:, :, :2].tolist():
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, corner) for corner in corners)
        doubled += (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    return doubled / 2


CAMPAIGNS = [
    Campaign("clip", "clipped surfaces against the surface and its regions", generate, examine),
]
