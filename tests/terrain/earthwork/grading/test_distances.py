"""Distances around a pad: exact but for facets of cones, with vertices only where they break."""

import numpy as np
import pytest
from fuzz.uneven import examine_pad, generate_pad
from support.each_value import list_seeds

import tinsmith as ts

shapely = pytest.importorskip("shapely")
measure_distances = pytest.importorskip(
    "tinsmith.terrain.earthwork.grading.distances"
).measure_distances


def measure(ring, reach):
    return measure_distances(shapely.orient_polygons(shapely.Polygon(ring)), reach, 1e-9)


def make_sawtooth(count):
    path = np.column_stack([np.linspace(0, 3 * count, count), 5.0 * (np.arange(count) % 2)])
    return [*path, (3 * count, -20), (0, -20)]


def require_distances(ring, reach):
    case = {"ring": ring, "reach": reach, "shares": np.random.default_rng(1).random((2000, 2))}
    assert examine_pad(case) == "measured"


@pytest.mark.parametrize("seed", list_seeds(40, few=6))
def test_distances_are_those_of_geos(seed):
    assert examine_pad(generate_pad(np.random.default_rng(seed))) in ("measured", "no pad")


@pytest.mark.parametrize("reach", [1.0, 4.0, 40.0])
def test_a_sawtooth_is_measured(reach):
    require_distances(make_sawtooth(21), reach)


def test_vertices_are_in_proportion_to_the_corners():
    few, many = (len(measure(make_sawtooth(count), 8.0).points) for count in (21, 81))
    assert many < 4.2 * few
    assert many < 120 * 81  # of a tooth two slopes and a cone in facets of two degrees


def test_slopes_of_two_edges_meet_along_one_segment():
    notch = [[0.0, 0], [40, 0], [40, 40], [20, 20], [0, 40]]
    surface = measure(notch, 5.0)
    xy = surface.points[:, :2]
    between = (np.abs(xy[:, 0] - 20) < 1e-9) & (xy[:, 1] > 20)
    assert np.round(xy[between], 6).tolist() == [[20.0, round(20 + 5 * np.sqrt(2), 6)]]


NOTCHES = {
    "as wide as twice the reach": [[0, 0], [9, 0], [9, 9], [6, 9], [6, 3], [4, 3], [4, 9], [0, 9]],
    "narrower": [[0, 0], [9, 0], [9, 9], [5.5, 9], [5.5, 3], [4.5, 3], [4.5, 9], [0, 9]],
    "with a narrow mouth": [
        [0, 0], [9, 0], [9, 9], [5.2, 9], [5.2, 8], [8, 8], [8, 3], [2, 3], [2, 8], [4, 8], [4, 9],
        [0, 9],
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", NOTCHES)
@pytest.mark.parametrize("shift", [0.0, 500_000.0])
def test_notches(name, shift):
    require_distances(np.array(NOTCHES[name]) + shift, 1.0)


def test_what_is_farther_than_the_reach_in_a_pocket_is_a_hole():
    surface = measure(NOTCHES["with a narrow mouth"], 1.0)
    assert len(surface.boundary) == 3  # around, at the pad, in the pocket
    assert np.isnan(surface.interpolate([[5.0, 5.5]]))


def test_a_tip_amid_a_long_edge_is_found():
    ring = [[0, 0], [40, 0], [40, 9], [20, 1.5], [39, 12], [45, 12], [45, -9], [0, -9]]
    require_distances(ring, 1.0)
    require_distances(ring, 30.0)


def test_corners_that_are_straight_but_for_rounding():
    turned = np.deg2rad(33.0)
    matrix = np.array([[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]])
    side = np.linspace(0, 30, 11)
    ring = np.vstack(
        [
            np.column_stack([side, 0 * side]),
            [[30, 20], [16, 20], [16, 8], [14, 8], [14, 20], [0, 20]],
        ]
    )
    require_distances(ring @ matrix.T + [500_000.0, 4_000_000.0], 6.0)


def test_grading_a_sawtooth_is_within_what_is_told():
    ground = ts.triangulate([[-50, -60, 5], [150, -60, 5], [150, 60, 5], [-50, 60, 5]])
    pad = np.array(make_sawtooth(31))
    graded = ts.grade(ground, pad, 3.0, cut_slope=2, fill_slope=2)
    xy = np.random.default_rng(3).random((3000, 2)) * [120, 60] + [-10, -30]
    away = shapely.distance(shapely.Polygon(pad), shapely.points(xy))
    assert np.abs(graded.interpolate(xy) - np.minimum(5.0, 3 + away / 2)).max() < 4e-4
    assert ts.check(graded).ok
