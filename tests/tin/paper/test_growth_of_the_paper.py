"""The paper's algorithms as written: where they are right, where they are wrong, that they end."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay
from support import oracles, point_sets
from support.each_value import list_seeds

import tinsmith as ts
from tinsmith.tin import OptionError, PointsError, paper
from tinsmith.tin.paper.rules import _measure_cotangents, widest_angle, widest_angle_then_closest

BOTH = [paper.original, paper.improved]
TIES = partial(paper.improved, distance="ties")
ALL = [*BOTH, partial(paper.improved, empty="open"), TIES]

CLOSEST_IS_NOT_DELAUNAY = [(0, 0), (0, 1), (0, 2), (1, 3), (3, 3)]
ANGLE_RULE_CROSSES_ITSELF = [(3, 0), (0, 2), (3, 3), (1, 2), (2, 2), (2, 1)]
DISTANCE_RULE_CROSSES_ITSELF = [
    (0, 2), (0, 3), (2, 1), (1, 1), (3, 3), (0, 1), (2, 0), (0, 0)
]  # fmt: skip


def flat(places):
    return np.array([(x, y, 0.0) for x, y in places], float)


def random_points(n, seed=0):
    return np.random.default_rng(seed).random((n, 3))


def places_of(network):
    return [oracles.place(point) for point in network.points]


def violating(network):
    """Triangles with a point strictly in their circle, by exact fractions."""
    places = places_of(network)
    return [
        tuple(triangle)
        for triangle in network.triangles.tolist()
        if any(oracles.in_circle(*(places[v] for v in triangle), place) > 0 for place in places)
    ]


def share_area(first, second):
    """Whether two counter-clockwise triangles overlap: no edge separates them."""
    for one, other in ((first, second), (second, first)):
        for k in range(3):
            a, b = one[k], one[(k + 1) % 3]
            if all(oracles.orientation(a, b, corner) <= 0 for corner in other):
                return False
    return True


def overlaps(network):
    places = places_of(network)
    corners = [[places[v] for v in triangle] for triangle in network.triangles.tolist()]
    return [pair for pair in itertools.combinations(corners, 2) if share_area(*pair)]


def edge_uses(triangles):
    uses = {}
    for a, b, c in np.asarray(triangles).tolist():
        for edge in ((a, b), (b, c), (c, a)):
            key = tuple(sorted(edge))
            uses[key] = uses.get(key, 0) + 1
    return uses


# ------------------------------------------------------------------ by the book


def widest(places, p1, p2, qualified):
    """Step 4, point by point: a later point must see the edge under a larger angle."""
    best = None
    for point in qualified:
        if best is None or oracles.in_circle(*(places[v] for v in (p2, p1, best, point))) > 0:
            best = point
    return best


def closest(places, p1, p2, qualified):
    """The improvement, point by point: in the circle on the edge, closer than the last found."""
    best = None
    for point in qualified:
        (ax, ay), (bx, by) = (
            [a - b for a, b in zip(places[p], places[point], strict=True)] for p in (p1, p2)
        )
        distance = abs(ax * by - ay * bx)
        if ax * bx + ay * by <= 0 and (best is None or distance < best[0]):
            best = distance, point
    return None if best is None else best[1]


def widest_then_closest(places, p1, p2, qualified):
    """Section 5's reason, point by point: a larger angle wins, of equal ones the closer point."""
    best = None
    for point in qualified:
        wider = (
            1 if best is None else oracles.in_circle(*(places[v] for v in (p2, p1, best, point)))
        )
        if wider > 0 or (wider == 0 and above(places, p1, p2, point) < above(places, p1, p2, best)):
            best = point
    return best


def above(places, p1, p2, point):
    """The height of a point above an edge, in lengths of the edge."""
    (ax, ay), (bx, by), (x, y) = (places[v] for v in (p1, p2, point))
    return abs((Fraction(bx) - ax) * (Fraction(y) - ay) - (Fraction(by) - ay) * (Fraction(x) - ax))


def closest_or_widest(places, p1, p2, qualified):
    point = closest(places, p1, p2, qualified)
    return widest(places, p1, p2, qualified) if point is None else point


def by_the_book(places, first, rule, *, removal):
    """The paper's steps in plain loops and exact numbers, from a given first triangle."""
    network, uses, deleted = [first], edge_uses([first]), set()
    for a, b, c in network:
        for p1, p2 in ((a, b), (b, c), (c, a)):
            qualified = [
                point
                for point in range(len(places))
                if point not in deleted
                and uses[tuple(sorted((p1, p2)))] < 2
                and oracles.orientation(places[p1], places[p2], places[point]) < 0
                and uses.get(tuple(sorted((p1, point))), 0) < 2
                and uses.get(tuple(sorted((p2, point))), 0) < 2
            ]
            point = rule(places, p1, p2, qualified)
            if point is not None:
                network.append((p2, p1, point))
                uses = edge_uses(network)
                if removal:
                    deleted = finished(uses)
    return network


def finished(uses):
    once = {v for edge, count in uses.items() if count < 2 for v in edge}
    return {v for edge in uses for v in edge} - once


@pytest.mark.each_value
@pytest.mark.parametrize("removal", [True, False])
@pytest.mark.parametrize(
    ("grow", "rule"),
    list(zip(ALL, [widest, closest_or_widest, closest, widest_then_closest], strict=True)),
    ids=["original", "improved", "open", "ties"],
)
@settings(max_examples=20)
@given(
    places=point_sets.places(st.integers(0, 6), 10, least=4).filter(
        lambda places: any(oracles.orientation(*places[:2], one) for one in places)
    )
)
def test_every_triangle_is_the_one_of_the_steps(grow, rule, removal, places):
    network = grow(flat(places), removal=removal)
    first, *_ = network.triangles.tolist()
    expected = by_the_book(places, tuple(first), rule, removal=removal)
    assert [tuple(one) for one in network.triangles.tolist()] == expected


# ------------------------------------------------------------------ the original


@pytest.mark.parametrize("seed", list_seeds(5, few=2))
def test_original_is_delaunay_of_random_points(seed):
    points = random_points(300, seed)
    grown = oracles.canonical(paper.original(points).triangles)
    turned = Delaunay(points[:, :2]).simplices
    assert {tuple(sorted(one)) for one in grown} == {tuple(sorted(one)) for one in turned.tolist()}
    assert grown == oracles.canonical(ts.triangulate(points).triangles)


def test_original_equals_the_definition_by_brute_force():
    points = random_points(25, 7)
    assert oracles.canonical(paper.original(points).triangles) == oracles.delaunay(points)


def test_original_at_utm_coordinates_far_from_the_origin():
    points = random_points(200, 3) * 50 + [752_000, 4_024_000, 300]
    grown = oracles.canonical(paper.original(points).triangles)
    assert grown == oracles.canonical(ts.triangulate(points).triangles)


def test_original_with_a_point_almost_on_the_edge():
    points = flat([(0, 0), (1, 0), (0.5, 2**-40), (0.5, 1), (0.5, -1)])
    assert oracles.canonical(paper.original(points).triangles) == oracles.delaunay(points)


def test_original_crosses_itself_where_four_points_lie_on_a_circle():
    network = paper.original(flat(ANGLE_RULE_CROSSES_ITSELF))
    places = places_of(network)
    ties = [
        four
        for four in itertools.combinations(sorted(places), 4)
        if oracles.orientation(*four[:3]) and oracles.in_circle(*four) == 0
    ]
    assert ties
    at_fault = [{places[v] for v in triangle} for triangle in violating(network)]
    crossing = [pair for pair in overlaps(network) if not any(set(one) in at_fault for one in pair)]
    assert any(tuple(sorted({*first, *second})) in ties for first, second in crossing)
    assert len(network.triangles) > 2 * 6 - 2 - oracles.hull_size(network.points)


# ------------------------------------------------------------------ the improved


def test_closest_in_circle_is_not_always_delaunay():
    network = paper.improved(flat(CLOSEST_IS_NOT_DELAUNAY))
    assert len(network.triangles) == 2 * 5 - 2 - oracles.hull_size(network.points) == 3
    assert overlaps(network) == []
    assert len(violating(network)) == 2
    assert violating(paper.original(flat(CLOSEST_IS_NOT_DELAUNAY))) == []


@pytest.mark.slow
def test_no_four_points_contradict_closest_in_circle():
    """Five points are the fewest: with four, an edge never has two points to choose from."""
    for four in itertools.combinations(itertools.product(range(3), range(4)), 4):
        if any(oracles.orientation(*three) for three in itertools.combinations(four, 3)):
            assert violating(paper.improved(flat(four))) == []


def test_improved_breeds_overlaps_on_random_points():
    network = paper.improved(random_points(75, 2))
    assert len(network.triangles) > 2 * len(network.points)
    assert len(network.unextended) > 0


def test_open_reading_stops_where_all_circles_are_empty():
    # An equilateral triangle's circles hold no corner; the points beyond are out of reach.
    points = flat([(0, 0), (4, 0), (2, 3.5), (2, -9), (-9, 6), (13, 6)])
    network = paper.improved(points, empty="open")
    assert len(network.triangles) == 1
    assert len(network.unextended) == 3
    assert len(paper.improved(points).triangles) == 7


# ------------------------------------------------------------------ distance breaks ties


@pytest.mark.parametrize("seed", list_seeds(12, few=4))
def test_ties_by_distance_are_delaunay_of_points_in_general_position(seed):
    points = random_points(100, seed)
    grown = oracles.canonical(TIES(points).triangles)
    assert grown == oracles.canonical(ts.triangulate(points).triangles)
    np.testing.assert_array_equal(TIES(points).triangles, paper.original(points).triangles)


def test_ties_by_distance_cross_each_other_where_each_edge_breaks_them_alone():
    network = TIES(flat(DISTANCE_RULE_CROSSES_ITSELF))
    assert len(overlaps(network)) > 0
    assert len(network.triangles) > 2 * 8 - 2 - oracles.hull_size(network.points)
    # The points on which the first of equals crosses itself are no trouble to it.
    assert overlaps(TIES(flat(ANGLE_RULE_CROSSES_ITSELF))) == []


def test_of_equal_angles_the_closer_point_is_taken_whatever_the_order():
    edge, near, far = [(0, 0), (8, 0)], (9, 3), (4, 8)  # on the circle about (4, 3)
    assert oracles.in_circle(*edge, near, far) == 0
    for order in ([near, far], [far, near]):
        points = flat([*edge, *order])
        xy = points[:, 0].copy(), points[:, 1].copy()
        choice = widest_angle_then_closest(xy, 0, 1, np.array([2, 3]))
        assert order[choice.point - 2] == near
        assert choice.tests == 1
        assert widest_angle(xy, 0, 1, np.array([2, 3])).point == 2


def test_of_equal_angles_the_first_is_taken_though_rounded_measure_cotangents_differ():
    circle = [
        (x, y) for x, y in itertools.product(range(-65, 66), repeat=2) if x * x + y * y == 4225
    ]
    left = [place for place in circle if place[1] > 16]
    rng, differ = np.random.default_rng(3), 0
    for _ in range(40):
        # So large that products are rounded, while the places stay exact, and on a circle.
        places = 3.0**17 * np.array([(-63, 16), (63, 16), *rng.permutation(left)])
        xy = places[:, 0].copy(), places[:, 1].copy()
        qualified = np.arange(2, len(places))
        differ += int(np.argmin(_measure_cotangents(xy, 0, 1, qualified))) != 0
        assert widest_angle(xy, 0, 1, qualified).point == 2
    assert differ > 10


# ------------------------------------------------------------------ the criteria


def smallest_angle(corners):
    angles = []
    for k in range(3):
        (x, y), (bx, by), (cx, cy) = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
        angles.append(math.atan2(by - y, bx - x) - math.atan2(cy - y, cx - x))
    return math.degrees(min(min(abs(a), 2 * math.pi - abs(a)) for a in angles))


def test_delaunay_has_the_largest_smallest_angle_but_not_the_largest_sum_of_them():
    a, b, c, d = places = [(0, 0), (0, 1), (1, 2), (2, 0)]
    delaunay = [[places[v] for v in one] for one in paper.original(flat(places)).triangles.tolist()]
    others = [[a, d, c], [a, c, b]]
    assert {frozenset(one) for one in delaunay}.isdisjoint({frozenset(one) for one in others})
    right, wrong = ([smallest_angle(one) for one in two] for two in (delaunay, others))
    assert min(right) > min(wrong) + 8
    assert sum(right) < sum(wrong) - 8


# ------------------------------------------------------------------ removal


@pytest.mark.parametrize("n", [50, 400])
def test_removal_lowers_the_candidates_and_changes_no_triangle(n):
    points = random_points(n, 1)
    removed, kept = paper.original(points), paper.original(points, removal=False)
    np.testing.assert_array_equal(removed.triangles, kept.triangles)
    assert removed.searches == kept.searches
    assert removed.candidates < 0.8 * kept.candidates
    assert kept.candidates == kept.candidates_without_removal == kept.searches * (n - 2)
    assert removed.candidates_without_removal == kept.candidates
    assert removed.tests < kept.tests


def test_counts_of_the_smallest_network():
    network = paper.original(flat([(0, 0), (1, 0), (0, 1)]))
    assert (network.searches, network.candidates, network.tests) == (3, 3, 0)
    assert len(network.unextended) == 0


def test_counts_of_two_triangles():
    # Three edges of the first triangle and two of the second are searched; one finds a point.
    network = paper.original(flat([(0, 0), (1, 0), (0, 1), (5, 6)]))
    assert network.triangles.tolist() == [[0, 1, 2], [2, 1, 3]]
    assert (network.searches, network.candidates, network.tests) == (5, 10, 0)


# ------------------------------------------------------------------ always ends, is honest


@pytest.mark.parametrize("grow", ALL)
@settings(max_examples=25)
@given(places=point_sets.places(st.integers(0, 4), 12, unique=False))
def test_ends_on_small_grids_and_uses_no_edge_thrice(grow, places):
    distinct = list(dict.fromkeys(places))
    try:
        network = grow(flat(places))
    except PointsError:
        assert not any(oracles.orientation(*three) for three in itertools.combinations(distinct, 3))
        return
    assert places_of(network) == distinct
    uses = edge_uses(network.triangles)
    assert max(uses.values()) <= 2
    for triangle in network.triangles.tolist():
        assert oracles.orientation(*(distinct[v] for v in triangle)) > 0
    inner = {
        edge
        for edge, count in uses.items()
        if count == 1
        and {oracles.orientation(distinct[edge[0]], distinct[edge[1]], place) for place in distinct}
        >= {-1, 1}
    }
    assert {tuple(edge) for edge in network.unextended.tolist()} == inner


@pytest.mark.parametrize("grow", BOTH)
def test_raster_is_covered_whole(grow):
    y, x = np.mgrid[0:8, 0:9]
    network = grow(flat(zip(x.ravel(), y.ravel(), strict=True)))
    assert len(network.triangles) == 2 * 7 * 8
    assert overlaps(network) == []


def test_growth_stops_at_the_number_of_triangles_allowed():
    points = random_points(75, 2)
    whole, part = paper.improved(points), paper.improved(points, most_triangles=100)
    assert not whole.is_stopped
    assert part.is_stopped
    np.testing.assert_array_equal(part.triangles, whole.triangles[:100])


def test_duplicates_are_one_point():
    points = random_points(30, 5)
    network = paper.original(np.concatenate([points, points[::-1]]))
    np.testing.assert_array_equal(network.points, points)
    np.testing.assert_array_equal(network.triangles, paper.original(points).triangles)


@pytest.mark.parametrize("grow", ALL)
@pytest.mark.parametrize(
    "points",
    [
        np.empty((0, 3)),
        flat([(1, 1)]),
        flat([(1, 1), (2, 2)]),
        flat([(1, 1), (1, 1), (2, 2), (2, 2)]),
        flat([(0, 0), (1, 1), (2, 2), (7, 7)]),
    ],
    ids=["none", "one", "two", "two places", "collinear"],
)
def test_points_without_a_triangle_are_refused(grow, points):
    with pytest.raises(PointsError, match="not collinear"):
        grow(points)


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e200])
def test_coordinates_out_of_range_are_refused(bad):
    with pytest.raises(PointsError):
        paper.original([[0, 0, 0], [1, 0, 0], [bad, 1, 0]])


def test_unknown_reading_is_refused():
    with pytest.raises(OptionError, match="one of angle, open"):
        paper.improved(flat(CLOSEST_IS_NOT_DELAUNAY), empty="widen")


def test_repr_is_one_line():
    network = paper.original(flat([(0, 0), (1, 0), (0, 1)]))
    assert repr(network) == "<Network: 3 points, 1 triangle, 0 edges not extended>"


def test_measure_cotangents_are_those_of_the_angles():
    rng = np.random.default_rng(9)
    xy = rng.uniform(-5, 5, (2, 80))
    found = _measure_cotangents(tuple(xy), 0, 1, np.arange(2, 80))
    a, b = xy[:, [0]] - xy[:, 2:], xy[:, [1]] - xy[:, 2:]
    turn = np.arctan2(a[1], a[0]) - np.arctan2(b[1], b[0])
    angle = np.abs(np.remainder(turn + np.pi, 2 * np.pi) - np.pi)
    np.testing.assert_allclose(found, 1 / np.tan(angle), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(30))
def test_the_widest_angle_is_exact_among_points_that_are_cocircular_but_for_rounding(seed):
    """Rounded cotangents put several in a wrong order: exact tests must go on to the best."""
    rng = np.random.default_rng(seed)
    angle = np.concatenate([[3.5, 5.9], rng.uniform(0.1, 3.0, 40)])
    radius = 1.0 + rng.integers(-3, 4, 42) * 1e-15
    xy = np.stack([radius * np.cos(angle) + 7e5, radius * np.sin(angle) + 4e6])
    _, first = np.unique(xy, axis=1, return_index=True)
    xy = np.ascontiguousarray(xy[:, np.sort(first)])
    qualified = np.arange(2, xy.shape[1])
    places = [oracles.place([*one, 0.0]) for one in xy.T]
    wanted = next(
        p
        for p in qualified
        if all(
            oracles.in_circle(places[0], places[1], places[p], places[q]) <= 0 for q in qualified
        )
    )
    choice = widest_angle((xy[0], xy[1]), 0, 1, qualified)
    assert choice.point == wanted
    assert choice.tests == len(qualified) - 1
