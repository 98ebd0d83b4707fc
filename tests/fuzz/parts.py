"""Campaign: products of a surface in tiles, against those of the whole surface."""

from __future__ import annotations

import numpy as np
from support.parts import Tiling
from support.point_cells import PointCells
from support.point_sets import points
from support.product_parts import require_parts_of_products

import tinsmith as ts

from .campaign import Campaign, Case

_MOST_CUTS = 4


def generate(rng: np.random.Generator) -> Case:
    """Points, lines between tiles, some through points, levels at vertices and between."""
    cloud = points(rng, int(rng.integers(3, 60)))
    cuts = []
    for axis in (0, 1):
        values = [one[axis] for one in cloud]
        low, high = min(values), max(values)
        found = {float(rng.choice(values)) for _ in range(int(rng.integers(0, _MOST_CUTS)))}
        found |= {float(low + (high - low) * rng.random()) for _ in range(int(rng.integers(0, 3)))}
        cuts.append(sorted(found))
    heights = [one[2] for one in cloud]
    low, high = min(heights), max(heights)
    levels = {float(rng.choice(heights)) for _ in range(2)}
    levels |= {float(low + (high - low) * rng.random()) for _ in range(3)}
    return {
        "points": cloud,
        "xs": cuts[0],
        "ys": cuts[1],
        "levels": sorted(levels),
        "cells": int(rng.integers(3, 30)),
        "seed": int(rng.integers(0, 1000)),
    }


def examine(case: Case) -> str:
    """Compute every product of the tiles in another order, and join it."""
    xyz = np.array(case["points"], np.float64).reshape(-1, 3)
    try:
        tin = ts.triangulate(xyz)
    except ts.PointsError:
        return "refused"
    tiling = Tiling(PointCells(xyz, case["xs"], case["ys"]))
    made = require_parts_of_products(
        tin, tiling, levels=case["levels"], cells=case["cells"], seed=case["seed"]
    )
    return f"{made} products"


CAMPAIGNS = (Campaign("parts", "products of a surface in tiles", generate, examine),)
