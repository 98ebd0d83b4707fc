"""Rasters that rasterio and xarray hold as points, the same as their files; and rasters out."""

from __future__ import annotations

import gc
import math

import numpy as np
import pytest
import rasterio
import rioxarray
import xarray
from rasterio.transform import Affine

import tinsmith as ts

pytestmark = pytest.mark.filterwarnings("ignore:Use .@. matmul")  # rioxarray uses `*`

CRS = "EPSG:32616"
HEIGHTS = (np.arange(48).reshape(6, 8) * 7 % 50 + 100).astype("float32")


def write(path, *bands, transform=(10.0, 0, 740_000.1, 0, -5.0, 4_030_000.7), crs=CRS, **options):
    scales = {name: options.pop(name) for name in ("scales", "offsets", "units") if name in options}
    rows, columns = bands[0].shape
    profile = {"dtype": bands[0].dtype, "transform": Affine(*transform), "crs": crs, **options}
    size = {"height": rows, "width": columns, "count": len(bands)}
    with rasterio.open(path, "w", driver="GTiff", **size, **profile) as dataset:
        for number, band in enumerate(bands, 1):
            dataset.write(band, number)
        for name, values in scales.items():
            setattr(dataset, name, values)
    return path


def with_void():
    heights = HEIGHTS.copy()
    heights[2:4, 3:5] = -9999
    return heights


CASES = {
    "plain": {},
    "nodata": {"bands": [with_void()], "nodata": -9999.0},
    "whole numbers": {"bands": [with_void().astype("int16")], "nodata": -9999},
    "NaN": {"bands": [np.where(with_void() < 0, np.nan, with_void())], "nodata": math.nan},
    "scaled": {"scales": (0.5,), "offsets": (100.0,)},
    "unit": {"units": ("US survey foot",)},
    "south up": {"transform": (10.0, 0, 7e5, 0, 10.0, 4e6)},
    "without a CRS": {"crs": None},
}


def open_as_xarray(path, **options):
    return rioxarray.open_rasterio(path, **options)


@pytest.mark.each_value
@pytest.mark.parametrize("fill", [False, True])
@pytest.mark.parametrize("case", CASES)
def test_the_survey_is_that_of_the_file(tmp_path, case, fill):
    options = dict(CASES[case])
    path = write(tmp_path / "dem.tif", *options.pop("bands", [HEIGHTS]), **options)
    wanted = ts.read(path, fill=fill)
    with rasterio.open(path) as dataset:
        require_same(ts.from_raster(dataset, fill=fill), wanted)
    arrays = [open_as_xarray(path)]
    if case != "scaled":  # masked, rioxarray leaves scale and offset in place, undone
        arrays += [open_as_xarray(path, masked=True), open_as_xarray(path).squeeze("band")]
        arrays.append(open_as_xarray(path).to_dataset(name="z"))
    for array in arrays:
        require_same(ts.from_raster(array, fill=fill), wanted)


def require_same(found, wanted):
    np.testing.assert_array_equal(found.points, wanted.points)
    assert (found.crs, found.skipped) == (wanted.crs, wanted.skipped)
    assert found.elevation_unit == wanted.elevation_unit
    assert len(found.extent) == len(wanted.extent)
    for ring, other in zip(found.extent, wanted.extent, strict=True):
        np.testing.assert_array_equal(ring, other)
    assert ts.triangulate(found) == ts.triangulate(wanted)


def test_windows_strides_bands_and_a_crs_that_is_wanted(tmp_path):
    path = write(tmp_path / "dem.tif", HEIGHTS, HEIGHTS + 1000)
    for options in (
        {"band": 2},
        {"cells": (1, 2, 5, 4), "stride": 2},
        {"window": (740_010, 4_029_985, 740_040, 4_029_998)},
        {"window": ts.Bounds(740_010, 4_029_985, 740_040, 4_029_998)},
        {"crs": "EPSG:32617"},
        {"nodata": 107, "elevation_unit": "ft"},
    ):
        with rasterio.open(path) as dataset:
            require_same(ts.from_raster(dataset, **options), ts.read(path, **options))
        array = open_as_xarray(path)
        if "band" not in options:
            array = array.sel(band=1)
        require_same(ts.from_raster(array, **options), ts.read(path, **options))


def test_a_part_of_an_array_has_the_coordinates_of_its_cells(tmp_path):
    array = open_as_xarray(write(tmp_path / "dem.tif", HEIGHTS)).squeeze("band")
    part = array[1:5:2, 2:7:3]  # its GeoTransform is that of the whole
    survey = ts.from_raster(part, fill=True)
    x, y = np.meshgrid(part.x, part.y)
    wanted = np.column_stack([x.ravel(), y.ravel(), part.values.ravel()])
    np.testing.assert_allclose(survey.points, wanted, rtol=1e-15)


def test_arrays_without_rioxarray():
    array = xarray.DataArray(
        HEIGHTS[:, ::-1].T,
        {"x": 500.0 + 2 * np.arange(8), "y": 30.0 - 3 * np.arange(6)},
        dims=("x", "y"),
        name="z",
        attrs={"units": "ft"},
    )
    survey = ts.from_raster(array, crs=CRS)
    assert survey.elevation_unit.name == "foot"
    assert survey.points[:2].tolist() == [
        [500.0, 30.0, HEIGHTS[0, 7]],
        [502.0, 30.0, HEIGHTS[0, 6]],
    ]


def test_rasters_of_our_own_come_back():
    tin = ts.triangulate(np.random.default_rng(1).random((40, 3)) * [90, 60, 9], crs=CRS)
    raster = ts.rasterize(tin, spacing=2.5)
    survey = ts.from_raster(raster, fill=True)
    band = raster.bands["elevation"][:, :]
    np.testing.assert_array_equal(survey.points[:, 2], band[np.isfinite(band)])
    np.testing.assert_array_equal(tin.interpolate(survey.points[:, :2]), survey.points[:, 2])
    require_same(ts.from_raster(raster.to_xarray()), ts.from_raster(raster))
    with ts.to_rasterio(raster) as dataset:
        require_same(ts.from_raster(dataset), ts.from_raster(raster))


def test_a_dataset_in_memory_is_that_of_the_file(tmp_path):
    tin = ts.triangulate(
        np.random.default_rng(1).random((40, 3)) * [90, 60, 9], crs=CRS, elevation_unit="m"
    )
    raster = ts.rasterize(tin, spacing=2.5)
    dataset = ts.to_rasterio(raster)
    gc.collect()
    with rasterio.open(ts.write(raster, tmp_path / "a.tif")) as file:
        np.testing.assert_array_equal(dataset.read(), file.read())
        assert dataset.profile["transform"] == file.profile["transform"]
        assert (dataset.crs, dataset.units, dataset.descriptions) == (
            file.crs,
            file.units,
            file.descriptions,
        )
    dataset.close()
    back = raster.to_xarray()
    assert back.rio.crs.to_epsg() == 32616
    assert back.rio.transform() == dataset.transform


def degrees():
    return xarray.DataArray(np.ones((3, 3)), {"y": [2.0, 1, 0], "x": [0.0, 1, 2]}).rio.write_crs(
        4326
    )


@pytest.mark.parametrize(
    ("raster", "options", "words"),
    [
        (np.ones((3, 3)), {}, "Invalid raster"),
        (xarray.DataArray(np.ones((3, 3)), dims=("a", "b")), {}, "the dimensions y and x"),
        (xarray.DataArray(np.ones((3, 3)), dims=("y", "x")), {}, "has no georeference"),
        (degrees(), {}, "measures in degrees"),
        (degrees().expand_dims(time=[1, 2]), {"crs": CRS}, "one of the 2 along 'time'"),
        (degrees().expand_dims(band=[1, 2]), {"crs": CRS}, "one of the 2 along 'band'"),
        (degrees().assign_coords(x=[0.0, 1.0, 5.0]), {"crs": CRS}, "even steps of x and y"),
        (degrees()[:1], {"crs": CRS}, "two or more columns and rows"),
        (xarray.Dataset({"a": degrees(), "b": degrees()}), {}, "Invalid band None: .* one of a, b"),
        (xarray.Dataset({"a": degrees()}), {"band": "c"}, "Invalid band 'c'"),
        (degrees().rio.write_crs(CRS) * np.nan, {"crs": CRS}, "none has an elevation but"),
    ],
)
def test_rasters_in_doubt_are_refused(raster, options, words):
    with pytest.raises(ts.TinsmithError, match=words):
        ts.from_raster(raster, **options)
    with pytest.raises(ts.OptionError, match="Invalid raster 5"):
        ts.to_rasterio(5)
