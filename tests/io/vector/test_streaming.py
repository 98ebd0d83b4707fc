"""GeoParquet group of rows after group is the file read at once; boxes are those of all points."""

import json

import numpy as np
import pytest
from support.streams import gather, require_same

import tinsmith as ts
from tinsmith.io.streaming import describe_source, read_box

pyarrow = pytest.importorskip("pyarrow")
geopandas = pytest.importorskip("geopandas")
parquet = pytest.importorskip("pyarrow.parquet")

UTM = "EPSG:32616"
RNG = np.random.default_rng(1)
XYZ = np.array([752_640.0, 4_024_180.0, 300.0]) + RNG.random((500, 3)) * (200, 100, 30)
XYZ = XYZ[np.argsort(XYZ[:, 0])]


def write(path, xyz=XYZ, crs=UTM, columns=None, group=64, **options):
    shapely = pytest.importorskip("shapely")
    shapes = shapely.points(xyz)
    frame = geopandas.GeoDataFrame(
        columns or {"code": np.arange(len(xyz))}, geometry=shapes, crs=crs
    )
    frame.to_parquet(path, row_group_size=group, **options)
    return path


@pytest.mark.each_value
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"crs": "EPSG:2274"},
        {"elevation_unit": "ft"},
        {"nodata": 300.0},
        {"z_field": "code"},
        {"z_field": "nothing"},
        {"layer": "nothing"},
        {"where": "code < 3"},
        {"crs": "EPSG:4326"},
        {"lines_as": "points"},
    ],
    ids=str,
)
@pytest.mark.parametrize("encoding", ["WKB", "geoarrow"])
def test_groups_are_the_whole(tmp_path, options, encoding):
    path = write(tmp_path / "a.parquet", geometry_encoding=encoding)
    require_same(path, chunks=(7, 10**9), **options)


def test_what_we_write(tmp_path):
    survey = ts.Survey(points=XYZ, attributes={"name": [f"p{k}" for k in range(500)]}, crs=UTM)
    path = ts.write(survey, tmp_path / "a.parquet")
    found = require_same(path, chunks=(77,))
    assert np.array_equal(found.points, XYZ)
    assert not describe_source(path).has_boxes
    with pytest.raises(ts.ReadError, match="tells no bounds"):
        read_box(path, (0, 0, 1, 1))


def test_features_without_geometry_and_elevations_of_a_column(tmp_path):
    shapely = pytest.importorskip("shapely")
    shapes = shapely.points(XYZ[:, :2])
    shapes[[3, 200, 499]] = None
    heights = XYZ[:, 2].copy()
    heights[[7, 300]] = np.nan
    frame = geopandas.GeoDataFrame({"elevation": heights}, geometry=shapes, crs=UTM)
    frame.to_parquet(tmp_path / "a.parquet", row_group_size=64)
    survey = require_same(tmp_path / "a.parquet", chunks=(7, 10**9))
    assert survey.skipped == {"features without an elevation": 2}
    chunks, _ = gather(tmp_path / "a.parquet", 10**9)
    rows = np.setdiff1d(np.arange(500), [3, 200, 499, 7, 300])
    assert np.array_equal(chunks[0].rows, rows)


def test_other_features_are_read_at_once(tmp_path):
    tin = ts.triangulate(XYZ, crs=UTM)
    path = ts.write(tin, tmp_path / "tin.parquet")
    with pytest.raises(ts.ReadError, match="holds a TIN"):
        gather(path, 10)
    lines = ts.write(ts.contours(tin, interval=5.0), tmp_path / "lines.parquet")
    require_same(lines)


# ------------------------------------------------------------------ metadata and boxes


@pytest.mark.each_value
@pytest.mark.parametrize("how", [{"write_covering_bbox": True}, {"geometry_encoding": "geoarrow"}])
@pytest.mark.parametrize(
    "box",
    [
        (752_650.0, 4_024_190.0, 752_670.5, 4_024_260.0),
        (752_700.0, 4_024_100.0, 752_700.5, 4_024_400.0),
        (-1e300, -1e300, 1e300, 1e300),
        (0, 0, 1, 1),
    ],
)
def test_boxes(tmp_path, how, box):
    path = write(tmp_path / "a.parquet", **how)
    assert describe_source(path).has_boxes
    (whole,), _ = gather(path, 10**9)
    xy = whole.points[:, :2]
    expected = whole.take(((xy >= box[:2]) & (xy <= box[2:])).all(axis=1))
    found = read_box(path, box)
    assert found.points.tobytes() == expected.points.tobytes()
    assert np.array_equal(found.rows, expected.rows)


def test_metadata_tell_of_the_points(tmp_path):
    path = write(tmp_path / "a.parquet", write_covering_bbox=True)
    header, survey = describe_source(path), ts.read(path)
    assert (header.count, header.bounds, header.crs) == (500, survey.bounds, survey.crs)
    assert header.elevation_unit == survey.elevation_unit
    moved = describe_source(path, crs="EPSG:2274")
    assert not moved.has_boxes
    assert moved.elevation_unit == ts.read(path, crs="EPSG:2274").elevation_unit
    geo = json.loads(parquet.read_schema(path).metadata[b"geo"])
    assert "covering" in geo["columns"]["geometry"]
