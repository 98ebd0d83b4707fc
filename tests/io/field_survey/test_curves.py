"""Curves among field codes: their vertices lie on the circle, and chords within the tolerance."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io import lines_from_codes

ORIGIN = np.array([752_640.0, 4_024_180.0])


def beside(east, north):
    return ORIGIN + np.array([east, north])


def site(places, descriptions, *, z=None, crs=None):
    points = np.column_stack([np.asarray(places, float), np.linspace(5, 6, len(places))])
    if z is not None:
        points[:, 2] = z
    attributes = {"description": np.array(descriptions, object)}
    return ts.Survey(points=points, attributes=attributes, crs=crs)


def on_circle(angles, radius=20.0, centre=ORIGIN):
    angles = np.radians(angles)
    return centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])


def bend(places, descriptions, **options):
    (line,) = lines_from_codes(site(places, descriptions), **options).breaklines
    return line.coords


def circle_of(a, b, c):
    """Return the centre by exact arithmetic, with nothing of tinsmith."""
    (ax, ay), (bx, by), (cx, cy) = [[Fraction(v) for v in p] for p in (a, b, c)]
    d = 2 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by))
    sq = [x * x + y * y for x, y in ((ax, ay), (bx, by), (cx, cy))]
    ux = (sq[0] * (by - cy) + sq[1] * (cy - ay) + sq[2] * (ay - by)) / d
    uy = (sq[0] * (cx - bx) + sq[1] * (ax - cx) + sq[2] * (bx - ax)) / d
    return np.array([float(ux), float(uy)])


def deviations(vertices, centre, radius):
    """Return how far vertices and the middles of chords are from a circle."""
    middles = (vertices[1:] + vertices[:-1]) / 2
    return [np.abs(np.hypot(*(p - centre).T) - radius).max() for p in (vertices, middles)]


@pytest.mark.parametrize("tolerance", [0.5, 0.01, 1e-4])
@pytest.mark.parametrize("angles", [(0, 40, 90), (0, 130, 250), (90, 80, -200), (0, 5, 300)])
def test_three_shots_make_their_circle(angles, tolerance):
    shots = on_circle(angles)
    line = bend(shots, ["EP1 BC", "EP1", "EP1 EC"], arc_tolerance=tolerance)
    centre = circle_of(*shots)
    on, off = deviations(line[:, :2], centre, float(np.hypot(*(shots[0] - centre))))
    assert on < 1e-7
    assert off <= tolerance * (1 + 1e-6)
    assert len(line) < 4 + 2 * math.radians(abs(angles[2] - angles[0])) / math.sqrt(
        2 * tolerance / 20
    )
    for shot in shots:
        assert (line[:, :2] == shot).all(axis=1).sum() == 1
    turn = np.unwrap(np.arctan2(*(line[:, :2] - centre).T[::-1]))
    assert math.degrees(abs(turn[-1] - turn[0])) == pytest.approx(abs(angles[2] - angles[0]))


@pytest.mark.parametrize("count", [4, 5, 9])
def test_many_shots_of_a_circle_make_this_circle(count):
    rng = np.random.default_rng(count)
    angles = np.sort(rng.uniform(0, 300, count))
    descriptions = ["EP1 PC", *["EP1"] * (count - 2), "EP1 PT"]
    line = bend(on_circle(angles), descriptions)
    on, off = deviations(line[:, :2], ORIGIN, 20.0)
    assert on < 1e-6
    assert off <= 0.01 + 1e-6


def test_a_curve_through_shots_of_no_circle_has_no_corner_and_misses_none():
    shots = ORIGIN + np.array([[0, 0], [8, 1], [15, 5], [19, 12], [20, 22], [14, 30.0]])
    descriptions = ["EP1 BC", *["EP1"] * 4, "EP1 EC"]
    line = bend(shots, descriptions, arc_tolerance=1e-5)
    for shot in shots:
        assert (line[:, :2] == shot).all(axis=1).any()
    steps = np.diff(line[:, :2], axis=0)
    turns = np.abs(np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))))
    assert turns.max() < 0.02


def test_an_arc_is_tangent_to_the_leg_before_it():
    # a straight of 30 m to the east, a quarter to the left of radius 20, a straight to the north
    places = ORIGIN + np.array([[0, 0], [30, 0], [50, 20], [50, 60.0]])
    line = bend(places, ["EP1", "EP1 PC", "EP1 PT", "EP1"], arc_tolerance=0.001)
    arc = line[1:-1, :2]
    on, off = deviations(arc, beside(30, 20), 20.0)
    assert on < 1e-8
    assert 0 < off <= 0.001 + 1e-9
    assert np.array_equal(line[[0, 1, -2, -1], :2], places)


def test_an_arc_at_the_begin_of_a_line_is_tangent_to_the_leg_behind_it():
    places = ORIGIN + np.array([[0, 0], [20, 20], [20, 60.0]])
    line = bend(places, ["EP1 B PC", "EP1 PT", "EP1 E"], arc_tolerance=0.001)
    on, _ = deviations(line[:-1, :2], beside(0, 20), 20.0)
    assert on < 1e-8


def test_two_arcs_in_succession_share_their_tangent():
    # to the left about (30, 20), then to the right about (70, 20)
    places = ORIGIN + np.array([[0, 0], [30, 0], [50, 20], [70, 40], [90, 40.0]])
    line = bend(places, ["EP1", "EP1 PC", "EP1 PT PC", "EP1 PT", "EP1"], arc_tolerance=0.001)
    at = int(np.flatnonzero((line[:, :2] == places[2]).all(axis=1))[0])
    assert deviations(line[1 : at + 1, :2], beside(30, 20), 20.0)[0] < 1e-8
    assert deviations(line[at:-1, :2], beside(70, 20), 20.0)[0] < 1e-8


def test_a_curve_without_an_end_is_the_arc_through_three_shots():
    shots = np.vstack([on_circle([0, 40, 90]), beside(-30, 20)])
    made = lines_from_codes(site(shots, ["EP1 BC", "EP1", "EP1", "EP1"]))
    line = made.breaklines[0].coords
    assert deviations(line[:-1, :2], ORIGIN, 20.0)[0] < 1e-7
    assert "the arc through three shots (EP1: row 0, row 1, row 2)" in " ".join(made.notes)


def test_elevations_change_evenly_along_the_curve():
    shots = on_circle([0, 60, 90])
    made = lines_from_codes(site(shots, ["EP1 BC", "EP1", "EP1 EC"], z=[10, 16, 13.0]))
    line = made.breaklines[0].coords
    angles = np.degrees(np.arctan2(*(line[:, :2] - ORIGIN).T[::-1]))
    assert np.allclose(line[:, 2], np.interp(angles, [0, 60, 90], [10, 16, 13]), atol=1e-6)


def test_shots_in_one_line_stay_straight():
    shots = ORIGIN + np.array([[0, 0], [10, 0], [25, 0.0]])
    assert len(bend(shots, ["EP1 BC", "EP1", "EP1 EC"])) == 3
    shots[1, 1] += 0.004  # below the tolerance
    assert len(bend(shots, ["EP1 BC", "EP1", "EP1 EC"])) <= 5


def test_the_tolerance_is_a_centimetre_in_the_unit_of_the_crs():
    shots = on_circle([0, 40, 90])
    codes = ["EP1 BC", "EP1", "EP1 EC"]
    metres = lines_from_codes(site(shots, codes, crs="EPSG:32616")).breaklines[0]
    feet = lines_from_codes(site(shots, codes, crs="EPSG:2274")).breaklines[0]
    assert deviations(metres.coords[:, :2], ORIGIN, 20.0)[1] <= 0.01
    assert 0.01 < deviations(feet.coords[:, :2], ORIGIN, 20.0)[1] <= 0.0328084


def test_vertices_that_nobody_shot_are_told():
    made = lines_from_codes(site(on_circle([0, 40, 90]), ["EP1 BC", "EP1", "EP1 EC"]))
    added = len(made.breaklines[0].coords) - 3
    assert made.notes[-1].startswith(f"{added} vertices stand for the curves of EP1, whose chords")
    assert len(made.points) == 3


def test_a_rectangle_gets_its_fourth_corner():
    places = ORIGIN + np.array([[0, 0], [12, 5], [9.5, 11.0]])  # square at the second
    made = lines_from_codes(site(places, ["BLDG1", "BLDG1", "BLDG1 RECT"], z=[5, 5.5, 6.5]))
    ring = made.breaklines[0].coords
    assert np.allclose(ring[3], [*(beside(-2.5, 6)), 6.0], atol=1e-9)
    assert np.array_equal(ring[0], ring[4])
    assert made.findings == []


def test_a_rectangle_of_more_corners_gets_the_mean_of_its_ends():
    places = ORIGIN + np.array([[0, 0], [20, 0], [20, 10], [12, 10], [12, 16.0]])
    codes = ["BLDG1"] * 4 + ["BLDG1 RECT"]
    made = lines_from_codes(site(places, codes, z=[5, 7, 8, 9, 6.5]))
    ring = made.breaklines[0].coords
    assert np.allclose(ring[5], [*beside(0, 16), 5.75], atol=1e-9)
    assert made.findings == []


def test_a_rectangle_out_of_square_is_told():
    places = ORIGIN + np.array([[0, 0], [12, 0], [14, 11.0]])
    made = lines_from_codes(site(places, ["BLDG1", "BLDG1", "BLDG1 RECT"]))
    assert [one.kind for one in made.findings] == ["rectangle out of square"]


def test_curves_that_cannot_be_are_refused_or_told():
    places = ORIGIN + np.array([[0, 0], [30, 0], [10, 0.5], [0, 9.0]])
    made = lines_from_codes(site(places, ["EP1", "EP1 PC", "EP1 PT", "EP1"]))
    assert "curve that turns back" in [one.kind for one in made.findings]
    assert len(made.breaklines[0].coords) == 4
    codes = ["EP1 BC", "EP1", "EP1 EC"]
    with pytest.raises(ts.LinesError, match=r"more than 10,000 vertices .* larger `arc_tolerance`"):
        bend(on_circle([0, 40, 90]), codes, arc_tolerance=1e-9)
    with pytest.raises(ts.LinesError, match="Curves need a projected CRS: EPSG:4326"):
        lines_from_codes(site([[0, 0], [1, 1], [2, 0]], codes, crs="EPSG:4326"))
    for wrong in (0, -1, math.nan, math.inf, "wide"):
        with pytest.raises(ts.OptionError, match=r"Invalid arc_tolerance .*: it must be a length"):
            bend(on_circle([0, 40, 90]), codes, arc_tolerance=wrong)


def test_a_repeated_shot_does_not_break_a_curve():
    shots = on_circle([0, 40, 40, 90])
    line = bend(shots, ["EP1 BC", "EP1", "EP1", "EP1 EC"])
    assert deviations(line[:, :2], ORIGIN, 20.0)[0] < 1e-7


def test_a_closed_curve_and_the_surface_over_it():
    ring = on_circle([0, 90, 180, 270])
    codes = ["SLAB1 BC", "SLAB1", "SLAB1", "SLAB1 EC C"]
    made = lines_from_codes(site(ring, codes))
    line = made.breaklines[0].coords
    assert np.array_equal(line[0], line[-1])
    tin = ts.triangulate(made)
    assert ts.check(tin, points=made).ok
