"""Terrain tiles: every pixel against bilinear values, by other readers of the archives."""

from __future__ import annotations

import math
import sqlite3
from contextlib import closing

import numpy as np
import pyproj
import pytest
import rasterio
from support.terrain_tiles import STEPS, decode, interpolate, locate, read_archive

import tinsmith as ts

UTM16 = "EPSG:32616"

pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")


def make(shape=(60, 90), *, spacing=2.0, crs=UTM16, unit="m", west=745_000.0, south=4_033_000.0):
    rows, columns = shape
    box = ts.Bounds(west, south, west + columns * spacing, south + rows * spacing)
    rng = np.random.default_rng(5)
    values = 300 + 40 * np.sin(np.arange(rows)[:, None] / 9) + rng.uniform(0, 3, shape)
    units = {} if unit == "" else {"elevation": unit}
    return ts.Raster({"elevation": values}, ts.Grid(box, shape=shape, spacing=spacing), crs=crs,
                     units=units)  # fmt: skip


def finest(about, tiles):
    return {place: one for place, one in tiles.items() if place[0] == int(about["maxzoom"])}


@pytest.mark.parametrize("suffix", [".pmtiles", ".mbtiles"])
@pytest.mark.parametrize("encoding", ["terrarium", "mapbox"])
def test_pixels_are_the_bilinear_elevations(tmp_path, suffix, encoding):
    raster = make()
    path = ts.write(raster, tmp_path / f"a{suffix}", tile_encoding=encoding)
    about, tiles = read_archive(path)
    assert about["encoding"] == encoding
    values, worst, count = np.asarray(raster.bands["elevation"]), 0.0, 0
    for place, content in finest(about, tiles).items():
        wanted = interpolate(values, raster.grid, *locate(place, UTM16))
        found = decode(content, encoding)
        inside = np.isfinite(wanted)
        worst = max(worst, float(np.abs(found - wanted)[inside].max(initial=0.0)))
        count += int(inside.sum())
    assert count > 60 * 90
    assert worst <= STEPS[encoding] / 2 + 1e-6


def test_gdal_sees_the_same_place(tmp_path):
    """The driver of MBTiles of GDAL puts the pixels of the finest zoom where they belong."""
    raster = make()
    path = ts.write(raster, tmp_path / "a.mbtiles", gaps="transparent")
    with rasterio.open(path) as source:
        assert source.crs.to_epsg() == 3857
        pixels = source.read().astype(float)
        columns, rows = np.meshgrid(np.arange(source.width), np.arange(source.height))
        east, north = source.transform @ (columns.ravel() + 0.5, rows.ravel() + 0.5)
    to_utm = pyproj.Transformer.from_crs("EPSG:3857", UTM16, always_xy=True)
    x, y = to_utm.transform(east, north)
    wanted = interpolate(np.asarray(raster.bands["elevation"]), raster.grid, x, y)
    red, green, blue, alpha = (band.ravel() for band in pixels)
    found = red * 256 + green + blue / 256 - 32_768
    inside = np.isfinite(wanted)
    assert (alpha[inside] == 255).all()
    assert np.abs(found - wanted)[inside].max() <= 1 / 512 + 1e-3  # bounds have 9 decimals
    assert inside.sum() > 60 * 90


def test_a_plane_is_met_at_every_zoom(tmp_path):
    points = np.array([[0, 0, 10.0], [900, 0, 100], [900, 900, 190], [0, 900, 100]])
    tin = ts.triangulate(points + np.array([745_000, 4_033_000, 0]), crs=UTM16, elevation_unit="m")
    raster = ts.rasterize(tin, spacing=3.0)
    path = ts.write(raster, tmp_path / "a.pmtiles", min_zoom=11, gaps="transparent")
    about, tiles = read_archive(path)
    assert {z for z, _, _ in tiles} == set(range(11, int(about["maxzoom"]) + 1))
    for place, content in tiles.items():
        x, y = locate(place, UTM16)
        found = decode(content, "terrarium")
        inside = (x > 745_030) & (x < 745_870) & (y > 4_033_030) & (y < 4_033_870)
        pixel = 2 * np.pi * 6_378_137 / 512 / 2 ** place[0]
        inside &= np.isfinite(found) & (pixel < 30)
        wanted = 10 + (x - 745_000) * 0.1 + (y - 4_033_000) * 0.1
        assert np.abs(found - wanted)[inside].max(initial=0.0) <= 1 / 512 + 1e-4


def test_coarser_pixels_are_means_of_four(tmp_path):
    about, tiles = read_archive(ts.write(make(), tmp_path / "a.pmtiles", gaps="transparent"))
    zoom = int(about["maxzoom"]) - 1
    for (z, x, y), content in tiles.items():
        if z != zoom:
            continue
        below = np.full((1024, 1024), np.nan)
        for dy in (0, 1):
            for dx in (0, 1):
                one = tiles.get((z + 1, 2 * x + dx, 2 * y + dy))
                if one is not None:
                    part = decode(one, "terrarium")
                    below[dy * 512 : dy * 512 + 512, dx * 512 : dx * 512 + 512] = part
        quarters = below.reshape(512, 2, 512, 2)
        counts = np.isfinite(quarters).sum(axis=(1, 3))
        means = np.nansum(quarters, axis=(1, 3)) / np.where(counts, counts, np.nan)
        found = decode(content, "terrarium")
        assert np.array_equal(np.isnan(found), np.isnan(means))
        assert np.nanmax(np.abs(found - means)) <= 1 / 256


def test_zooms_are_chosen_by_cells_and_extent_and_told(tmp_path):
    raster = make()
    with pytest.warns(ts.LossWarning, match=r"from zoom (\d+) to (\d+); .* 1/256 m"):
        path = ts.write(raster, tmp_path / "a.pmtiles")
    about, tiles = read_archive(path)
    low, high = int(about["minzoom"]), int(about["maxzoom"])
    pixel = 2 * math.pi * 6_378_137 / 512 * math.cos(math.radians(36.4))
    assert pixel / 2**high <= 2.0 * 1.001 < pixel / 2 ** (high - 1)
    assert pixel * 512 / 2**low >= 180
    assert {z for z, _, _ in tiles} == set(range(low, high + 1))
    chosen = ts.write(raster, tmp_path / "b.pmtiles", min_zoom=3, max_zoom=12)
    _, tiles = read_archive(chosen)
    assert {z for z, _, _ in tiles} == set(range(3, 13))


def test_gaps_show_the_lowest_elevation_or_nothing(tmp_path):
    raster = make()
    values = np.asarray(raster.bands["elevation"]).copy()
    values[20:40, 30:60] = np.nan
    raster = ts.Raster({"elevation": values}, raster.grid, crs=UTM16, units={"elevation": "m"})
    with pytest.warns(ts.LossWarning, match="without data are at the lowest elevation, 26"):
        about, tiles = read_archive(ts.write(raster, tmp_path / "a.pmtiles"))
    low = np.nanmin(values)
    found = [decode(one, "terrarium") for one in finest(about, tiles).values()]
    assert abs(min(one.min() for one in found) - low) <= 1 / 512
    with pytest.warns(ts.LossWarning, match="without data are transparent"):
        path = ts.write(raster, tmp_path / "b.pmtiles", gaps="transparent")
    about, tiles = read_archive(path)
    gaps = 0
    for place, content in finest(about, tiles).items():
        x, y = locate(place, UTM16)
        hole = (x > 745_064) & (x < 745_116) & (y > 4_033_044) & (y < 4_033_076)
        assert np.isnan(decode(content, "terrarium")[hole]).all()
        gaps += int(hole.sum())
    assert gaps > 0


def test_feet_become_metres_and_unknown_units_are_told(tmp_path):
    foot = 1200 / 3937
    raster = make(crs="EPSG:2274", unit=ts.Unit.of("US survey foot"), west=1.7e6, south=6e5)
    with pytest.warns(ts.LossWarning, match="were converted from US survey foot to metre"):
        about, tiles = read_archive(ts.write(raster, tmp_path / "a.mbtiles"))
    values = np.asarray(raster.bands["elevation"]) * foot
    for place, content in finest(about, tiles).items():
        wanted = interpolate(values, raster.grid, *locate(place, "EPSG:2274"))
        inside = np.isfinite(wanted)
        found = decode(content, "terrarium")
        assert np.abs(found - wanted)[inside].max(initial=0.0) <= 1 / 512 + 1e-6
    unknown = make(crs="EPSG:2274", unit=None, west=1.7e6, south=6e5)
    with pytest.warns(ts.LossWarning, match="unit of elevations is not known.*US survey foot"):
        again = ts.write(unknown, tmp_path / "b.mbtiles")
    assert read_archive(again)[1] == tiles


def test_the_same_raster_gives_the_same_bytes(tmp_path):
    for suffix in (".pmtiles", ".mbtiles"):
        first = ts.write(make(), tmp_path / f"a{suffix}").read_bytes()
        assert ts.write(make(), tmp_path / f"b{suffix}").read_bytes() == first


def test_what_makes_no_tiles_is_refused(tmp_path):
    path = tmp_path / "a.pmtiles"
    path.write_text("old")
    for error, words, raster, options in (
        (ts.CrsError, "CRS of this raster is not known", make(crs=None), {}),
        (ts.FormatError, "unit of the band 'elevation' is no length", make(unit=""), {}),
        (ts.FormatError, "is no length", make(unit="degrees"), {}),
        (ts.OptionError, "band", make(), {"band": "slope"}),
        (ts.OptionError, "max_zoom", make(), {"max_zoom": 25}),
        (ts.OptionError, "min_zoom", make(), {"min_zoom": 12, "max_zoom": 11}),
        (ts.OptionError, "tile_encoding", make(), {"tile_encoding": "png"}),
        (ts.OptionError, "gaps", make(), {"gaps": "none"}),
        (ts.WriteError, "antimeridian", make(crs="EPSG:32601", west=300_000, south=7e6,
                                             spacing=1_000.0), {}),
        (ts.WriteError, "Web Mercator ends", make(crs="EPSG:32661", west=1.9e6, south=2.0e6), {}),
    ):  # fmt: skip
        with pytest.raises(error, match=words):
            ts.write(raster, path, **options)
    empty = make()
    empty = ts.Raster({"elevation": np.full(empty.shape, np.nan)}, empty.grid, crs=UTM16,
                      units={"elevation": "m"})  # fmt: skip
    with pytest.raises(ts.WriteError, match="no cell has data"):
        ts.write(empty, path)
    high = make()
    high = ts.Raster({"elevation": np.asarray(high.bands["elevation"]) + 40_000}, high.grid,
                     crs=UTM16, units={"elevation": "m"})  # fmt: skip
    with pytest.raises(ts.WriteError, match="pixels have those from"):
        ts.write(high, path)
    ts.write(high, tmp_path / "b.pmtiles", tile_encoding="mapbox")
    assert path.read_text() == "old"


def test_mbtiles_keep_to_their_specification(tmp_path):
    path = ts.write(make(), tmp_path / "a.mbtiles")
    with closing(sqlite3.connect(path)) as base:
        assert base.execute("PRAGMA application_id").fetchone() == (0x4D504258,)
        about = dict(base.execute("SELECT name, value FROM metadata"))
        zooms = base.execute("SELECT min(zoom_level), max(zoom_level) FROM tiles").fetchone()
    assert about["format"] == "png"
    assert zooms == (int(about["minzoom"]), int(about["maxzoom"]))
    west, south, east, north = map(float, about["bounds"].split(","))
    assert -84.3 < west < east < -84.0
    assert 36.3 < south < north < 36.5


def test_a_raster_of_several_bands_and_lazy_blocks(tmp_path):
    raster = make()
    both = ts.Raster(
        {"slope": np.zeros(raster.shape), "elevation": raster.bands["elevation"]},
        raster.grid, crs=UTM16, units={"slope": "degrees", "elevation": "m"},
    )  # fmt: skip
    with pytest.raises(ts.OptionError, match="one of slope, elevation"):
        ts.write(both, tmp_path / "a.pmtiles")
    path = ts.write(both, tmp_path / "a.pmtiles", band="elevation")
    assert read_archive(path)[1] == read_archive(ts.write(raster, tmp_path / "b.pmtiles"))[1]
