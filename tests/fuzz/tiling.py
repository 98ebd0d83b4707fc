"""Campaigns: triangles of boxes from what lies near, against the whole triangulation."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

import numpy as np
from support.point_cells import PointCells
from support.point_sets import points
from support.tiled import require_triangles_of_the_whole

import tinsmith as ts
from tinsmith.tin.tiling import local_triangulation

from .campaign import Campaign, Case

_MOST_CUTS = 7


def generate(rng: np.random.Generator) -> Case:
    """Points, and lines between cells: through points, beyond all points, and slivers."""
    cloud = points(rng, int(rng.integers(3, 120)))
    cuts = []
    for axis in (0, 1):
        values = [one[axis] for one in cloud]
        low, high = min(values), max(values)
        found = {float(rng.choice(values)) for _ in range(int(rng.integers(0, _MOST_CUTS)))}
        found |= {float(low + (high - low) * rng.random()) for _ in range(int(rng.integers(0, 4)))}
        if rng.random() < 0.2:
            found |= {float(np.nextafter(value, np.inf)) for value in list(found)}
        cuts.append(sorted(found))
    extent = max(abs(value) for one in cloud for value in one[:2])
    return {
        "points": cloud,
        "xs": cuts[0],
        "ys": cuts[1],
        "margin": float(rng.choice([0.0, 0.01, 0.1, 1.0])) * extent,
        "duplicates": str(rng.choice(["mean", "first", "lowest"])),
        "looks_first": bool(rng.random() < 0.5),
    }


def generate_lines(rng: np.random.Generator) -> Case:
    """Add lines and rings between the points, and beyond them, to such a case."""
    case = generate(rng)
    pool = np.array(case["points"], np.float64)
    return case | {
        "breaklines": [_draw(rng, pool, 2, 7) for _ in range(int(rng.integers(0, 6)))],
        "boundary": [_draw_ring(rng, pool) for _ in range(int(rng.random() < 0.2))],
        "holes": [_draw_ring(rng, pool) for _ in range(int(rng.choice([0, 0, 0, 1, 2])))],
    }


def generate_crossing(rng: np.random.Generator) -> Case:
    """Add many short lines that cross each other, between which needles see far past several."""
    case = generate(rng)
    pool = np.array(case["points"], np.float64)[:, :2]
    low, extent = pool.min(axis=0), np.ptp(pool, axis=0)
    length = float(rng.choice([0.05, 0.2, 0.6]))
    lines = []
    for _ in range(int(rng.integers(5, 60))):
        middle = low + extent * rng.random(2)
        away = extent * (rng.random(2) - 0.5) * length
        rows = np.column_stack([[middle - away, middle + away], rng.integers(0, 9, 2)])
        lines.append(rows.tolist())
    return case | {"breaklines": lines}


def _draw(rng: np.random.Generator, pool: Any, least: int, most: int) -> list[list[float]]:
    """Return corners that are points, or lie between two of them."""
    count = int(rng.integers(least, most))
    one, other = (pool[rng.integers(0, len(pool), count)] for _ in range(2))
    share = np.where(rng.random((count, 1)) < 0.5, 0.0, rng.random((count, 1)))
    rows: list[list[float]] = (one + share * (other - one)).tolist()
    return rows


def _flatten(rng: np.random.Generator, lines: list[Any], likely: float) -> list[Any]:
    """Leave the elevations of some lines out: these are draped."""
    return [[row[:2] for row in one] if rng.random() < likely else one for one in lines]


def generate_draped(rng: np.random.Generator) -> Case:
    """Lines and rings of which some have no elevations, and reach beyond the points or run along.

    Elevations are whole numbers, which those of no two triangles share by chance.
    """
    case = generate_lines(rng)
    pool = np.array(case["points"], np.float64)
    middle = pool[:, :2].mean(axis=0)
    likely = float(rng.choice([0.3, 1.0]))
    for name in ("breaklines", "boundary", "holes"):
        lines = case[name]
        if rng.random() < 0.5:
            grown = 1.0 + 2.0 * rng.random()
            lines = [
                [[*(middle + grown * (np.array(row[:2]) - middle)), *row[2:]] for row in one]
                for one in lines
            ]
        case[name] = _flatten(rng, lines, likely)
    return case


def _draw_ring(rng: np.random.Generator, pool: Any) -> list[list[float]]:
    """Return corners by their direction from the middle, so that most rings are simple."""
    corners = np.array(_draw(rng, pool, 3, 8))
    away = corners[:, :2] - corners[:, :2].mean(axis=0)
    rows: list[list[float]] = corners[np.argsort(np.arctan2(away[:, 1], away[:, 0]))].tolist()
    return rows


def examine(case: Case) -> str:
    """Ask for every cell."""
    xyz = np.array(case["points"], np.float64).reshape(-1, 3)
    lines = {
        name: [np.array(line, np.float64) for line in case[name]]
        for name in ("breaklines", "boundary", "holes")
        if case.get(name)
    }
    try:
        ts.triangulate(xyz, duplicates=case["duplicates"], **lines)
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    source = PointCells(xyz, case["xs"], case["ys"])
    least = 0 if case.get("looks_first") else local_triangulation._WORTH_LOOKING
    with patch.object(local_triangulation, "_WORTH_LOOKING", least):
        rounds = require_triangles_of_the_whole(
            xyz, source, margin=case["margin"], duplicates=case["duplicates"], **lines
        )
    return f"{rounds} rounds" if rounds < 4 else "more rounds"


CAMPAIGNS = (
    Campaign("tiling", "triangles of boxes of a surface in cells", generate, examine),
    Campaign("tiling lines", "the same with lines, boundaries and holes", generate_lines, examine),
    Campaign("tiling crossing", "the same with lines that cross", generate_crossing, examine),
    Campaign("tiling draped", "the same with lines without elevations", generate_draped, examine),
)
