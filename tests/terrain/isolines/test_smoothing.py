"""Smoothed and simplified contours stay apart and near their level; the checker can say no."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain._kernel import trace_contours
from tinsmith.terrain.isolines.lines import _find_places

ROUNDING = 1e-12


def hilly(seed, n=900, noise=0.3):
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, 100, (n, 2))
    z = 10 * np.sin(xy[:, 0] / 15) * np.cos(xy[:, 1] / 12) + rng.normal(0, noise, n)
    return ts.triangulate(np.column_stack([xy, z]))


def integer_grid(seed):
    rng = np.random.default_rng(seed)
    side = int(rng.integers(4, 13))
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(side), np.arange(side)))
    z = rng.integers(0, int(rng.integers(2, 6)), side * side)
    return ts.triangulate(np.column_stack([x, y, z]).astype(float))


OPTIONS = [
    {"smooth": 0.2},
    {"simplify": 0.2},
    {"smooth": 0.5, "simplify": 0.1},
    {"smooth": 3.0, "simplify": 3.0},
]


@pytest.mark.each_value
@pytest.mark.parametrize("options", OPTIONS)
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("make", [hilly, integer_grid])
def test_lines_never_touch_nor_leave_the_tolerance(make, seed, options):
    tin = make(seed)
    exact = ts.contours(tin, interval=0.75)
    found = ts.contours(tin, interval=0.75, **options)
    proof = ts.check_contours(tin, found)
    assert proof.contacts == 0, proof
    assert proof.deviation <= max(options.values()) * (1 + ROUNDING)
    assert len(found) == len(exact)
    assert found.columns["is_closed"].sum() == exact.columns["is_closed"].sum()


def test_simplified_lines_have_fewer_points_and_smoothed_ones_rounder_corners():
    tin = hilly(1)
    exact = ts.contours(tin, interval=1)
    assert len(ts.contours(tin, interval=1, simplify=0.4).coordinates) < len(exact.coordinates) / 2
    smooth = ts.contours(tin, interval=1, smooth=0.4)
    assert mean_turn(smooth) < 0.6 * mean_turn(exact)


def mean_turn(features):
    turns = []
    for first, last in zip(features.offsets[0][:-1], features.offsets[0][1:], strict=True):
        steps = np.diff(features.coordinates[first:last, :2], axis=0)
        headings = np.arctan2(steps[:, 1], steps[:, 0])
        turns.append(np.abs((np.diff(headings) + np.pi) % (2 * np.pi) - np.pi))
    return np.degrees(np.concatenate(turns)).mean()


def test_ends_stay_at_the_boundary():
    tin = hilly(2)
    exact = ts.contours(tin, interval=1)
    found = ts.contours(tin, interval=1, smooth=0.5, simplify=0.5)
    for features in (exact, found):
        assert not features.columns["is_closed"].all()
    assert ends(found) == ends(exact)


def ends(features):
    return {
        tuple(features.coordinates[row].tolist())
        for k in np.flatnonzero(~features.columns["is_closed"])
        for row in (features.offsets[0][k], features.offsets[0][k + 1] - 1)
    }


def test_the_same_lines_come_of_any_order_of_triangles():
    tin = hilly(3)
    order = np.random.default_rng(0).permutation(len(tin.triangles))
    other = ts.TIN.from_triangles(tin.points, tin.triangles[order])
    one, two = (ts.contours(t, interval=1, smooth=0.3, simplify=0.2) for t in (tin, other))
    assert np.array_equal(one.coordinates, two.coordinates)


@pytest.mark.parametrize("option", ["smooth", "simplify"])
@pytest.mark.parametrize("value", [0, -1, np.nan, "much", True])
def test_tolerances_that_are_none_are_refused(option, value):
    with pytest.raises(ts.OptionError, match=f"Invalid {option} .*> 0 in the unit"):
        ts.contours(hilly(0, 20), interval=1, **{option: value})


# ------------------------------------------------------------------------- the checker


def lines(*parts):
    offsets = np.cumsum([0, *map(len, parts)])
    return ts.Features.of_lines(np.concatenate(parts).astype(float), offsets)


PLANE = ts.TIN.from_triangles([[0, 0, 0], [9, 0, 9], [9, 9, 9], [0, 9, 0]], [[0, 1, 2], [0, 2, 3]])


def test_the_checker_finds_lines_that_cross():
    found = ts.check_contours(PLANE, lines([[3, 9, 3], [5, 0, 3]], [[4, 9, 4], [4, 0, 4]]))
    assert (found.contacts, found.lines, found.is_apart) == (1, ((0, 1),), False)


def test_the_checker_finds_a_line_that_touches_itself_or_runs_back():
    loop = [[3, 9, 3], [3, 5, 3], [2, 4, 3], [3, 3, 3], [3, 5, 3], [4, 6, 3]]
    assert ts.check_contours(PLANE, lines(loop)).contacts > 0
    spike = [[3, 9, 3], [3, 2, 3], [3, 5, 3]]
    assert ts.check_contours(PLANE, lines(spike)).contacts == 1


def test_the_checker_measures_how_far_a_line_leaves_its_level():
    found = ts.check_contours(PLANE, lines([[3, 9, 3], [3.5, 4, 3], [3, 0, 3]]))
    assert found.deviation == pytest.approx(0.5)
    between = lines([[2, 8.5, 2], [2, 0.5, 2]])  # its ends are right
    bump = PLANE.points.copy()
    bump[2, 2] = 20
    assert ts.check_contours(PLANE, between).deviation == 0
    assert ts.check_contours(PLANE.replace(points=bump), between).deviation > 1


def test_the_checker_knows_lines_that_meet_in_a_vertex_at_their_level():
    tin = ts.TIN.from_triangles(
        [[0, 0, 0], [4, 0, 4], [4, 4, 0], [0, 4, 4], [2, 2, 2]],
        [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    )
    found = ts.check_contours(tin, ts.contours(tin, levels=[2]))
    assert (found.contacts, found.shared_vertices) == (0, 4)


def test_the_checker_refuses_what_are_no_contours():
    with pytest.raises(ts.OptionError, match="contours, as lines with elevations"):
        ts.check_contours(PLANE, ts.Features.of_points([[0, 0]]))


def test_more_points_than_smoothing_can_number_are_refused(monkeypatch):
    monkeypatch.setattr("tinsmith.terrain.isolines.lines.MOST_POINTS", 9)
    tin = ts.triangulate([[0, 0, 0], [4, 0, 4], [4, 4, 4], [0, 4, 0]])
    sentence = "it must be left out where contours have more than 9 points: here 12"
    for option in ("smooth", "simplify"):
        ts.contours(tin, levels=[1, 2, 3], **{option: 0.1})
        with pytest.raises(ts.OptionError, match=f"Invalid {option} 0.1: {sentence}"):
            ts.contours(tin, levels=[0.5, 1.5, 2.5, 3.5], **{option: 0.1})


@pytest.mark.parametrize("make", [hilly, integer_grid])
def test_each_point_of_a_line_is_known_in_a_triangle_that_holds_it(make):
    tin = make(3)
    kernel_arrays = (tin.points, tin.triangles, tin.neighbors)
    lines = trace_contours(*kernel_arrays, np.arange(-12.0, 12.0, 0.75))
    places = _find_places(tin, lines)
    is_last = np.zeros(len(lines.coordinates), bool)
    is_last[(lines.offsets[1:] - 1)[lines.is_closed]] = True
    xy = lines.coordinates[~is_last, :2]
    assert len(places) == len(xy)
    assert (places >= 0).all()
    a, b, c = (tin.points[tin.triangles[places, k], :2] for k in range(3))
    for start, end in ((a, b), (b, c), (c, a)):
        along, to = end - start, xy - start
        length = np.hypot(*along.T)
        assert ((along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) / length > -1e-9).all()


def test_clusters_far_apart_are_smoothed_and_stay_apart():
    cluster = np.random.default_rng(1).random((150, 3))
    tin = ts.triangulate(np.concatenate([cluster, cluster + np.array([1e6, 1e6, 0.0])]))
    lines = ts.contours(tin, interval=0.1, smooth=0.1)
    assert len(lines.coordinates) > 2 * len(ts.contours(tin, interval=0.1).coordinates)
    found = ts.check_contours(tin, lines)
    assert found.is_apart
    assert found.deviation <= 0.1 + 1e-9


def test_straight_contours_are_left_with_their_ends():
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(300.0), np.arange(4.0)))
    tin = ts.triangulate(np.column_stack([x, y, y]))
    lines = ts.contours(tin, levels=[0.25, 1.5, 2.75], simplify=0.1)
    assert np.diff(lines.offsets[0]).tolist() == [2, 2, 2]


@pytest.mark.parametrize("turn", [(3, 1), (1, 3), (-7, 11)])
def test_contours_along_a_slanted_line_stay_within_their_tolerance(turn):
    """Its triangles along the boundary are thinner than rounding, and as long as the line."""
    along = np.arange(200.0)
    line = np.column_stack([along * turn[0] / 3, along * turn[1] / 3, np.sin(along)])
    aside = [[300.0 * turn[1] / 10, -300.0 * turn[0] / 10, 0.0]]
    tin = ts.triangulate(np.vstack([line, aside]))
    lines = ts.contours(tin, 0.2, smooth=0.1, simplify=0.05)
    found = ts.check_contours(tin, lines)
    assert found.is_apart
    assert 0.0 < found.deviation <= 0.15
    assert len(lines.coordinates) < 20 * len(tin.points)
