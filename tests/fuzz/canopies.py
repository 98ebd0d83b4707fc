"""Surface, terrain and canopy height of points on hard grounds and grids.

The oracle: a dictionary of cells for the highest points, `interpolate` at the centres for the
ground, and what notes tell counted again.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from support.point_sets import scattered

import tinsmith as ts

from .campaign import Campaign, Case

FOOT = 0.3048


def generate(rng: np.random.Generator) -> Case:
    """Ground that may have gaps, points upon and beside it, cells that cut both."""
    ground = scattered(rng, int(rng.integers(3, 60)), 20.0)
    count = int(rng.integers(1, 120))
    points = np.column_stack(
        [rng.uniform(-3, 23, (count, 2)), rng.normal(size=count) * rng.choice([0.0, 1.0, 30.0])]
    )
    if rng.random() < 0.5:
        points[:, :2] = np.round(points[:, :2])
    return {
        "ground": ground.tolist(),
        "z": rng.normal(size=len(ground)).tolist(),
        "max_edge": [None, 6.0][int(rng.integers(2))],
        "points": points.tolist(),
        "classes": rng.choice([1, 2, 5, 7, 18], count).tolist(),
        "unit": str(rng.choice(["m", "ft"])),
        "spacing": float(rng.choice([0.5, 1.0, 3.0, 50.0])),
        "west": float(rng.choice([0.0, 500_000.0])),
    }


def examine(case: Case) -> str:
    """Make the three bands and compare them cell by cell."""
    move = [case["west"], 0.0, 0.0]
    ground = np.column_stack([np.array(case["ground"]), case["z"]]) + move
    points = np.array(case["points"]) + move
    try:
        tin = ts.triangulate(
            ground, max_edge=case["max_edge"], crs="EPSG:32616", elevation_unit="m"
        )
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    classes = np.array(case["classes"], np.uint8)
    cloud = ts.Survey(
        points=points.copy(),
        crs="EPSG:32616",
        elevation_unit=case["unit"],
        attributes={"classification": classes},
    )
    if case["unit"] == "ft":
        points[:, 2] *= FOOT
    try:
        made = ts.rasterize_canopy(tin, cloud, spacing=case["spacing"])
    except ts.PointsError as error:
        require_nothing(tin, points, case["spacing"])
        return f"refused: {str(error)[:20]}"
    require_bands(made, tin, points)
    said = " ".join(made.notes)
    for number, name in ((7, "low noise"), (18, "high noise")):
        count = int((classes == number).sum())
        assert bool(count) == (f"class of {name}" in said), name
    below = int((made.bands["chm"] < 0).sum())
    assert bool(below) == ("below 0" in said), "heights below 0"
    return "made"


def find_highest(grid: ts.Grid, points: Any) -> dict[tuple[int, int], float]:
    found: dict[tuple[int, int], float] = {}
    box, (rows, columns) = grid.bounds, grid.shape
    for x, y, z in points.tolist():
        if box.xmin <= x <= box.xmax and box.ymin <= y <= box.ymax:
            row = min(int((box.ymax - y) / grid.spacing), rows - 1)
            column = min(int((x - box.xmin) / grid.spacing), columns - 1)
            found[row, column] = max(z, found.get((row, column), -math.inf))
    return found


def require_bands(made: Any, tin: Any, points: Any) -> None:
    rows, columns = made.shape
    box, side = made.grid.bounds, made.grid.spacing
    x = box.xmin + (np.arange(columns) + 0.5) * side
    y = box.ymax - (np.arange(rows) + 0.5) * side
    centers = np.column_stack([np.tile(x, rows), np.repeat(y, columns)])
    below = tin.interpolate(centers).reshape(made.shape)
    assert np.array_equal(made.bands["dtm"], below, equal_nan=True), "ground"
    highest = np.full(made.shape, np.nan)
    for cell, z in find_highest(made.grid, points).items():
        highest[cell] = z
    assert np.allclose(made.bands["dsm"], highest, rtol=0, atol=1e-9, equal_nan=True), "highest"
    height = made.bands["dsm"] - made.bands["dtm"]
    assert np.array_equal(made.bands["chm"], height, equal_nan=True), "height"


def require_nothing(tin: Any, points: Any, spacing: float) -> None:
    """A raster was refused: no cell has a point and ground."""
    try:
        ground = ts.rasterize(tin, spacing=spacing)
    except ts.PointsError:
        return
    known = np.isfinite(ground.bands["elevation"])
    assert not any(known[cell] for cell in find_highest(ground.grid, points)), "refused"


CAMPAIGNS = (Campaign("canopies", "surface, terrain and canopy height", generate, examine),)
