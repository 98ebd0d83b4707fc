"""Noding: afterwards no step crosses another or passes a vertex, by rational arithmetic."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import line_oracle
from support.line_oracle import places_of, steps_of
from support.point_sets import seeds, small_integers, utm_floats, utm_raster

import tinsmith as ts
from tinsmith.base.errors import LinesError, OptionError
from tinsmith.tin import _kernel
from tinsmith.tin.constraints import splitting
from tinsmith.tin.constraints.noding import node
from tinsmith.tin.constraints.polylines import Polylines

UTM = np.array([500_000.0, 4_000_000.0])
NAN = float("nan")


def lines_of(polylines):
    return [part.tolist() for part in np.split(polylines.vertices, polylines.offsets[1:-1])]


def noded(xy, lines, heights=None, *, priority=None, **options):
    priority = np.zeros(len(lines)) if priority is None else np.array(priority)
    if heights is None:
        heights = [np.zeros(len(line)) for line in lines]
    elevations = np.array([z for line in heights for z in line], float)
    polylines = Polylines.of_chains(lines)
    return node(np.array(xy, float), polylines, elevations, priority, **options)


def all_xy(xy, result):
    return np.concatenate([np.asarray(xy, float), result.new_points[:, :2]])


def placed_steps(xy, result):
    """Undirected steps as pairs of places."""
    every = all_xy(xy, result)
    steps = steps_of(result.polylines.vertices, result.polylines.offsets)
    return {frozenset(map(tuple, every[list(step)].tolist())) for step in steps}


def require_sound(xy, lines, result, *, snap=0.0):
    """Nothing crosses or touches, nothing is doubled, every line still goes from end to end."""
    every = all_xy(xy, result)
    assert len(np.unique(every, axis=0)) == len(every)
    segments = sorted(steps_of(result.polylines.vertices, result.polylines.offsets))
    places = places_of(every)
    assert line_oracle.crossings(places, segments) == []
    assert line_oracle.touches(places, segments) == []
    if snap > 0:
        pairs = np.array(segments, np.int32).reshape(-1, 2)
        assert len(_kernel.touches(every, pairs, snap)) == 0
    for line, chain in zip(lines, lines_of(result.polylines), strict=True):
        require_subsequence([v for v, w in zip(line, [None, *line], strict=False) if v != w], chain)
    new = result.new_points[:, :2].tolist()
    assert new == sorted(new)


def require_subsequence(wanted, found):
    assert (found[0], found[-1]) == (wanted[0], wanted[-1])
    rest = iter(found)
    assert all(v in rest for v in wanted)


def require_same_for_any_order(xy, lines, rng, *, snap=0.0):
    result = noded(xy, lines, snap=snap)
    order = rng.permutation(len(lines))
    turned = [lines[i][:: rng.choice([-1, 1])] for i in order]
    other = noded(xy, turned, snap=snap)
    np.testing.assert_array_equal(other.new_points[:, :2], result.new_points[:, :2])
    assert placed_steps(xy, other) == placed_steps(xy, result)
    return result


# -------------------------------------------------------------------- crossings and heights

CROSS = [[0, 0], [4, 4], [0, 4], [4, 0]]
TWO = [[0, 1], [2, 3]]


def crossing_rows(result):
    found = result.crossings
    return [
        (v, *xy, *pair, *heights, z)
        for v, xy, pair, heights, z in zip(*(column.tolist() for column in found), strict=True)
    ]


def test_two_lines_cross_in_a_new_vertex():
    result = noded(CROSS, TWO, [[0, 8], [10, 20]])
    assert result.new_points.tolist() == [[2, 2, 4]]
    assert lines_of(result.polylines) == [[0, 4, 1], [2, 4, 3]]
    assert result.elevations.tolist() == [0, 4, 8, 10, 15, 20]
    assert crossing_rows(result) == [(4, 2, 2, 0, 1, 4, 15, 4)]
    assert len(result.touches.vertex) == 0


def test_higher_priority_gives_the_height():
    result = noded(CROSS, TWO, [[0, 8], [10, 20]], priority=[1, 2])
    assert result.new_points.tolist() == [[2, 2, 15]]
    assert crossing_rows(result) == [(4, 2, 2, 1, 0, 15, 4, 15)]


def test_line_without_heights_never_gives_one():
    result = noded(CROSS, TWO, [[NAN, NAN], [10, 20]], priority=[9, 0])
    assert result.new_points.tolist() == [[2, 2, 15]]
    (row,) = crossing_rows(result)
    assert row[:6] == (4, 2, 2, 1, 0, 15)
    assert np.isnan(row[6])


def test_two_lines_without_heights_leave_it_open():
    result = noded(CROSS, TWO, [[NAN] * 2] * 2)
    assert np.isnan(result.new_points[0, 2])
    assert np.isnan(result.crossings.vertex_elevations).tolist() == [True]


def test_three_lines_through_one_place_share_a_vertex():
    xy = [*CROSS, [0, 2], [4, 2]]
    heights = [[0, 0], [1, 1], [2, 2]]
    result = noded(xy, [*TWO, [4, 5]], heights, priority=[0, 5, 0])
    assert result.new_points.tolist() == [[2, 2, 1]]
    rows = [(6, 2, 2, 1, 0, 1, 0, 1), (6, 2, 2, 1, 2, 1, 2, 1)]
    assert sorted(crossing_rows(result)) == rows


def test_place_of_three_lines_that_is_no_double():
    ends = [[0, 0], [1, 1], [0, 1], [1, -1], [-1, 1], [3, -1], [0, 2], [1, -3]]
    result = noded(ends, [[0, 1], [2, 3], [4, 5], [6, 7]])
    assert result.new_points[:, :2].tolist() == [[1 / 3, 1 / 3]]
    assert len(result.crossings.vertices) == 3


def test_crossing_at_a_vertex_of_neither_line_takes_it():
    """The lines' exact meeting place is not the mass point's, but rounds to it."""
    ends = np.array([[0, 0], [1, 1], [0, 1], [1, -1], [1 / 3, 1 / 3], [2, 2]])
    result = noded(ends, TWO, [[3, 3], [5, 5]])
    assert len(result.new_points) == 0
    assert lines_of(result.polylines) == [[0, 4, 1], [2, 4, 3]]
    assert crossing_rows(result) == [(4, 1 / 3, 1 / 3, 0, 1, 3, 5, 3)]
    touched = zip(*(column.tolist() for column in result.touches), strict=True)
    assert list(touched) == [(4, 0, 3), (4, 1, 5)]


def test_line_that_crosses_itself_takes_its_first_height():
    xy = [[0, 0], [4, 4], [4, 0], [0, 4]]
    result = noded(xy, [[0, 1, 2, 3]], [[0, 8, 10, 20]])
    assert lines_of(result.polylines) == [[0, 4, 1, 2, 4, 3]]
    assert crossing_rows(result) == [(4, 2, 2, 0, 0, 4, 15, 4)]


def test_line_there_and_back_does_not_cross_itself():
    result = noded(CROSS, [[0, 1, 0], [2, 3]], [[1, 1, 1], [2, 2]])
    assert lines_of(result.polylines) == [[0, 4, 1, 4, 0], [2, 4, 3]]
    assert crossing_rows(result) == [(4, 2, 2, 0, 1, 1, 2, 1)]


def test_heights_stay_within_the_steps_own():
    rng = np.random.default_rng(0)
    ends = rng.random((40, 2)) * 100 + UTM
    heights = [[0.1, 0.1], *([z, z] for z in rng.random(19))]
    result = noded(ends, np.arange(40).reshape(-1, 2).tolist(), heights)
    for part, (z, _) in zip(
        np.split(result.elevations, result.polylines.offsets[1:-1]), heights, strict=True
    ):
        assert set(part.tolist()) == {z}


@settings(max_examples=60)
@given(seeds)
def test_heights_are_linear_and_the_rule_chooses_one(seed):
    rng = np.random.default_rng(seed)
    xy = rng.random((16, 2)) * 50 + UTM
    heights = rng.random((8, 2)) * 10
    priority = rng.integers(0, 3, 8)
    lines = np.arange(16).reshape(-1, 2)
    result = noded(xy, lines.tolist(), heights.tolist(), priority=priority)
    every = all_xy(xy, result)
    through = {v: [] for v in range(16, len(every))}
    for line, chain in enumerate(lines_of(result.polylines)):
        span = every[chain] - every[chain[0]]
        share = np.hypot(*span.T) / np.hypot(*span[-1])
        own = heights[line, 0] + share * (heights[line, 1] - heights[line, 0])
        first = result.polylines.offsets[line]
        np.testing.assert_allclose(result.elevations[first : first + len(chain)], own, atol=1e-6)
        for v, z in zip(chain[1:-1], own[1:-1], strict=True):
            through[v].append((-priority[line], line, z))
    rows = {(row[0], row[3], row[4]): row for row in crossing_rows(result)}
    for v, met in through.items():
        (_, winner, z), *others = sorted(met)
        assert result.new_points[v - 16, 2] == pytest.approx(z, abs=1e-6)
        for _, other, z_other in others:
            row = rows.pop((v, winner, other))
            assert row[1:3] == tuple(every[v])
            assert row[5:] == pytest.approx((z, z_other, z), abs=1e-6)
    assert rows == {}


# -------------------------------------------------------------------- touches and overlaps


def test_vertex_on_a_line_becomes_its_vertex():
    result = noded([[0, 0], [4, 2], [2, 1], [9, 9]], [[0, 1]], [[1, 3]])
    assert lines_of(result.polylines) == [[0, 2, 1]]
    assert [column.tolist() for column in result.touches] == [[2], [0], [2]]


def test_line_ends_on_another():
    result = noded([[0, 0], [4, 0], [2, 0], [2, 3]], TWO, [[1, 3], [7, 9]])
    assert lines_of(result.polylines) == [[0, 2, 1], [2, 3]]
    assert [column.tolist() for column in result.touches] == [[2], [0], [2]]
    assert len(result.crossings.vertices) == 0


def test_segment_through_a_thousand_collinear_vertices_both_ways():
    xy = np.arange(1002)[:, None] * [0.25, 0.75] + UTM
    middle = np.random.default_rng(1).permutation(1000) + 1
    shuffled = np.empty_like(xy)
    shuffled[[0, 1001]] = xy[[0, 1001]]
    shuffled[middle] = xy[1:1001]
    result = noded(shuffled, [[0, 1001], [1001, 0]], [[0, 1001], [1001, 0]])
    forth = [0, *middle.tolist(), 1001]
    assert lines_of(result.polylines) == [forth, forth[::-1]]
    np.testing.assert_allclose(result.elevations[:1002], np.arange(1002), atol=1e-6)
    assert len(result.touches.vertex) == 1000 * 2


def test_overlapping_lines_share_steps():
    xy = [[i, 2 * i] for i in range(6)]
    result = noded(xy, [[0, 3], [5, 1], [2, 4]])
    assert lines_of(result.polylines) == [[0, 1, 2, 3], [5, 4, 3, 2, 1], [2, 3, 4]]


def test_duplicate_and_reversed_lines():
    result = noded(CROSS, [[0, 1], [1, 0], [2, 3], [0, 1]])
    assert lines_of(result.polylines) == [[0, 4, 1], [1, 4, 0], [2, 4, 3], [0, 4, 1]]
    assert len(result.new_points) == 1


def test_repeated_vertices_count_once():
    result = noded([[0, 0], [1, 0], [2, 0]], [[0, 0, 1, 1, 1, 2, 2], [1, 1]])
    assert lines_of(result.polylines) == [[0, 1, 2], [1]]


def test_closed_line_ends_where_it_begins():
    xy = [[0, 0], [4, 0], [4, 4], [0, 4], [2, -1], [2, 5]]
    result = noded(xy, [[0, 1, 2, 3, 0], [4, 5]])
    assert lines_of(result.polylines) == [[0, 6, 1, 2, 7, 3, 0], [4, 6, 7, 5]]


def test_no_lines_and_lines_without_steps():
    nothing = noded([[0, 0], [1, 1]], [])
    assert nothing.polylines.offsets.tolist() == [0]
    assert nothing.new_points.shape == (0, 3)
    alone = noded([[0, 0], [1, 1]], [[1], [0]])
    assert lines_of(alone.polylines) == [[1], [0]]


# -------------------------------------------------------------------- sets of lines


def drawn_lines(rng, xy, *, most=10):
    count = rng.integers(1, most)
    return [rng.integers(0, len(xy), rng.integers(1, 6)).tolist() for _ in range(count)]


def nearly_raster(rng, n):
    return small_integers(rng, n, 6) * 0.1 + UTM + rng.integers(-2, 3, (n, 2)) * 2.0**-30


def drawn_places(name, rng):
    places = {
        "small_grid": lambda: small_integers(rng, 14, 6),
        "utm_raster": lambda: utm_raster(rng, 14, 6),
        "nearly_raster": lambda: nearly_raster(rng, 14),
        "random": lambda: utm_floats(rng, 14),
    }[name]()
    return np.unique(places, axis=0)


NAMES = ["small_grid", "utm_raster", "nearly_raster", "random"]


@settings(max_examples=120)
@given(seeds, st.sampled_from(NAMES))
def test_any_lines_in_any_order_and_direction(seed, name):
    rng = np.random.default_rng(seed)
    xy = drawn_places(name, rng)
    lines = drawn_lines(rng, xy, most=7)
    result = require_same_for_any_order(xy, lines, rng)
    require_sound(xy, lines, result)


@settings(max_examples=80)
@given(seeds, st.sampled_from(NAMES), st.sampled_from([0.05, 0.4, 1.2, 20.0]))
def test_any_lines_within_a_distance(seed, name, snap):
    rng = np.random.default_rng(seed)
    xy = drawn_places(name, rng)
    lines = drawn_lines(rng, xy, most=6)
    result = require_same_for_any_order(xy, lines, rng, snap=snap)
    require_sound(xy, lines, result, snap=snap)


def test_noding_twice_changes_nothing():
    rng = np.random.default_rng(2)
    xy = rng.random((60, 2)) * 100 + UTM
    first = noded(xy, np.arange(60).reshape(-1, 2).tolist())
    again = node(all_xy(xy, first), first.polylines, first.elevations, np.zeros(30))
    assert len(first.new_points) > 50
    assert len(again.new_points) == 0
    np.testing.assert_array_equal(again.polylines.vertices, first.polylines.vertices)


@pytest.mark.parametrize("unit", [2.0**-33, 2.0**-30, 2.0**-26])
def test_cascade_of_nearly_parallel_lines(unit):
    """Each crossing bends two lines by a rounding, onto or across the next one."""
    rng = np.random.default_rng(3)
    ends = np.array([[0, 0], [300.0, 100.0]]) + UTM + rng.integers(-9, 10, (18, 2, 2)) * unit
    xy, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    lines = number.reshape(-1, 2).tolist()
    result = require_same_for_any_order(xy, lines, rng)
    require_sound(xy, lines, result)


def test_lines_that_pass_a_crossing_on_end_it():
    """On cells of 30.1 m: each crossing of three lines makes the next one, a rounding further."""
    columns = [0, 0, 0, 0, 1, 1, 2, 2, 2, 4, 4], [0, 1, 3, 5, 0, 1, 0, 1, 3, 4, 5]
    lines = [[7, 10, 3, 9], [7, 1, 10, 2], [3, 5, 0, 9, 5], [1, 6, 0, 1]]
    xy = np.transpose(columns) * 30.1 + UTM
    result = require_same_for_any_order(xy, lines, np.random.default_rng(1))
    require_sound(xy, lines, result)
    assert len(result.new_points) < 50


def test_cascade_that_is_cut_short_says_so(monkeypatch):
    monkeypatch.setattr(splitting, "MOST_ROUNDS", 1)
    with pytest.raises(LinesError, match="still meet at new places after"):
        noded(CROSS, TWO)


def test_many_short_lines_that_cross_are_sound_by_the_search():
    """As many as a survey has; the search itself is held to the oracle elsewhere."""
    rng = np.random.default_rng(4)
    start = rng.random((400, 1, 2)) * 1000 + UTM
    xy = (start + np.cumsum(rng.normal(0, 3, (400, 50, 2)), axis=1)).reshape(-1, 2)
    lines = np.arange(20_000).reshape(400, 50).tolist()
    result = noded(xy, lines, threads=2)
    assert len(result.new_points) > 1000
    every = all_xy(xy, result)
    steps = np.array(
        sorted(steps_of(result.polylines.vertices, result.polylines.offsets)), np.int32
    )
    crossings, touches = _kernel.contacts(every, steps)
    assert (len(crossings), len(touches)) == (0, 0)
    np.testing.assert_array_equal(noded(xy, lines).polylines.vertices, result.polylines.vertices)


# -------------------------------------------------------------------- within a distance


def test_line_bends_onto_a_vertex_near_it():
    xy = [[0, 0], [10, 0], [5, 0.4], [7, -0.6]]
    result = noded(xy, [[0, 1]], [[0, 10]], snap=0.5)
    assert lines_of(result.polylines) == [[0, 2, 1]]
    assert [column.tolist() for column in result.touches] == [[2], [0], [5]]


def test_bent_parts_are_looked_at_again():
    """The second vertex is near the bent line only."""
    xy = [[0, 0], [10, 0], [5, 0.5], [6, 0.8]]
    assert lines_of(noded(xy, [[0, 1]], snap=0.5).polylines) == [[0, 2, 3, 1]]


def test_line_does_not_bend_onto_what_is_near_its_end():
    xy = [[0, 0], [10, 0], [0.2, 0.3]]
    assert lines_of(noded(xy, [[0, 1]], snap=0.5).polylines) == [[0, 1]]


def test_vertices_on_both_sides_of_a_short_segment():
    """Taking both at once would make a longer part: the nearer one comes first."""
    xy = [[0, 0], [1, 0], [0.45, 0.7], [0.55, -0.69]]
    result = noded(xy, [[0, 1]], snap=0.71)
    assert lines_of(result.polylines)[0][1] == 3
    require_sound(xy, [[0, 1]], result, snap=0.71)


def test_all_vertices_near_a_segment_are_taken_at_once(monkeypatch):
    """Else lines along dense points would need a round of splitting for each point."""
    monkeypatch.setattr(splitting, "MOST_ROUNDS", 3)
    x = np.arange(1.0, 40.0)
    beside = np.column_stack([x, 0.01 * x])  # the nearest is always at one end
    ends = np.array([[0.0, 0], [40, 0], [0, 900], [40, 900]])
    xy = np.concatenate([ends, beside, beside + np.array([0.0, 900])])
    result = noded(xy, [[0, 1], [2, 3]], snap=0.5)
    assert lines_of(result.polylines) == [[0, *range(4, 43), 1], [2, *range(43, 82), 3]]


def test_lines_that_cross_beside_a_vertex_meet_in_it():
    xy = [*CROSS, [2.1, 2]]
    result = noded(xy, TWO, snap=0.2)
    assert lines_of(result.polylines) == [[0, 4, 1], [2, 4, 3]]
    assert len(result.new_points) == 0


# -------------------------------------------------------------------- crossing="error"


def test_crossing_lines_are_named_with_place_and_heights():
    xy = np.array(CROSS) + UTM
    sentence = r"^Line 0 crosses line 1 at \(500002, 4000002\), with elevation 4 and elevation 15: "
    with pytest.raises(LinesError, match=sentence) as caught:
        noded(xy, TWO, [[0, 8], [10, 20]], crossing="error")
    assert caught.value.lines == (0, 1)


def test_the_first_crossing_is_named_by_its_lines():
    xy = [[0, 0], [9, 0], [1, -1], [1, 1], [5, -1], [5, 1]]
    lines = [[4, 5], [2, 3], [0, 1]]
    names = ["breakline 'a'", "", "the boundary"]
    with pytest.raises(LinesError, match=r"^Breakline 'a' crosses the boundary at \(5, 0\), ") as e:
        noded(xy, lines, [[NAN, NAN], [1, 1], [2, 2]], crossing="error", names=names)
    assert "with no elevation and elevation 2" in str(e.value)


def test_line_that_crosses_itself_is_named():
    xy = [[0, 0], [4, 4], [4, 0], [0, 4]]
    with pytest.raises(LinesError, match=r"^Line 0 crosses itself at \(2, 2\)") as caught:
        noded(xy, [[0, 1, 2, 3]], crossing="error")
    assert caught.value.lines == (0,)


def test_touching_and_overlapping_lines_do_not_cross():
    xy = [[0, 0], [4, 0], [2, 0], [2, 3], [6, 0]]
    result = noded(xy, [[0, 1], [2, 3], [2, 4]], crossing="error")
    assert lines_of(result.polylines) == [[0, 2, 1], [2, 3], [2, 1, 4]]


def test_unknown_crossing_is_refused():
    with pytest.raises(OptionError, match=r"Invalid crossing 'join': .* one of split, error"):
        noded(CROSS, TWO, crossing="join")


@pytest.mark.parametrize("turn", [[0, 1, 2], [1, 0, 2]])
def test_order_of_rows_has_no_say_where_an_upright_line_bends_onto_two_points(turn):
    """Both lie equally far along the line, on either side of it."""
    points = np.array([[-0.1, 5, 1], [0.1, 5, 2], [-9, 4, 0], [9, 4, 0]], float)
    line = np.array([[0, 0, 0], [0, 10, 0]], float)
    tins = [
        ts.triangulate(rows[:, turn], breaklines=[line[:, turn]], snap=0.15)
        for rows in (points, points[::-1])
    ]
    chains = [tin.points[tin.lines.vertices].tolist() for tin in tins]
    assert len(chains[0]) == 4
    assert chains[0] == chains[1]
