"""Contours of hard surfaces against segments in fractions, shapely and their own proof."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from support.isolines import area_between, level_segments, rounded_segments, segments_of_lines
from support.point_sets import whole_number_grid

import tinsmith as ts

from .campaign import Campaign, Case

ROUNDING = 1e-12


def generate(rng: np.random.Generator) -> Case:
    """A small integer grid with many flats, or scattered points, perhaps trimmed."""
    case: Case = {"seed": int(rng.integers(1 << 30))}
    case["interval"] = float(rng.choice([0.3, 0.5, 0.75, 1.0]))
    case["tolerance"] = float(rng.choice([0.02, 0.1, 0.3, 1.0]))
    is_grid = rng.random() < 0.6
    case["points"] = (thinned_grid(rng) if is_grid else scatter(rng)).tolist()
    case["is_exact"] = bool(is_grid)
    case["max_edge"] = [None, 1.5, 3.0, 20.0][int(rng.integers(4))]
    return case


def thinned_grid(rng: np.random.Generator) -> Any:
    points = whole_number_grid(rng, *rng.integers(2, 9, 2), int(rng.integers(5)))
    return points[rng.random(len(points)) < rng.choice([0.7, 1.0])]


def scatter(rng: np.random.Generator) -> Any:
    count = int(rng.integers(3, 150))
    xy = rng.uniform(0, 60, (count, 2))
    z = 5 * np.sin(xy[:, 0] / 9) * np.cos(xy[:, 1] / 7) + rng.normal(0, rng.choice([0, 0.5]), count)
    decimals = int(rng.choice([0, 1, 2, 9]))
    shift = rng.choice([0.0, 500_000.0])
    return np.column_stack([xy.round(decimals) + shift, z.round(decimals)])


def examine(case: Case) -> str:
    """Ask for lines, bands and smoothed lines that are what they promise."""
    try:
        tin = ts.triangulate(case["points"], max_edge=case["max_edge"])
    except ts.TinsmithError:
        return "refused: points"
    lines = ts.contours(tin, interval=case["interval"])
    bands = ts.contour_bands(tin, interval=case["interval"])
    if case["is_exact"]:
        require_segments(tin, lines)
        require_areas(tin, bands)
    require_partition(tin, bands)
    require_apart(tin, lines, case)
    return "lines" if len(lines) else "no lines"


def require_segments(tin: Any, lines: Any) -> None:
    for level in np.unique(lines.columns["elevation"]):
        expected = rounded_segments(level_segments(tin.points, tin.triangles, level))
        assert segments_of_lines(lines, level) == expected, f"segments at {level}"


def require_areas(tin: Any, bands: Any) -> None:
    for low, high, area in zip(*(bands.columns[k] for k in ("from", "to", "area")), strict=True):
        within = (Fraction(float(low)), Fraction(float(high)))
        exact = sum(area_between(tin.points[t], *within) for t in tin.triangles)
        assert abs(float(exact) - area) < 1e-9, f"the area of {low} to {high}"


def require_partition(tin: Any, bands: Any) -> None:
    rings, polygons, _ = bands.offsets
    total = 0.0
    for first, last in pairwise(polygons):
        loops = [bands.coordinates[rings[r] : rings[r + 1]] for r in range(first, last)]
        shape = shapely.Polygon(loops[0], loops[1:])
        assert shape.is_valid, shapely.is_valid_reason(shape)
        total += shape.area
    assert abs(total - tin.area) <= 1e-7 * tin.area + 1e-9, f"areas: {total} of {tin.area}"


def require_apart(tin: Any, lines: Any, case: Case) -> None:
    tolerance = case["tolerance"]
    slack = ROUNDING + steepest(tin) * float(np.spacing(np.abs(tin.points[:, :2]).max())) * 4
    for options in ({"smooth": tolerance}, {"simplify": tolerance},
                    {"smooth": tolerance, "simplify": tolerance}):  # fmt: skip
        found = ts.contours(tin, interval=case["interval"], **options)
        proof = ts.check_contours(tin, found)
        assert proof.is_apart, f"{options}: {proof}"
        assert proof.deviation <= tolerance * (1 + ROUNDING) + slack, f"{options}: {proof}"
        assert len(found) == len(lines), "lines were lost"


def steepest(tin: Any) -> float:
    return float(np.tan(np.radians(ts.slope(tin).max(initial=0.0))))


CAMPAIGNS = (Campaign("contours", "lines, bands and smoothed lines, proven", generate, examine),)
