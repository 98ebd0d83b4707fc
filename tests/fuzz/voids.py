"""Campaign: rasters with cells without data, in tiles, against the surface in memory."""

from __future__ import annotations

import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from support.many_files import Shuffled

import tinsmith as ts

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """Cells of which a share, squares and rows have no elevation, and which of them are read."""
    shape = rng.integers(2, 25, 2)
    cells = rng.integers(0, 9, shape).astype(np.float64)
    is_void = rng.random(shape) < rng.choice([0.0, 0.02, 0.3, 0.6])
    for _ in range(int(rng.integers(0, 4))):
        start, size = rng.integers(0, shape), rng.integers(1, 9, 2)
        is_void[start[0] : start[0] + size[0], start[1] : start[1] + size[1]] = True
    if rng.random() < 0.3:
        is_void[int(rng.integers(0, shape[0]))] = True
    return {
        "cells": np.where(is_void, -99.0, cells).tolist(),
        "stride": int(rng.choice([1, 1, 2, 3])),
        "tiles": int(rng.integers(1, 12)),
        "seed": int(rng.integers(0, 10**6)),
    }


def examine(case: Case) -> str:
    """Compare a raster, the area and the counts of both."""
    cells = np.array(case["cells"], np.float64)
    cells[cells == -99.0] = np.nan
    rows, columns = cells.shape
    box = ts.Bounds(500_000.0, 4_000_000.0, 500_000.0 + 2 * columns, 4_000_000.0 + 2 * rows)
    raster = ts.Raster({"elevation": cells}, ts.Grid(box, (rows, columns), 2.0), crs="EPSG:32616")
    options = {"stride": case["stride"]}
    with TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        folder = Path(name)
        path = ts.write(raster, folder / "cells.tif")
        try:
            tin = ts.triangulate(ts.read(path, **options))
        except ts.TinsmithError:
            return _require_refusal(path, folder, options)
        _compare(tin, ts.tiles(path, **options), folder, case)
    return "voids" if np.isnan(cells).any() else "full"


def _require_refusal(path: Path, folder: Path, options: dict[str, int]) -> str:
    try:
        cloud = ts.tiles(path, **options)
        cloud.check(run=folder / "run", executor=Shuffled())
    except ts.TinsmithError:
        return "refused"
    raise AssertionError("in memory it is refused")


def _compare(tin: ts.TIN, cloud: ts.TiledPoints, folder: Path, case: Case) -> None:
    import rasterio

    way = {"tiles": case["tiles"], "executor": Shuffled(case["seed"])}
    proof = cloud.check(run=folder / "run", **way)
    assert (proof.triangles, proof.vertices) == (len(tin.triangles), len(tin.points))
    for value in ("elevation", "hillshade"):
        try:
            wanted = ts.rasterize(tin, spacing=0.7, value=value).bands[value]
        except ts.PointsError:
            continue
        made = cloud.rasterize(folder / "made.tif", spacing=0.7, value=value, **way)
        with rasterio.open(made) as dataset:
            np.testing.assert_array_equal(dataset.read(1), wanted)


CAMPAIGNS = (Campaign("voids", "rasters with voids in tiles", generate, examine),)
