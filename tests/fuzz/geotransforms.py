"""Rasters of hard surfaces in cells of any geotransform: flipped, rectangular, rotated, sheared.

The oracles: `TIN.interpolate` and `TIN.locate` at the centres, bit for bit; gradients in fractions;
planes, whose means are their values in the middle; blocks of a lazy raster beside the whole; the
same cells in another order; the geotransform of the file.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case
from .rasters import make_points, require_gradients

VALUES = ["elevation", "slope", "aspect", "hillshade", "tri", "roughness", "mean-curvature"]


def generate(rng: np.random.Generator) -> Case:
    """A surface, and a geotransform that lies upon its vertices, beside it, or is hostile."""
    kind = str(rng.choice(["lattice", "scatter", "needles", "plane", "parts"]))
    points = make_points(rng, kind)
    points[:, :2] += rng.choice([0.0, 500_000.0, 4_030_000.25], 2)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    shape = rng.choice([1, 2, 7, 40], 2)
    extent = max(float((high - low).max()), 1e-9)
    side = extent / float(rng.choice([0.5, 3.0, 20.0, 60.0]))
    is_whole = rng.random() < 0.4
    if is_whole:
        low, side = np.floor(low), float(rng.choice([0.25, 0.5, 1.0, 2.0]))
    way = str(rng.choice(["aligned", "aligned", "rotated", "sheared", "hostile"]))
    turn = choose_turn(rng, way, is_whole) * side
    with np.errstate(invalid="ignore", over="ignore"):
        middle = turn @ (shape[::-1] / 2)
    middle = np.clip(np.nan_to_num(middle), -1e300, 1e300)
    off = rng.choice([-0.4, -0.25, 0.0, 0.0, 0.25, 0.4], 2) * extent
    corner = (low + high) / 2 - middle + off
    corner = np.rint(corner * 4) / 4 if is_whole else corner
    (a, b), (d, e) = turn.tolist()
    return {
        "points": points.tolist(),
        "kind": kind,
        "max_edge": None if kind != "parts" else extent / 4,
        "transform": [a, b, float(corner[0]), d, e, float(corner[1])],
        "shape": shape.tolist(),
        "way": way,
        "value": str(rng.choice(VALUES)),
        "method": str(rng.choice(["linear", "linear", "nearest", "natural"])),
        "smooth": bool(rng.random() < 0.3),
        "operator": str(rng.choice(["", "", "horn", "zevenbergen-thorne"])),
        "threads": int(rng.integers(1, 3)),
        "cut": rng.random(4).tolist(),
    }


def choose_turn(rng: np.random.Generator, way: str, is_whole: bool) -> Any:
    """Return the sides of a cell as the columns of a matrix."""
    if way == "aligned":
        return np.diag(rng.choice([-1, 1], 2) * rng.choice([0.5, 1.0, 1.0, 3.0], 2))
    if way == "hostile":
        scale = rng.choice([0.0, 1e-300, 1e-15, 1e-12, 1.0, 1e12, 1e300, np.nan, np.inf], (2, 2))
        return scale * rng.choice([-1, 1], (2, 2))
    if is_whole:
        return rng.integers(-3, 4, (2, 2)).astype(float)
    if way == "sheared":
        return rng.uniform(-2, 2, (2, 2))
    angle = float(rng.choice([0.01, 0.3, 0.785398163, 1.0, 1.57079632679, 3.0]))
    turn = np.array([[np.cos(angle), np.sin(angle)], [np.sin(angle), -np.cos(angle)]])
    return turn * rng.choice([-1, 1], 2)


def examine(case: Case) -> str:
    """Ask for all that a raster of such cells can hold."""
    try:
        tin = ts.triangulate(case["points"], max_edge=case["max_edge"])
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    rows, columns = case["shape"]
    try:
        grid = ts.Grid.of_transform(case["transform"], (rows, columns))
        raster = ts.rasterize(tin, grid=grid, threads=1)
    except ts.OptionError as error:
        return examine_refusal(str(error), case)
    except ts.PointsError:
        with np.errstate(over="ignore", invalid="ignore"):
            places = list_centers(grid)
        assert not np.isfinite(places).all() or (tin.locate(places) < 0).all(), "cells with a value"
        return "refused: nothing there"
    places = list_centers(grid)
    require_centers(tin, raster, places, case)
    require_values(tin, grid, places, case)
    require_means(tin, raster, case)
    require_points(grid, places, tin)
    require_file(raster)
    return case["way"]


def examine_refusal(sentence: str, case: Case) -> str:
    assert sentence.count(". ") == 0, "more than a sentence"
    assert case["way"] == "hostile" or has_no_area(case), f"refused: {sentence}"
    return "refused: geotransform"


def has_no_area(case: Case) -> bool:
    a, b, _, d, e, _ = case["transform"]
    return abs(a * e - b * d) <= 2.0**-30 * np.hypot(a, d) * np.hypot(b, e)


def list_centers(grid: ts.Grid) -> Any:
    """Return the centres of cells, (rows * columns, 2), rounded as the numbers are given."""
    a, b, c, d, e, f = grid.transform
    rows, columns = (np.arange(side) + 0.5 for side in grid.shape)
    column, row = np.tile(columns, len(rows)), np.repeat(rows, len(columns))
    if b == 0.0 == d:
        return np.column_stack([c + column * a, f + row * e])
    return np.column_stack([column * a + row * b + c, column * d + row * e + f])


def require_centers(tin: Any, raster: Any, places: Any, case: Case) -> None:
    found = raster.bands["elevation"].ravel()
    assert np.array_equal(found, tin.interpolate(places), equal_nan=True), "elevations"
    how = {"method": case["method"], "threads": case["threads"]}
    again = ts.rasterize(tin, grid=raster.grid, **how).bands["elevation"]
    wanted = tin.interpolate(places, method=case["method"])
    assert np.array_equal(again.ravel(), wanted, equal_nan=True), case["method"]


def require_values(tin: Any, grid: ts.Grid, places: Any, case: Case) -> None:
    value, rows, columns = case["value"], *grid.shape
    asked: dict[str, Any] = {"value": value}
    is_of_cells = value in ("tri", "roughness", "mean-curvature")
    if not is_of_cells and case["operator"] and value != "elevation":
        asked["operator"], is_of_cells = case["operator"], True
    elif value in ("slope", "aspect", "hillshade"):
        asked["smooth"] = case["smooth"]
    try:
        made = ts.rasterize(tin, grid=grid, **asked).bands[value]
    except ts.PointsError:
        assert is_of_cells, "no value"
        return
    except ts.OptionError:
        assert is_of_cells, "refused"
        assert value not in ("tri", "roughness"), "refused"
        assert not grid.is_aligned, "refused of cells that are not rotated"
        return
    lazy = ts.rasterize(tin, grid=grid, lazy=True, **asked).bands[value]
    top, left = int(case["cut"][0] * rows), int(case["cut"][1] * columns)
    block = slice(top, top + 1 + int(case["cut"][2] * 9)), slice(left, left + 1)
    assert np.array_equal(lazy[block], made[block], equal_nan=True), "a block"
    if value in ("slope", "aspect") and not case["smooth"] and not is_of_cells:
        require_gradients(tin, places, made.ravel(), value)
    if not grid.is_aligned:
        return
    other = turn_about(grid)
    if np.array_equal(list_centers(other), places.reshape(rows, columns, 2)[::-1].reshape(-1, 2)):
        again = ts.rasterize(tin, grid=other, **asked).bands[value]
        assert np.array_equal(again[::-1], made, equal_nan=True), "rows the other way"


def turn_about(grid: ts.Grid) -> ts.Grid:
    """Return the same cells with rows the other way."""
    a, b, c, d, e, f = grid.transform
    return ts.Grid.of_transform((a, b, c, d, -e, f + grid.shape[0] * e), grid.shape)


def require_means(tin: Any, raster: Any, case: Case) -> None:
    grid = raster.grid
    found = ts.rasterize(tin, grid=grid, at="mean", threads=case["threads"]).bands["elevation"]
    centers = raster.bands["elevation"]
    inside = tin.locate(list_centers(grid)).reshape(grid.shape) >= 0
    if case["kind"] != "needles":  # which rounding among rotated columns and rows may flatten
        assert not np.isnan(found[inside]).any(), "a covered cell has no mean"
    low, high = tin.points[:, 2].min(), tin.points[:, 2].max()
    slack = 1e-6 * max(high - low, 1e-9)
    known = found[np.isfinite(found)]
    assert ((known >= low - slack) & (known <= high + slack)).all(), "means out of range"
    if case["kind"] != "plane":
        return
    rows, columns = (np.arange(side) for side in grid.shape)
    is_whole = inside.copy()
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        x, y = np.broadcast_arrays(*grid.transform.apply(columns + i, (rows + j)[:, None]))
        is_whole &= tin.locate(np.stack([x, y], axis=-1).reshape(-1, 2)).reshape(grid.shape) >= 0
    apart = np.abs(found - centers)[is_whole]
    assert (apart <= 1e-5 * max(high - low, 1.0)).all(), "the mean of a plane"


def require_points(grid: ts.Grid, places: Any, tin: Any) -> None:
    """Each centre is a point in its own cell, and vertices in those that hold them."""
    cloud = np.column_stack([places, np.zeros(len(places))])
    counts = ts.rasterize_counts(cloud, grid=grid).bands["count"]
    assert (counts == 1).all(), "points in the middle"
    column, row = grid.transform.invert().apply(*tin.points[:, :2].T)
    away = 1e-6 + np.abs(np.column_stack([column, row])).max(axis=1) * 1e-9
    for at in (column, row):
        if (np.abs(at - np.rint(at)) < away).any():
            return  # rounding decides
    inside = (column > 0) & (row > 0) & (column < grid.shape[1]) & (row < grid.shape[0])
    wanted = np.zeros(grid.shape, int)
    np.add.at(wanted, (row[inside].astype(int), column[inside].astype(int)), 1)
    try:
        found = ts.rasterize_counts(tin.points, grid=grid).bands["count"]
    except ts.PointsError:
        found = np.zeros(grid.shape, int)
    assert np.array_equal(found, wanted), "points"


def require_file(raster: Any) -> None:
    import rasterio

    with tempfile.TemporaryDirectory() as folder:
        path = ts.write(raster, Path(folder, "a.tif"), overviews="none")
        with rasterio.open(path) as file:
            assert tuple(file.transform)[:6] == tuple(raster.grid.transform), "the geotransform"
            back = file.read(1)
        assert ts.rasterize(ts.triangulate([[-1e9, -1e9, 0], [1e9, -1e9, 1], [0, 1e9, 2]]),
                            like=path).grid == raster.grid, "the grid of the file"  # fmt: skip
    assert np.array_equal(back, raster.bands["elevation"], equal_nan=True), "the file"


CAMPAIGNS = (Campaign("geotransforms", "rasters in cells of any geotransform", generate, examine),)
