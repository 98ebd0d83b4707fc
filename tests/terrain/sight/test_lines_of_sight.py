"""Lines of sight: closed forms, and every edge in fractions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.point_sets import seeds
from support.sight_oracle import find_first_block
from support.surfaces import triangulate_whole_numbers

import tinsmith as ts

RIDGE = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]


def assert_as_brute_force(tin, eye, targets, height=0.0):
    targets = targets[(targets != eye).any(axis=1)]
    found = ts.line_of_sight(tin, eye, targets, eye_height=height)
    ends = found.coordinates.reshape(-1, 2, 3)
    for row, (start, end) in enumerate(ends):
        block = find_first_block(tin.points, tin.edges, start, end)
        assert found.columns["visible"][row] == (block is None), f"{start} to {end}"
        if block is not None:  # it went in before it came to the edge
            way = found.columns["distance"][row]
            assert 0 <= found.columns["block_distance"][row] <= float(block) * way + 1e-9


@settings(max_examples=25, deadline=None)
@given(seeds, st.integers(1, 4), st.sampled_from([0.0, 0.5, 1.0]))
def test_lines_on_integer_grids_are_those_of_brute_force(seed, relief, height):
    rng = np.random.default_rng(seed)
    tin = triangulate_whole_numbers(5, relief, rng)
    targets = rng.integers(0, 9, (12, 2)) / 2
    assert_as_brute_force(tin, rng.integers(0, 5, 2).astype(float), targets, height)


def test_lines_far_from_the_origin_are_those_of_brute_force():
    rng = np.random.default_rng(5)
    points = np.column_stack([rng.uniform(0, 90, (60, 2)), rng.uniform(0, 9, 60)])
    tin = ts.triangulate(points + np.array([752_000.3, 4_024_000.7, 300.1]))
    assert_as_brute_force(tin, tin.points[3, :2], tin.points[:, :2], 2.0)


def test_what_only_touches_does_not_block():
    tin = ts.triangulate(RIDGE)
    seen = ts.line_of_sight(tin, [[2, 2]], [[6, 2]], eye_height=1, target_height=1)
    assert seen.columns["visible"].tolist() == [True]
    assert seen.columns["clearance"].tolist() == [0.0]
    lower = 1.0 - 2.0**-50
    hidden = ts.line_of_sight(tin, [[2, 2]], [[6, 2]], eye_height=lower, target_height=lower)
    assert hidden.columns["visible"].tolist() == [False]


def test_the_blocking_place_is_where_the_line_goes_into_the_ground():
    found = ts.line_of_sight(ts.triangulate(RIDGE), [1, 2], [7, 2], eye_height=1)
    # From 1.5 above x = 1 to 0.5 above x = 7; the slope rises by 1/2.
    assert found.columns["block_x"] == pytest.approx([2.5])
    assert found.columns["block_distance"] == pytest.approx([1.5])


def test_sight_is_the_same_there_and_back():
    rng = np.random.default_rng(8)
    tin = triangulate_whole_numbers(7, 3, rng)
    one, other = rng.uniform(0, 6, (40, 2)), rng.uniform(0, 6, (40, 2))
    there, back = ts.line_of_sight(tin, one, other), ts.line_of_sight(tin, other, one)
    assert there.columns["visible"].tolist() == back.columns["visible"].tolist()


@pytest.mark.parametrize(("crs", "metres"), [("EPSG:32616", 1.0), ("EPSG:2274", 1200 / 3937)])
def test_the_horizon_of_the_sea_is_where_geometry_puts_it(crs, metres):
    size = 40_000.0 / metres
    sea = [[-size, -size, 0], [size, -size, 0], [size, size, 0], [-size, size, 0]]
    tin = ts.triangulate(
        np.array(sea) + np.array([500_000, 500_000, 0]), crs=crs, elevation_unit="m"
    )
    height, coefficient = 20.0, 0.13
    radius = 6_371_000.0 / (1 - coefficient)
    horizon = np.sqrt(2 * radius * height) / metres
    eye = [500_000 + 0.1, 500_000 + 0.2]
    targets = [[eye[0] + share * horizon, eye[1]] for share in (0.99, 1.01)]
    how = {"eye_height": height, "curvature": True}
    found = ts.line_of_sight(tin, eye, targets, **how)
    assert found.columns["visible"].tolist() == [True, False]
    assert found.columns["block_distance"][1] == pytest.approx(horizon, rel=0.02)
    plain = ts.line_of_sight(tin, eye, targets, eye_height=height)
    assert plain.columns["visible"].all()
    stronger = ts.line_of_sight(tin, eye, targets, refraction=0.3, **how)
    assert stronger.columns["visible"].all()


@pytest.mark.parametrize("height", [0.0, 2.0])
def test_ground_that_bulges_hides_what_is_beyond_the_horizon_on_any_slope(height):
    places = np.array([[0.0, 0], [40_000, 0], [40_000, 40_000], [0, 40_000]])
    rise = 3.3 + places @ [0.0337, 0.0071]
    tin = ts.triangulate(np.column_stack([places, rise]), crs="EPSG:32616", elevation_unit="m")
    rng = np.random.default_rng(0)
    # More than twice the horizon of two metres: the ground between is metres above each line.
    targets = np.column_stack([rng.uniform(15_000, 39_000, 2000), rng.uniform(100, 900, 2000)])
    eye = [1000.3, 500.7]
    how = {"eye_height": height, "curvature": True}
    assert not ts.line_of_sight(tin, eye, targets, **how).columns["visible"].any()
    assert not ts.line_of_sight(tin, targets, [eye] * 2000, curvature=True).columns["visible"].any()


def test_holes_do_not_block_and_are_told():
    square = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]
    hole = [[3, 3], [6, 3], [6, 6], [3, 6]]
    points = [*square, *([x, y, 5.0] for x, y in hole)]
    tin = ts.triangulate(points, holes=[hole])
    found = ts.line_of_sight(tin, [[1, 4.5]], [[8, 4.5]], eye_height=9, target_height=9)
    assert found.columns["visible"].tolist() == [True]
    assert any("1 line of sight crosses places without surface" in note for note in found.notes)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"eye_height": -1}, ts.OptionError, "eye_height"),
        ({"target_height": float("nan")}, ts.OptionError, "target_height"),
        ({"refraction": 0.2}, ts.OptionError, "refraction"),
        ({"curvature": True}, ts.CrsError, "curvature"),
        ({"curvature": "yes"}, ts.OptionError, "curvature"),
    ],
)
def test_wrong_options_are_refused(options, error, words):
    with pytest.raises(error, match=words):
        ts.line_of_sight(ts.triangulate(RIDGE), [1, 2], [7, 2], **options)


def test_wrong_places_are_refused():
    tin = ts.triangulate(RIDGE)
    with pytest.raises(ts.PointsError, match="outside the surface"):
        ts.line_of_sight(tin, [1, 2], [99, 2])
    with pytest.raises(ts.PointsError, match="lies where its eye is"):
        ts.line_of_sight(tin, [1, 2], [1, 2])
    with pytest.raises(ts.PointsError, match="2 eyes for 3 targets"):
        ts.line_of_sight(tin, [[1, 2], [2, 2]], [[3, 2], [4, 2], [5, 2]])
    degrees = ts.triangulate(RIDGE, crs="EPSG:4326")
    with pytest.raises(ts.CrsError, match="degrees"):
        ts.line_of_sight(degrees, [1, 2], [7, 2])
