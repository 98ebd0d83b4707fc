"""Viewsheds: each vertex in fractions, and GDAL's on a fine raster."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.sight_oracle import find_first_block

import tinsmith as ts


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4), st.sampled_from([0.0, 0.5]))
def test_vertices_that_are_seen_are_those_of_brute_force(seed, relief, height):
    rng = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(6), np.arange(6)))
    tin = ts.triangulate(np.column_stack([x, y, rng.integers(0, relief + 1, 36)]).astype(float))
    eye = rng.integers(0, 11, 2) / 2
    seen = ts.visible_vertices(tin, eye, eye_height=height)
    start = [*eye, float(tin.interpolate([eye])[0]) + height]
    for vertex, point in enumerate(tin.points.tolist()):
        is_eye = point[:2] == start[:2]
        block = None if is_eye else find_first_block(tin.points, tin.edges, start, point)
        assert seen[vertex] == (block is None)


def test_classes_tile_the_surface_and_a_radius_limits_them():
    rng = np.random.default_rng(2)
    points = np.column_stack([rng.uniform(0, 90, (400, 2)), rng.uniform(0, 9, 400)])
    tin = ts.triangulate(points, crs="EPSG:32616", z_unit="m")
    found = ts.viewshed(tin, [45, 45], eye_height=5)
    assert found.columns["area"].sum() == pytest.approx(tin.area)
    assert found.columns["triangles"].sum() == len(tin.triangles)
    seen = ts.visible_vertices(tin, [45, 45], eye_height=5, radius=20)
    far = np.hypot(*(tin.points[:, :2] - 45).T) > 20
    assert not seen[far].any()
    assert seen[~far].tolist() == (ts.visible_vertices(tin, [45, 45], eye_height=5)[~far].tolist())
    near = ts.viewshed(tin, [45, 45], eye_height=5, radius=20)
    assert near.columns["area"].sum() < found.columns["area"].sum()


def test_a_slope_behind_a_crest_is_hidden_and_the_one_before_it_seen():
    ridge = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]
    found = ts.viewshed(ts.triangulate(ridge), [1, 2], eye_height=0.5)
    assert found.columns["class"].tolist() == ["visible", "hidden"]
    assert found.columns["area"].tolist() == [16.0, 16.0]


@pytest.mark.skipif(shutil.which("gdal_viewshed") is None, reason="needs gdal_viewshed")
def test_gdal_sees_the_same_on_a_fine_raster(tmp_path):
    rng = np.random.default_rng(4)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0, 101, 5.0), np.arange(0, 101, 5.0)))
    z = 6 * np.sin(x / 13) * np.cos(y / 11) + rng.uniform(0, 0.5, len(x))
    origin = np.array([500_000.0, 4_000_000.0, 0.0])
    tin = ts.triangulate(np.column_stack([x, y, z]) + origin, crs="EPSG:32616", z_unit="m")
    eye = origin[:2] + 50.25
    ts.write(ts.rasterize(tin, spacing=0.5), tmp_path / "dem.tif")
    # GDAL's own line of sight: no curvature, targets on the ground.
    how = ("-ox", f"{eye[0]}", "-oy", f"{eye[1]}", "-oz", "4", "-cc", "0")
    subprocess.run(
        ["gdal_viewshed", *how, tmp_path / "dem.tif", tmp_path / "seen.tif"],
        check=True,
        timeout=600,
    )
    import rasterio

    with rasterio.open(tmp_path / "seen.tif") as file:
        theirs = [value[0] > 0 for value in file.sample(tin.points[:, :2] + 1e-3)]
    ours = ts.visible_vertices(tin, eye, eye_height=4)
    inner = np.abs(tin.points[:, :2] - origin[:2] - 50).max(axis=1) < 50
    assert (np.array(theirs) == ours)[inner].mean() > 0.9  # GDAL interpolates between cells
    assert 0.1 < ours.mean() < 0.9


def test_wrong_options_are_refused():
    tin = ts.triangulate([[0, 0, 0], [4, 0, 0], [0, 4, 0]])
    for radius in (0, -1, float("nan"), "far"):
        with pytest.raises(ts.OptionError, match="radius"):
            ts.viewshed(tin, [1, 1], radius=radius)
    with pytest.raises(ts.PointsError, match="a viewshed has one"):
        ts.visible_vertices(tin, [[1, 1], [1, 2]])
