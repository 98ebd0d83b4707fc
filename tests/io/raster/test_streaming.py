"""Rasters strip by strip are the rasters read at once; boxes are those of all their cells."""

import numpy as np
import pytest
from support.streams import gather, require_same

import tinsmith as ts
from tinsmith.io.raster import reading
from tinsmith.io.streaming import describe_source, read_box, stream_points

rasterio = pytest.importorskip("rasterio")

UTM = "EPSG:32616"
RNG = np.random.default_rng(1)
HEIGHTS = 300 + np.round(np.cumsum(RNG.normal(size=(37, 23)), axis=1), 2)


def write(path, heights=HEIGHTS, crs=UTM, nodata=None, transform=None, **more):
    transform = transform or rasterio.Affine(2.0, 0, 752_640, 0, -2.0, 4_024_280)
    with rasterio.open(
        path,
        "w",
        driver="GTiff" if path.suffix == ".tif" else "AAIGrid",
        height=heights.shape[0],
        width=heights.shape[1],
        count=1,
        dtype=heights.dtype,
        crs=crs,
        transform=transform,
        nodata=nodata,
        **more,
    ) as dataset:
        dataset.write(heights, 1)
    return path


@pytest.fixture(params=[30, 200, 10**6])
def strips(request, monkeypatch):
    monkeypatch.setattr(reading, "_STRIP_CELLS", request.param)


def with_voids():
    heights = HEIGHTS.copy()
    heights[3:6, 4:9] = -9999
    heights[30, 2] = -9999
    return heights


OPTIONS = [
    {},
    {"stride": 3},
    {"most_cells": 100},
    {"cells": (3, 2, 11, 20)},
    {"window": (752_650, 4_024_220, 752_670.5, 4_024_260)},
    {"window": (752_650, 4_024_220, 752_670.5, 4_024_260), "stride": 2},
    {"crs": "EPSG:2274"},
    {"elevation_unit": "ft"},
    {"nodata": 300},
    {"band": 2},
    {"crs": "EPSG:4326"},
    {"window": (0, 0, 1, 1)},
]


@pytest.mark.each_value
@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_strips_are_the_whole(tmp_path, strips, options):
    require_same(write(tmp_path / "dem.tif", blockysize=4, tiled=False), **options)


@pytest.mark.parametrize("fill", [True, False])
def test_voids(tmp_path, strips, fill):
    path = write(tmp_path / "dem.tif", with_voids(), nodata=-9999)
    survey = require_same(path, fill=fill)
    _, stream = gather(path, 100, fill=fill)
    assert stream.has_voids == bool(survey.extent) == (not fill)


def test_an_undeclared_mark_of_no_data_is_noted(tmp_path, strips):
    survey = require_same(write(tmp_path / "dem.tif", with_voids()))
    assert any("nodata=-9999" in note for note in survey.notes)
    assert len(require_same(write(tmp_path / "flat.tif", np.zeros((30, 30))))) == 900


def test_lonely_cells(tmp_path, strips):
    heights = np.full((9, 9), -9999.0)
    heights[::3, ::3] = 5
    path = write(tmp_path / "dem.tif", heights, nodata=-9999)
    require_same(path)
    require_same(path, fill=True)
    require_same(write(tmp_path / "none.tif", np.full((9, 9), -9999.0), nodata=-9999))


def test_a_turned_raster_and_an_ascii_grid(tmp_path, strips):
    turned = rasterio.Affine(1.5, 0.5, 752_640, 0.5, -1.5, 4_024_280)
    require_same(write(tmp_path / "turned.tif", transform=turned))
    require_box(tmp_path / "turned.tif", (752_660, 4_024_250, 752_670, 4_024_270))
    require_same(write(tmp_path / "dem.asc", HEIGHTS.astype(np.float32), crs=None), crs=UTM)


def test_rows_are_the_cells(tmp_path, strips):
    path = write(tmp_path / "dem.tif")
    (chunk,), _ = gather(path, 10**9, stride=5)
    at = np.unravel_index(chunk.rows, HEIGHTS.shape)
    assert np.array_equal(HEIGHTS[at], chunk.points[:, 2])
    assert np.array_equal(chunk.points[:, 0], 752_641 + 2.0 * at[1])


# ------------------------------------------------------------------- headers and boxes


def test_a_header_tells_of_the_cells(tmp_path):
    path = write(tmp_path / "dem.tif")
    header, survey = describe_source(path), ts.read(path)
    assert (header.format, header.count, header.bounds) == ("raster", 37 * 23, survey.bounds)
    assert (header.crs, header.elevation_unit) == (survey.crs, survey.elevation_unit)
    assert header.has_boxes
    moved, there = describe_source(path, crs="EPSG:2274"), ts.read(path, crs="EPSG:2274")
    assert not moved.has_boxes
    assert moved.bounds.xmin == pytest.approx(there.bounds.xmin, abs=0.01)
    with pytest.raises(ts.ReadError, match="reprojected"):
        read_box(path, (0, 0, 1, 1), crs="EPSG:2274")
    with pytest.raises(ts.CrsError, match="in degrees"):
        describe_source(write(tmp_path / "d.tif", crs="EPSG:4326"))


def require_box(path, box, **options):
    (whole,), _ = gather(path, 10**9, fill=True, **options)
    xy = whole.points[:, :2]
    expected = whole.take(((xy >= box[:2]) & (xy <= box[2:])).all(axis=1))
    found = read_box(path, box, **options)
    assert found.points.tobytes() == expected.points.tobytes()
    assert np.array_equal(found.rows, expected.rows)
    return found


BOXES = [
    (752_650.0, 4_024_220.0, 752_670.5, 4_024_260.0),
    (752_641.0, 4_024_207.0, 752_641.0, 4_024_279.0),
    (752_650.1, 4_024_250.1, 752_650.2, 4_024_250.2),
    (-1e300, -1e300, 1e300, 1e300),
    (0, 0, 1, 1),
]


@pytest.mark.each_value
@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("options", [{}, {"stride": 3}, {"cells": (3, 2, 11, 20), "stride": 2}])
def test_boxes(tmp_path, strips, box, options):
    path = write(tmp_path / "dem.tif", with_voids(), nodata=-9999)
    require_box(path, box, **options)


def test_a_box_of_random_places(tmp_path):
    path = write(tmp_path / "dem.tif")
    rng = np.random.default_rng(3)
    for _ in range(15):
        x, y = 752_630 + 70 * rng.random(2), 4_024_200 + 90 * rng.random(2)
        require_box(path, (x.min(), y.min(), x.max(), y.max()), stride=int(rng.integers(1, 4)))


def test_more_cells_than_memory_holds_are_given_in_chunks(tmp_path, monkeypatch):
    path = write(tmp_path / "dem.tif")
    monkeypatch.setattr(reading, "measure_free_memory", lambda: 48 * 800)
    with pytest.raises(ts.ReadError, match="800 are the most"):
        ts.read(path)
    with stream_points(path, chunk_points=100) as stream:
        assert sum(map(len, stream)) == HEIGHTS.size
