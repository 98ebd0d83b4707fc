"""Duplicates: policies against a plain dictionary, snapping against every pair."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import oracles

import tinsmith as ts
from tinsmith.tin import check
from tinsmith.tin.predicates import LARGEST_ELEVATION

heights = st.floats(-500, 9000)
small = st.integers(0, 3)
rows_with_repeats = st.lists(st.tuples(small, small, heights), min_size=6, max_size=40).filter(
    lambda rows: oracles.delaunay(sorted({row[:2] for row in rows}))
)

CHOICES = {
    "mean": lambda z: float(sum(map(Fraction, z)) / len(z)),
    "first": lambda z: z[0],
    "last": lambda z: z[-1],
    "lowest": min,
    "highest": max,
}

FOUR_CORNERS = [[0, 0, 1], [9, 0, 2], [9, 9, 3], [0, 9, 4]]


def rows_by_place(rows):
    """Places in the order of their first row, with their row numbers."""
    places = {}
    for number, (x, y, _) in enumerate(rows):
        places.setdefault((x, y), []).append(number)
    return places


@pytest.mark.parametrize("policy", CHOICES)
@given(rows_with_repeats)
def test_policies_equal_a_dictionary(policy, rows):
    tin = ts.triangulate(rows, duplicates=policy)
    places = rows_by_place(rows)
    assert [tuple(p) for p in tin.points[:, :2].tolist()] == list(places)
    wanted = [
        CHOICES[policy]([rows[number][2] for number in numbers]) for numbers in places.values()
    ]
    np.testing.assert_allclose(tin.points[:, 2], wanted, rtol=1e-15, atol=1e-12)
    if policy != "mean":
        assert tin.points[:, 2].tolist() == wanted
    for vertex, numbers in enumerate(places.values()):
        assert all(tin.vertex_of[number] == vertex for number in numbers)
    assert check(tin, points=rows).ok


@given(rows_with_repeats)
def test_report_names_every_merged_row(rows):
    tin = ts.triangulate(rows, duplicates="highest")
    found = [(merge.vertex, merge.rows, merge.elevations) for merge in tin.report.merges()]
    wanted = [
        (vertex, tuple(numbers), tuple(rows[number][2] for number in numbers))
        for vertex, numbers in enumerate(rows_by_place(rows).values())
        if len(numbers) > 1
    ]
    assert found == wanted
    for merge in tin.report.merges():
        assert set(merge.shifts) == {0.0}
        assert merge.elevation == max(merge.elevations) == tin.points[merge.vertex, 2]
    assert tin.report.n_rows == len(rows)
    assert tin.report.n_vertices == len(tin.points)
    assert tin.report.n_triangles == len(tin.triangles)


def test_mean_does_not_depend_on_the_order_of_rows():
    rng = np.random.default_rng(1)
    repeated = np.column_stack([np.full((40, 2), 5.0), rng.normal(0, 1e3, 40) ** 3])
    rows = np.concatenate([FOUR_CORNERS, repeated])
    found = set()
    for _ in range(30):
        tin = ts.triangulate(rng.permutation(rows))
        (merge,) = tin.report.merges()
        found.add(merge.elevation)
    assert len(found) == 1
    assert math.isclose(found.pop(), math.fsum(repeated[:, 2]) / 40, rel_tol=1e-13)


@given(st.lists(st.floats(-1e300, 1e300), min_size=1, max_size=8))
def test_mean_lies_between_lowest_and_highest(z):
    z = [value * 1e-8 for value in z]
    rows = [*FOUR_CORNERS, *([5, 5, value] for value in z)]
    height = ts.triangulate(rows).points[-1, 2]
    assert min(z) <= height <= max(z)


def test_mean_of_equal_heights_is_that_height():
    tin = ts.triangulate([*FOUR_CORNERS, *[[5, 5, 0.1]] * 3])
    assert tin.points[-1, 2] == 0.1


def test_without_repeats_nothing_is_merged():
    report = ts.triangulate(FOUR_CORNERS).report
    assert list(report.merges()) == []
    assert report.to_dict()["merges"] == []
    assert repr(report) == "<Report: 4 rows, 4 vertices, 2 triangles, 0 rows merged away>"


def test_report_is_plain_data():
    tin = ts.triangulate([*FOUR_CORNERS, [9, 9, 5]], duplicates="last")
    assert tin.report.to_dict() == {
        "rows": 5,
        "vertices": 4,
        "triangles": 2,
        "duplicates": "last",
        "snap": 0.0,
        "merges": [
            {
                "vertex": 2,
                "rows": (2, 4),
                "elevations": (3.0, 5.0),
                "shifts": (0.0, 0.0),
                "elevation": 5.0,
            }
        ],
        "left_out": {},
        "lines": 0,
        "from_raster": False,
        "crossings": [],
        "overruled": [],
        "skipped": {},
        "notes": [],
        "unmended": [],
        "edits": [],
    }
    assert repr(tin.report) == "<Report: 5 rows, 4 vertices, 2 triangles, 1 row merged away>"


def test_zero_has_no_sign():
    tin = ts.triangulate([[0.0, -0.0, 1], [-0.0, 0.0, 3], [1, 0, 0], [0, 1, 0]])
    assert tin.vertex_of.tolist() == [0, 0, 1, 2]
    assert tin.points[0].tolist() == [0, 0, 2]
    assert not np.signbit(tin.points).any()


# ------------------------------------------------------------------ error


def test_error_policy_names_the_rows():
    rows = [*FOUR_CORNERS, [9, 9, 5], [0, 0, 1.5], [9, 9, 6]]
    with pytest.raises(ts.PointsError) as caught:
        ts.triangulate(rows, duplicates="error")
    assert "3 of 7 rows repeat" in str(caught.value)
    assert "rows 0, 5 at x 0.0, y 0.0 with elevations 1, 1.5" in str(caught.value)
    assert caught.value.rows == (0, 5)


def test_error_policy_accepts_distinct_rows():
    assert len(ts.triangulate(FOUR_CORNERS, duplicates="error").points) == 4


def test_error_policy_refuses_snapped_rows_too():
    with pytest.raises(ts.PointsError, match=r"1 of 5 rows .*rows 0, 4"):
        ts.triangulate([*FOUR_CORNERS, [0.1, 0, 1]], duplicates="error", snap=0.5)


@pytest.mark.parametrize("policy", ["median", "", None, 1])
def test_other_policies_are_refused(policy):
    with pytest.raises(ts.OptionError, match=r"duplicates .* mean, first, last"):
        ts.triangulate(FOUR_CORNERS, duplicates=policy)


@pytest.mark.parametrize("snap", [-1, math.nan, math.inf, "1", None])
def test_other_snaps_are_refused(snap):
    with pytest.raises(ts.OptionError, match=r"snap .* >= 0"):
        ts.triangulate(FOUR_CORNERS, snap=snap)


# ------------------------------------------------------------------ snap


def squared_distance(p, q):
    (px, py), (qx, qy) = oracles.place(p), oracles.place(q)
    return (px - qx) ** 2 + (py - qy) ** 2


def kept_by_definition(rows, snap):
    """Places in lexicographic order, each if no earlier one that is kept is within the snap."""
    kept, limit = [], Fraction(snap) ** 2
    for row in sorted({row[:2] for row in rows}):
        if all(squared_distance(row, other) > limit for other in kept):
            kept.append(row)
    return kept


def snapped_or_none(rows, snap):
    try:
        return ts.triangulate(rows, snap=snap)
    except ts.PointsError:
        assert oracles.are_collinear(kept_by_definition(rows, snap))
        return None


eighths = st.integers(0, 40).map(lambda value: value / 8)


@given(
    st.lists(st.tuples(eighths, eighths, heights), min_size=5, max_size=40),
    st.sampled_from([0.125, 0.25, 0.375, 0.5, 0.625, 1.0, 1.25]),
)
def test_snap_holds_for_every_pair(rows, snap):
    tin = snapped_or_none(rows, snap)
    if tin is None:
        return
    limit = Fraction(snap) ** 2
    for p, q in combinations(tin.points, 2):
        assert squared_distance(p, q) > limit
    for row, vertex in zip(rows, tin.vertex_of, strict=True):
        assert squared_distance(row, tin.points[vertex]) <= limit
    kept = kept_by_definition(rows, snap)
    assert sorted(tuple(p) for p in tin.points[:, :2].tolist()) == kept
    assert check(tin, points=rows).ok


@given(
    st.lists(st.tuples(eighths, eighths, heights), min_size=5, max_size=40),
    st.sampled_from([0.125, 0.5, 0.625, 1.0]),
    st.randoms(use_true_random=False),
)
def test_snap_does_not_depend_on_the_order_of_rows(rows, snap, random):
    tin = snapped_or_none(rows, snap)
    shuffled = random.sample(rows, len(rows))
    again = snapped_or_none(shuffled, snap)
    assert (tin is None) == (again is None)
    if tin is not None:
        assert sorted(tin.points.tolist()) == sorted(again.points.tolist())


def test_snap_of_a_crowd_at_utm_coordinates():
    """5,000 points on 10 m by 10 m, snapped to 0.2 m: across all cell borders, all pairs."""
    rng = np.random.default_rng(2)
    rows = np.column_stack([rng.random((5000, 2)) * 10 + np.array([5e5, 4e6]), rng.random(5000)])
    tin = ts.triangulate(rows, snap=0.2)
    x, y = tin.points[:, 0], tin.points[:, 1]
    distance = np.hypot(x[:, None] - x, y[:, None] - y)
    np.fill_diagonal(distance, np.inf)
    assert distance.min() > 0.2
    moved = np.hypot(*(tin.points[tin.vertex_of, :2] - rows[:, :2]).T)
    assert moved.max() <= 0.2
    assert 500 < len(tin.points) < 5000
    assert check(tin, points=rows).ok


def test_snapped_rows_are_reported_with_their_shift():
    rows = [[0, 0, 10], [8, 0, 10], [0, 8, 10], [0.3, 0.4, 20]]
    (merge,) = ts.triangulate(rows, snap=0.5).report.merges()
    assert merge == (0, (0, 3), (10.0, 20.0), (0.0, 0.5), 15.0)


def test_points_exactly_the_snap_apart_are_merged():
    rows = [[0, 0, 0], [8, 0, 0], [0, 8, 0], [3, 4, 0]]
    assert len(ts.triangulate(rows, snap=5).points) == 3
    assert len(ts.triangulate(rows, snap=np.nextafter(5, 0)).points) == 4


def test_chains_are_not_swallowed():
    """A chain of points each within the snap of the next keeps every second one."""
    rows = [[x, 0, 0] for x in range(10)] + [[0, 50, 0]]
    tin = ts.triangulate(rows, snap=1)
    assert tin.points[:, 0].tolist() == [0, 2, 4, 6, 8, 0]


def test_snap_zero_merges_exact_repeats_only():
    apart = np.nextafter(1.0, 2.0)
    rows = [[0, 0, 0], [1, 0, 0], [apart, 0, 0], [1, 0, 4], [0, 1, 0]]
    tin = ts.triangulate(rows, snap=0)
    assert tin.vertex_of.tolist() == [0, 1, 2, 1, 3]


def test_the_report_tells_what_the_reader_left_out_and_assumed():
    survey = ts.Survey(
        points=np.array([[0.0, 0, 1], [1, 0, 2], [0, 1, 3]]),
        skipped={"comment lines": 2},
        notes=("columns taken as PNEZD",),
    )
    told = ts.triangulate(survey).report.to_dict()
    assert told["skipped"] == {"comment lines": 2}
    assert told["notes"] == ["columns taken as PNEZD"]


@pytest.mark.parametrize("share", [0.01, 0.5, 3.0])
def test_repeated_rows_do_not_show_in_the_triangles(share):
    rng = np.random.default_rng(4)
    points = rng.integers(0, 60, (2_000, 3)).astype(float)
    alone = ts.triangulate(points[np.sort(np.unique(points[:, :2], axis=0, return_index=True)[1])])
    again = np.concatenate([points, points[rng.integers(0, 2_000, int(2_000 * share))]])
    tin = ts.triangulate(again)
    np.testing.assert_array_equal(tin.triangles, alone.triangles)
    np.testing.assert_array_equal(tin.neighbors, alone.neighbors)


@pytest.mark.parametrize("options", [{"snap": 0.1}, {"breaklines": [[[0, 0, 1], [5, 5, 1]]]}])
def test_error_policy_with_snap_or_lines_and_no_duplicates(options):
    points = [[0, 0, 1], [5, 0, 1], [0, 5, 1], [5, 5, 1]]
    tin = ts.triangulate(points, duplicates="error", **options)
    assert len(tin.points) == 4
    with pytest.raises(ts.PointsError, match="1 of 5 rows repeats the place"):
        ts.triangulate([*points, [5, 5, 2]], duplicates="error", **options)


@pytest.mark.parametrize(
    ("heights", "mean"),
    [([1e300, -1e300], 0.0), ([1e300] * 5, 1e300), ([6e299, 9e299, 9e299], 8e299)],
)
def test_mean_of_the_largest_elevations_does_not_overflow(heights, mean):
    corners = [[4.0, 0.0, 1.0], [0.0, 4.0, 2.0]]
    tin = ts.triangulate([*corners, *([0.0, 0.0, z] for z in heights)])
    assert tin.points[2, 2] == pytest.approx(mean, rel=1e-15)


@pytest.mark.parametrize("seed", range(20))
def test_means_of_elevations_of_any_size_are_the_exact_ones_rounded(seed):
    """Of two to nine rows a place, up to the largest elevation of either sign."""
    rng = np.random.default_rng(seed)
    largest = LARGEST_ELEVATION * rng.choice([1.0, 0.9, 0.5, 0.26, 1e-300])
    z = rng.choice([-1.0, 1.0, 0.99, -0.3], 30) * largest
    place = rng.integers(0, 6, 30)
    corners = [[-9, -9, 0], [20, -9, 0], [0, 20, 0]]
    rows = np.concatenate([corners, np.column_stack([place, place % 3, z])])
    tin = ts.triangulate(rows)
    for one in np.unique(place):
        own = z[place == one]
        exact = sum(map(Fraction, own.tolist())) / len(own)
        found = Fraction(float(tin.points[tin.vertex_of[3 + np.argmax(place == one)], 2]))
        rounding = Fraction(float(np.spacing(np.abs(own).max() / 2)))
        assert abs(found - exact) <= 32 * rounding
