"""Rasters written with rasterio, read back as points; plain loops are the second opinion."""

from __future__ import annotations

import subprocess
import sys
import warnings
from types import SimpleNamespace

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io import CrsError, OptionError, ReadError, read
from tinsmith.io.raster import reading

rasterio = pytest.importorskip("rasterio")
pyproj = pytest.importorskip("pyproj")
from rasterio.enums import ColorInterp  # noqa: E402
from rasterio.transform import Affine  # noqa: E402

UPRIGHT = Affine(30.0, 0.0, 740000.0, 0.0, -20.0, 4030000.0)
ROTATED = Affine(5.87, 2.72, 740000.5, 3.81, -4.19, 4030000.25)
SOUTH_UP = Affine(10.0, 0.0, 740000.0, 0.0, 10.0, 4000000.0)


def heights(rows=6, columns=9, dtype="float32"):
    return (np.arange(rows * columns).reshape(rows, columns) * 7 % 50 + 100).astype(dtype)


@pytest.fixture
def raster(tmp_path):
    """Return a function that writes bands to a GeoTIFF and returns its path."""

    def of(*bands, transform=UPRIGHT, crs="EPSG:32616", mask=None, name="dem.tif", **profile):
        path = tmp_path / name
        size = {"height": bands[0].shape[0], "width": bands[0].shape[1]}
        options = {"dtype": bands[0].dtype, "transform": transform, "crs": crs, **size, **profile}
        scales, offsets = options.pop("scales", None), options.pop("offsets", None)
        with rasterio.open(path, "w", driver="GTiff", count=len(bands), **options) as dataset:
            for number, band in enumerate(bands, 1):
                dataset.write(band, number)
            if mask is not None:
                dataset.write_mask(mask)
            if scales is not None:
                dataset.scales, dataset.offsets = scales, offsets
        return path

    return of


def centre(transform, row, column):
    """Rasterio's own answer; it uses an operator that its library affine is about to drop."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)
        return rasterio.transform.xy(transform, row, column)


def points_by_loop(array, transform, keep=lambda value: True):
    """Every cell in turn, its centre by rasterio."""
    points = []
    for row in range(array.shape[0]):
        for column in range(array.shape[1]):
            if keep(array[row, column]):
                x, y = centre(transform, row, column)
                points.append((x, y, float(array[row, column])))
    return np.array(points)


def fault(path, error=ReadError, **options):
    with pytest.raises(error) as caught:
        read(path, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert message.endswith(".")
    return message


# ------------------------------------------------------------------ values and places


@pytest.mark.parametrize("transform", [UPRIGHT, ROTATED, SOUTH_UP])
@pytest.mark.parametrize("dtype", ["uint8", "int16", "uint16", "int32", "float32", "float64"])
def test_points_stand_at_the_pixel_centres(raster, transform, dtype):
    array = heights(dtype=dtype)
    survey = read(raster(array, transform=transform))
    assert np.allclose(survey.points, points_by_loop(array, transform), rtol=0, atol=1e-9)
    assert np.array_equal(survey.points[:, 2], array.ravel())
    assert survey.crs == "EPSG:32616"
    assert survey.source == "dem.tif"
    assert survey.skipped == {}


@pytest.mark.parametrize("nodata", [-9999.0, np.nan, -1.7e308])
def test_nodata_nan_and_infinity_are_left_out_and_counted(raster, nodata):
    array = heights(dtype="float64")
    array[0, 0] = array[2, 3] = nodata
    array[4, 4], array[5, 5] = np.nan, np.inf
    survey = read(raster(array, nodata=nodata))
    expected = points_by_loop(array, UPRIGHT, lambda z: np.isfinite(z) and z != nodata)
    assert np.array_equal(survey.points, expected)
    assert survey.skipped == {"nodata cells": 4}


def test_mask_is_honoured(raster):
    array = heights(dtype="int16")
    mask = np.full(array.shape, 255, np.uint8)
    mask[1, 2:5] = 0
    survey = read(raster(array, mask=mask))
    assert survey.skipped == {"nodata cells": 3}
    assert np.array_equal(survey.points[:, 2], array[mask != 0])


def test_alpha_band_is_a_mask(raster):
    array, alpha = heights(dtype="uint8"), np.full((6, 9), 255, np.uint8)
    alpha[0] = 0
    path = raster(array, alpha, photometric="MINISBLACK", alpha="YES")
    with rasterio.open(path) as dataset:
        assert dataset.colorinterp[1] == ColorInterp.alpha
    assert read(path).skipped == {"nodata cells": 9}


@pytest.mark.parametrize("nodata", ["none", [1.0, "x"], 10**400, object()])
def test_nodata_that_is_no_number_is_refused(raster, nodata):
    with pytest.raises(
        ts.OptionError, match=r"Invalid nodata .*: it must be a number, or several\."
    ):
        ts.read(raster(np.ones((3, 3), np.float32)), nodata=nodata)


def test_scale_and_offset_are_applied_after_nodata(raster):
    array = heights(dtype="int16")
    array[0, 0] = -1
    survey = read(raster(array, nodata=-1, scales=(0.25,), offsets=(1000.0,)))
    assert np.array_equal(survey.points[:, 2], array.ravel()[1:] * 0.25 + 1000.0)
    assert survey.skipped == {"nodata cells": 1}


def test_band_by_number(raster):
    first, second = heights(), heights() * 3
    path = raster(first, second)
    assert np.array_equal(read(path).points[:, 2], first.ravel())
    assert np.array_equal(read(path, band=2).points[:, 2], second.ravel())
    for band in (0, 3, -1, 1.5, "1"):
        assert "bands 1 to 2" in fault(path, OptionError, band=band)


def test_strips_join_without_a_seam(raster, monkeypatch):
    from tinsmith.io.raster import reading as module

    array = heights(61, 37)
    array[10:20, 5:9] = -1
    path = raster(array, nodata=-1, tiled=True, blockxsize=16, blockysize=16)
    plain = [read(path), read(path, stride=3), read(path, cells=(3, 7, 30, 50), stride=4)]
    monkeypatch.setattr(module, "_STRIP_CELLS", 1)
    strips = [read(path), read(path, stride=3), read(path, cells=(3, 7, 30, 50), stride=4)]
    for one, other in zip(plain, strips, strict=True):
        assert np.array_equal(one.points, other.points)
        assert one.skipped == other.skipped


# ------------------------------------------------------------------ window and stride


@pytest.mark.parametrize("stride", [1, 2, 3, 4])
@pytest.mark.parametrize("cells", [None, (2, 1, 6, 5), (0, 0, 9, 6)])
def test_part_in_cells_and_stride(raster, cells, stride):
    array = heights()
    survey = read(raster(array, transform=ROTATED), cells=cells, stride=stride)
    column, row, width, height = cells or (0, 0, 9, 6)
    expected = [
        (*centre(ROTATED, i, j), array[i, j])
        for i in range(row, row + height, stride)
        for j in range(column, column + width, stride)
    ]
    assert np.allclose(survey.points, expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("transform", [UPRIGHT, ROTATED, SOUTH_UP])
def test_window_in_coordinates_holds_the_centres_within(raster, transform):
    array = heights(20, 20)
    everything = points_by_loop(array, transform)
    middle, reach = everything[:, :2].mean(axis=0), np.ptp(everything[:, :2], axis=0) / 5
    bounds = ts.Bounds(*(middle - reach), *(middle + reach))
    path = raster(array, transform=transform)
    survey = read(path, window=bounds)
    limits = (bounds.xmin, bounds.ymin, bounds.xmax, bounds.ymax)
    assert np.array_equal(read(path, window=limits).points, survey.points)
    inside = (np.abs(everything[:, :2] - middle) <= reach).all(axis=1)
    assert 0 < inside.sum() < 400
    assert np.allclose(survey.points, everything[inside], rtol=0, atol=1e-9)


@pytest.mark.parametrize("transform", [UPRIGHT, SOUTH_UP])
def test_centres_on_the_bounds_of_a_window_are_within(raster, transform):
    array = heights(20, 20)
    everything = points_by_loop(array, transform)
    x, y = (np.unique(everything[:, k]) for k in range(2))
    bounds = ts.Bounds(x[4], y[5], x[9], y[12])
    path = raster(array, transform=transform)
    assert len(read(path, window=bounds).points) == 6 * 8
    closer = ((x[4], x[5]), (y[5], y[6]), (x[9], x[8]), (y[12], y[11]))
    for k, (limit, inner) in enumerate(closer):
        limits = [bounds.xmin, bounds.ymin, bounds.xmax, bounds.ymax]
        limits[k] = np.nextafter(limit, inner)
        survey = read(path, window=ts.Bounds(*limits))
        assert len(survey.points) == (5 * 8 if k in (0, 2) else 6 * 7)


@pytest.mark.parametrize("transform", [UPRIGHT, SOUTH_UP])
@pytest.mark.parametrize("side", range(5))
def test_window_beyond_a_side_of_the_raster_holds_what_there_is(raster, transform, side):
    array = heights(20, 20)
    everything = points_by_loop(array, transform)
    low, high = np.quantile(everything[:, :2], [0.3, 0.7], axis=0)
    limits = np.array([*low, *high])
    wide = np.array([*(low - 1000), *(high + 1000)])
    limits = np.where(np.arange(4) == side, wide, limits) if side < 4 else wide
    survey = read(raster(array, transform=transform), window=ts.Bounds(*limits))
    x, y = everything[:, :2].T
    inside = (limits[0] <= x) & (x <= limits[2]) & (limits[1] <= y) & (y <= limits[3])
    assert np.allclose(survey.points, everything[inside], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "window",
    [
        (0, 0, 10, 6),
        (-1, 0, 3, 3),
        (0, 0, 0, 3),
        (9, 0, 1, 1),
        (1, 2),
        3,
        (0.5, 0, 3, 3),
        "abcd",
        ts.Bounds(0, 0, 1, 1),
        ts.Bounds(np.nan, 0, 1, 1),
        ts.Bounds(740001, 4029990, 740002, 4029991),
        ts.Bounds(740100, 4029990, 740000, 4029900),
    ],
)
def test_window_that_the_raster_does_not_have(raster, window):
    assert "indow" in fault(raster(heights()), OptionError, window=window)


@pytest.mark.parametrize("stride", [1, 3])
def test_cells_are_no_more_than_an_int32_can_number(monkeypatch, stride):
    monkeypatch.setattr(reading, "measure_free_memory", lambda: 1 << 60)
    most = np.iinfo(np.int32).max
    reading._require_few_cells(reading.Cells(0, 0, stride * most, 1, stride))
    with pytest.raises(ReadError, match=f"{most + 1:,} cells .* {most:,} are the most that a TIN"):
        reading._require_few_cells(reading.Cells(0, 0, stride * most + 1, 1, stride))


@pytest.mark.parametrize("stride", [0, -2, 6, 100, 1.5, "2"])
def test_stride_that_cannot_be(raster, stride):
    assert "1 to 5" in fault(raster(heights()), OptionError, stride=stride)


@pytest.mark.parametrize("most", [4, 5, 12, 29, 54, 100, 366, 10**9])
def test_no_more_cells_than_wanted(raster, most):
    """The smallest stride for which they are no more, found by trying each."""
    array = heights(61, 37)
    array[0, 0] = -1
    path = raster(array, nodata=-1)
    stride = next(n for n in range(1, 60) if -(-61 // n) * -(-37 // n) <= most)
    found, wanted = read(path, most_cells=most), read(path, stride=min(stride, 36))
    np.testing.assert_array_equal(found.points, wanted.points)
    left_out = 61 * 37 - len(found.points) - 1
    if stride == 1:
        assert found.skipped == wanted.skipped
        assert not any("of 2,257 cells" in note for note in found.notes)
    else:
        assert found.skipped == {"nodata cells": 1, "cells between samples": left_out}
        told = f"One row and column of {min(stride, 36)} is read: {len(found.points) + 1:,} of"
        assert any(told in note for note in found.notes)


def test_a_narrow_raster_keeps_two_rows(raster):
    found = read(raster(heights(3, 400)), most_cells=50)
    assert len(found.points) == 2 * 200
    assert found.skipped["cells between samples"] == 800


@pytest.mark.parametrize("most", [3, 0, -1, 1.5, "9", True])
def test_a_number_of_cells_that_cannot_be(raster, most):
    assert "a whole number >= 4" in fault(raster(heights()), OptionError, most_cells=most)


def test_a_stride_and_a_number_of_cells_are_one_too_many(raster):
    assert "stride" in fault(raster(heights()), OptionError, most_cells=9, stride=2)


# ------------------------------------------------------------------ CRS


def test_reprojection_moves_the_centres_exactly(raster):
    array = heights()
    array[0, 0] = -1
    path = raster(array, nodata=-1)
    survey = read(path, crs="EPSG:2274")
    source = points_by_loop(array, UPRIGHT, lambda z: z != -1)
    move = pyproj.Transformer.from_crs("EPSG:32616", "EPSG:2274", always_xy=True)
    x, y = move.transform(source[:, 0], source[:, 1])
    assert np.allclose(survey.points[:, :2], np.stack([x, y], axis=1), rtol=0, atol=1e-9)
    assert np.allclose(survey.points[:, 2], source[:, 2] * 3937 / 1200, rtol=1e-15, atol=0)
    assert any("taken to be metre" in note for note in survey.notes)
    assert survey.elevation_unit is None
    assert survey.crs == "EPSG:2274"


def test_same_crs_leaves_every_bit(raster):
    path = raster(heights())
    assert read(path, crs="EPSG:32616").points.tobytes() == read(path).points.tobytes()


def test_degrees_are_projected_or_refused_with_a_fitting_zone(raster):
    transform = Affine(0.01, 0.0, -84.5, 0.0, -0.01, 36.5)
    path = raster(heights(), transform=transform, crs="EPSG:4269")
    for crs in (None, "EPSG:4326"):
        sentence = fault(path, crs=crs)
        assert "give `crs='EPSG:32616'` to reproject" in sentence
        assert "--" not in sentence  # the command line alone speaks of flags
    survey = read(path, crs="EPSG:32616")
    source = points_by_loop(heights(), transform)
    move = pyproj.Transformer.from_crs("EPSG:4269", "EPSG:32616", always_xy=True)
    expected = np.stack(move.transform(source[:, 0], source[:, 1]), axis=1)
    assert np.allclose(survey.points[:, :2], expected, rtol=0, atol=1e-9)


def test_raster_without_crs_takes_the_one_declared(raster):
    path = raster(heights(), crs=None)
    assert read(path).crs is None
    survey = read(path, crs="EPSG:32616")
    assert survey.crs == "EPSG:32616"
    assert survey.points.tobytes() == read(path).points.tobytes()


def test_crs_without_a_code_travels_as_wkt(raster):
    custom = "+proj=tmerc +lat_0=0 +lon_0=-84 +k=0.9999 +x_0=5000 +y_0=0 +ellps=GRS80 +units=m"
    survey = read(raster(heights(), crs=custom))
    assert str(survey.crs).startswith(("PROJCRS[", "BOUNDCRS["))
    assert 5000 in [one.value for one in pyproj.CRS(survey.crs).coordinate_operation.params]
    assert read(raster(heights(), crs=custom), crs=survey.crs).crs == survey.crs


def test_points_outside_the_wanted_crs(raster):
    path = raster(heights(), transform=Affine(30.0, 0.0, 1e9, 0.0, -30.0, 1e9))
    assert "dem.tif" in fault(path, CrsError, crs="EPSG:2274")


# ------------------------------------------------------------------ bad input


def test_all_nodata(raster):
    array = np.full((4, 5), -1.0)
    assert "of 20 cells of band 1, none" in fault(raster(array, nodata=-1))


@pytest.mark.parametrize("share", [0.05, 0.5, 0.9])
def test_truncated_file_is_one_sentence_and_quiet(raster, tmp_path, share):
    path = raster(np.random.default_rng(1).random((200, 200)))
    content = path.read_bytes()
    (tmp_path / "cut.tif").write_bytes(content[: int(len(content) * share)])
    assert "truncated" in fault(tmp_path / "cut.tif")
    code = (
        "import sys; from tinsmith.io import ReadError, read\n"
        "try: read(sys.argv[1])\nexcept ReadError: pass\nelse: sys.exit(3)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, tmp_path / "cut.tif"], check=False, capture_output=True
    )
    assert (done.returncode, done.stderr, done.stdout) == (0, b"", b"")


def test_pictures_are_refused(raster, tmp_path):
    grey = np.full((8, 9), 7, np.uint8)
    assert "picture" in fault(raster(grey, grey, grey, photometric="RGB"))
    assert len(read(raster(grey, grey, grey, photometric="RGB"), band=2)) == 72
    path = tmp_path / "photo.csv"
    profile = {"driver": "PNG", "width": 9, "height": 8, "dtype": "uint8"}
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):  # noqa: SIM117
        with rasterio.open(path, "w", count=3, **profile) as dataset:
            dataset.write(np.stack([grey] * 3))
    assert "picture" in fault(path)


def test_raster_without_a_place(tmp_path):
    path = tmp_path / "plain.tif"
    profile = {"driver": "GTiff", "width": 9, "height": 6, "dtype": "float32", "count": 1}
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):  # noqa: SIM117
        with rasterio.open(path, "w", **profile) as dataset:
            dataset.write(heights(), 1)
    assert "georeference" in fault(path)


def test_complex_numbers(raster):
    assert "complex" in fault(raster(heights(dtype="complex64")))


def test_missing_rasterio_is_named_with_its_extra(raster, monkeypatch):
    path = raster(heights())
    monkeypatch.setitem(sys.modules, "rasterio", None)
    with pytest.raises(ts.MissingExtraError, match="pip install rasterio"):
        read(path)


# ------------------------------------------------------------------ other formats of GDAL


def test_text_grid_whatever_its_suffix(tmp_path):
    header = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -1\n"
    expected = [[105, 215, 1], [115, 215, 2], [125, 215, 3], [105, 205, 4], [125, 205, 6]]
    for name in ("grid.asc", "grid.txt", "grid"):
        (tmp_path / name).write_text(header + "1 2 3\n4 -1 6\n")
        survey = read(tmp_path / name)
        assert survey.points.tolist() == expected
        assert survey.skipped == {"nodata cells": 1}


def test_virtual_raster_and_one_whose_source_is_gone(raster, tmp_path):
    array = heights()
    path = raster(array)
    text = (
        '<VRTDataset rasterXSize="9" rasterYSize="6"><GeoTransform>740000, 30, 0, 4030000, 0, -20'
        '</GeoTransform><VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename '
        'relativeToVRT="1">dem.tif</SourceFilename><SourceBand>1</SourceBand></SimpleSource>'
        "</VRTRasterBand></VRTDataset>"
    )
    (tmp_path / "dem.vrt").write_text(text)
    assert np.array_equal(read(tmp_path / "dem.vrt").points, points_by_loop(array, UPRIGHT))
    path.unlink()
    fault(tmp_path / "dem.vrt")


def test_raster_becomes_a_tin(raster):
    tin = ts.triangulate(read(raster(heights())))
    assert len(tin.triangles) == 2 * 5 * 8


@pytest.mark.parametrize(
    "transform",
    [(2.0, 4.0, 0.0, 1.0, 2.0, 0.0), (np.inf, 0, 0, 0, -1, 0), (1.0, 0, np.nan, 0, -1.0, 0)],
)
def test_cells_without_a_size_are_refused(transform):
    header = SimpleNamespace(transform=transform, bounds=(0.0, 0.0, 1.0, 1.0))
    with pytest.raises(ReadError, match="in which a cell has no size, or none that is finite"):
        reading._require_position(header)
