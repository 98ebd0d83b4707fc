"""Flow paths: closed forms, and paths of hard surfaces checked in fractions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.hydrology_oracle import require_descent
from support.point_sets import seeds
from support.surfaces import triangulate_whole_numbers

import tinsmith as ts
from tinsmith.terrain.hydrology.falls import find_falls, measure_fall


def split_lines(features):
    offsets = features.offsets[0]
    return [features.coordinates[a:b] for a, b in pairwise(offsets.tolist())]


def scatter(seed, count, height, size=100.0):
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, size, (count, 2))
    return np.column_stack([xy, height(*xy.T)])


def test_an_inclined_plane_is_run_down_straight():
    tin = ts.triangulate(scatter(1, 400, lambda x, y: 3 * x + 4 * y))
    (line,) = split_lines(ts.flow_path(tin, [[70, 80]]))
    way = line[-1, :2] - line[0, :2]
    assert way[0] / way[1] == pytest.approx(3 / 4, rel=1e-9)
    turned = (line[1:, :2] - line[0, :2]) @ [4.0, -3.0]
    assert np.abs(turned).max() < 1e-9


def test_all_paths_of_a_cone_of_few_sides_end_at_its_tip():
    angle = np.arange(8) * np.pi / 4 + 0.1
    rim = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle), np.full(8, 5.0)])
    tin = ts.triangulate([*rim.tolist(), [0, 0, 0]])
    found = ts.flow_path(tin, np.random.default_rng(2).uniform(-6, 6, (50, 2)))
    for line in split_lines(found):
        assert line[-1].tolist() == [0, 0, 0]
    assert set(found.columns["end"].tolist()) == {"pit"}


def test_a_paraboloid_is_run_down_towards_its_axis():
    tin = ts.triangulate(scatter(3, 5_000, lambda x, y: (x - 50) ** 2 + (y - 50) ** 2))
    found = ts.flow_path(tin, [[75, 60], [20, 30], [50, 80]])
    for line in split_lines(found):
        start, end = line[0, :2] - 50, line[-1, :2] - 50
        assert np.hypot(*end) < 4.0  # one of the pits that triangles make near the axis
        away = np.abs(line[:, 0] - 50) * start[1] - np.abs(line[:, 1] - 50) * abs(start[0])
        assert np.hypot(*end) < 0.2 * np.hypot(*start), away


def test_water_runs_along_a_gutter():
    low, high = [[0, 0, 1], [4, 0, 0]], [[0, 2, 3], [4, 2, 2], [0, -2, 3], [4, -2, 2]]
    tin = ts.triangulate([*low, *high])
    found = ts.flow_path(tin, [[1, 1], [1, -1], [0, 0]])
    for line in split_lines(found)[:2]:
        assert line[-2:].tolist() == [[1.25, 0, 0.6875], [4, 0, 0]]
    assert found.columns["end"].tolist() == ["boundary"] * 3


def test_flat_ground_stops_a_drop_and_is_told():
    tin = ts.triangulate([[0, 0, 1], [2, 0, 1], [1, 2, 1], [1, 4, 3]])
    found = ts.flow_path(tin, [[1.0, 3.0], [1.0, 0.5]])
    assert found.columns["start"].tolist() == [0]
    assert any("Nothing descends from 1 point (first: number 1)" in note for note in found.notes)


def test_of_two_ways_as_steep_the_smaller_azimuth_is_taken():
    tin = ts.triangulate([[0, 0, 5], [4, 0, 1], [0, 4, 1], [-4, 0, 1], [0, -4, 1]])
    (line,) = split_lines(ts.flow_path(tin, [[0, 0]]))
    assert line[1].tolist() == [2, 2, 1]  # down the triangle to the north-east


@settings(max_examples=12, deadline=None)
@given(seeds, st.integers(1, 4), st.sampled_from([3, 5]))
def test_paths_of_integer_grids_descend_along_gradients_and_channels(seed, relief, side):
    rng = np.random.default_rng(seed)
    tin = triangulate_whole_numbers(side, relief, rng)
    starts = np.vstack([tin.points[:, :2], rng.integers(0, 4 * side - 3, (20, 2)) / 4])
    for line in split_lines(ts.flow_path(tin, starts)):
        require_descent(tin, line, 1e-9)


def test_paths_of_far_away_coordinates_descend():
    points = scatter(5, 3000, lambda x, y: 20 * np.sin(x / 9) * np.cos(y / 7) + 0.1 * x)
    tin = ts.triangulate(points + np.array([752_000.0, 4_024_000.0, 300.0]))
    starts = np.random.default_rng(6).uniform(5, 95, (40, 2)) + np.array([752_000, 4_024_000])
    found = ts.flow_path(tin, starts)
    for line in split_lines(found):
        require_descent(tin, line, 1e-6)
    measured = [np.hypot(*np.diff(line[:, :2], axis=0).T).sum() for line in split_lines(found)]
    assert found.columns["length"] == pytest.approx(measured)


def test_signs_of_falls_are_those_of_fractions():
    rng = np.random.default_rng(7)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(7) / 10, np.arange(7) / 10))
    z = np.where(rng.random(49) < 0.5, 0.3 * x + 0.1 * y, rng.integers(0, 3, 49) / 10)
    tin = ts.triangulate(np.column_stack([x, y, z]))
    falls = find_falls(tin)
    for triangle, corners in enumerate(tin.triangles.tolist()):
        for k in range(3):
            a, b, c = (corners[(k + turn) % 3] for turn in (1, 2, 0))
            exact = measure_fall(tin.points, a, b, c)
            assert falls.signs[triangle, k] == (exact > 0) - (exact < 0)
            assert falls.values[triangle, k] == pytest.approx(float(exact), rel=1e-9, abs=1e-300)


def test_bad_input_is_told():
    tin = ts.triangulate([[0, 0, 1], [4, 0, 2], [0, 4, 3]])
    with pytest.raises(ts.PointsError, match=r"1 of 2 points .* outside the surface .*number 1"):
        ts.flow_path(tin, [[1, 1], [9, 9]])
    with pytest.raises(ts.PointsError, match="at least one"):
        ts.flow_path(tin, np.zeros((0, 2)))
    with pytest.raises(ts.PointsError, match="there are lines"):
        ts.flow_path(tin, ts.Features.of_lines([[0, 0], [1, 1]], [0, 2]))
    degrees = ts.triangulate([[0, 0, 1], [4, 0, 2], [0, 4, 3]], crs="EPSG:4326")
    for ask in (lambda: ts.flow_path(degrees, [[1, 1]]), lambda: ts.pits(degrees)):
        with pytest.raises(ts.CrsError, match="degrees"):
            ask()
    other = ts.Features.of_points([[1, 1]], crs="EPSG:32616")
    with pytest.raises(ts.CrsError):
        ts.flow_path(ts.triangulate(tin.points, crs="EPSG:32617"), other)


@pytest.mark.parametrize("find", [ts.catchments, ts.flow_accumulation, ts.ridges_and_valleys])
def test_elevations_that_are_too_large_are_refused_with_the_first_of_them(find):
    tin = ts.triangulate([[0, 0, 0], [4, 0, 1e200], [0, 4, -1e200], [3, 3, 1]])
    with pytest.raises(ts.PointsError, match=r"2 rows outside .* row 1, elevation 1e\+200\)"):
        find(tin)
