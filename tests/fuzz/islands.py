"""Holes, erased parts and boundaries with islands, against the areas that shapely finds."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

import tinsmith as ts

from .campaign import Campaign

_SIZE = 12


def generate(rng: np.random.Generator) -> dict[str, Any]:
    """Return points of a square, and polygons whose islands may hold further polygons."""
    points = rng.integers(0, _SIZE + 1, (int(rng.integers(0, 60)), 2)).tolist()
    n = int(rng.integers(1, 4))
    return {
        "points": points,
        "polygons": [_nest(rng) for _ in range(n)],
        "role": str(rng.choice(["holes", "erase", "boundary"])),
        "form": str(rng.choice(["shapely", "rings", "multi"])),
        "scale": float(rng.choice([1.0, 0.1, 1 / 3])),
    }


def _nest(rng: np.random.Generator) -> list[list[list[int]]]:
    """Return rings each within the one before, which they may touch at corners."""
    low, high = np.sort(rng.choice(_SIZE + 1, 2, replace=False))
    box = np.array([low, low, high, high])
    rings = []
    for _ in range(int(rng.integers(1, 4))):
        x0, y0, x1, y1 = (int(side) for side in box)
        if x1 - x0 < 1 or y1 - y0 < 1:
            break
        rings.append(_ring(rng, x0, y0, x1, y1))
        box = box + np.array([1, 1, -1, -1]) * int(rng.integers(1, 3))
    return rings


def _ring(rng: np.random.Generator, x0: int, y0: int, x1: int, y1: int) -> list[list[int]]:
    corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    if rng.random() < 0.3 and x1 - x0 > 1 and y1 - y0 > 1:
        corners = [[x0 + (x1 - x0) // 2, y0], [x1, y0 + (y1 - y0) // 2], [x0, y1]]
    return corners[::-1] if rng.random() < 0.5 else corners


def examine(case: dict[str, Any]) -> None:
    """Compare areas, and rows left out, with shapely's."""
    scale = case["scale"]
    regions = [
        [np.array(ring, float) * scale for ring in rings] for rings in case["polygons"] if rings
    ]
    regions = [rings for rings in regions if all(len(ring) >= 3 for ring in rings)]
    if not regions:
        return
    side = _SIZE * scale
    rows = np.array([*case["points"], [0, 0], [_SIZE, 0], [_SIZE, _SIZE], [0, _SIZE]], float)
    rows = np.column_stack([rows * scale, np.arange(len(rows))])
    role = case["role"]
    shapes = [_even_odd(rings) for rings in regions]
    try:
        tin = ts.triangulate(rows, **{role: _as_given(regions, shapes, case["form"])})
    except ts.TinsmithError:
        _require_nothing_left(shapes, role, side)
        return
    _compare(tin, rows, shapes, role, side)


def _even_odd(rings: list[np.ndarray]) -> Any:
    shape = shapely.Polygon()
    for ring in rings:
        shape = shapely.symmetric_difference(shape, shapely.Polygon(ring))
    return shape


def _as_given(regions: list[list[np.ndarray]], shapes: list[Any], form: str) -> list[Any]:
    if form == "rings":
        return regions
    if form == "multi" and len(shapes) == 1:
        return [shapes[0]] if shapes[0].geom_type.endswith("Polygon") else regions
    return [
        shape if shape.geom_type.endswith("Polygon") else rings
        for shape, rings in zip(shapes, regions, strict=True)
    ]


def _surface(shapes: list[Any], role: str, side: float) -> Any:
    square = shapely.box(0, 0, side, side)
    if role == "erase":
        return square
    if role == "holes":
        return shapely.difference(square, shapely.union_all(shapes))
    inside = shapely.Polygon()
    for shape in shapes:
        inside = shapely.symmetric_difference(inside, shape)
    return shapely.intersection(square, inside)


def _require_nothing_left(shapes: list[Any], role: str, side: float) -> None:
    surface = _surface(shapes, role, side)
    assert surface.area < 1e-9 * side * side or role == "holes", "refused without a reason"


def _compare(tin: Any, rows: np.ndarray, shapes: list[Any], role: str, side: float) -> None:
    found = ts.check(tin)
    assert found.ok, [problem.sentence for problem in found.problems]
    surface = _surface(shapes, role, side)
    if role != "erase":
        assert abs(tin.area - surface.area) <= 1e-9 * side * side, (tin.area, surface.area)
        return
    inside = np.zeros(len(rows), np.bool_)
    for shape in shapes:
        inside |= shapely.contains(shape, shapely.points(rows[:, :2]))
    assert ((tin.vertex_of < 0) == inside).all(), "other rows are erased"


CAMPAIGNS = (
    Campaign(
        "islands", "polygons with islands as holes, boundary or erased parts", generate, examine
    ),
)
