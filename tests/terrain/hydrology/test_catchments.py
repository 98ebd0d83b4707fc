"""Catchments: closed forms, and flow paths of random points inside each."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from support.hydrology_oracle import require_catchments
from support.point_sets import rolling, seeds
from support.surfaces import triangulate_whole_numbers

import tinsmith as ts

GUTTER = [[0, 0, 1], [4, 0, 0], [0, 2, 3], [4, 2, 2], [0, -2, 3], [4, -2, 2]]


def fold_two_bowls(crest=3.0):
    """Return two pyramids upside down, 6 and 4 wide, with a ridge between them."""
    rim = [[0, 0, 5], [6, 0, 5], [10, 0, 5], [10, 6, 5], [6, 6, 5], [0, 6, 5]]
    return ts.triangulate([*rim, [6, 3, crest], [3, 3, 0], [8, 3, 1]])


def waves(seed, count):
    return ts.triangulate(rolling(np.random.default_rng(seed), count))


def test_all_of_a_cone_drains_to_its_tip():
    angle = np.arange(8) * np.pi / 4 + 0.1
    rim = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle), np.full(8, 5.0)])
    tin = ts.triangulate([*rim.tolist(), [0, 0, 0]])
    found = ts.catchments(tin)
    assert found.columns["pit"].tolist() == [8]
    assert found.columns["area"] == pytest.approx([tin.area])


def test_a_ridge_parts_two_bowls():
    found = ts.catchments(fold_two_bowls())
    assert found.columns["pit"].tolist() == [7, 8]
    assert found.columns["end"].tolist() == ["pit", "pit"]
    assert found.columns["area"] == pytest.approx([36, 24], rel=1e-14)
    wanted = [shapely.box(0, 0, 6, 6), shapely.box(6, 0, 10, 6)]
    assert shapely.equals(found.to_shapely(), wanted).all()


def test_water_of_a_gutter_leaves_at_its_lower_end():
    tin = ts.triangulate(GUTTER)
    found = ts.catchments(tin)
    assert (found.columns["pit"].tolist(), found.columns["area"].tolist()) == ([-1], [16])
    # A drop at (x, y) comes to the floor at x + |y| / 4: beyond 4 it leaves at the side.
    channel = ts.flow_accumulation(tin)
    assert channel.columns["area"] == pytest.approx([15.0], rel=1e-14)
    assert channel.coordinates.tolist() == [[0, 0, 1], [4, 0, 0]]
    outlet = ts.catchments(tin, [[4, 0]])
    assert outlet.columns["vertex"].tolist() == [1]
    floor = shapely.Polygon([(0, 0), (0, 2), (3.5, 2), (4, 0), (3.5, -2), (0, -2)])
    assert outlet.to_shapely()[0].symmetric_difference(floor).area < 1e-12


def test_a_fall_line_parts_a_triangle():
    # The crest at (0, 0) lies in the fall of one plane; water passes it on either side.
    points = [[-4, 4, 8], [4, 4, 8], [0, 0, 4], [-4, -4, 0], [4, -4, 0], [0, -4, 2.0]]
    tin = ts.triangulate(points)
    found = ts.catchments(tin, [[-4, -4], [4, -4]])
    assert len(found) == 2
    west, east = sorted(found.to_shapely(), key=lambda shape: shape.bounds[0])
    assert west.bounds[2] <= 0 <= east.bounds[0]
    assert west.area == pytest.approx(east.area, rel=1e-12)


@settings(max_examples=15, deadline=None)
@given(seeds, st.integers(1, 5), st.sampled_from([4, 7]))
def test_paths_from_inside_end_at_the_pit_of_integer_grids(seed, relief, side):
    rng = np.random.default_rng(seed)
    tin = triangulate_whole_numbers(side, relief, rng)
    require_catchments(tin, rng.random((30, 2)))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_paths_from_inside_end_at_the_pit_of_scattered_points(seed):
    tin = waves(seed, 500)
    require_catchments(tin, np.random.default_rng(seed).random((150, 2)))


def test_far_away_coordinates_have_the_same_catchments():
    tin = waves(5, 400)
    points = tin.points + np.array([752_000.0, 4_024_000.0, 300.0])
    require_catchments(ts.triangulate(points), np.random.default_rng(6).random((100, 2)))


def test_pits_with_a_catchment_are_those_of_pits():
    tin = waves(7, 600)
    found = ts.catchments(tin)
    is_pit = found.columns["end"] == "pit"
    assert sorted(found.columns["pit"][is_pit]) == sorted(ts.pits(tin).columns["vertex"])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_level_pits_have_the_vertex_that_pits_lists_whatever_the_order(seed):
    rng = np.random.default_rng(seed)
    tin = triangulate_whole_numbers(12, 2, rng)
    tin = ts.triangulate(tin.points[rng.permutation(len(tin.points))])
    found = ts.catchments(tin)
    pits = found.columns["pit"][found.columns["end"] == "pit"]
    assert len(pits) > 1
    assert set(pits) <= set(ts.pits(tin).columns["vertex"])


def test_level_ground_is_told():
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    inner = (abs(x - 2) < 2) & (abs(y - 2) < 2)
    tin = ts.triangulate(np.column_stack([x, y, np.where(inner, 1.0, 2.0)]))
    found = ts.catchments(tin)
    row = found.columns["end"].tolist().index("pit")
    assert found.columns["pit"][row] == ts.pits(tin).columns["vertex"][0]
    level = ts.catchments(ts.triangulate([[0, 0, 1], [2, 0, 1], [0, 2, 1]]))
    assert level.columns["end"].tolist() == ["flat"]


def test_what_accumulates_is_what_drains_to_a_vertex():
    tin = waves(8, 400)
    found = ts.flow_accumulation(tin)
    for row in range(0, len(found), 17):
        vertex = int(found.columns["end"][row])
        upstream = ts.catchments(tin, tin.points[[vertex], :2])
        assert upstream.columns["area"] == pytest.approx([found.columns["end_area"][row]])
        assert found.columns["area"][row] <= found.columns["end_area"][row] * (1 + 1e-12)
    large = ts.flow_accumulation(tin, min_area=50.0)
    assert len(large) == (found.columns["area"] >= 50.0).sum()


def test_channels_bring_a_pit_all_of_its_catchment_or_what_falls_in_directly():
    tin = fold_two_bowls()
    found = ts.flow_accumulation(tin)
    into = found.columns["end"] == 7
    assert into.any()
    assert (found.columns["end_area"][into] <= 36.0 + 1e-12).all()


def test_outlets_that_are_none_are_refused():
    tin = fold_two_bowls()
    with pytest.raises(ts.PointsError, match="outside the surface"):
        ts.catchments(tin, [[99, 1]])
    with pytest.raises(ts.PointsError, match="same vertex"):
        ts.catchments(tin, [[3, 3], [3, 3]])
    with pytest.raises(ts.PointsError, match="comes to no vertex"):
        ts.catchments(ts.triangulate(GUTTER), [[3.9, 1.9]])
    degrees = ts.triangulate([[0, 0, 1], [4, 0, 2], [0, 4, 3]], crs="EPSG:4326")
    for ask in (ts.catchments, ts.flow_accumulation):
        with pytest.raises(ts.CrsError, match="degrees"):
            ask(degrees)
    with pytest.raises(ts.OptionError, match="min_area"):
        ts.flow_accumulation(tin, min_area=-1)
