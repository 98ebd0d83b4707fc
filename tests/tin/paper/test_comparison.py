"""The comparison's figures, each against a second opinion."""

from __future__ import annotations

import json
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import shapely
from support import oracles

import tinsmith as ts
from tinsmith.tin import PointsError, compare, paper
from tinsmith.tin.meshing.shape_quality import measure_smallest_angles
from tinsmith.tin.paper.cover import cover
from tinsmith.tin.paper.faults import find_overlapping, find_violating

SURVEY = Path(__file__).parents[3] / "sample_data" / "site_survey.csv"
NAMES = ("original", "improved", "improved (open)", "improved (ties)", "exact")
WHOLE = 75, 1  # points and seed of which the improved algorithm makes a triangulation
OVERLAPS = 75, 2  # and of which it does not


def random_points(n, seed=0):
    return np.random.default_rng(seed).random((n, 3))


@pytest.fixture(scope="module")
def compared():
    return compare(random_points(*OVERLAPS))


def polygons(points, triangles):
    return shapely.polygons(points[triangles][..., :2])


# ------------------------------------------------------------------ areas of overlap and gap


def areas_by_shapely(points, triangles):
    """Return the area covered more than once, and what is missing to the convex hull."""
    shapes = polygons(points, triangles)
    first, second = shapely.STRtree(shapes).query(shapes)
    both = shapely.intersection(shapes[first], shapes[second])[first < second]
    hull = shapely.convex_hull(shapely.multipoints(points[:, :2]))
    return shapely.union_all(both).area, hull.area - shapely.union_all(shapes).area


@pytest.mark.each_value
@pytest.mark.parametrize(("n", "seed"), [(30, 0), (30, 7), (50, 35), (60, 19), (75, 2)])
@pytest.mark.parametrize("empty", ["angle", "open"])
def test_areas_are_those_of_shapely(n, seed, empty):
    points = random_points(n, seed)
    network = paper.improved(points, empty=empty)
    found = cover(points, network.triangles, ts.triangulate(points).hull)
    assert found == pytest.approx(areas_by_shapely(points, network.triangles), rel=1e-4, abs=1e-9)


def test_some_of_these_overlap_and_some_leave_gaps(compared):
    assert compared.outcomes[1].overlap > 0.1
    assert compared.outcomes[2].gap > 0.1


def test_areas_of_any_heap_of_triangles():
    rng = np.random.default_rng(8)
    points = rng.random((40, 3))
    heap = np.array([rng.choice(40, 3, replace=False) for _ in range(25)], np.int32)
    heap = turned(points, heap)
    found = cover(points, heap, ts.triangulate(points).hull)
    assert found == pytest.approx(areas_by_shapely(points, heap), rel=1e-3)


def turned(points, triangles):
    """Triangles turned counter-clockwise."""
    a, b, c = (points[triangles[:, k], :2] for k in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    return np.where((area > 0)[:, None], triangles, triangles[:, [0, 2, 1]])


def test_areas_of_a_triangulation_are_exactly_zero():
    for points in (random_points(200), ts.read(SURVEY).points):
        tin = ts.triangulate(points)
        assert cover(tin.points, tin.triangles, tin.hull) == (0.0, 0.0)


def test_area_of_one_triangle_left_out_or_doubled():
    tin = ts.triangulate(random_points(200) + np.array([752_000, 4_024_000, 0]))
    for one in range(0, len(tin.triangles), 97):
        area = tin.triangle_areas[one]
        without = np.delete(tin.triangles, one, axis=0)
        twice = np.concatenate([tin.triangles, tin.triangles[one : one + 1]])
        assert cover(tin.points, without, tin.hull) == pytest.approx((0.0, area), rel=1e-6)
        assert cover(tin.points, twice, tin.hull) == pytest.approx((area, 0.0), rel=1e-6)


# ------------------------------------------------------------------ triangles at fault


@pytest.mark.parametrize(("n", "seed"), [(30, 7), (40, 9), (50, 1)])
def test_triangles_at_fault_are_those_of_the_definitions(n, seed):
    points = random_points(n, seed)
    triangles = paper.improved(points).triangles
    places = [oracles.place(point) for point in points]
    for triangle, is_violating in zip(triangles, find_violating(points, triangles), strict=True):
        corners = [places[v] for v in triangle]
        assert is_violating == any(oracles.in_circle(*corners, place) > 0 for place in places)
    shapes = polygons(points, triangles)
    for shape, is_overlapping in zip(shapes, find_overlapping(points, triangles), strict=True):
        shared = shapely.area(shapely.intersection(shape, shapes))
        assert is_overlapping == (np.count_nonzero(shared > 1e-12) > 1)


def test_overlaps_are_found_among_very_many():
    """More triangles at one place than are looked at in one go, but for one that lies apart."""
    corners = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [20, 0, 0], [29, 0, 0], [20, 9, 0]]
    heap = np.array([[0, 1, 2]] * 700 + [[3, 4, 5]], np.int32)
    found = find_overlapping(np.array(corners, float), heap)
    assert found[:700].all()
    assert not found[700]


def test_touching_triangles_do_not_overlap():
    points = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 0], [2, 2, 0], [5, 5, 0]], float)
    heap = np.array([[0, 1, 2], [4, 1, 3], [2, 4, 3], [3, 5, 2]], np.int32)
    assert not find_overlapping(points, heap).any()


def test_minimum_angles_of_known_triangles():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, np.sqrt(0.75), 0], [9, 0.001, 0]])
    angles = measure_smallest_angles(points[np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]]), :2])
    assert angles == pytest.approx(
        [45, 60, np.degrees(np.arctan(0.001 / 8) - np.arctan(0.001 / 9))]
    )


# ------------------------------------------------------------------ the comparison


def test_comparison_holds_the_four_outcomes(compared):
    points = random_points(*OVERLAPS)
    assert tuple(one.name for one in compared.outcomes) == NAMES
    networks = [paper.original(points), paper.improved(points)]
    networks.append(paper.improved(points, empty="open"))
    networks.append(paper.improved(points, distance="ties"))
    for outcome, network in zip(compared.outcomes, networks, strict=False):
        np.testing.assert_array_equal(outcome.triangles, network.triangles)
        assert outcome.tests == network.tests
        assert outcome.candidates == network.candidates


def test_exact_and_original_have_no_fault_and_all_triangles(compared):
    original, *_, exact = compared.outcomes
    due = 2 * 75 - 2 - oracles.hull_size(compared.points)
    for one in (original, exact):
        assert len(one.triangles) == compared.expected == due
        assert not one.violating.any()
        assert not one.overlapping.any()
        assert (one.overlap, one.gap, len(one.unextended)) == (0.0, 0.0, 0)
    assert oracles.canonical(original.triangles) == oracles.canonical(exact.triangles)


def test_removal_lowers_what_is_searched(compared):
    original, *_, exact = compared.outcomes
    assert original.candidates < original.candidates_without_removal
    assert (
        original.candidates_without_removal
        == paper.original(compared.points, removal=False).candidates
    )
    assert exact.candidates < original.candidates
    assert exact.candidates_without_removal is None


def test_as_many_triangles_may_still_not_be_delaunay():
    found = compare(random_points(*WHOLE)).outcomes[1]
    assert found.overlap == found.gap == 0.0
    assert not found.overlapping.any()
    assert found.violating.any()


@pytest.mark.slow
def test_growth_that_breeds_is_stopped_and_says_so(compared):
    points = random_points(100, 46)
    found = compare(points).outcomes[1]
    assert found.is_stopped
    assert len(found.triangles) == 4 * 100
    assert not compared.outcomes[1].is_stopped


def test_to_dict_is_plain_and_adds_up(compared):
    facts = json.loads(json.dumps(compared.to_dict()))
    assert facts["points"] == 75
    assert [one["name"] for one in facts["outcomes"]] == list(NAMES)
    for one, outcome in zip(facts["outcomes"], compared.outcomes, strict=True):
        assert sum(one["minimum_angle"]["counts"]) == one["triangles"] == len(outcome.triangles)
        assert one["overlapping"] == outcome.overlapping.sum()
        assert one["seconds"] > 0
        assert one["memory"] > outcome.triangles.nbytes


@pytest.mark.slow
def test_memory_grows_with_what_is_kept():
    small, large = (compare(random_points(n)).outcomes[0].memory for n in (20, 160))
    assert large > 4 * small


def test_tracing_that_was_on_stays_on():
    tracemalloc.start()
    try:
        compare(random_points(10))
        assert tracemalloc.is_tracing()
    finally:
        tracemalloc.stop()
    compare(random_points(10))
    assert not tracemalloc.is_tracing()


def test_survey_and_duplicates_are_taken():
    points = random_points(20)
    survey = ts.Survey(points=np.concatenate([points, points]))
    np.testing.assert_array_equal(compare(survey).points[:, :2], points[:, :2])


def test_equilateral_triangles_are_in_the_last_class():
    points = [[x + 0.5 * (y % 2), y * np.sqrt(0.75), 0] for x in range(4) for y in range(4)]
    counts = compare(points).outcomes[-1].angle_counts
    assert counts.sum() == compare(points).expected
    assert counts[-1] >= 18


@pytest.mark.parametrize("points", [[], [[0, 0, 0], [1, 1, 1]], [[0, 0, 0], [1, 1, 1], [2, 2, 0]]])
def test_points_without_a_triangle_are_refused(points):
    with pytest.raises(PointsError):
        compare(np.reshape(points, (-1, 3)))


def test_too_many_points_are_refused_with_a_sentence():
    with pytest.raises(PointsError, match=r"31 points are too many .* at most 30 are allowed"):
        compare(random_points(31), limit=30)
    assert len(compare(random_points(30), limit=30).points) == 30


def test_repr_is_one_line(compared):
    assert repr(compared).startswith("<Comparison: 75 points, ")
    assert "\n" not in repr(compared)
