"""Cross sections: square to the centreline, at an interval and at stations."""

import numpy as np
import pytest

import tinsmith as ts

PLANE = ts.TIN.from_triangles(
    [[0, 0, 0], [8, 0, 8], [8, 8, 24], [0, 8, 16]], [[0, 1, 2], [0, 2, 3]]
)
"""z = x + 2 y."""


def test_a_section_is_square_to_its_segment_and_looks_up_station():
    table = ts.cross_sections(PLANE, [[1, 4], [7, 4]], stations=[2], width=4)
    assert table["offset"].tolist() == [-2, 0, 1, 2]
    assert table["x"].tolist() == [3, 3, 3, 3]
    assert table["y"].tolist() == [6, 4, 3, 2]
    assert table["elevation"].tolist() == [15, 11, 9, 7]
    assert table["crossed"].tolist() == ["line", "line", "edge", "line"]
    assert set(table["station"].tolist()) == {2.0}


def test_left_and_right_may_differ():
    table = ts.cross_sections(PLANE, [[7, 4], [1, 4]], stations=2, left=1, right=3)
    assert (table["offset"].min(), table["offset"].max()) == (-1, 3)
    assert table["y"][table["offset"] == -1].tolist() == [3]
    one_side = ts.cross_sections(PLANE, [[1, 4], [7, 4]], stations=2, right=3)
    assert one_side["offset"].min() == 0


def test_sections_stand_at_multiples_and_at_both_ends():
    table = ts.cross_sections(PLANE, [[1, 4], [7, 4]], interval=2.5, width=1, start=1)
    assert np.unique(table["station"]).tolist() == [1, 2.5, 5, 7]
    more = ts.cross_sections(PLANE, [[1, 4], [7, 4]], interval=2.5, stations=[3], width=1)
    assert np.unique(more["station"]).tolist() == [0, 2.5, 3, 5, 6]
    assert np.unique(more["section"]).tolist() == [0, 1, 2, 3, 4]


def test_at_a_kink_the_section_halves_the_angle():
    table = ts.cross_sections(PLANE, [[2, 2], [5, 2], [5, 5]], stations=[3], width=2)
    ends = np.column_stack([table["x"], table["y"]])[[0, -1]]
    half = np.sqrt(0.5)
    assert ends == pytest.approx(np.array([[5 - half, 2 + half], [5 + half, 2 - half]]))


def test_where_the_centreline_turns_back_the_segment_before_counts():
    table = ts.cross_sections(PLANE, [[2, 2], [5, 2], [3, 2]], stations=[3], width=2)
    assert table["x"].tolist() == [5, 5, 5]
    assert table["y"].tolist() == [3, 2, 1]


def test_every_line_has_its_sections():
    table = ts.cross_sections(PLANE, [[[1, 2], [3, 2]], [[1, 5], [6, 5]]], stations=[1, 4], width=1)
    pairs = sorted(set(zip(table["line"].tolist(), table["station"].tolist(), strict=True)))
    assert pairs == [(0, 1), (1, 1), (1, 4)]


def test_offsets_and_elevations_of_several_surfaces():
    raised = PLANE.replace(points=PLANE.points + np.array([0, 0, 1.5]))
    table = ts.cross_sections([PLANE, raised], [[1, 4], [7, 4]], interval=1, width=2)
    assert table["difference_2"] == pytest.approx(1.5)
    where = np.column_stack([table["x"], table["y"]])
    assert table["elevation_1"] == pytest.approx(where @ [1, 2])
    assert table["offset"] == pytest.approx(4 - table["y"])


def test_ends_beyond_the_surface_have_no_elevation():
    table = ts.cross_sections(PLANE, [[1, 1], [7, 1]], stations=[3], width=4)
    assert table["crossed"].tolist()[-2:] == ["boundary", "line"]
    assert np.isnan(table["elevation"]).tolist()[-2:] == [False, True]


def test_sections_are_lines_in_space():
    lines = ts.section_lines(PLANE, [[1, 4], [7, 4]], interval=2, width=2)
    assert lines.kind == "lines"
    assert lines.columns["station"].tolist() == [0, 2, 4, 6]
    table = ts.cross_sections(PLANE, [[1, 4], [7, 4]], interval=2, width=2)
    columns = np.column_stack([table["x"], table["y"], table["elevation"]])
    assert lines.coordinates == pytest.approx(columns)


def test_a_section_over_a_hole_is_two_lines():
    rng = np.random.default_rng(5)
    xyz = np.column_stack([rng.random((300, 2)) * 10, rng.random(300)])
    tin = ts.triangulate(xyz, holes=[[[4, 4], [6, 4], [6, 6], [4, 6]]])
    lines = ts.section_lines({"ground": tin}, [[5, 1], [5, 9]], stations=[1, 4], width=6)
    assert lines.columns["section"].tolist() == [0, 1, 1]
    assert set(lines.columns["surface"].tolist()) == {"ground"}
    assert not np.isnan(lines.coordinates).any()


def test_ten_thousand_sections_agree_with_interpolate():
    rng = np.random.default_rng(6)
    tin = ts.triangulate(np.column_stack([rng.random((4000, 2)) * 1000, rng.random(4000)]))
    table = ts.cross_sections(tin, [[100, 100], [500, 800], [900, 150]], interval=0.15, width=20)
    assert table["section"].max() > 10_000
    places = np.column_stack([table["x"], table["y"]])
    assert np.abs(tin.interpolate(places) - table["elevation"]).max() < 1e-9


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({}, "interval"),
        ({"width": 1}, "interval"),
        ({"interval": 1}, "width"),
        ({"interval": 0, "width": 1}, "interval"),
        ({"interval": -2, "width": 1}, "interval"),
        ({"interval": np.nan, "width": 1}, "interval"),
        ({"interval": 1, "width": 0}, "width"),
        ({"interval": 1, "width": 2, "left": 1}, "without left and right"),
        ({"interval": 1, "left": -1}, "left"),
        ({"interval": 1, "left": 0, "right": 0}, "left and right"),
        ({"interval": 1, "width": 1e-30}, "wide enough"),
        ({"interval": 1e-9, "width": 1}, "at most 1,000,000"),
        ({"stations": [99], "width": 1}, "on the centreline, from 0 to 6"),
        ({"stations": [], "width": 1}, "stations"),
        ({"stations": ["a"], "width": 1}, "stations"),
        ({"stations": [np.nan], "width": 1}, "stations"),
        ({"interval": 1, "width": 1, "start": "x"}, "start"),
    ],
)
def test_wrong_options_are_refused_in_a_sentence(how, why):
    with pytest.raises(ts.OptionError, match=why):
        ts.cross_sections(PLANE, [[1, 4], [7, 4]], **how)


def test_sections_outside_are_refused():
    with pytest.raises(ts.LinesError, match="outside the surface"):
        ts.cross_sections(PLANE, [[100, 100], [200, 100]], interval=10, width=1)
    with pytest.raises(ts.LinesError, match="A centreline runs along lines"):
        ts.cross_sections(PLANE, ts.Features.of_points([[1, 1]]), interval=10, width=1)
