"""Slope, aspect and hillshade of DEMs on their own cells: beside gdaldem, and for any window."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import rasterio

import tinsmith as ts

JACKSBORO = Path("sample_data/jacksboro.tif")
VALUES = ["slope", "aspect", "hillshade"]


def write_dem(path, z, *, spacing=2.0, crs="EPSG:32616", west_north=(500_000.0, 4_000_000.0)):
    height, width = z.shape
    profile = {
        "driver": "GTiff",
        "height": height,
        "width": width,
        "count": 1,
        "dtype": "float64",
        "crs": crs,
        "transform": rasterio.Affine(spacing, 0, west_north[0], 0, -spacing, west_north[1]),
    }
    with rasterio.open(path, "w", **profile) as file:
        file.write(z, 1)
    return path


def quadratic(rows=30, columns=40):
    y, x = np.mgrid[0:rows, 0:columns].astype(float)
    return 256 + 0.5 * x - 0.75 * y + (3 * x * x - 2 * x * y + 2 * y * y) / 64  # of 32 bits


def ask_gdaldem(value, path, *options):
    made = path.with_name(f"{value}.tif")
    subprocess.run(["gdaldem", value, "-q", *options, path, made], check=True)
    with rasterio.open(made) as file:
        band = file.read(1).astype(float)
        return np.where(band == file.nodata, np.nan, band)


def measure_difference(value, found, wanted):
    off = np.abs(found - wanted)
    return np.minimum(off, 360.0 - off) if value == "aspect" else off


@pytest.mark.each_value
@pytest.mark.skipif(shutil.which("gdaldem") is None, reason="needs gdaldem")
@pytest.mark.parametrize("smooth", [None, False, True])
@pytest.mark.parametrize("value", VALUES)
def test_cells_of_a_quadratic_dem_have_what_gdaldem_says(tmp_path, value, smooth):
    """Horn's gradient and that of a vertex are both the true one there."""
    path = write_dem(tmp_path / "dem.tif", quadratic())
    tin = ts.triangulate(ts.read(path))
    found = ts.rasterize(tin, like=path, value=value, smooth=smooth).bands[value]
    wanted = ask_gdaldem(value, path)
    inside = (slice(1, -1), slice(1, -1))
    off = measure_difference(value, found, wanted)[inside]
    assert off.max() < (1.001 if value == "hillshade" else 1e-4)
    if value == "hillshade":
        lit = ts.hillshade(tin, grid=ts.rasterize(tin, like=path).grid, smooth=smooth)
        np.testing.assert_array_equal(lit.bands["hillshade"], np.nan_to_num(found))


@pytest.mark.skipif(shutil.which("gdaldem") is None, reason="needs gdaldem")
def test_slopes_of_a_real_dem_are_near_those_of_gdaldem(tmp_path):
    """One triangle of each vertex was 2.5 degrees off on average, and stripes were seen."""
    path = Path(shutil.copy(JACKSBORO, tmp_path))
    tin = ts.triangulate(ts.read(path))
    found = ts.rasterize(tin, like=path, value="slope").bands["slope"]
    off = np.abs(found - ask_gdaldem("slope", path))
    assert np.nanmean(off) < 0.4
    assert np.nanpercentile(off, 99) < 1.8


@pytest.mark.each_value
@pytest.mark.parametrize("smooth", [None, False])
@pytest.mark.parametrize("value", VALUES)
def test_a_window_of_a_dem_has_the_cells_of_the_whole(value, smooth):
    """Inside: at the edge of the window a vertex has fewer triangles."""
    column, row, width, height = 97, 220, 133, 134
    whole = ts.triangulate(ts.read(JACKSBORO))
    part = ts.triangulate(ts.read(JACKSBORO, cells=(column, row, width, height)))
    one, other = (
        ts.rasterize(tin, like=JACKSBORO, value=value, smooth=smooth).bands[value]
        for tin in (whole, part)
    )
    inside = slice(row + 1, row + height - 1), slice(column + 1, column + width - 1)
    assert np.isfinite(other[inside]).mean() > 0.99
    np.testing.assert_array_equal(one[inside], other[inside])


@pytest.mark.parametrize("value", ["slope", "aspect"])
def test_cells_of_a_dem_have_the_values_of_its_vertices(tmp_path, value):
    rng = np.random.default_rng(3)
    path = write_dem(tmp_path / "dem.tif", rng.integers(0, 30, (20, 25)).astype(float))
    tin = ts.triangulate(ts.read(path))
    found = ts.rasterize(tin, like=path, value=value, smooth=False).bands[value]
    each = getattr(ts, value)(tin, per="vertex")
    np.testing.assert_array_equal(found.ravel(), each)  # rows from the north, as they are read


def describe(raster):
    return " ".join(raster.notes)


def test_cells_of_a_raster_are_smooth_unless_asked_otherwise(tmp_path):
    path = write_dem(tmp_path / "dem.tif", quadratic(12, 12))
    tin = ts.triangulate(ts.read(path))
    assert tin.report.from_raster
    options = {"spacing": 0.7}
    made = {smooth: ts.hillshade(tin, smooth=smooth, **options) for smooth in (None, True, False)}
    bands = {smooth: one.bands["hillshade"] for smooth, one in made.items()}
    np.testing.assert_array_equal(bands[None], bands[True])
    assert (bands[None] != bands[False]).any()
    assert "smooth, as the points are the cells of a raster" in describe(made[None])
    assert "(smooth)" in describe(made[True])
    assert "those of the triangles" in describe(made[False])
    slopes = ts.rasterize(tin, value="slope", **options)
    assert "smooth, as the points are" in describe(slopes)
    again = ts.rasterize(tin, value="slope", smooth=True, **options)
    np.testing.assert_array_equal(slopes.bands["slope"], again.bands["slope"])


def test_other_points_and_breaklines_are_not_smooth_by_default(tmp_path):
    path = write_dem(tmp_path / "dem.tif", quadratic(12, 12))
    survey = ts.read(path)
    corner = survey.points[:, :2].min(axis=0) + 3.1
    broken = ts.triangulate(survey, breaklines=[np.array([corner, corner + np.array([9.0, 6.0])])])
    points = ts.triangulate(survey.points)
    for tin in (broken, points):
        assert "those of the triangles" in describe(ts.hillshade(tin, spacing=1.0))
    assert not points.report.from_raster


def test_a_raster_stays_one_through_windows_edits_and_simplification(tmp_path):
    path = write_dem(tmp_path / "dem.tif", quadratic(12, 12))
    survey = ts.read(path)
    assert survey.from_raster
    tin = ts.triangulate(survey)
    tin.remove([40])
    assert tin.report.from_raster
    assert ts.simplify(tin, tolerance=0.5).report.from_raster
    assert ts.simplify(ts.read_raster(path), tolerance=0.5).report.from_raster
    assert not ts.read("sample_data/site_survey.csv", crs="EPSG:32616").from_raster


def test_means_are_those_of_triangles_and_cannot_be_smooth(tmp_path):
    tin = ts.triangulate(ts.read(write_dem(tmp_path / "dem.tif", quadratic(12, 12))))
    mean = ts.rasterize(tin, spacing=1.0, value="slope", at="mean")
    assert "averaged" in describe(mean)
    with pytest.raises(ts.OptionError, match="smooth True"):
        ts.rasterize(tin, spacing=1.0, value="slope", at="mean", smooth=True)
    with pytest.raises(ts.OptionError, match="smooth True"):
        ts.rasterize(tin, spacing=1.0, smooth=True)
    with pytest.raises(ts.OptionError, match="smooth 1"):
        ts.rasterize(tin, spacing=1.0, value="slope", smooth=1)


@pytest.mark.parametrize("smooth", [False, True])
def test_blocks_and_threads_give_the_same_bits(smooth):
    tin = ts.triangulate(ts.read(JACKSBORO, cells=(0, 0, 300, 300)))
    whole = ts.rasterize(tin, like=JACKSBORO, value="slope", smooth=smooth, threads=1)
    lazy = ts.rasterize(tin, like=JACKSBORO, value="slope", smooth=smooth, lazy=True, threads=3)
    rows, columns = slice(40, 290), slice(130, 270)
    block = lazy.bands["slope"][rows, columns]
    np.testing.assert_array_equal(block, whole.bands["slope"][rows, columns])


def test_points_in_another_order_have_the_same_slopes():
    rng = np.random.default_rng(8)
    y, x = np.mgrid[0:25, 0:25].astype(float)
    points = np.column_stack([x.ravel(), y.ravel(), rng.normal(size=625)])
    grid = ts.Grid(ts.Bounds(-0.5, -0.5, 24.5, 24.5), (25, 25), 1.0)
    order = rng.permutation(len(points))
    one, other = (
        ts.rasterize(ts.triangulate(rows), grid=grid, value="slope").bands["slope"]
        for rows in (points, points[order])
    )
    assert np.isfinite(one).all()
    np.testing.assert_array_equal(one, other)


def test_only_rasters_joined_are_a_raster(tmp_path):
    west = write_dem(tmp_path / "west.tif", quadratic(12, 12))
    east = write_dem(tmp_path / "east.tif", quadratic(12, 12), west_north=(500_024.0, 4_000_000.0))
    points = tmp_path / "points.csv"
    points.write_text("x,y,z\n500003.5,3999990.5,260\n500013.5,3999980.5,261\n500009,3999985,262\n")
    assert ts.read([west, east]).from_raster
    assert not ts.read([west, points], crs="EPSG:32616").from_raster
