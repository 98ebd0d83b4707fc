"""Crossings and touches of segments: the search against every pair in rational arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import line_oracle
from support.line_oracle import places_of
from support.point_sets import UTM_CORNER, seeds, small_integers, utm_raster

from tinsmith.tin import _kernel

DATA = ["small_grid", "utm_raster", "one_line", "near_line", "huge", "bundle"]


def as_pairs(segments):
    return np.asarray(segments, np.int32).reshape(-1, 2)


def drawn(name, rng):
    """Distinct places and segments between them, some of them twice or without length."""
    if name == "bundle":
        return bundle(rng, 8)
    xy = {
        "small_grid": lambda: small_integers(rng, 24),
        "utm_raster": lambda: utm_raster(rng, 24),
        "one_line": lambda: np.repeat(rng.integers(0, 20, (14, 1)), 2, axis=1) * [0.1, 0.3],
        "near_line": lambda: near_line(rng, 16),
        "huge": lambda: rng.integers(-2, 3, (16, 2)) * 1e70,
    }[name]()
    xy = np.unique(xy, axis=0) + 0.0
    return xy, as_pairs(rng.integers(0, len(xy), (rng.integers(0, 30), 2)))


def near_line(rng, n):
    x = rng.random(n)
    return np.column_stack([x, 3 * x + rng.integers(-2, 3, n) * 2.0**-51])


def bundle(rng, n):
    """Nearly parallel segments a few roundings apart, at UTM_CORNER coordinates."""
    noise = rng.integers(-4, 5, (n, 2, 2)) * 2.0**-30
    ends = np.array([[0, 0], [300.0, 100.0]]) + UTM_CORNER + noise
    xy, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    return xy, as_pairs(number)


@settings(max_examples=60)
@given(seeds, st.sampled_from(DATA), st.integers(1, 3))
def test_contacts_of_all_pairs(seed, name, threads):
    xy, segments = drawn(name, np.random.default_rng(seed))
    places = places_of(xy)
    crossings = line_oracle.crossings(places, segments.tolist())
    touches = line_oracle.touches(places, segments.tolist())
    assert _kernel.crossings(xy, segments, threads=threads).tolist() == crossings
    assert _kernel.touches(xy, segments, threads=threads).tolist() == touches
    together = _kernel.contacts(xy, segments, threads=threads)
    assert [pairs.tolist() for pairs in together] == [crossings, touches]


@settings(max_examples=60)
@given(seeds, st.sampled_from(DATA))
def test_only_what_is_new(seed, name):
    rng = np.random.default_rng(seed)
    xy, segments = drawn(name, rng)
    first = int(rng.integers(0, len(segments) + 2))
    new = [pair for pair in _kernel.crossings(xy, segments).tolist() if pair[1] >= first]
    assert _kernel.crossings(xy, segments, first).tolist() == new
    first = int(rng.integers(0, len(xy) + 2))
    new = [pair for pair in _kernel.touches(xy, segments).tolist() if pair[1] >= first]
    assert _kernel.touches(xy, segments, 0.0, first).tolist() == new


def test_many_short_segments_among_long_ones():
    """Thousands in the tree, places that a raster must not rule out; against every pair."""
    rng = np.random.default_rng(1)
    start = rng.integers(0, 250, (800, 2))
    ends = np.stack([start, start + rng.integers(-9, 10, (800, 2))], axis=1)
    ends[:20] = rng.integers(0, 250, (20, 2, 2))
    mass = rng.integers(0, 250, (6000, 2))
    xy, number = np.unique(np.vstack([ends.reshape(-1, 2), mass]), axis=0, return_inverse=True)
    segments = as_pairs(number.ravel()[:1600])
    crossings, touches = every_pair(xy, segments)
    xy = xy * 0.5 + UTM_CORNER
    assert len(crossings) > 50
    assert len(touches) > 50
    for threads in (1, 3):
        np.testing.assert_array_equal(_kernel.crossings(xy, segments, threads=threads), crossings)
        np.testing.assert_array_equal(_kernel.touches(xy, segments, threads=threads), touches)
        together = _kernel.contacts(xy, segments, threads=threads)
        np.testing.assert_array_equal(together[0], crossings)
        np.testing.assert_array_equal(together[1], touches)


def every_pair(xy, segments):
    """Compare all with all, in integers small enough to be exact."""
    places = xy.astype(np.int64)
    a, b = places[segments[:, 0]], places[segments[:, 1]]

    def side(p):
        u, v = (b - a)[:, None], p[None] - a[:, None]
        return np.sign(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])

    parts = side(a) * side(b) < 0
    crossings = np.argwhere(np.triu(parts & parts.T))
    to_a, to_b = places[None] - a[:, None], places[None] - b[:, None]
    between = (to_a * to_b).sum(axis=2) < 0
    return crossings, np.argwhere((side(places) == 0) & between)


@pytest.mark.parametrize("steps", [[0, 1], [1, 0]])
def test_segment_through_a_thousand_collinear_vertices(steps):
    xy = np.arange(1002)[:, None] * [0.25, 0.75] + UTM_CORNER
    segments = as_pairs(np.array([0, 1001])[steps])
    assert _kernel.touches(xy, segments)[:, 1].tolist() == list(range(1, 1001))


# -------------------------------------------------------------------- within a distance


def near(p, distance, *, ends=((0, 0), (10, 0))):
    xy = np.array([*ends, p], float)
    found = []
    for order in ([0, 1], [1, 0]):
        segment = as_pairs(order)
        found.append(_kernel.touches(xy, segment, distance).tolist() == [[0, 2]])
        both = np.vstack([segment, as_pairs([2, 2])])  # as an end, too
        assert (_kernel.contacts(xy, both, distance)[1].tolist() == [[0, 2]]) == found[-1]
    assert found[0] == found[1]
    return found[0]


def test_distance_from_the_line_counts():
    assert near([5, 0.5], 0.5)
    assert near([5, -0.5], 0.5)
    assert not near([5, 0.5], 0.49)


def test_vertex_near_an_end_is_the_ends_affair():
    assert not near([0.3, 0.3], 0.5)
    assert not near([9.6, 0.1], 0.5)
    assert near([0.3, 0], 0.5)  # exactly on it
    assert near([9.6, 0], 0.5)
    assert near([0.6, 0.1], 0.5)


def test_vertex_beyond_an_end_touches_nothing():
    assert not near([-0.6, 0], 0.5)
    assert not near([10.6, 0.1], 0.5)
    assert not near([10, 0], 0.5, ends=((0, 0), (9, 0)))


def test_vertex_that_would_make_a_longer_part_touches_nothing():
    assert not near([0.9, 0.8], 0.85, ends=((0, 0), (1, 0)))
    assert near([0.5, 0.8], 0.85, ends=((0, 0), (1, 0)))


@settings(max_examples=80)
@given(seeds, st.sampled_from([0.1, 0.7, 1.5]), st.booleans())
def test_touches_within_a_distance_of_all_pairs(seed, distance, is_utm):
    rng = np.random.default_rng(seed)
    xy = rng.random((40, 2)) * 10 + (UTM_CORNER if is_utm else 0.0)
    segments = as_pairs(rng.integers(0, 20, (12, 2)))
    wanted = [
        [i, v]
        for i, (a, b) in enumerate(segments.tolist())
        for v in range(len(xy))
        if a != b and v not in (a, b) and is_near(*(xy[[a, b, v]] - xy[a]), distance)
    ]
    assert _kernel.touches(xy, segments, distance).tolist() == wanted
    assert _kernel.contacts(xy, segments, distance)[1].tolist() == wanted


def is_near(a, b, p, distance):
    length = np.hypot(*(b - a))
    to_a, to_b = np.hypot(*(p - a)), np.hypot(*(p - b))
    u, v = (b - a) / length, p - a
    return (
        distance < min(to_a, to_b)
        and max(to_a, to_b) < length
        and (abs(u[0] * v[1] - u[1] * v[0]) <= distance)
    )


@pytest.mark.parametrize(("units", "is_near"), [(1, True), (-1, True), (2, False), (-2, False)])
def test_a_rounding_counts_in_units_of_the_segments_own_coordinates(units, is_near):
    """A far outlier must not make other segments reach far."""
    ends = np.array([[0, 0], [8, 0]]) + UTM_CORNER
    beside = UTM_CORNER + np.array([4, units * np.spacing(UTM_CORNER[1])])
    xy = np.vstack([ends, beside, [1e20, 1e20]])
    segments = as_pairs([[0, 1], [3, 3]])
    found = _kernel.touches(xy, segments, is_rounded=True).tolist()
    assert found == ([[0, 2]] if is_near else [])
    assert _kernel.touches(xy, segments).tolist() == []


# -------------------------------------------------------------------- where they meet


@settings(max_examples=100)
@given(seeds, st.sampled_from(DATA))
def test_meeting_places_are_the_true_ones_rounded_once(seed, name):
    """Rectangles' diagonals meet in the middle between two doubles: rounded to even."""
    xy, segments = drawn(name, np.random.default_rng(seed))
    places = places_of(xy)
    pairs = _kernel.crossings(xy, segments)
    found = _kernel.intersections(xy, segments, pairs)
    for pair, met in zip(pairs, found.tolist(), strict=True):
        a, b, c, d = (places[v] for v in segments[pair].ravel())
        assert tuple(met) == line_oracle.meeting_place(a, b, c, d)


def test_meeting_places_do_not_depend_on_order_or_direction():
    rng = np.random.default_rng(2)
    xy = rng.random((200, 2)) * 100 + UTM_CORNER
    segments = as_pairs(np.arange(200))
    pairs = _kernel.crossings(xy, segments)
    found = _kernel.intersections(xy, segments, pairs)
    assert len(found) > 100
    flipped = np.ascontiguousarray(segments[:, ::-1])
    exchanged = np.ascontiguousarray(pairs[:, ::-1])
    for other in (
        _kernel.intersections(xy, flipped, pairs),
        _kernel.intersections(xy, segments, exchanged),
        _kernel.intersections(xy, flipped, exchanged),
    ):
        np.testing.assert_array_equal(other, found)


def test_lines_through_one_place_meet_in_one_point():
    """Five lines between integers through (1/3, 1/3), which is no double."""
    lines = [[0, 0, 1, 1], [0, 1, 1, -1], [-1, 1, 3, -1], [0, 2, 1, -3], [0, -1, 1, 3]]
    xy = np.array(lines, float).reshape(-1, 2)
    segments = as_pairs(np.arange(10))
    pairs = _kernel.crossings(xy, segments)
    assert len(pairs) == 10
    met = _kernel.intersections(xy, segments, pairs)
    assert np.unique(met, axis=0).tolist() == [[1 / 3, 1 / 3]]


# -------------------------------------------------------------------- vertices at places


def test_vertices_at_places():
    rng = np.random.default_rng(6)
    xy = np.unique(rng.integers(0, 300, (20_000, 2)), axis=0) * 0.1 + UTM_CORNER
    rng.shuffle(xy)
    beside = xy[::11] + np.array([0, 1e-9])
    places = np.vstack([xy[::7], beside, xy[:5]])
    number = {tuple(row): i for i, row in enumerate(xy.tolist())}
    wanted = [number.get(tuple(row), -1) for row in places.tolist()]
    assert wanted.count(-1) == len(beside)
    assert _kernel.vertices_at(xy, places).tolist() == wanted


# -------------------------------------------------------------------- bad input


def test_no_segments_and_no_places():
    nothing, no_pairs = np.empty((0, 2)), as_pairs([])
    for pairs in (
        _kernel.crossings(nothing, no_pairs),
        _kernel.touches(nothing, no_pairs),
        *_kernel.contacts(np.zeros((1, 2)), no_pairs),
    ):
        assert pairs.shape == (0, 2)


@pytest.mark.parametrize("numbers", [[0, 2], [-1, 0]])
@pytest.mark.parametrize("search", ["crossings", "touches", "contacts"])
def test_ends_that_are_no_vertices_are_refused(search, numbers):
    with pytest.raises(ValueError, match="existing row"):
        getattr(_kernel, search)(np.zeros((2, 2)), as_pairs(numbers))


@pytest.mark.parametrize("value", [np.nan, np.inf, -1e80])
@pytest.mark.parametrize("search", ["crossings", "touches", "contacts"])
def test_coordinates_out_of_range_are_refused(search, value):
    with pytest.raises(ValueError, match="finite and within the exact range"):
        getattr(_kernel, search)(np.array([[0, 0], [value, 1]]), as_pairs([0, 1]))


@pytest.mark.parametrize("distance", [-1.0, np.nan, np.inf])
@pytest.mark.parametrize("search", ["touches", "contacts"])
def test_distances_that_are_none_are_refused(search, distance):
    with pytest.raises(ValueError, match="finite and 0 or more"):
        getattr(_kernel, search)(np.eye(2), as_pairs([0, 1]), distance)


def test_pairs_that_do_not_cross_have_no_meeting_place():
    xy = np.array([[0, 0], [1, 0], [0, 1], [1, 1.0]])
    with pytest.raises(ValueError, match="must cross"):
        _kernel.intersections(xy, as_pairs([[0, 1], [2, 3]]), as_pairs([0, 1]))


@pytest.mark.parametrize("ends", [(0, 1), (1, 0)])
@pytest.mark.parametrize(
    ("vertex", "is_touching"),
    [
        ((50, 5), True),
        ((50, np.nextafter(5, 6)), False),
        ((97, 4), False),  # as near to the end as to be one vertex with it
        ((96.875, 4), True),
        ((3, 4), False),
        ((3.125, 4), True),
    ],
)
def test_a_vertex_at_just_the_distance_from_an_end_is_the_ends_not_the_segments(
    ends, vertex, is_touching
):
    xy = np.array([(0, 0), (100, 0), vertex], float)
    found = _kernel.touches(xy, as_pairs(ends), 5.0).tolist()
    assert found == ([[0, 2]] if is_touching else [])


def test_diagonals_of_rectangles_meet_in_the_even_neighbor_of_their_middle():
    """Sides of all digits: their areas are no doubles, and a quotient by these is no tie."""
    rng = np.random.default_rng(11)
    low, high = np.sort(rng.uniform(1.0, 2.0, (2, 500, 2)), axis=0)
    corners = np.stack(
        [low, np.c_[high[:, 0], low[:, 1]], high, np.c_[low[:, 0], high[:, 1]]], axis=1
    )
    first = np.arange(0, 2000, 4, dtype=np.int32)
    segments = np.stack([first, first + 2, first + 1, first + 3], axis=1).reshape(-1, 2)
    pairs = np.arange(1000, dtype=np.int32).reshape(-1, 2)
    found = _kernel.intersections(corners.reshape(-1, 2), segments, pairs)
    middle = [
        [(Fraction(a) + Fraction(b)) / 2 for a, b in zip(one, other, strict=True)]
        for one, other in zip(low.tolist(), high.tolist(), strict=True)
    ]
    np.testing.assert_array_equal(found, [[float(x), float(y)] for x, y in middle])  # half to even
    ties = sum(Fraction(float(value)) != value for place in middle for value in place)
    assert ties > 300
