"""Alignments: stations and offsets, places beside them, station equations, chords, features."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

import tinsmith as ts

CORNERS = [[0, 0], [300, 20], [400, 300], [800, 250], [820, 600]]


@pytest.fixture(scope="module")
def road():
    return ts.Alignment.from_points(CORNERS, radii=[90, 60, 40], transitions=[40, 30, 20])


def test_elements_follow_each_other_without_a_bend(road):
    kinds = [one.kind for one in road.elements]
    assert kinds == ["line", *["clothoid", "arc", "clothoid", "line"] * 3]
    for before, after in zip(road.elements, road.elements[1:], strict=False):
        assert math.dist(before.end, after.start) < 1e-11
        assert math.cos(before.end_direction - after.direction) > 1 - 1e-12
    assert road.elements[0].start == (0.0, 0.0)
    assert road.elements[-1].end == pytest.approx((820, 600), abs=1e-10)


def test_arcs_touch_both_tangents_where_closed_forms_say():
    road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=40)
    assert road.length == pytest.approx(60 + 20 * math.pi + 60, abs=1e-12)
    np.testing.assert_allclose(road.points_at([60 + 10 * math.pi])[0], _on_arc(), atol=1e-12)
    np.testing.assert_allclose(road.tangents_at([60 + 20 * math.pi])[0], [0, 1], atol=1e-12)


def _on_arc():
    return [60 + 40 * math.sin(math.pi / 4), 40 - 40 * math.cos(math.pi / 4)]


def test_elevations_of_points_are_left_aside(road):
    flat = road.stations_of([[30, 5], [90, 8]])["station"].tolist()
    for given in ([[30, 5, 1], [90, 8, 2]], np.array([[30, 5, 1], [90, 8, 2]])):
        assert road.stations_of(given)["station"].tolist() == flat


def test_stations_and_offsets_lead_back_to_the_points(road):
    rng = np.random.default_rng(5)
    given = rng.uniform(-100, 900, (1000, 2))
    table = road.stations_of(given)
    known = np.isfinite(table["station"])
    back = road.points_at(table["station"][known], offset=table["offset"][known])
    np.testing.assert_allclose(back, given[known], atol=1e-9)
    steps = np.linspace(road.start, road.end, 10_001)
    distance, nearest = cKDTree(road.points_at(steps)).query(given)
    step = steps[1] - steps[0]
    assert (np.abs(table["offset"][known]) <= distance[known] + 1e-9).all()
    # Outside of an arc of radius r the square grows by (1 + d / r) of that of the step.
    slack = step**2 * (1 + distance[known] / 40)
    assert (distance[known] ** 2 - table["offset"][known] ** 2 <= slack).all()
    # Those without a station are nearest to an end, and not square to it.
    assert set(nearest[~known]) <= {0, len(steps) - 1}
    assert any("before the start or beyond the end" in note for note in table.notes)


def test_offsets_are_negative_to_the_left_whatever_the_axes():
    east = ts.Alignment.from_points([[0, 0], [10, 0]])
    assert east.stations_of([[4, 1], [4, -1]])["offset"].tolist() == [-1.0, 1.0]
    assert east.points_at([4], offset=2)[0].tolist() == [4.0, -2.0]
    # Lo19: westing and southing, turned by half a turn, so left stays left.
    south = replace(east, crs="EPSG:2048")
    assert south.stations_of([[4, 1]])["offset"].tolist() == [-1.0]


@pytest.mark.parametrize("turn", [-1.0, 1.0])
def test_the_side_of_a_break_is_that_of_the_mean_tangent(turn):
    road = ts.Alignment.from_points([[0, 0], [10, 0], [10, 10 * turn]])
    table = road.stations_of([[11, -turn], [12, -0.5 * turn], [10.5, -2 * turn]])
    np.testing.assert_allclose(table["station"], 10.0)
    assert (np.sign(table["offset"]) == turn).all()


def test_the_centre_of_an_arc_is_as_near_to_all_of_it_and_this_is_told():
    road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=40)
    table = road.stations_of([[60, 40]])
    assert abs(table["offset"][0]) == pytest.approx(40)
    assert any("as near to another place" in note for note in table.notes)


def test_station_equations_change_what_is_written():
    jumps = [ts.StationEquation(150.0, 400.0), ts.StationEquation(180.0, 20.0, False)]
    road = ts.Alignment.from_points([[0, 0], [200, 0]], start=100.0, equations=jumps)
    assert road.written_stations([120, 150, 170, 180, 190]).tolist() == [120, 400, 420, 20, 10]
    assert road.find_stations([420.0]).tolist() == [170.0]
    assert road.find_stations([10.0]).tolist() == [190.0]
    assert "written_station" in road.stations_of([[30, 1]]).columns
    with pytest.raises(ts.OptionError, match="on the alignment"):
        road.find_stations([5000.0])


def test_a_station_that_is_written_twice_needs_its_zone():
    road = ts.Alignment.from_points([[0, 0], [200, 0]], equations=[ts.StationEquation(100, 50)])
    with pytest.raises(ts.OptionError, match="zone"):
        road.find_stations([70.0])
    assert road.find_stations([70.0], zone=1).tolist() == [70.0]
    assert road.find_stations([70.0], zone=2).tolist() == [120.0]


@pytest.mark.parametrize("tolerance", [1.0, 1e-2, 1e-4])
def test_chords_lie_within_the_tolerance(road, tolerance):
    line = road.to_features(tolerance).coordinates
    stations = road.cut_into_chords(tolerance)
    np.testing.assert_array_equal(line, road.points_at(stations))
    chords = np.diff(line, axis=0)
    worst = 0.0
    for share in (0.25, 0.5, 0.75):
        between = road.points_at(stations[:-1] + share * np.diff(stations)) - line[:-1]
        across = chords[:, 0] * between[:, 1] - chords[:, 1] * between[:, 0]
        worst = max(worst, float((np.abs(across) / np.hypot(*chords.T)).max()))
    assert tolerance / 20 <= worst <= tolerance


def test_features_have_the_elevations_of_a_vertical_alignment(road):
    points = [ts.VerticalPoint(0, 10), ts.VerticalPoint(600, 40, "arc", radius=4000)]
    points.append(ts.VerticalPoint(road.end, 5.0))
    rise = ts.VerticalAlignment(points, "design")
    line = replace(road, verticals=[rise]).to_features(0.01, vertical="design")
    assert line.has_elevations
    stations = road.stations_of(line.coordinates)["station"]
    np.testing.assert_allclose(line.coordinates[:, 2], rise.elevations_at(stations), atol=1e-7)
    short = ts.VerticalAlignment([ts.VerticalPoint(0, 1), ts.VerticalPoint(9, 1)])
    with pytest.raises(ts.OptionError, match="it goes from"):
        replace(road, verticals=[short]).to_features(0.01, vertical="")


def test_points_along_it_are_at_multiples_and_where_elements_meet():
    road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=40, start=7.0)
    at = road.tabulate_points(20.0)["station"]
    assert set(range(20, 181, 20)) <= set(at.tolist())
    np.testing.assert_allclose(at[[0, -1]], [7.0, road.end])
    assert np.isclose(at, 67.0).any()


def test_pickles_and_copies_are_the_same(road):
    road.stations_of([[1, 2]])
    other = pickle.loads(pickle.dumps(road))
    np.testing.assert_array_equal(other.points_at([500.0]), road.points_at([500.0]))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: ts.Alignment([]), "at least one is needed"),
        (lambda: ts.Alignment.from_points([[0, 0], [0, 0]]), "are the same"),
        (lambda: ts.Alignment.from_points([[0, 0], [9, 0], [9, 9]], radii=40), "no room"),
        (lambda: ts.Alignment.from_points([[0, 0], [9, 0], [9, 9]], radii=-1), "0 or more"),
        (lambda: ts.Alignment.from_points([[0, 0], [9, 0], [9, 9]], transitions=1), "radius is 0"),
        (lambda: ts.Alignment.from_points([[0, 0], [9, 0], [0, 0]], radii=1), "turns back"),
        (lambda: ts.Alignment.from_points(CORNERS, radii=[1, 2]), "number of radii"),
        (lambda: ts.Alignment.from_points(CORNERS, radii=50, transitions=900), "at most"),
        (
            lambda: ts.Alignment(
                [ts.Element("line", (0, 0), 0, 5), ts.Element("line", (9, 0), 0, 5)]
            ),
            "must follow each other",
        ),
        (lambda: ts.Alignment.from_points(CORNERS, crs="EPSG:4326"), "angles"),
        (
            lambda: ts.Alignment.from_points(CORNERS, equations=[ts.StationEquation(-5, 0)]),
            "on the alignment",
        ),
        (lambda: ts.Alignment.from_points(CORNERS).points_at([1e9]), "on the alignment"),
        (lambda: ts.Alignment.from_points(CORNERS).points_at(["a"]), "finite numbers"),
        (lambda: ts.Alignment.from_points(CORNERS).stations_of([[np.nan, 1]]), "not finite"),
        (lambda: ts.Alignment.from_points(CORNERS).stations_of([]), "no point"),
        (lambda: ts.Alignment.from_points(CORNERS).stations_of("a"), "numbers"),
        (lambda: ts.Alignment.from_points([[0, 0], [np.nan, 1]]), "not finite"),
        (lambda: ts.Alignment.from_points(CORNERS).to_features(0.0), "tolerance"),
        (lambda: ts.Alignment.from_points(CORNERS).find_vertical(), "there is none"),
        (lambda: ts.Alignment.from_points(CORNERS).tabulate_points(1e-9), "at most"),
    ],
)
def test_what_is_no_alignment_is_refused(make, words):
    with pytest.raises(ts.TinsmithError, match=words):
        make()
