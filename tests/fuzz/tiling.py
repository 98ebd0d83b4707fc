"""Campaign: triangles of boxes from the points near by, against the whole triangulation."""

from __future__ import annotations

import numpy as np
from support.point_cells import PointCells
from support.point_sets import points
from support.tiled import require_triangles_of_the_whole

import tinsmith as ts

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
    }


def examine(case: Case) -> str:
    """Ask for every cell."""
    xyz = np.array(case["points"], np.float64).reshape(-1, 3)
    try:
        ts.triangulate(xyz)
    except ts.PointsError:
        return "refused"
    source = PointCells(xyz, case["xs"], case["ys"])
    rounds = require_triangles_of_the_whole(
        xyz, source, margin=case["margin"], duplicates=case["duplicates"]
    )
    return f"{rounds} rounds" if rounds < 4 else "more rounds"


CAMPAIGNS = (Campaign("tiling", "triangles of boxes of a surface in cells", generate, examine),)
