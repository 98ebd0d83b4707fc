"""The ground filter: scenes whose ground is known, properties, units, returns, bad input."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts


def make_scene(shape, *, side=60.0, spacing=1.0, seed=3):
    """Return scattered points on a ground, `shape(x, y)` its elevations."""
    rng = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.arange(0, side, spacing)] * 2))
    x, y = x + rng.uniform(0, 0.5 * spacing, len(x)), y + rng.uniform(0, 0.5 * spacing, len(y))
    return np.column_stack([x, y, shape(x, y)]).round(3)


def lift_box(points, *, center, half, height):
    """Raise the points of a square onto a flat roof; returns which they are."""
    inside = (np.abs(points[:, :2] - center) <= half).all(axis=1)
    points[inside, 2] = points[inside, 2].max() + height
    return inside


def plant_trees(points, *, share=0.15, seed=5):
    """Raise some points by 2 to 15 m; returns which they are."""
    rng = np.random.default_rng(seed)
    rows = rng.uniform(size=len(points)) < share
    points[rows, 2] += rng.uniform(2, 15, int(rows.sum()))
    return rows


def measure_errors(is_ground, truth):
    """Return the shares of ground that was missed, and of others taken as ground."""
    return (truth & ~is_ground).sum() / truth.sum(), (~truth & is_ground).sum() / (~truth).sum()


def plane(x, y):
    return 100 + 0.05 * x - 0.02 * y


def hill(x, y):
    return 100 + 12 * np.exp(-((x - 30) ** 2 + (y - 30) ** 2) / 300)


# ------------------------------------------------------------------ scenes with a known ground


@pytest.mark.parametrize("tilt", [0.0, 0.1, 0.3, 0.5])
def test_all_of_a_plane_is_ground(tilt):
    points = make_scene(lambda x, y: tilt * x - 0.5 * tilt * y)
    found = ts.ground(points)
    assert found.is_ground.all()
    assert np.abs(found.heights).max() < 1e-2  # of coordinates in millimetres, at the border too


def test_of_a_steep_plane_only_the_lowest_corner_is_taken_for_noise():
    found = ts.ground(make_scene(lambda x, y: x - 0.5 * y))
    others = found.given.points[~found.is_ground]
    assert len(others) < 10
    assert others[:, 0].max(initial=0) < 6
    assert others[:, 1].min(initial=60) > 54


def test_all_of_a_hill_is_ground():
    assert ts.ground(make_scene(hill)).is_ground.all()


def test_a_house_on_a_plane_goes_and_nothing_else():
    points = make_scene(plane)
    roof = lift_box(points, center=(30, 30), half=8, height=6)
    assert (ts.ground(points).is_ground == ~roof).all()


def test_a_house_that_the_border_cuts_goes_too():
    points = make_scene(plane)
    roof = lift_box(points, center=(0, 30), half=8, height=6)
    assert (ts.ground(points).is_ground == ~roof).all()


@pytest.mark.parametrize("degrees", [10, 30, 45, 80])
def test_a_house_that_an_oblique_border_cuts_goes_too(degrees):
    points = make_scene(plane)
    roof = lift_box(points, center=(0, 30), half=8, height=6)
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    points[:, :2] = points[:, :2] @ np.array([[cosine, sine], [-sine, cosine]])
    missed, wrong = measure_errors(ts.ground(points).is_ground, ~roof)
    assert missed == 0
    assert wrong == 0


def test_a_terrace_that_joins_the_slope_is_ground_and_a_roof_of_its_height_is_not():
    points = make_scene(lambda x, y: 0.1 * y, side=80)
    x, y = points[:, 0], points[:, 1]
    terrace = (x > 10) & (x < 25) & (y > 30) & (y < 60)  # it joins the slope in the north
    points[terrace, 2] = 6.0
    roof = (x > 50) & (x < 65) & (y > 30) & (y < 55)
    points[roof, 2] = 9.0
    found = ts.ground(points).is_ground
    assert found[terrace].mean() > 0.95
    assert not found[roof].any()
    assert found[~roof & ~terrace].all()


def test_the_ridge_of_steep_ground_is_ground():
    points = make_scene(lambda x, y: 30 - 0.4 * np.abs(x - 40) + 0.02 * y, side=80)
    trees = plant_trees(points)
    missed, wrong = measure_errors(ts.ground(points).is_ground, ~trees)
    assert missed < 0.005
    assert wrong == 0


def test_houses_and_trees_on_a_hill():
    points = make_scene(hill)
    others = lift_box(points, center=(12, 45), half=5, height=5)
    others |= lift_box(points, center=(48, 12), half=5, height=4)
    others |= plant_trees(points)
    missed, wrong = measure_errors(ts.ground(points).is_ground, ~others)
    assert missed < 0.02
    assert wrong < 0.02


def test_terraces_lower_than_the_iteration_distance_are_ground():
    points = make_scene(lambda x, y: 1.0 * np.floor(x / 15) + 0 * y)
    assert ts.ground(points).is_ground.mean() > 0.95


def test_a_house_wider_than_told_is_not_removed():
    points = make_scene(plane, side=100)
    roof = lift_box(points, center=(50, 50), half=20, height=6)
    assert ts.ground(points, building=20).is_ground[roof].mean() > 0.9
    assert not ts.ground(points, building=45).is_ground[roof].any()


def test_low_noise_is_told_apart_and_does_no_harm():
    points = make_scene(hill)
    rng = np.random.default_rng(8)
    low = np.column_stack([rng.uniform(5, 55, (6, 2)), rng.uniform(20, 90, 6)])
    found = ts.ground(np.concatenate([points, low]))
    assert (found.classification[-6:] == 7).all()
    assert found.is_ground[:-6].all()
    assert found.counts == {"ground": len(points), "others": 0, "low noise": 6}


@pytest.mark.each_value
@pytest.mark.parametrize("apart", [1.0, 2.0, 5.0, 7.0, 9.0, 14.0])
@pytest.mark.parametrize("direction", [(1.0, 0.0), (0.0, 1.0), (0.7, 0.7)])
def test_two_low_points_of_one_depth_do_not_hide_each_other(direction, apart):
    points = make_scene(hill)
    first = np.array([20.3, 24.6])
    pair = np.array([first, first + apart * np.array(direction)])
    low = np.column_stack([pair, hill(*pair.T) - 9.0])
    found = ts.ground(np.concatenate([points, low]))
    assert found.counts == {"ground": len(points), "others": 0, "low noise": 2}


def test_a_group_of_low_points_is_noise():
    points = make_scene(plane)
    low = np.array([[30.1, 30.1, 60], [30.7, 30.2, 61], [31.1, 30.9, 60.5]])
    found = ts.ground(np.concatenate([points, low]))
    assert (found.classification[-3:] == 7).all()
    assert found.is_ground[:-3].all()


# ------------------------------------------------------------------------------- properties


@pytest.fixture(scope="module")
def mixed():
    points = make_scene(hill, spacing=1.5)
    lift_box(points, center=(12, 45), half=5, height=5)
    plant_trees(points)
    doubled = np.concatenate([points, points[:50], points[100:150] + np.array([0, 0, 0.25])])
    return np.concatenate([doubled, [[20.0, 20.0, 50.0]]])


def test_the_order_of_points_does_not_matter(mixed):
    order = np.random.default_rng(1).permutation(len(mixed))
    one, other = ts.ground(mixed), ts.ground(mixed[order])
    assert (one.classification[order] == other.classification).all()
    assert (one.heights[order] == other.heights).all()


def test_moved_points_have_the_same_classes(mixed):
    grid = np.round(mixed * 1024) / 1024  # coordinates that a move does not round
    moved = ts.ground(grid + np.array([2.0**19, 2.0**22, 2.0**10]))
    assert (ts.ground(grid).classification == moved.classification).all()


def test_scaled_points_with_scaled_lengths_have_the_same_classes(mixed):
    lengths = {
        "building": 40.0,
        "cell": 1.0,
        "iteration_distance": 1.4,
        "edge_length": 5.0,
        "tolerance": 0.3,
        "horizontal_tolerance": 1.0,
        "noise_depth": 1.0,
    }
    scaled = ts.ground(mixed * 4, **{name: 4 * value for name, value in lengths.items()})
    # ... but for points at the border, which are put every 5 m whatever the scale.
    inner = ((mixed[:, :2] > 3) & (mixed[:, :2] < 57)).all(axis=1)
    assert (ts.ground(mixed).classification == scaled.classification)[inner].all()


def test_heights_are_those_above_a_tin_where_the_ground_is_even():
    points = make_scene(plane)
    roof = lift_box(points, center=(30, 30), half=8, height=6)
    found = ts.ground(points)
    expected = points[:, 2] - plane(points[:, 0], points[:, 1])
    assert np.abs(found.heights - expected)[roof].max() < 0.05
    above = ts.height_above(found.tin, points[roof])["height_above_ground"]
    assert np.abs(above - found.heights[roof]).max() < 0.05


def test_every_vertex_of_the_tin_is_ground(mixed):
    found = ts.ground(mixed)
    assert len(found.survey) == found.counts["ground"]
    assert ts.check(found.tin).ok
    assert (found.survey.points == mixed[found.is_ground]).all()


# ------------------------------------------------------------------------------------ units


@pytest.mark.parametrize(
    ("crs", "metres"), [("EPSG:32616", 1.0), ("EPSG:2274", 1200 / 3937), ("EPSG:2222", 0.3048)]
)
def test_lengths_are_converted_to_the_unit_of_the_crs(mixed, crs, metres):
    given = ts.Survey(points=mixed / metres, crs=crs, elevation_unit=_unit_of(crs))
    found = ts.ground(given)
    in_metres = ts.ground(mixed)
    same = found.classification == in_metres.classification
    assert same.mean() > 0.999  # coordinates are rounded when they are divided
    assert found.heights * metres == pytest.approx(in_metres.heights, abs=0.05)
    assert bool(found.notes) == (metres != 1.0)


def _unit_of(crs):
    return {"EPSG:32616": "m", "EPSG:2274": "US survey foot", "EPSG:2222": "foot"}[crs]


def test_elevations_have_a_unit_of_their_own(mixed):
    in_feet = mixed * [1, 1, 1 / 0.3048]
    found = ts.ground(ts.Survey(points=in_feet, crs="EPSG:32616", elevation_unit="foot"))
    assert (found.classification == ts.ground(mixed).classification).mean() > 0.999


def test_an_unknown_crs_is_told(mixed):
    assert "taken to be in metres" in ts.ground(mixed).notes[0]


def test_degrees_are_refused():
    points = [[10.0, 50.0, 1.0], [10.1, 50.0, 1.0], [10.0, 50.1, 1.0]]
    with pytest.raises(ts.CrsError, match="measures in degrees"):
        ts.ground(ts.Survey(points=points, crs="EPSG:4326"))


# ------------------------------------------------------------------- attributes of the points


def with_attributes(points, **attributes):
    return ts.Survey(points=points, crs="EPSG:32616", elevation_unit="m", attributes=attributes)


def test_only_last_returns_are_ground():
    points = make_scene(plane)
    number = np.ones(len(points), np.uint8)
    of = np.where(np.arange(len(points)) % 7 == 0, 2, 1).astype(np.uint8)
    survey = with_attributes(points, return_number=number, number_of_returns=of)
    found = ts.ground(survey)
    assert (found.is_ground == (of == 1)).all()
    assert "were no last return" in found.notes[0]
    assert ts.ground(survey, returns="all").is_ground.all()


def test_senseless_numbers_of_returns_tell_nothing():
    points = make_scene(plane)
    zeros = np.zeros(len(points), np.uint8)
    found = ts.ground(with_attributes(points, return_number=zeros, number_of_returns=zeros))
    assert found.is_ground.all()
    assert "does not fit" in found.notes[0]


def test_given_noise_keeps_its_class_and_is_no_ground():
    points = make_scene(plane)
    classes = np.ones(len(points), np.uint8)
    classes[100], classes[200] = 18, 7
    found = ts.ground(with_attributes(points, classification=classes, intensity=classes * 3))
    assert found.classification[[100, 200]].tolist() == [18, 7]
    assert np.count_nonzero(found.is_ground) == len(points) - 2
    assert (found.classified.attributes["intensity"] == classes * 3).all()
    assert set(found.survey.attributes["classification"]) == {2}


# -------------------------------------------------------------------------- small and bad input


@pytest.mark.parametrize(
    "points",
    [
        [[5.0, 5.0, 1.0]],
        [[5.0, 5.0, 1.0], [5.0, 5.0, 1.0]],
        [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [2.0, 0.0, 1.0]],
        [[0.0, 0.0, 1.0], [30.0, 0.0, 1.0], [0.0, 30.0, 1.0]],
        [[i, j, 7.0] for i in range(4) for j in range(4)],
    ],
)
def test_few_points_are_ground(points):
    assert ts.ground(points).is_ground.all()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("building", 0.0),
        ("building", float("nan")),
        ("cell", -1.0),
        ("cell", "1"),
        ("cell", 50.0),
        ("terrain_slope", 0.0),
        ("iteration_angle", 90.0),
        ("iteration_angle", 0.0),
        ("iteration_distance", float("inf")),
        ("edge_length", 0.0),
        ("tolerance", -0.1),
        ("horizontal_tolerance", True),
        ("noise_depth", 0.0),
        ("returns", "first"),
    ],
)
def test_parameters_out_of_range_are_refused(name, value):
    with pytest.raises(ts.OptionError, match=name):
        ts.ground(make_scene(plane, side=5), **{name: value})


def test_no_points_are_refused():
    with pytest.raises(ts.PointsError, match="no points"):
        ts.ground(np.empty((0, 3)))


def test_noise_alone_is_refused():
    points = make_scene(plane, side=5)
    with pytest.raises(ts.PointsError, match="may be ground"):
        ts.ground(with_attributes(points, classification=np.full(len(points), 7)))


def test_a_point_far_away_is_refused_before_memory_is_asked_for():
    points = np.concatenate([make_scene(plane, side=20), [[1e7, 1e7, 0]]])
    with pytest.raises(ts.PointsError, match="larger cells"):
        ts.ground(points)


def test_points_that_are_not_finite_are_refused():
    with pytest.raises(ts.PointsError):
        ts.ground([[0, 0, np.nan], [1, 0, 0], [0, 1, 0]])
