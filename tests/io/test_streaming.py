"""Files of formats without parts are read whole, if they are small, and given in chunks."""

import numpy as np
import pytest
from support.streams import gather, require_same

import tinsmith as ts
from tinsmith.io import streaming
from tinsmith.io.streaming import describe_source, read_box, stream_points

RNG = np.random.default_rng(1)
POINTS = np.array([752_640.0, 4_024_180.0, 300.0]) + RNG.random((40, 3)) * (200, 100, 30)


@pytest.fixture
def survey():
    return ts.Survey(points=POINTS, attributes={"number": np.arange(40)}, crs="EPSG:32616")


@pytest.mark.parametrize("name", ["points.geojson", "points.gpkg", "points.dxf"])
def test_a_small_file_of_any_format(tmp_path, survey, name):
    path = ts.write(survey, tmp_path / name)
    found = require_same(path, crs="EPSG:32616")
    assert len(found) == 40
    header = describe_source(path)
    assert (header.size, header.has_boxes, header.count) == (path.stat().st_size, False, None)


def test_a_large_file_that_is_read_whole_is_refused(tmp_path, survey, monkeypatch):
    path = ts.write(survey, tmp_path / "points.geojson")
    monkeypatch.setattr(streaming, "_LARGEST_WHOLE", 100)
    with pytest.raises(ts.ReadError, match=r"read only whole, up to 0 MB"):
        stream_points(path, crs="EPSG:32616")


def test_triangles_and_lines_are_no_points(tmp_path, survey):
    tin = ts.write(ts.triangulate(survey), tmp_path / "tin.ply")
    with pytest.raises(ts.ReadError, match="holds a TIN"):
        stream_points(tin)


def test_what_is_wrong_is_refused_as_by_read(tmp_path, survey):
    path = ts.write(survey, tmp_path / "points.geojson")
    require_same(tmp_path / "missing.laz")
    require_same(path, format="nonsense")
    require_same(path, nonsense=1)
    (tmp_path / "empty.csv").write_text("")
    require_same(tmp_path / "empty.csv")
    for count in (0, 1.5, None):
        with pytest.raises(ts.OptionError, match="chunk_points"):
            stream_points(path, chunk_points=count)
    with pytest.raises(ts.ReadError, match="no order in space"):
        read_box(path, (0, 0, 1, 1), crs="EPSG:32616")


def test_a_folder_of_text_files(tmp_path, survey):
    for name in ("a.csv", "b.csv"):
        ts.write(survey, tmp_path / name)
    whole = ts.read(tmp_path, crs="EPSG:32616")
    chunks, stream = gather(tmp_path, 9, crs="EPSG:32616")
    assert np.array_equal(np.concatenate([one.points for one in chunks]), whole.points)
    assert stream.notes == list(whole.notes)
