"""Operators on the cells of grids: hard elevations, holes, units, rims and blocks.

The oracle is gdaldem's source, cell by cell, of the elevations that `rasterize` gives.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from support import operator_oracle

import tinsmith as ts
from tinsmith.terrain.gridding import OPERATORS

from .campaign import Campaign, Case

CRSS = [(None, None), ("EPSG:32616", "m"), ("EPSG:2274", "m"), ("EPSG:32616", "ft")]
METRES = {None: 1.0, "EPSG:32616": 1.0, "EPSG:2274": 1200 / 3937}
FEET = {None: None, "m": 1.0, "ft": 0.3048}


def generate(rng: np.random.Generator) -> Case:
    """Cells of a raster with holes, or of a grid of any size upon scattered points."""
    crs, unit = CRSS[int(rng.integers(len(CRSS)))]
    value = str(rng.choice(list(OPERATORS)))
    rows, columns = rng.integers(1, 14, 2).tolist()
    kind = str(rng.choice(["flat", "steps", "random", "steep", "plane"]))
    return {
        "crs": crs,
        "unit": unit,
        "value": value,
        "operator": str(rng.choice(OPERATORS[value])) if OPERATORS[value] else None,
        "edges": bool(rng.random() < 0.5),
        "spacing": float(rng.choice([0.25, 1.0, 2.0, 30.0])),
        "corner": rng.choice([0.0, 500_000.0, 4_030_000.25], 2).tolist(),
        "elevations": make_elevations(rng, kind, rows, columns).tolist(),
        "keep": (rng.random((rows, columns)) >= rng.choice([0.0, 0.1, 0.4])).tolist(),
        "shift": rng.choice([0.0, 0.0, 0.3, 1.0], 2).tolist(),
        "method": str(rng.choice(["linear", "linear", "nearest", "natural"])),
        "light": [float(rng.uniform(-400, 400)), float(rng.choice([0.0, 30.0, 90.0]))],
        "cut": rng.random(4).tolist(),
    }


def make_elevations(rng: np.random.Generator, kind: str, rows: int, columns: int) -> Any:
    y, x = np.mgrid[0:rows, 0:columns].astype(float)
    if kind == "flat":
        return np.full((rows, columns), float(rng.choice([0.0, -7.3, 8848.86])))
    if kind == "steps":
        return rng.integers(0, 3, (rows, columns)).astype(float)
    if kind == "plane":
        a, b = rng.integers(-3, 4, 2)
        return a * x + b * y + 100.0
    return rng.normal(size=(rows, columns)) * (1e6 if kind == "steep" else 5.0)


def examine(case: Case) -> str:
    """Compare all cells with the twin, and a block with the whole."""
    z = np.array(case["elevations"])
    (rows, columns), side = z.shape, case["spacing"]
    west, south = case["corner"]
    bounds = ts.Bounds(west, south, west + columns * side, south + rows * side)
    y, x = np.mgrid[0:rows, 0:columns]
    points = np.column_stack(
        [(west + (x + 0.5) * side).ravel(), (bounds.ymax - (y + 0.5) * side).ravel(), z.ravel()]
    )[np.array(case["keep"]).ravel()]
    move = np.array(case["shift"]) * side
    moved = ts.Bounds(west + move[0], south + move[1], bounds.xmax + move[0], bounds.ymax + move[1])
    try:
        grid = ts.Grid(moved, shape=(rows, columns), spacing=side)
        tin = ts.triangulate(
            points, crs=case["crs"], elevation_unit=case["unit"], max_edge=4 * side
        )
        elevations = ts.rasterize(tin, grid=grid, method=case["method"]).bands["elevation"]
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    return compare(case, tin, grid, elevations.tolist())


def compare(case: Case, tin: Any, grid: ts.Grid, z: Any) -> str:
    value, operator = case["value"], case["operator"]
    options = {
        "grid": grid,
        "value": value,
        "operator": operator,
        "compute_edges": case["edges"],
        "method": case["method"],
        "azimuth": case["light"][0],
        "altitude": case["light"][1],
    }
    windows = [
        [operator_oracle.find_window(z, row, column, case["edges"]) for column in range(len(z[0]))]
        for row in range(len(z))
    ]
    try:
        found = ts.rasterize(tin, **options).bands[value]
    except ts.PointsError:
        assert all(window is None for row in windows for window in row), "refused, with values"
        return "refused: no neighbours"
    unit = FEET[case["unit"]] or METRES[case["crs"]]
    up = unit / METRES[case["crs"]]
    for row, some in enumerate(windows):
        for column, window in enumerate(some):
            require_cell(found[row, column], window, case, grid.spacing, up)
    lazy = ts.rasterize(tin, lazy=True, **options).bands[value]
    top, bottom = sorted(int(part * (len(z) + 1)) for part in case["cut"][:2])
    left, right = sorted(int(part * (len(z[0]) + 1)) for part in case["cut"][2:])
    block, whole = lazy[top:bottom, left:right], found[top:bottom, left:right]
    assert np.array_equal(block, whole, equal_nan=True), "a block"
    return value


def require_cell(found: float, window: Any, case: Case, side: float, up: float) -> None:
    value = case["value"]
    if window is None:
        assert math.isnan(found), "a value without neighbours"
        return
    light = tuple(case["light"])
    wanted = operator_oracle.measure(window, value, case["operator"], side, side, up, light)
    if is_level(window, value):  # but for rounding: a direction that rounding alone tells
        return
    assert math.isnan(found) == math.isnan(wanted), f"{value}: {found}, not {wanted}"
    if math.isnan(wanted):
        return
    off = abs(found - wanted)
    rounding = 1e-13 * max(map(abs, window)) * up
    if value == "aspect":
        assert min(off, 360 - off) <= 1e-5, f"aspect: {found}, not {wanted}"
    elif value == "hillshade":
        assert off <= 0.5 + 1e-6, f"light: {found}, not {wanted}"
    elif value.endswith("-curvature"):
        slack = (rounding / side**2) * (1 + max(map(abs, window)) * up / side**2) + 1e-9
        assert off <= 1e-6 * abs(wanted) + slack, f"{value}: {found}, not {wanted}"
    else:
        assert off <= 1e-9 * abs(wanted) + rounding / side + 1e-9, f"{value}: {found}, {wanted}"


def is_level(window: Any, value: str) -> bool:
    """Whether a direction, or what is divided by a slope, is that of rounding alone."""
    a, b, c, d, _, f, g, h, i = window
    gradients = [c + 2 * f + i - a - 2 * d - g, a + 2 * b + c - g - 2 * h - i, f - d, b - h]
    least = 1e-6 * max(map(abs, window))
    needs_direction = value in ("aspect", "profile-curvature", "plan-curvature")
    needs_direction |= value == "tangential-curvature"
    pairs = gradients[:2], gradients[2:]
    return needs_direction and any(0 < max(map(abs, pair)) <= least for pair in pairs)


CAMPAIGNS = (Campaign("operators", "slopes, curvatures and others of cells", generate, examine),)
