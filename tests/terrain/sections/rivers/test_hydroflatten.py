"""Flowing water: closed forms, levels that fall, banks, islands, and what is refused."""

import numpy as np
import pytest
import shapely
from fuzz.rivers import examine_water, generate_water
from scipy.optimize import isotonic_regression
from support.refusals import refuse

import tinsmith as ts
from tinsmith.terrain.sections.rivers.levels import fall_by_squares

AXIS = [[0.0, 20.0], [90.0, 20.0]]
STREAM = [[0, 15], [90, 15], [90, 25], [0, 25]]
BEND = [[5.0, 20.0], [50.0, 20.0], [50.0, 70.0]]


def make_valley(fall=1 / 30, rough=0.0, size=(90, 40), **options):
    """Return a valley whose banks rise by 0.1 from its line, and fall to the east."""
    x, y = (
        one.ravel()
        for one in np.meshgrid(np.linspace(0, size[0], 46), np.arange(0, size[1] + 1, 5))
    )
    z = 12 - fall * x + 0.1 * np.abs(y - 20) + rough * np.random.default_rng(1).normal(size=len(x))
    return ts.triangulate(np.column_stack([x, y, z]), **options)


def make_noise():
    rng = np.random.default_rng(3)
    values, weights = rng.normal(0, 1, 200).cumsum() - 0.1 * np.arange(200), rng.uniform(0, 2, 200)
    return values, np.where(rng.random(200) < 0.1, 0.0, weights)


# ---------------------------------------------------------------- levels


def test_isotonic_fit_is_that_of_scipy():
    values, weights = make_noise()
    found = fall_by_squares(values, weights)
    has = weights > 0
    wanted = isotonic_regression(values[has], weights=weights[has], increasing=False).x
    assert np.abs(found[has] - wanted).max() < 1e-12
    assert (np.diff(found) <= 0).all()


def test_fit_of_one_value_and_of_falling_ones_is_themselves():
    assert fall_by_squares(np.array([3.0]), np.ones(1)).tolist() == [3.0]
    assert fall_by_squares(np.array([3.0, 2, 2, 1]), np.ones(4)).tolist() == [3, 2, 2, 1]
    assert fall_by_squares(np.array([9.0, 2, 4]), np.array([0.0, 1, 1])).tolist() == [3, 3, 3]


# ---------------------------------------------------------------- closed forms


def test_water_in_an_even_valley_is_the_plane_through_the_lower_ends_of_its_steps():
    made = ts.hydroflatten(make_valley(), STREAM, AXIS, spacing=2)
    x, y = np.random.default_rng(1).uniform([0.1, 15], [85, 25], (300, 2)).T
    low = made.interpolate(np.column_stack([x, y]))
    bank = 12.5 - x / 30
    assert (low <= bank + 1e-9).all()
    assert (low >= bank - 2 / 30 - 1e-9).all()  # by one step along the centreline
    same = made.interpolate(np.column_stack([x, 40 - y]))
    assert np.abs(low - same).max() < 1e-9


def test_isotonic_water_in_an_even_valley_is_its_banks():
    made = ts.hydroflatten(make_valley(), STREAM, AXIS, spacing=2, fit="isotonic")
    x, y = np.random.default_rng(1).uniform([4, 15], [86, 25], (300, 2)).T
    assert np.abs(made.interpolate(np.column_stack([x, y])) - (12.5 - x / 30)).max() < 0.02


def test_level_never_rises_along_the_centreline_nor_stands_above_the_ground():
    ground = make_valley(rough=0.2)
    made = ts.hydroflatten(ground, STREAM, AXIS, spacing=3)
    along = ts.profile(made, AXIS)["elevation"]
    assert (np.diff(along) <= 1e-12).all()
    shore = ts.profile({"ground": ground, "made": made}, [STREAM[:2], STREAM[2:]])
    above = shore["difference_made"]
    assert above.max() <= 1e-9


def test_water_is_level_square_to_each_part_of_a_bent_centreline():
    ground = make_valley(size=(90, 90))
    water = shapely.LineString(BEND).buffer(5, cap_style="flat", join_style="mitre")
    made = ts.hydroflatten(ground, water, BEND, spacing=4, downstream="along")
    for offset in (-4.9, -2.0, 3.0, 4.9):
        x = np.linspace(6, 44, 50)
        here = made.interpolate(np.column_stack([x, np.full(50, 20 + offset)]))
        assert np.abs(here - made.interpolate(np.column_stack([x, np.full(50, 20.0)]))).max() < 1e-9
    assert any("of the centreline is level" in one for one in made.report.notes)
    assert ts.check(made).ok


# ---------------------------------------------------------------- the ground


def test_ground_beyond_the_water_and_islands_stay_bit_for_bit():
    ground = make_valley(rough=0.3, crs="EPSG:32616", elevation_unit="m")
    island = shapely.Point(40, 20).buffer(3)
    water = shapely.Polygon(STREAM) - island
    made = ts.hydroflatten(ground, water, AXIS, spacing=4)
    xy = ground.points[:, :2]
    dry = ~shapely.intersects_xy(water, *xy.T)
    vertices = {tuple(one) for one in made.points.tolist()}
    assert all(tuple(one) in vertices for one in ground.points[dry].tolist())
    assert shapely.contains_xy(island, *made.points[:, :2].T).any()
    far = np.random.default_rng(1).uniform([0, 31], [90, 40], (100, 2))
    assert (made.interpolate(far) == ground.interpolate(far)).all()
    notes = " ".join(made.report.notes)
    lost = int(shapely.contains_xy(water, *xy.T).sum())
    assert f"{lost} vertices in the water were left out" in notes
    assert "asks for streams from 30 m (100 ft) on" in notes
    assert "1 island smaller than an acre" in notes
    assert {"shore", "across", "centreline"} <= set(made.lines.names)


def test_widths_are_told_in_metres_whatever_the_unit():
    ground = make_valley(crs="EPSG:2274", elevation_unit="US survey foot")
    notes = " ".join(ts.hydroflatten(ground, STREAM, AXIS, spacing=9).report.notes)
    assert "The water is 3.05 m wide on average" in notes
    assert "The banks" not in notes
    assert "the banks fall by" in notes
    assert "US ft that way" in notes


def test_water_beyond_the_surface_is_left_out_and_told():
    water = [[-30, 15], [120, 15], [120, 25], [-30, 25]]
    made = ts.hydroflatten(make_valley(), water, AXIS, spacing=5)
    assert made.area == pytest.approx(3600.0)
    assert "40 % of the water lies beyond the surface" in " ".join(made.report.notes)


def test_parts_that_a_bridge_divides_fall_together():
    parts = [shapely.box(0, 15, 40, 25), shapely.box(50, 15, 90, 25)]
    made = ts.hydroflatten(make_valley(rough=0.1), parts, AXIS, spacing=5)
    upper, lower = made.interpolate([[39, 20], [51, 20]])
    assert upper >= lower
    bridge = made.interpolate([[45, 20]])[0]
    assert bridge == pytest.approx(make_valley(rough=0.1).interpolate([[45, 20]])[0])
    refuse("2 parts", ts.hydroflatten, make_valley(), parts, spacing=5, error=ts.OptionError)


# ---------------------------------------------------------------- direction


def test_direction_is_that_in_which_banks_fall_and_is_told():
    ground = make_valley(rough=0.05)
    along, back = (ts.hydroflatten(ground, STREAM, line, spacing=5) for line in (AXIS, AXIS[::-1]))
    assert "The water flows along the centreline: the banks fall by" in " ".join(along.report.notes)
    assert "against the centreline as it is drawn" in " ".join(back.report.notes)
    places = [[10, 20], [50, 20], [85, 20]]
    assert np.abs(along.interpolate(places) - back.interpolate(places)).max() < 0.2


def test_direction_that_banks_do_not_tell_is_refused_unless_it_is_given():
    for ground in (make_valley(0.0), make_valley(0.0, rough=0.1)):
        words = "do not tell which way"
        refuse(words, ts.hydroflatten, ground, STREAM, AXIS, spacing=5, error=ts.OptionError)
    for way, sign in (("along", -1), ("against", 1)):
        made = ts.hydroflatten(ground, STREAM, AXIS, spacing=5, downstream=way)
        heights = made.interpolate([[5, 20], [50, 20], [85, 20]])
        assert (sign * np.diff(heights) >= 0).all()
        assert "as it was given" in " ".join(made.report.notes)


def test_centreline_is_drawn_in_the_middle_where_none_is_given():
    made = ts.hydroflatten(make_valley(), STREAM, spacing=4)
    lines = dict(zip(made.lines.names, made.lines.chains(), strict=True))
    assert np.abs(made.points[lines["centreline"], 1] - 20).max() < 1.0
    assert "medial axis of the water" in " ".join(made.report.notes)
    pond = [[30, 15], [45, 15], [45, 28], [30, 28]]
    words = "not much longer than wide"
    refuse(words, ts.hydroflatten, make_valley(), pond, spacing=4, error=ts.OptionError)


# ---------------------------------------------------------------- what is refused


def test_bad_water_lines_and_options_are_refused():
    ground = make_valley(crs="EPSG:32616")
    bow = [[0, 15], [90, 25], [90, 15], [0, 25]]
    away = [[x + 500, y] for x, y in STREAM]
    loop = [[0, 20], [50, 20], [50, 24], [20, 16]]
    flatten = ts.hydroflatten
    refuse("Invalid water", flatten, ground, bow, AXIS, spacing=5, error=ts.LinesError)
    refuse("off the surface", flatten, ground, away, AXIS, spacing=5, error=ts.PointsError)
    refuse("crosses itself at 35", flatten, ground, STREAM, loop, spacing=5, error=ts.LinesError)
    refuse("2 centrelines", flatten, ground, STREAM, [AXIS, loop], spacing=5, error=ts.LinesError)
    for options in ({"spacing": 0}, {"spacing": 1e-9}, {"spacing": 5, "fit": "mean"}):
        refuse("", flatten, ground, STREAM, AXIS, **options, error=ts.OptionError)
    refuse(
        "downstream",
        flatten,
        ground,
        STREAM,
        AXIS,
        spacing=5,
        downstream="up",
        error=ts.OptionError,
    )
    line = ts.Features.of_lines(AXIS, [0, 2], crs="EPSG:32617")
    refuse("must be the same", flatten, ground, STREAM, line, spacing=5, error=ts.CrsError)
    degrees = ts.triangulate([[0, 0, 1], [1, 0, 1], [1, 1, 0]], crs="EPSG:4326")
    refuse("degrees", flatten, degrees, STREAM, AXIS, spacing=5, error=ts.CrsError)


def test_progress_ascends_to_one():
    seen = []
    ts.hydroflatten(make_valley(), STREAM, AXIS, spacing=9, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


@pytest.mark.parametrize("seed", range(12))
def test_random_water_is_level_falls_and_leaves_the_ground(seed):
    examine_water(generate_water(np.random.default_rng(seed)))
