"""Vertical alignments against closed forms."""

import math

import numpy as np
import pytest

import tinsmith as ts


def crest(kind, **lengths):
    return ts.VerticalAlignment(
        [
            ts.VerticalPoint(0.0, 100.0),
            ts.VerticalPoint(200.0, 110.0, kind, **lengths),
            ts.VerticalPoint(400.0, 104.0),
        ]
    )


def test_a_symmetric_parabola_has_its_rate_of_grade():
    line = crest("parabola", length_in=60.0, length_out=60.0)
    at = np.linspace(140.0, 260.0, 25)
    rate = (-0.03 - 0.05) / 120.0
    along = at - 140.0
    expected = 107.0 + 0.05 * along + rate * along**2 / 2
    np.testing.assert_allclose(line.elevations_at(at), expected, atol=1e-12)
    np.testing.assert_allclose(line.grades_at(at), 0.05 + rate * along, atol=1e-14)


def test_an_unsymmetrical_parabola_has_the_middle_ordinate_of_the_textbooks():
    line = crest("parabola", length_in=30.0, length_out=90.0)
    middle = 30.0 * 90.0 * (-0.03 - 0.05) / (2 * 120.0)
    assert line.elevations_at([200.0])[0] == pytest.approx(110.0 + middle, abs=1e-12)
    for station in (170.0, 200.0, 290.0):  # no break of grade
        before, after = line.grades_at([station - 1e-9, station + 1e-9])
        assert before == pytest.approx(after, abs=1e-9)


def test_an_arc_lies_on_its_circle_and_touches_both_tangents():
    radius = 1500.0
    line = crest("arc", radius=radius)
    angles = math.atan(0.05), math.atan(-0.03)
    tangent = radius * math.tan((angles[0] - angles[1]) / 2)
    begin, end = 200 - tangent * math.cos(angles[0]), 200 + tangent * math.cos(angles[1])
    at = np.linspace(begin, end, 31)
    x = begin + radius * math.sin(angles[0])
    y = 100 + 0.05 * begin - radius * math.cos(angles[0])
    away = np.hypot(at - x, line.elevations_at(at) - y)
    np.testing.assert_allclose(away, radius, rtol=1e-13)
    np.testing.assert_allclose(line.grades_at([begin, end]), [0.05, -0.03], atol=1e-12)
    assert line.curve_lengths[1] == pytest.approx(radius * (angles[0] - angles[1]))


def test_chords_lie_within_the_tolerance():
    line = crest("arc", radius=1500.0)
    knots = line.cut_into_chords(0.01)
    at = np.linspace(0.0, 400.0, 9001)
    chords = np.interp(at, knots, line.elevations_at(knots))
    assert np.abs(chords - line.elevations_at(at)).max() <= 0.01
    assert len(knots) < 40


def test_nothing_is_known_beyond_its_ends():
    line = crest(None)
    assert np.isnan(line.elevations_at([-1.0, 401.0])).all()
    assert line.elevations_at([0.0, 400.0]).tolist() == [100.0, 104.0]


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([ts.VerticalPoint(0, 1)], "2 or more"),
        ([ts.VerticalPoint(0, 1), ts.VerticalPoint(0, 2)], "above 0"),
        (
            [
                ts.VerticalPoint(0, 1),
                ts.VerticalPoint(10, 2, "parabola", 20, 20),
                ts.VerticalPoint(30, 1),
            ],
            "ends before",
        ),
        ([ts.VerticalPoint(0, 1, "arc", radius=3), ts.VerticalPoint(9, 2)], "only one tangent"),
    ],
)
def test_what_is_no_vertical_alignment_is_refused(points, words):
    with pytest.raises(ts.OptionError, match=words):
        ts.VerticalAlignment(points)
    with pytest.raises(ts.OptionError, match="radius"):
        ts.VerticalPoint(0, 1, "arc")
