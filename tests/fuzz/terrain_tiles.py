"""Terrain tiles of random rasters: each pixel, each zoom, both archives."""

from __future__ import annotations

import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from support.terrain_tiles import SIDE, STEPS, decode, interpolate, locate, read_archive

import tinsmith as ts

from .campaign import Campaign, Case

PLACES = {
    "EPSG:32616": (745_000.0, 4_033_000.0, 1.0),
    "EPSG:2274": (1.7e6, 6e5, 1200 / 3937),
    "EPSG:2056": (2.6e6, 1.2e6, 1.0),
    "EPSG:4326": (-84.2, 36.3, 111_320.0),
    "EPSG:3031": (1e6, 2e6, 1.0),
}
MOST_TILES = 12


def generate(rng: np.random.Generator) -> Case:
    """Cells of a raster with gaps, and how they are written."""
    shape = [int(n) for n in rng.integers(1, 40, 2)]
    return {
        "crs": str(rng.choice(list(PLACES))),
        "spacing": float(10.0 ** rng.uniform(-1, 3)),
        "values": rng.uniform(-50, 3000, shape).round(int(rng.integers(0, 4))).tolist(),
        "gaps": float(rng.choice([0.0, 0.1, 0.6])),
        "seed": int(rng.integers(1000)),
        "nodata": rng.choice([None, -9999.0]),
        "encoding": str(rng.choice(list(STEPS))),
        "shown": str(rng.choice(["lowest", "transparent"])),
        "coarser": int(rng.integers(0, 3)),
        "suffix": str(rng.choice([".pmtiles", ".mbtiles"])),
    }


def examine(case: Case) -> str:
    """Compare pixels with bilinear values, and zooms with the means of the one below."""
    west, south, metres = PLACES[case["crs"]]
    spacing = case["spacing"] / metres
    values = np.array(case["values"])
    rows, columns = values.shape
    is_gap = np.random.default_rng(case["seed"]).random(values.shape) < case["gaps"]
    nodata = np.nan if case["nodata"] is None else case["nodata"]
    box = ts.Bounds(west, south, west + columns * spacing, south + rows * spacing)
    grid = ts.Grid(box, shape=(rows, columns), spacing=spacing)
    raster = ts.Raster({"elevation": np.where(is_gap, nodata, values)}, grid, crs=case["crs"],
                       nodata=nodata, units={"elevation": "m"})  # fmt: skip
    options = {"tile_encoding": case["encoding"], "gaps": case["shown"]}
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        path = Path(folder, f"a{case['suffix']}")
        try:
            about, tiles = read_archive(ts.write(raster, path, **options))
        except ts.WriteError as error:
            if not is_gap.all() and "pole" not in str(error):
                raise
            return "refused"
        low, high = int(about["minzoom"]), int(about["maxzoom"])
        fewer = ts.write(raster, path, max_zoom=max(high - case["coarser"], low), **options)
        coarse = read_archive(fewer)[1]
        assert {p: one for p, one in tiles.items() if p in coarse} == coarse
    step, lowest = STEPS[case["encoding"]], values[~is_gap].min()
    known = np.where(is_gap, np.nan, values)
    for number, (place, content) in enumerate(tiles.items()):
        found = decode(content, case["encoding"])
        if place[0] == high and number < MOST_TILES and min(rows, columns) > 1:
            wanted = interpolate(known, grid, *locate(place, case["crs"]))
            inside = np.isfinite(wanted)
            assert np.abs(found - wanted)[inside].max(initial=0) <= step / 2 + 1e-5
        if place[0] < high:
            require_means(place, found, tiles, case, lowest)
        assert np.nanmin(found) >= lowest - step
        assert np.nanmax(found) <= known[~is_gap].max() + step
    return case["encoding"]


def require_means(place, found, tiles, case, lowest) -> None:
    """A pixel is the mean of the four below; where some have no data it lies between them."""
    z, x, y = place
    step = STEPS[case["encoding"]]
    low, high = np.full((2, SIDE, SIDE), np.nan)
    for dy in (0, 1):
        for dx in (0, 1):
            content = tiles.get((z + 1, 2 * x + dx, 2 * y + dy))
            below = np.full((SIDE, SIDE), np.nan)
            if content is not None:
                below = decode(content, case["encoding"])
            quarters = below.reshape(SIDE // 2, 2, -1, 2).swapaxes(1, 2).reshape(SIDE // 2, -1, 4)
            part = np.s_[
                dy * SIDE // 2 : (dy + 1) * SIDE // 2, dx * SIDE // 2 : (dx + 1) * SIDE // 2
            ]
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)
                low[part] = np.nanmin(quarters, axis=2)
                high[part] = np.nanmax(quarters, axis=2)
                if case["shown"] == "transparent":
                    means = np.nanmean(quarters, axis=2)
                    assert np.array_equal(np.isnan(means), np.isnan(found[part]))
                    away = np.abs(means - found[part])
                    assert np.nanmax(away, initial=0.0) <= step
    low, high = np.where(np.isnan(low), lowest, low), np.where(np.isnan(high), lowest, high)
    inside = np.isfinite(found)
    assert (found >= low - step)[inside].all()
    assert (found <= high + step)[inside].all()


CAMPAIGNS = (
    Campaign("terrain-tiles", "rasters as tiles for maps: pixels, zooms", generate, examine),
)
