"""Counts and heights of points in many files: the same bytes as in memory, for any tiles."""

from __future__ import annotations

import filecmp
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
import rasterio
from support.many_files import Shuffled

import tinsmith as ts
from tinsmith.tiled.computing import computing
from tinsmith.tiled.products import point_rasters
from tinsmith.tiled.running.run_options import RunSettings


def read_cells(path):
    """Return the cells of a file of one band."""
    with rasterio.open(path) as dataset:
        return dataset.read(1)


def write_without_notes(raster, path):
    return ts.write(replace(raster, notes=()), path)


def write_tiled(cloud, path, tiles, **asked):
    how = RunSettings.of(tiles=tiles, executor=Shuffled(tiles))
    with computing(cloud, "point_rasters", path, how, **asked) as made:
        return write_without_notes(made, path)


@pytest.mark.each_value
@pytest.mark.parametrize("tiles", [1, 5, 40])
@pytest.mark.parametrize("spacing", [1.0, 10.0, 300.0])
def test_bytes_are_those_in_memory(lidar, tmp_path, tiles, spacing, monkeypatch):
    monkeypatch.setattr(point_rasters, "_MOST_POINTS", 400)
    survey, ground = ts.read(lidar), ts.triangulate(ts.read(lidar, classes=2))
    whole = ts.rasterize_counts(survey, spacing=spacing)
    wanted = write_without_notes(whole, tmp_path / "whole.tif")
    asked = {"value": "count", "spacing": spacing}
    path = write_tiled(ts.tiles(lidar), tmp_path / "tiled.tif", tiles, **asked)
    assert filecmp.cmp(path, wanted, shallow=False)
    whole = ts.rasterize_heights(ground, survey, spacing=spacing)
    wanted = write_without_notes(whole, tmp_path / "whole.tif")
    cloud, asked = ts.tiles(lidar, classes=2), {"value": "height", "spacing": spacing}
    path = write_tiled(cloud, tmp_path / "tiled.tif", tiles, other=ts.tiles(lidar), **asked)
    assert filecmp.cmp(path, wanted, shallow=False)


def test_methods_write_the_same_with_threads_and_tell_the_same_points(lidar, tmp_path):
    cloud, above = ts.tiles(lidar, where={"classification": 2}), ts.tiles(lidar)
    with ThreadPoolExecutor(2) as threads:
        counts = above.rasterize_counts(tmp_path / "c.tif", spacing=7.0, tiles=4, executor=threads)
        heights = cloud.rasterize_heights(
            tmp_path / "h.tif", above, spacing=7.0, tiles=4, executor=threads
        )
    survey = ts.read(lidar)
    whole = ts.rasterize_heights(ts.triangulate(ts.read(lidar, classes=2)), survey, spacing=7.0)
    wanted = ts.rasterize_counts(survey, spacing=7.0).bands["count"]
    np.testing.assert_array_equal(read_cells(counts), wanted)
    np.testing.assert_array_equal(read_cells(heights), whole.bands["height"])
    assert any("lie outside the surface: they have no height" in one for one in whole.notes)
    with rasterio.open(heights) as dataset:
        assert whole.notes[-1] in dataset.tags()["notes"]
    assert sorted(one.name for one in tmp_path.iterdir()) == ["c.tif", "h.tif"]


def test_cells_of_another_raster_and_points_beyond_the_ground(lidar, tmp_path):
    metres = {"classes": 2, "elevation_unit": "m"}
    ground = ts.triangulate(ts.read(lidar, **metres))
    points = np.array([[500_100.0, 4_000_100.0, 350.0], [490_000.0, 4_000_100.0, 350.0]])
    survey = ts.Survey(points=points, crs="EPSG:32616")
    above = ts.tiles(
        ts.write(survey, tmp_path / "above.csv"), crs="EPSG:32616", elevation_unit="ft"
    )
    like = ts.rasterize(ground, spacing=50.0)
    path = ts.tiles(lidar, **metres).rasterize_heights(
        tmp_path / "h.tif", above, like=like, tiles=6, executor=Shuffled()
    )
    survey = ts.read(tmp_path / "above.csv", crs="EPSG:32616", elevation_unit="ft")
    whole = ts.rasterize_heights(ground, survey, like=like)
    cells = read_cells(path)
    np.testing.assert_array_equal(cells, whole.bands["height"])
    assert np.isfinite(cells).sum() == 1


def test_a_boundary_limits_heights(lidar, tmp_path):
    ring = np.array([[20, 20, 300], [280, 25, 303], [270, 180, 311], [25, 170, 305]], float)
    ring += [500_000, 4_000_000, 0]
    ground = ts.triangulate(ts.read(lidar, classes=2), boundary=[ring])
    whole = ts.rasterize_heights(ground, ts.read(lidar), spacing=5.0)
    cloud = ts.tiles(lidar, classes=2, boundary=[ring])
    way = {"tiles": 9, "executor": Shuffled()}
    path = cloud.rasterize_heights(tmp_path / "h.tif", ts.tiles(lidar), spacing=5.0, **way)
    cells = read_cells(path)
    np.testing.assert_array_equal(cells, whole.bands["height"])


def test_what_is_none_is_refused_and_leaves_nothing(lidar, tmp_path):
    cloud = ts.tiles(lidar)
    line = [[500_000.0, 4_000_000.0, 300.0], [500_100.0, 4_000_100.0, 300.0]]
    lined = ts.tiles(lidar, breaklines=[line])
    with pytest.raises(ts.OptionError, match="none where points are counted"):
        lined.rasterize_counts(tmp_path / "a.tif", spacing=1.0)
    with pytest.raises(ts.OptionError, match="points without lines"):
        cloud.rasterize_heights(tmp_path / "a.tif", lined, spacing=1.0)
    with pytest.raises(ts.OptionError, match="points in files"):
        cloud.rasterize_heights(tmp_path / "a.tif", ts.read(lidar), spacing=1.0)
    with pytest.raises(ts.OptionError, match="spacing"):
        cloud.rasterize_counts(tmp_path / "a.tif", spacing=-1.0)
    assert list(tmp_path.iterdir()) == []


def test_files_without_a_point_that_is_taken_are_told_and_left_out(lidar, tmp_path):
    folder = tmp_path / "lidar"
    folder.mkdir()
    for one in lidar.iterdir():
        (folder / one.name).write_bytes(one.read_bytes())
    water = ts.Survey(
        points=ts.read(lidar).points[:9],
        attributes={"classification": np.full(9, 9, np.uint8)},
        crs="EPSG:32616",
    )
    ts.write(water, folder / "water.laz")
    whole = ts.rasterize_counts(ts.read(folder, classes=2), spacing=10.0)
    for cloud in (ts.tiles(folder, classes=2), ts.tiles(folder, where={"classification": 2})):
        path = cloud.rasterize_counts(tmp_path / "c.tif", spacing=10.0, executor=Shuffled())
        with rasterio.open(path) as dataset:
            np.testing.assert_array_equal(dataset.read(1), whole.bands["count"])
            assert dataset.tags()["notes"].split() == " ".join(whole.notes).split()
    with pytest.raises(ts.ReadError, match="There are no points in the inputs"):
        ts.tiles(folder, classes=3).rasterize_counts(tmp_path / "e.tif", spacing=10.0)


def test_one_store_for_both_clouds_is_refused(lidar, tmp_path):
    cloud = ts.tiles(lidar, classes=2, store=tmp_path / "store")
    above = ts.tiles(lidar, store=tmp_path / "store")
    with pytest.raises(ts.OptionError, match="a folder of its own for each of both"):
        cloud.rasterize_heights(tmp_path / "a.tif", above, spacing=5.0, executor=Shuffled())
    assert list(tmp_path.iterdir()) == []
