"""Rasters, light, heights above ground and curvature of hard surfaces on hostile grids.

The oracles: `TIN.interpolate` and `TIN.locate` at the centres, bit for bit; planes, whose means are
their values in the middle; blocks of a lazy raster beside the whole; the plain twin of curvature.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from support import relief_oracle
from support.point_sets import scattered, whole_number_grid

import tinsmith as ts
from tinsmith.terrain import _kernel
from tinsmith.terrain.gridding.grids import cover

from .campaign import Campaign, Case

CRSS = [
    (None, None),
    ("EPSG:32616", "m"),
    ("EPSG:2274", "m"),
    ("EPSG:2274", None),
    ("EPSG:4326", "m"),
]
CELLS = 40_000


def generate(rng: np.random.Generator) -> Case:
    """A surface, and cells that lie upon its vertices, beside it, around it or deep within it."""
    crs, unit = CRSS[int(rng.integers(len(CRSS)))]
    kind = str(rng.choice(["lattice", "scatter", "needles", "plane", "parts"]))
    points = make_points(rng, kind)
    if crs == "EPSG:4326":
        points[:, :2] = points[:, :2] / 50.0 + rng.choice([0.0, 60.0])
    elif rng.random() < 0.6:
        points[:, :2] *= float(rng.choice([1e-5, 1.0, 1e3]))
        points[:, :2] += rng.choice([0.0, 500_000.0, 4_030_000.25, -1e8], 2)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    return {
        "points": points.tolist(),
        "kind": kind,
        "crs": crs,
        "unit": unit,
        "max_edge": None if kind != "parts" else float((high - low).max() / 4),
        "cells": choose_cells(rng, low, high),
        "value": str(rng.choice(["elevation", "elevation", "slope", "aspect", "hillshade"])),
        "method": str(rng.choice(["linear", "linear", "nearest", "natural"])),
        "threads": int(rng.integers(1, 4)),
        "light": [float(rng.uniform(-400, 400)), float(rng.choice([0.0, 30.0, 90.0]))],
        "cut": rng.random(4).tolist(),
        "packing": str(rng.choice(["deflate", "none"])),
    }


def make_points(rng: np.random.Generator, kind: str) -> Any:
    count = int(rng.integers(3, 90))
    if kind == "lattice":
        return whole_number_grid(rng, *rng.integers(2, 10, 2), 4)
    if kind == "needles":
        along = rng.uniform(0, 40, count)
        off = rng.choice([1e-9, 1e-3, 0.3]) * rng.normal(size=count)
        return np.column_stack([along, 0.3 * along + off, rng.uniform(0, 5, count)])
    xy = scattered(rng, count, 40.0)
    if kind == "plane":
        a, b = rng.integers(-3, 4, 2)
        xy = xy.round(0)
        return np.column_stack([xy, a * xy[:, 0] + b * xy[:, 1] + 7.0])
    return np.column_stack([xy, rng.uniform(-9, 9, count)])


def choose_cells(rng: np.random.Generator, low: Any, high: Any) -> dict[str, Any]:
    """Spacing alone, or a grid: its corner, its side and how many."""
    extent = float(max((high - low).max(), 1e-12))
    spacing = extent / float(rng.choice([0.4, 1.0, 3.0, 17.0, 60.0]))
    if rng.random() < 0.3:
        spacing = float(rng.choice([0.25, 0.5, 1.0, 2.0]))
    if rng.random() < 0.5:
        return {"spacing": spacing}
    corner = low + rng.choice([-0.5, -0.1, 0.0, 0.0, 0.1, 0.3], 2) * extent
    if rng.random() < 0.4:  # centres upon multiples
        corner = np.floor(corner / spacing) * spacing - spacing / 2
    return {
        "spacing": spacing,
        "corner": corner.tolist(),
        "shape": rng.choice([1, 9, 40, 300], 2).tolist(),
    }


def as_grid(cells: dict[str, Any]) -> ts.Grid:
    (west, south), (rows, columns), side = cells["corner"], cells["shape"], cells["spacing"]
    bounds = ts.Bounds(west, south, west + columns * side, south + rows * side)
    return ts.Grid(bounds, shape=(rows, columns), spacing=side)


def examine(case: Case) -> str:
    """Ask for all that a raster can hold."""
    try:
        tin = ts.triangulate(
            case["points"], max_edge=case["max_edge"], crs=case["crs"], elevation_unit=case["unit"]
        )
        where = case["cells"]
        if "corner" not in where and tin.bounds.width * tin.bounds.height > (
            CELLS * where["spacing"] ** 2
        ):
            return "refused: too many cells"
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    asked = {"grid": as_grid(where)} if "corner" in where else {"spacing": where["spacing"]}
    try:
        raster = ts.rasterize(tin, threads=1, **asked)
    except ts.PointsError as error:
        if str(error).startswith("Corners"):
            return "refused: cells beyond the globe"
        grid = asked["grid"] if "grid" in asked else cover(tin.bounds, where["spacing"])
        assert (tin.locate(list_centers(grid)) < 0).all(), "cells that have a value"
        return "refused: nothing there"
    except ts.OptionError as error:
        return f"refused: {error.option}"
    require_curvature(tin)
    require_centers(tin, raster, case)
    require_blocks(tin, raster, case)
    require_means(tin, raster, case)
    require_light(tin, raster.grid, case)
    require_heights(tin, case)
    require_file(raster, case)
    return case["kind"]


def list_centers(grid: ts.Grid) -> Any:
    rows, columns = grid.shape
    x = grid.bounds.xmin + (np.arange(columns) + 0.5) * grid.spacing
    y = grid.bounds.ymax - (np.arange(rows) + 0.5) * grid.spacing
    return np.column_stack([np.tile(x, rows), np.repeat(y, columns)])


def require_centers(tin: Any, raster: Any, case: Case) -> None:
    places = list_centers(raster.grid)
    found = raster.bands["elevation"].ravel()
    assert np.array_equal(found, tin.interpolate(places), equal_nan=True), "elevations"
    if case["value"] == "elevation":
        method = case["method"]
        again = ts.rasterize(tin, grid=raster.grid, method=method, threads=case["threads"])
        wanted = tin.interpolate(places, method=method)
        assert np.array_equal(again.bands["elevation"].ravel(), wanted, equal_nan=True), method
        return
    name = case["value"]
    azimuth, altitude = case["light"]
    made = ts.rasterize(
        tin,
        grid=raster.grid,
        value=name,
        azimuth=azimuth,
        altitude=altitude,
        threads=case["threads"],
    )
    if name != "hillshade" and case["crs"] is None:
        require_gradients(tin, places, made.bands[name].ravel(), name)
    require_no_order(tin, made, case)


def require_gradients(tin: Any, places: Any, found: Any, name: str) -> None:
    """Some cells, those on vertices and edges among them, beside the gradient in fractions."""
    gradient_at = relief_oracle.GradientAt(tin.points, tin.triangles)
    at_vertex = {tuple(row) for row in tin.points[:, :2].tolist()}
    special = [i for i, row in enumerate(places.tolist()) if tuple(row) in at_vertex]
    chosen = [*special[:30], *range(0, len(places), max(1, len(places) // 40))]
    measure = gradient_at.slope if name == "slope" else gradient_at.aspect
    for i in chosen:
        wanted = measure(*places[i].tolist())
        assert np.isnan(found[i]) == np.isnan(wanted), f"{name} of cell {i}"
        if not np.isnan(wanted):
            off = abs(found[i] - wanted)
            assert min(off, 360.0 - off) <= 1e-5, f"{name} of cell {i}: {found[i]}, not {wanted}"


def require_no_order(tin: Any, made: Any, case: Case) -> None:
    """The same surface with its triangles in another order has the same cells."""
    rng = np.random.default_rng(len(tin.triangles))
    order, turn = rng.permutation(len(tin.triangles)), int(rng.integers(3))
    triangles = np.roll(tin.triangles[order], turn, axis=1)
    other = ts.TIN.from_triangles(
        tin.points, triangles, crs=tin.crs, elevation_unit=tin.elevation_unit
    )
    name, (azimuth, altitude) = case["value"], case["light"]
    for smooth in (False, True):
        one, again = (
            ts.rasterize(
                each,
                grid=made.grid,
                value=name,
                smooth=smooth,
                azimuth=azimuth,
                altitude=altitude,
            ).bands[name]
            for each in (tin, other)
        )
        if smooth and name != "aspect":  # which is undefined where rounding alone is left
            apart = np.abs(one - again)
            assert np.nanmax(apart, initial=0.0) <= (1.0 if name == "hillshade" else 1e-5)
        elif not smooth:
            assert np.array_equal(one, again, equal_nan=True), f"{name} by another order"


def require_blocks(tin: Any, raster: Any, case: Case) -> None:
    lazy = ts.rasterize(tin, grid=raster.grid, lazy=True, threads=case["threads"])
    means = ts.rasterize(tin, grid=raster.grid, at="mean", threads=1)
    lazy_means = ts.rasterize(tin, grid=raster.grid, at="mean", lazy=True)
    rows, columns = raster.shape
    top, bottom = sorted(int(part * (rows + 1)) for part in case["cut"][:2])
    left, right = sorted(int(part * (columns + 1)) for part in case["cut"][2:])
    block = lazy.bands["elevation"][top:bottom, left:right]
    whole = raster.bands["elevation"][top:bottom, left:right]
    assert np.array_equal(block, whole, equal_nan=True), "a block"
    block = lazy_means.bands["elevation"][top:bottom, left:right]
    whole = means.bands["elevation"][top:bottom, left:right]
    assert np.array_equal(block, whole, equal_nan=True), "a block of means"


def require_means(tin: Any, raster: Any, case: Case) -> None:
    means = ts.rasterize(tin, grid=raster.grid, at="mean", threads=case["threads"])
    found, centers = means.bands["elevation"], raster.bands["elevation"]
    assert not np.isnan(found[np.isfinite(centers)]).any(), "a covered cell has no mean"
    low, high = tin.points[:, 2].min(), tin.points[:, 2].max()
    slack = 1e-6 * max(high - low, 1e-9)
    inside = found[np.isfinite(found)]
    assert (inside >= low - slack).all(), "means too low"
    assert (inside <= high + slack).all(), "means too high"
    if case["kind"] != "plane" or max(abs(v) for v in tin.bounds.center) > 1e7:
        return
    corners = list_centers(raster.grid)[:, None, :] + raster.grid.spacing * np.array(
        [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
    )
    is_whole = (tin.locate(corners.reshape(-1, 2)).reshape(-1, 4) >= 0).all(axis=1)
    apart = np.abs(found.ravel() - centers.ravel())[is_whole]
    assert (apart <= 1e-5 * max(high - low, 1.0)).all(), "the mean of a plane"


def require_light(tin: Any, grid: ts.Grid, case: Case) -> None:
    azimuth, altitude = case["light"]
    sun = {"azimuth": azimuth, "altitude": altitude}
    shade = ts.hillshade(tin, grid=grid, **sun).bands["hillshade"]
    drawn = ts.rasterize(tin, grid=grid, value="hillshade", **sun).bands["hillshade"]
    assert np.array_equal(shade, np.nan_to_num(drawn).astype(np.uint8)), "hillshade"
    covered = tin.locate(list_centers(grid)).reshape(grid.shape) >= 0
    assert ((shade > 0) == covered).all(), "light outside, or none inside"
    smooth = ts.hillshade(tin, grid=grid, smooth=True, **sun).bands["hillshade"]
    assert ((smooth > 0) == covered).all(), "smooth light outside, or none inside"
    if case["kind"] == "plane":
        levels = smooth[covered]
        assert len(levels) == 0 or int(np.ptp(levels)) <= 1, "a plane has one light"


def require_heights(tin: Any, case: Case) -> None:
    rng = np.random.default_rng(len(case["points"]))
    bounds = tin.bounds
    sides = (bounds.xmin, bounds.ymin), (bounds.xmax, bounds.ymax)
    xy = np.vstack([rng.uniform(*sides, (50, 2)), tin.points[:20, :2]])
    cloud = np.column_stack([xy, rng.uniform(-5, 5, len(xy))])
    table = ts.height_above(tin, cloud)
    wanted = cloud[:, 2] - tin.interpolate(xy)
    assert np.array_equal(table["height_above_ground"], wanted, equal_nan=True), "heights"


def require_curvature(tin: Any) -> None:
    one = np.ones(1)
    found = _kernel.fit_quadratics(tin.points, tin.triangles, one, one, 1.0, 2)
    wanted = relief_oracle.fit_quadratics(tin.points, tin.triangles)
    assert np.array_equal(found, wanted, equal_nan=True), "curvature"


def require_file(raster: Any, case: Case) -> None:
    import rasterio

    with tempfile.TemporaryDirectory() as folder:
        path = ts.write(raster, Path(folder, "a.tif"), compression=case["packing"])
        with rasterio.open(path) as file:
            back = file.read(1)
            box = raster.grid.bounds
            assert abs(file.bounds.left - box.xmin) <= 1e-9 * raster.grid.spacing
    assert np.array_equal(back, raster.bands["elevation"], equal_nan=True), "the file"


CAMPAIGNS = (
    Campaign("rasters", "rasters, light, heights above ground and curvature", generate, examine),
)
