"""What files say of their bands and axes: descriptions, signs, units, times."""

from __future__ import annotations

import netCDF4
import numpy as np
import pytest
import rasterio

import tinsmith as ts

UTM = "EPSG:32616"
LEVELS = 300 + np.arange(12.0).reshape(3, 4)


@pytest.fixture
def tiff(tmp_path):
    """Return what writes a GeoTIFF of bands, each with a description."""

    def write(bands, *, crs=UTM, at=(5e5, 4e6, 10.0)):
        path = tmp_path / "a.tif"
        place = rasterio.Affine(at[2], 0.0, at[0], 0.0, -at[2], at[1])
        made = rasterio.open(
            path, "w", driver="GTiff", width=4, height=3, count=len(bands), dtype="float32",
            crs=crs, transform=place,
        )  # fmt: skip
        with made:
            for number, (word, values) in enumerate(bands, 1):
                made.write(np.broadcast_to(values, (3, 4)).astype("float32"), number)
                made.set_band_description(number, word)
        return path

    return write


@pytest.fixture
def netcdf(tmp_path):
    """Return what writes netCDF of the CF conventions."""

    def write(*, units="m", names=("projection_x_coordinate", "projection_y_coordinate"),
              start=(500.0, 4000.0), level="elevation", times=0, **attributes):  # fmt: skip
        path = tmp_path / "a.nc"
        with netCDF4.Dataset(path, "w") as made:
            for axis, name, first, count in zip("xy", names, start, (4, 3), strict=True):
                made.createDimension(axis, count)
                variable = made.createVariable(axis, "f8", (axis,))
                variable[:] = first + 0.01 * np.arange(count)
                variable.setncatts({"units": units, "standard_name": name})
            dimensions = ("y", "x")
            if times:
                made.createDimension("time", times)
                made.createVariable("time", "f8", ("time",))[:] = np.arange(times)
                dimensions = ("time", "y", "x")
            variable = made.createVariable(level, "f4", dimensions)
            variable[:] = np.broadcast_to(LEVELS, variable.shape)
            variable.setncatts({"units": "m", **attributes})
        return path

    return write


@pytest.mark.parametrize("word", ["uncertainty", "Std. dev.", "error (m)", "point density"])
def test_the_band_of_elevations_is_found_by_its_description(tiff, word):
    found = ts.read(tiff([(word, 0.3), ("DTM elevation", LEVELS)]))
    assert found.points[:, 2].min() == 300
    assert any("Band 2 of 2 is read" in note for note in found.notes)
    raster = ts.read_raster(tiff([(word, 0.3), ("DTM elevation", LEVELS)]))
    assert list(raster.notes) == found.notes


def test_a_band_of_errors_is_read_only_where_it_is_asked_for(tiff):
    path = tiff([("uncertainty", 0.3), ("backscatter", -20.0)])
    for reader in (ts.read, ts.read_raster):
        with pytest.raises(ts.ReadError, match=r"'uncertainty', which is no elevation.*band"):
            reader(path)
    assert ts.read(path, band=2).points[:, 2].max() == -20


def test_of_several_bands_without_a_word_the_first_is_read_and_told(tiff):
    found = ts.read(tiff([("", LEVELS), ("", 5.0)]))
    assert found.points[:, 2].min() == 300
    assert any("Band 1 of 2 is read" in note for note in found.notes)
    assert not any("Band" in note for note in ts.read(tiff([("", LEVELS)])).notes)


@pytest.mark.parametrize(
    "said",
    [
        {"positive": "down"},
        {"positive": "Down", "standard_name": "sea_floor_depth_below_geoid"},
        {"standard_name": "sea_floor_depth_below_mean_sea_level"},
    ],
)
def test_what_is_positive_downwards_is_turned(netcdf, said):
    path = netcdf(level="depth", **said)
    found = ts.read(path)
    assert sorted(found.points[:, 2]) == sorted(-LEVELS.ravel())
    assert any("their sign was changed" in note for note in found.notes)
    raster = ts.read_raster(path)
    assert np.asarray(raster.bands["elevation"][0:3, 0:4]).max() == -300
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(path) as data:
        assert ts.from_raster(data["depth"]).points[:, 2].max() == -300


def test_what_is_called_a_depth_is_told(netcdf):
    assert any(
        "check that they are no depths" in note for note in ts.read(netcdf(level="depth")).notes
    )
    path = netcdf(level="depth", positive="up")
    assert not any("depths" in note for note in ts.read(path).notes)


def test_times_are_not_chosen_silently(netcdf):
    path = netcdf(times=3)
    with pytest.raises(ts.ReadError, match="3 bands, one for each time"):
        ts.read(path)
    assert len(ts.read(path, band=2).points) == 12


@pytest.mark.parametrize(("unit", "metres"), [("km", 1000.0), ("ft", 0.3048), ("m", 1.0)])
def test_axes_in_another_unit_than_the_crs_are_converted(netcdf, unit, metres):
    found = ts.read(netcdf(units=unit, start=(5e5 / metres, 4e6 / metres)), crs=UTM)
    west, south = found.points[:, :2].min(axis=0)
    assert (west, south) == pytest.approx((5e5, 4e6), abs=1e-6)
    assert any("converted" in note for note in found.notes) == (unit != "m")


def test_axes_in_degrees_are_of_wgs84_and_told(netcdf):
    path = netcdf(units="degrees_east", names=("longitude", "latitude"), start=(-84.5, 36.3))
    found = ts.read(path, crs=UTM)
    x, y, _ = ts.transform_points(np.array([[-84.5, 36.3, 0.0]]), "EPSG:4326", UTM)[0]
    assert np.hypot(found.points[:, 0] - x, found.points[:, 1] - y).min() < 1e-3
    assert any("WGS 84" in note for note in found.notes)


def test_a_raster_that_lies_in_the_area_as_degrees_alone_is_taken_so(tiff):
    path = tiff([("", LEVELS)], crs=None, at=(-84.5, 36.3, 1e-3))
    found = ts.read(path, crs=UTM)
    assert any("degrees of WGS 84" in note for note in found.notes)
    x, y, _ = ts.transform_points(np.array([[-84.4995, 36.2995, 0.0]]), "EPSG:4326", UTM)[0]
    assert np.hypot(found.points[:, 0] - x, found.points[:, 1] - y).min() < 1e-3
    with pytest.raises(ts.OptionError, match="cells are not transformed"):
        ts.read_raster(path, crs=UTM)
