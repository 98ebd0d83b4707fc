"""Rasters of points: counts as rasterio adds points up, heights as one computes them by hand."""

from __future__ import annotations

import numpy as np
import pytest
import rasterio.features
from rasterio.enums import MergeAlg

import tinsmith as ts


def make_points(rng, count, side=40.0):
    """Return points of which half lie on the sides and corners of cells one wide."""
    points = rng.random((count, 3)) * [side, side, 9.0]
    points[::2, :2] = np.round(points[::2, :2])
    points[::5, 0] = np.round(points[::5, 0])
    return points


def make_ground(rng):
    """Return a surface that is larger than the points."""
    corners = [[-1, -1, 1], [41, -1, 2], [41, 41, 3], [-1, 41, 0]]
    inner = rng.random((60, 3)) * [40, 40, 2]
    return ts.triangulate(np.concatenate([corners, inner]), crs="EPSG:32616", elevation_unit="m")


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("spacing", [1.0, 2.5, 0.5])
def test_counts_are_those_of_rasterio(seed, spacing):
    points = make_points(np.random.default_rng(seed), 2_000)
    made = ts.rasterize_counts(points, spacing=spacing)
    box, counts = made.grid.bounds, made.bands["count"]
    assert (counts.dtype, counts.sum()) == (np.uint32, 2_000)
    xy = points[:, :2].copy()
    xy[xy[:, 0] == box.xmax, 0] -= spacing / 2  # rasterio leaves the rim out
    xy[xy[:, 1] == box.ymin, 1] += spacing / 2
    wanted = rasterio.features.rasterize(
        [({"type": "Point", "coordinates": one}, 1) for one in xy.tolist()],
        made.shape,
        merge_alg=MergeAlg.add,
        dtype=np.uint32,
        transform=rasterio.Affine(spacing, 0.0, box.xmin, 0.0, -spacing, box.ymax),
    )
    np.testing.assert_array_equal(counts, wanted)


def test_sides_belong_to_the_east_and_the_south_and_the_rim_to_the_cells_within():
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 3.0, 2.0), (2, 3), 1.0)
    places = {(0, 2): (0, 0), (1, 1): (1, 1), (3, 2): (0, 2), (3, 0): (1, 2), (1.5, 0): (1, 1)}
    for (x, y), cell in places.items():
        counts = ts.rasterize_counts([[x, y, 0]], grid=grid).bands["count"]
        assert tuple(np.argwhere(counts)[0].tolist()) == cell, (x, y)
    beside = [[3.01, 1, 0], [-0.01, 1, 0], [1, 2.01, 0], [1, -0.01, 0], [1, 1, 0]]
    assert ts.rasterize_counts(beside, grid=grid).bands["count"].sum() == 1


@pytest.mark.parametrize("spacing", [0.1, 0.3, 1 / 3, 0.07, 1e-3])
def test_no_point_is_lost_where_sides_are_rounded(spacing):
    steps = np.arange(500_000, 500_030) * spacing
    points = np.column_stack([steps, steps[::-1], steps])
    counts = ts.rasterize_counts(points, spacing=spacing).bands["count"]
    assert counts.sum() == 30


@pytest.mark.parametrize("seed", range(5))
def test_heights_are_those_one_computes_point_by_point(seed):
    rng = np.random.default_rng(seed)
    ground, points = make_ground(rng), make_points(rng, 600)
    made = ts.rasterize_heights(ground, points, spacing=2.0)
    box, wanted = made.grid.bounds, np.full(made.shape, np.nan)
    for (x, y, z), below in zip(points.tolist(), ground.interpolate(points[:, :2]), strict=True):
        row, column = int((box.ymax - y) // 2.0), int((x - box.xmin) // 2.0)
        wanted[row, column] = np.nanmax([wanted[row, column], z - below])
    np.testing.assert_array_equal(made.bands["height"], wanted)
    assert (str(made.crs), str(made.units["height"])) == ("EPSG:32616", "metre")
    lower = ts.height_above(ground, points)["height_above_ground"]
    assert np.nanmax(made.bands["height"]) == lower.max()


def test_order_and_parts_of_points_change_nothing():
    rng = np.random.default_rng(3)
    ground, points = make_ground(rng), make_points(rng, 500)
    points[:50, 2] = ground.interpolate(points[:50, :2])
    made = ts.rasterize_heights(ground, points, spacing=2.0).bands["height"]
    again = ts.rasterize_heights(ground, points[::-1], spacing=2.0).bands["height"]
    assert made.tobytes() == again.tobytes()


def test_zero_has_one_sign():
    flat = ts.triangulate([[0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 0]])
    for heights in ([-0.0, 0.0], [0.0, -0.0]):
        cloud = [[1, 1, heights[0]], [1.5, 1.5, heights[1]]]
        made = ts.rasterize_heights(flat, cloud, spacing=4.0).bands["height"]
        assert np.signbit(made).tolist() == [[False]]


def test_units_are_converted_and_what_lies_outside_is_told():
    ground = make_ground(np.random.default_rng(1))
    points = np.array([[5.0, 5.0, 100.0], [90.0, 5.0, 1.0]])
    cloud = ts.Survey(points=points, crs="EPSG:32616", elevation_unit="ft", notes=["Flown once."])
    made = ts.rasterize_heights(ground, cloud, spacing=10.0)
    height = 100.0 * 0.3048 - ground.interpolate([[5.0, 5.0]])[0]
    assert np.nanmax(made.bands["height"]) == pytest.approx(height, abs=1e-12)
    told = " ".join(made.notes)
    assert "The points above: Flown once." in told
    assert "converted from" in told
    assert "1 of 2 points lies outside the surface: it has no height." in told


def test_what_is_none_is_refused():
    ground, far = make_ground(np.random.default_rng(1)), [[500.0, 500.0, 1.0]]
    with pytest.raises(ts.PointsError, match="No cell has a point"):
        ts.rasterize_heights(ground, far, spacing=1.0)
    with pytest.raises(ts.PointsError, match="There are no points to count"):
        ts.rasterize_counts(np.empty((0, 3)), spacing=1.0)
    with pytest.raises(ts.PointsError):
        ts.rasterize_counts([[0, 0, np.nan]], spacing=1.0)
    with pytest.raises(ts.PointsError, match="do not meet"):
        ts.rasterize_counts(far, grid=ts.Grid(ts.Bounds(0.0, 0.0, 2.0, 2.0), (2, 2), 1.0))
    gap = [[0.5, 0.5, 0], [2.5, 2.5, 0]]
    with pytest.raises(ts.PointsError, match="No cell has a point"):
        ts.rasterize_counts(gap, grid=ts.Grid(ts.Bounds(1.0, 1.0, 2.0, 2.0), (1, 1), 1.0))
    with pytest.raises(ts.OptionError, match="one of spacing, like and grid"):
        ts.rasterize_counts(far)
    with pytest.raises(ts.OptionError, match="number of cells"):
        ts.rasterize_counts([[0, 0, 0], [1e6, 1e6, 0]], spacing=1e-3)
    like = ts.rasterize(ground, spacing=5.0)
    cloud = ts.Survey(points=far, crs="EPSG:32617")
    with pytest.raises(ts.CrsError):
        ts.rasterize_heights(ground, cloud, spacing=1.0)
    with pytest.raises(ts.CrsError, match="the other raster"):
        ts.rasterize_counts(cloud, like=like)
