"""Flow paths, catchments, depressions and ponds of hard surfaces.

The oracles: gradients in fractions, flow paths from inside of catchments, a priority flood on
edges, stage-storage tables, shapely.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from support.hydrology_oracle import flood, require_catchments, require_descent

import tinsmith as ts

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """A grid with many flats, or scattered points, perhaps far away and trimmed."""
    count = int(rng.integers(4, 80))
    if rng.random() < 0.5:
        side = int(rng.integers(2, 9))
        x, y = (axis.ravel() for axis in np.meshgrid(np.arange(side), np.arange(side)))
        points = np.column_stack([x, y, rng.integers(0, int(rng.integers(1, 6)), len(x))])
    else:
        xy = rng.uniform(0, 60, (count, 2)).round(int(rng.choice([0, 1, 9])))
        points = np.column_stack([xy, rng.uniform(0, 9, count).round(int(rng.choice([0, 9])))])
    origin = [0.0, 0.0, 0.0] if rng.random() < 0.7 else [752_000.0, 4_024_000.0, 300.0]
    return {
        "points": (points + origin).tolist(),
        "max_edge": [None, 1.5, 20.0][int(rng.integers(3))],
        "starts": rng.random((10, 2)).tolist(),
        "level": float(rng.uniform(0, 6) + origin[2]),
    }


def examine(case: Case) -> str:
    """Ask for everything, and hold it against the oracles."""
    try:
        tin = ts.triangulate(case["points"], max_edge=case["max_edge"], crs="EPSG:32616")
    except ts.TinsmithError:
        return "refused: points"
    require_paths(tin, case["starts"])
    require_depressions(tin)
    require_ponds(tin, case["level"])
    require_catchments(tin, np.array(case["starts"]))
    require_accumulation(tin)
    return "flow"


def require_paths(tin: Any, shares: list[list[float]]) -> None:
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    starts = np.vstack([low + np.array(shares) * (high - low), tin.points[:, :2]])
    starts = starts[tin.locate(starts) >= 0]
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


CAMPAIGNS = (Campaign("hydrology", "flow paths, catchments, ponds", generate, examine),)
