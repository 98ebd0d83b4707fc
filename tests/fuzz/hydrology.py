"""Flow paths, catchments, depressions and ponds of hard surfaces.

The oracles: gradients in fractions, flow paths from inside of catchments, a priority flood on
edges, a plain search across ponds and level ground, stage-storage tables, shapely.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from support.hydrology_oracle import (
    flood,
    require_catchments,
    require_descent,
    require_full_catchments,
    require_full_routes,
)
from support.point_sets import grid, scattered

import tinsmith as ts

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """A grid with many flats, or scattered points; perhaps far away, trimmed, with a hole."""
    points = make_grid(rng) if rng.random() < 0.6 else make_scattered(rng)
    size = float(points[:, :2].max())
    hole = rng.uniform(0.2, 0.5, 2) * size
    origin = [0.0, 0.0, 0.0] if rng.random() < 0.6 else [752_000.1, 4_024_000.7, 300.3]
    return {
        "points": (points + origin).tolist(),
        "max_edge": [None, 1.5, 20.0][int(rng.integers(3))],
        "trim": ["perimeter", "everywhere"][int(rng.integers(2))],
        "hole": None if rng.random() < 0.7 else [*(hole + origin[:2]), 0.3 * size],
        "starts": rng.random((10, 2)).tolist(),
        "level": float(rng.uniform(0, 6) + origin[2]),
    }


def make_grid(rng: np.random.Generator) -> np.ndarray:
    """Few elevations: ties, level ponds that touch, islands and ridges of one level."""
    side, spacing = int(rng.integers(2, 9)), float(rng.choice([1.0, 0.1, 3.7]))
    x, y = spacing * grid(side, side).T
    z = rng.integers(0, int(rng.integers(1, 6)), len(x)) * float(rng.choice([1.0, 0.1, 1e-9]))
    if rng.random() < 0.3:  # the same on both sides
        z = np.minimum(z.reshape(side, side), z.reshape(side, side)[::-1]).ravel()
    if rng.random() < 0.3:  # a bowl with terraces
        z = np.round(np.hypot(x - x.mean(), y - y.mean()) / spacing) + np.minimum(z, 1.0)
    return np.column_stack([x, y, z])


def make_scattered(rng: np.random.Generator) -> np.ndarray:
    xy = scattered(rng, int(rng.integers(4, 80)), 60.0)
    return np.column_stack([xy, rng.uniform(0, 9, len(xy)).round(int(rng.choice([0, 1, 9])))])


def examine(case: Case) -> str:
    """Ask for everything, and hold it against the oracles."""
    try:
        tin = ts.triangulate(
            case["points"],
            max_edge=case["max_edge"],
            trim=case["trim"],
            holes=make_hole(case["hole"]),
            crs="EPSG:32616",
        )
    except ts.TinsmithError:
        return "refused: points"
    require_paths(tin, case["starts"])
    require_depressions(tin)
    require_ponds(tin, case["level"])
    require_catchments(tin, np.array(case["starts"]))
    require_accumulation(tin)
    require_full(tin, np.array(case["starts"]))
    return "flow"


def make_hole(hole: list[float] | None) -> list[list[list[float]]]:
    """Return a square, of a corner and a width."""
    if hole is None:
        return []
    x, y, width = hole
    return [[[x, y], [x + width, y], [x + width, y + width], [x, y + width]]]


def choose_starts(tin: Any, shares: Any) -> np.ndarray:
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    starts = np.vstack([low + np.array(shares) * (high - low), tin.points[:, :2]])
    return starts[tin.locate(starts) >= 0]


def require_paths(tin: Any, shares: list[list[float]]) -> None:
    starts = choose_starts(tin, shares)
    found = ts.flow_path(tin, starts)
    offsets = found.offsets[0]
    for begin, end in pairwise(offsets.tolist()):
        require_descent(tin, found.coordinates[begin:end], 1e-5)


def require_depressions(tin: Any) -> None:
    rim = {vertex for ring in tin.boundary for vertex in ring.tolist()}
    filled = flood(tin.points, tin.edges, rim)
    found = ts.depressions(tin, nested=True)
    shapes, levels = found.to_shapely(), found.columns["spill_level"]
    outer = found.columns["parent"] == -1
    used = np.unique(tin.triangles)
    under = used[filled[used] > tin.points[used, 2]]
    if any("made valid" in note for note in found.notes):  # of less than rounding nothing is left
        under = under[filled[under] > tin.points[under, 2] + 1e-9]
    for vertex in under:
        inside = shapely.intersects_xy(shapes[outer], *tin.points[vertex, :2])
        assert filled[vertex] in levels[outer][inside], f"vertex {vertex}: not under water"
    rounding = 1e-9 * (1 + tin.bounds.diagonal**2)
    assert np.allclose(shapely.area(shapes), found.columns["area"], rtol=1e-6, atol=rounding)


def require_ponds(tin: Any, level: float) -> None:
    found, stage = ts.ponds(tin, level), ts.stage_storage(tin, levels=[level])
    for name in ("area", "volume"):
        assert np.isclose(found.columns[name].sum(), stage[name][0], rtol=1e-9, atol=1e-9), name
    assert bool(found.columns["is_contained"].all()) == bool(stage["is_contained"][0])


def require_accumulation(tin: Any) -> None:
    """What drains through the lower end of the largest channel is the catchment of that vertex."""
    found = ts.flow_accumulation(tin)
    if len(found) == 0:
        return
    vertex, area = int(found.columns["end"][0]), found.columns["end_area"][0]
    upstream = ts.catchments(tin, tin.points[[vertex], :2]).columns["area"]
    assert np.isclose(upstream, area, rtol=1e-9).all(), "what accumulates is not what drains"


def require_full(tin: Any, shares: np.ndarray) -> None:
    """Water of full depressions goes where paths go, and nothing of it is lost."""
    starts = choose_starts(tin, shares)
    require_full_routes(tin, starts, 1e-5)
    require_full_catchments(tin, shares)
    require_spills(tin)
    found = ts.flow_accumulation(tin, fill_depressions=True)
    kinds, ends = found.columns["kind"], found.columns["end"]
    rows = np.flatnonzero(kinds == "descent")[:1]
    if len(rows) == 0 or tin.points[ends[rows[0]], 2] != found.coordinates[2 * rows[0] + 1, 2]:
        return  # that vertex is under water
    outlet = tin.points[ends[rows], :2]
    upstream = ts.catchments(tin, outlet, fill_depressions=True).columns["area"]
    area = found.columns["end_area"][rows]
    assert np.isclose(upstream, area, rtol=1e-9).all(), "what accumulates is not what drains"


def require_spills(tin: Any) -> None:
    """What a depression runs over into is what a path from its pit comes to next."""
    found = ts.depressions(tin, min_depth=1.0)
    pits = found.columns["pit_vertex"]
    if len(pits) == 0:
        return
    parts = ts.flow_path(tin, tin.points[pits, :2], fill_depressions=True).columns
    for row, (pit, into) in enumerate(zip(pits, found.columns["into"], strict=True)):
        ponds = parts["pit"][parts["start"] == row]
        later = [number for one in ponds[ponds >= 0][1:] for number in np.flatnonzero(pits == one)]
        assert [pit, into] == [ponds[0], [*later, -1][0]], f"depression {row}: not into {into}"


CAMPAIGNS = (Campaign("hydrology", "flow paths, catchments, ponds", generate, examine),)
