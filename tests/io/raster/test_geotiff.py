"""Rasters written, and read back by rasterio and by tinsmith."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
import rasterio

import tinsmith as ts
from tinsmith.base.errors import FormatError, OptionError, WriteError
from tinsmith.base.types import Bounds, Grid
from tinsmith.io.raster import geotiff

FORMATS = ["geotiff", "cog"]


def grid(rows, columns, spacing=0.5, x=500_000.25, y=4_000_000.5):
    box = Bounds(x, y, x + columns * spacing, y + rows * spacing)
    return Grid(box, (rows, columns), spacing)


def raster(rows=40, columns=30, *, dtype=np.float64, crs="EPSG:32616", **about):
    values = np.random.default_rng(1).uniform(0, 200, (rows, columns)).astype(dtype)
    if np.dtype(dtype).kind == "f":
        values[:3, 2:3] = math.nan
    return ts.Raster({"elevation": values}, grid(rows, columns), crs=crs, **about)


@pytest.mark.each_value
@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (40, 30), (700, 513), (3, 1200)])
def test_what_rasterio_reads_back(tmp_path, form, rows, columns):
    made = raster(rows, columns, units={"elevation": ts.Unit.of("ft")}, notes=["One."])
    with rasterio.open(ts.write(made, tmp_path / "a.tif", format=form)) as found:
        np.testing.assert_array_equal(found.read(1), made.bands["elevation"])
        assert found.descriptions == ("elevation",)
        assert found.units == ("ft",)
        assert found.crs.to_epsg() == 32616
        assert math.isnan(found.nodata)
        assert tuple(found.bounds) == (
            made.grid.bounds.xmin,
            made.grid.bounds.ymin,
            made.grid.bounds.xmax,
            made.grid.bounds.ymax,
        )
        assert found.tags()["notes"] == "One."
        assert bool(found.overviews(1)) == (max(rows, columns) > 512)
        layout = found.tags(ns="IMAGE_STRUCTURE").get("LAYOUT")
        assert (layout == "COG") == (form == "cog")


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("dtype", ["uint8", "int16", "int32", "float32", "float64", "bool"])
def test_types_of_values(tmp_path, form, dtype):
    made = raster(dtype=dtype, nodata=0)
    with rasterio.open(ts.write(made, tmp_path / "a.tif", format=form)) as found:
        assert found.dtypes == ("uint8" if dtype == "bool" else dtype,)
        np.testing.assert_array_equal(found.read(1), made.bands["elevation"])
        assert found.nodata == 0


def test_cells_may_be_written_as_they_are(tmp_path):
    made = raster(700, 513)
    path = ts.write(made, tmp_path / "a.tif", compression="none", overviews="none")
    with rasterio.open(path) as found:
        assert found.compression is None
        np.testing.assert_array_equal(found.read(1), made.bands["elevation"])
    assert path.stat().st_size > 700 * 513 * 8


def test_deflate_is_the_usual_compression_of_cells_and_overviews(tmp_path):
    with rasterio.open(ts.write(raster(1200, 1100), tmp_path / "a.tif")) as found:
        assert found.compression.name == "deflate"
        assert found.tags(ns="IMAGE_STRUCTURE")["PREDICTOR"] == "3"
    with rasterio.open(tmp_path / "a.tif", overview_level=0) as found:
        assert found.tags(ns="IMAGE_STRUCTURE")["PREDICTOR"] == "3"


def test_another_compression_is_refused(tmp_path):
    with pytest.raises(OptionError, match="'lerc'"):
        ts.write(raster(), tmp_path / "a.tif", compression="lerc")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.each_value
@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("dtype", ["uint8", "float64"])
def test_bytes_do_not_depend_on_the_number_of_cores(tmp_path, monkeypatch, form, dtype):
    made = raster(600, 1100, dtype=dtype)
    written = set()
    for threads in ("1", "2", "5"):
        monkeypatch.setattr(geotiff, "_choose_threads", lambda number=threads: number)
        written.add(ts.write(made, tmp_path / "a.tif", format=form).read_bytes())
    assert len(written) == 1


def test_a_large_draft_of_a_cog_is_compressed(tmp_path, monkeypatch):
    made = raster(600, 600)
    one = ts.write(made, tmp_path / "one.tif", format="cog").read_bytes()
    monkeypatch.setattr(geotiff, "_LARGEST_DRAFT", 1000)
    other = ts.write(made, tmp_path / "other.tif", format="cog").read_bytes()
    assert one == other


def test_several_bands_share_the_type_that_holds_all(tmp_path):
    bands = {"a": np.full((4, 5), 7, np.uint8), "slope": np.full((4, 5), 0.1)}
    made = ts.Raster(bands, grid(4, 5), units={"a": None, "slope": "°"})
    with rasterio.open(ts.write(made, tmp_path / "a.tif")) as found:
        assert found.descriptions == ("a", "slope")
        assert found.units == (None, "°")
        assert found.tags(1)["unit"] == "unknown"
        assert found.read(2)[0, 0] == 0.1
        assert found.crs is None


@pytest.mark.parametrize(
    "crs", ["EPSG:2274", "EPSG:2274+6360", "EPSG:32616+5703", "EPSG:28992+5709"]
)
@pytest.mark.parametrize("form", FORMATS)
def test_the_crs_comes_back_with_its_units(tmp_path, crs, form):
    """GDAL gave NAVD88 in feet back in metres when it got the CRS as WKT 2."""
    path = ts.write(raster(crs=crs), tmp_path / "a.tif", format=form)
    with rasterio.open(path) as found:
        again = ts.CRS(found.crs.to_wkt(version="WKT2_2019"))
    assert again.is_same(crs)
    assert again.vertical_unit == ts.CRS(crs).vertical_unit


def test_a_crs_that_would_change_its_unit_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(geotiff, "_make_gdal_crs", lambda *_: rasterio.crs.CRS.from_epsg(26736))
    with pytest.raises(WriteError, match="does not keep the CRS"):
        ts.write(raster(), tmp_path / "a.tif")
    assert list(tmp_path.iterdir()) == []


def test_another_crs_of_the_same_units_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(geotiff, "_make_gdal_crs", lambda *_: rasterio.crs.CRS.from_epsg(32617))
    with pytest.warns(ts.LossWarning, match="UTM zone 17N"):
        ts.write(raster(), tmp_path / "a.tif")


def test_the_elevations_read_back_as_points(tmp_path):
    path = ts.write(raster(units={"elevation": "US ft"}), tmp_path / "a.tif")
    survey = ts.read(path)
    assert len(survey) == 40 * 30 - 3
    assert survey.elevation_unit.name == "US survey foot"


class Lazy:
    """A band that is computed block by block, and remembers the largest."""

    dtype = np.dtype(np.float32)

    def __init__(self, rows, columns):
        self.shape = (rows, columns)
        self.largest = 0

    def __getitem__(self, place):
        rows, columns = place
        y, x = np.mgrid[rows, columns]
        self.largest = max(self.largest, y.size)
        return (y * 10_000.0 + x).astype(np.float32)


@pytest.mark.parametrize("form", FORMATS)
def test_blocks_are_asked_for_one_by_one(tmp_path, monkeypatch, form):
    monkeypatch.setattr(geotiff, "_BLOCK_CELLS", 1 << 19)
    band, seen = Lazy(1100, 1700), []
    made = ts.Raster({"z": band}, grid(1100, 1700))
    path = ts.write(made, tmp_path / "a.tif", format=form, progress=seen.append)
    assert 0 < band.largest <= 1 << 19
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
    with rasterio.open(path) as found:
        np.testing.assert_array_equal(found.read(1), band[0:1100, 0:1700])


@pytest.mark.parametrize("form", FORMATS)
def test_overviews_of_an_aspect_are_cells_of_it(tmp_path, form):
    """The mean of 359 and 1 degrees would be south."""
    band = np.where(np.indices((1100, 1100)).sum(axis=0) % 2, 359.0, 1.0)
    made = ts.Raster({"aspect": band}, grid(1100, 1100), units={"aspect": "°"})
    path = ts.write(made, tmp_path / "a.tif", format=form)
    with rasterio.open(path) as found:
        assert set(np.unique(found.read(1, out_shape=(275, 275)))) <= {1.0, 359.0}
    ts.write(made, path, format=form, overviews="average")
    with rasterio.open(path, overview_level=0) as found:
        assert found.read(1)[5, 5] == 180.0
    ts.write(made, path, format=form, overviews="none")
    with rasterio.open(path) as found:
        assert found.overviews(1) == []


@pytest.mark.parametrize("form", FORMATS)
def test_the_same_raster_gives_the_same_bytes(tmp_path, form):
    made = raster(700, 600)
    paths = [ts.write(made, tmp_path / name, format=form) for name in ("a.tif", "b.tif")]
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_files_that_belonged_to_an_earlier_raster_are_removed(tmp_path):
    for name in ("a.tif.aux.xml", "a.tif.ovr", "a.tif.msk"):
        (tmp_path / name).write_text("stale")
    (tmp_path / "a.tiff.ovr").write_text("of another")
    ts.write(raster(), tmp_path / "a.tif")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.tif", "a.tiff.ovr"]


@pytest.mark.parametrize("form", FORMATS)
def test_a_failed_write_leaves_the_old_file(tmp_path, form):
    class Broken(Lazy):
        def __getitem__(self, place):
            raise MemoryError

    path = tmp_path / "a.tif"
    path.write_text("old")
    with pytest.raises(MemoryError):
        ts.write(ts.Raster({"z": Broken(600, 600)}, grid(600, 600)), path, format=form)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("dtype", "nodata"), [("uint8", -1), ("uint8", 256), ("int16", 0.5), ("float32", 1e300)]
)
def test_nodata_that_the_bands_cannot_hold(tmp_path, dtype, nodata):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(WriteError, match="nodata"):
            ts.write(raster(dtype=dtype, nodata=nodata), tmp_path / "a.tif")


def test_options_and_formats_that_are_none(tmp_path):
    with pytest.raises(OptionError, match="overviews"):
        ts.write(raster(), tmp_path / "a.tif", overviews="cubic")
    with pytest.raises(FormatError, match="Raster"):
        ts.write(raster(), tmp_path / "a.gpkg")
    with pytest.raises(FormatError, match="not a Survey"):
        ts.write(ts.Survey(points=np.eye(3)), tmp_path / "a.tif")
    with pytest.raises(FormatError, match="not written"):
        ts.write(raster(), tmp_path / "a.vrt")
    assert list(tmp_path.iterdir()) == []
