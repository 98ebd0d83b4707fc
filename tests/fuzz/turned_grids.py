"""Differences and bands of grids and lines that are collinear as surveyed and not in doubles."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from support.point_sets import grid

import tinsmith as ts

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """Two design surfaces near each other, perhaps far from the origin, perhaps rounded."""
    origin = [(0.0, 0.0), (500_000.0, 4_000_000.0), (-71_234.5, 33.3)][int(rng.integers(3))]
    digits = [None, 3, 2, 1][int(rng.integers(4))]
    angle = float(rng.uniform(0, 90))
    is_parallel = rng.random() < 0.2  # edges of both on each other but for rounding
    return {
        "points": shape(rng, angle, origin, digits).tolist(),
        "other": shape(rng, angle if is_parallel else None, origin, digits).tolist(),
        "interval": float(rng.choice([0.1, 0.25, 1.0, 3.0])),
    }


def shape(
    rng: np.random.Generator, angle: float | None, origin: tuple[float, float], digits: int | None
) -> Any:
    """Return a grid turned about its corner, or points on slanted lines y = x / k."""
    columns, rows = rng.integers(2, 16, 2)
    size = float(rng.choice([1.0, 0.25, 5.0, 1 / 3]))
    x, y = size * grid(columns, rows).T
    if rng.random() < 0.25:
        y = y + x / float(rng.integers(2, 12))  # its ends are slanted, its sides upright
    turn = np.deg2rad(rng.uniform(0, 90) if angle is None else angle)
    shift = np.array(origin) + rng.choice([0.0, 0.37, 1.5], 2)
    xy = np.column_stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)])
    z = np.sin(x / 3) * rng.choice([0.0, 3.0]) + np.cos(y / 2) * 2 + 0.1 * rng.integers(0, 9)
    points = np.column_stack([xy + shift, z])
    return points if digits is None else points.round(digits)


def examine(case: Case) -> str:
    """Ask for a difference of the volumes of `ts.volume`, and zones and bands that tile."""
    try:
        tin, other = (ts.triangulate(case[name]) for name in ("points", "other"))
    except ts.TinsmithError:
        return "refused: points"
    for one in (tin, other):
        bands = ts.contour_bands(one, interval=case["interval"])
        require_tiles(bands, one.area, rounding_of(one, one))
    table = ts.volume(tin, other)
    if table["area"][0] < 1e-3:
        return "apart"
    examine_difference(ts.difference(tin, other), table, rounding_of(tin, other))
    return "overlaid"


def examine_difference(found: Any, table: Any, slack: float) -> None:
    assert ts.check(found.tin).ok, repr(ts.check(found.tin))
    area, relief = float(table["area"][0]), float(np.abs(found.tin.points[:, 2]).max())
    assert abs(found.tin.area - area) <= slack, "area"
    require_tiles(found.zones, area, slack)
    columns = found.zones.columns
    for kind in ("cut", "fill"):
        exact = float(table[kind][0])
        assert abs(getattr(found, kind) - exact) <= 1e-12 * area * (relief + 1), kind
        apart = abs(columns["volume"][columns["kind"] == kind].sum() - exact)
        assert apart <= 2e-7 * area * relief + slack * (relief + 1), f"zones of {kind}: {apart}"
    lowest, highest = (float(found.statistics[name][0]) for name in ("lowest", "highest"))
    heights = found.tin.points[:, 2]
    within = 1e-6 * (relief + 1)
    assert heights.min() >= lowest - within, f"{heights.min()} is below the lowest, {lowest}"
    assert heights.max() <= highest + within, f"{heights.max()} is above the highest, {highest}"


def require_tiles(features: Any, area: float, slack: float) -> None:
    """Ask for valid polygons whose areas add up and whose union loses none of it."""
    rings, polygons = features.offsets[:2]
    shapes = []
    for first, last in pairwise(polygons):
        loops = [features.coordinates[rings[r] : rings[r + 1]] for r in range(first, last)]
        shapes.append(shapely.Polygon(loops[0], loops[1:]))
    assert all(shapely.is_valid(shapes)), "a polygon is not valid"
    total = sum(one.area for one in shapes)
    assert abs(total - area) <= 1e-9 * area + slack, f"areas: {total} of {area}"
    union = shapely.union_all(shapes).area
    assert abs(union - area) <= 1e-9 * area + slack, f"union: {union} of {area}"


def rounding_of(tin: Any, other: Any) -> float:
    """Return the area that moving every vertex by a rounding can change."""
    xy = np.concatenate([tin.points[:, :2], other.points[:, :2]])
    edges = 3 * (len(tin.triangles) + len(other.triangles))
    return float(8 * np.spacing(np.abs(xy).max()) * np.ptp(xy, axis=0).sum() * edges)


CAMPAIGNS = (Campaign("turned grids", "differences and bands of turned grids", generate, examine),)
