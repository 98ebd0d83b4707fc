"""Places in rings: the chains of edges against a ray in rational arithmetic."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.line_oracle import is_inside, places_of
from support.point_sets import seeds

from tinsmith.tin import _kernel

UTM = np.array([500_000.0, 4_000_000.0])


def sides(xy, rings, threads=1):
    corners = [np.asarray(ring, float).reshape(-1, 2) for ring in rings]
    offsets = np.cumsum([0, *map(len, corners)], dtype=np.int32)
    return _kernel.places_in_rings(
        np.asarray(xy, float).reshape(-1, 2),
        np.concatenate([np.empty((0, 2)), *corners]),
        offsets,
        threads,
    )


def require_as_oracle(xy, rings):
    exact_rings = [places_of(ring) for ring in rings]
    wanted = [is_inside(p, exact_rings) for p in places_of(xy)]
    for threads in (1, 3):
        assert sides(xy, rings, threads).tolist() == wanted


def circle(n, radius, center=(0, 0)):
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.column_stack([np.cos(angle), np.sin(angle)]) * radius + center


SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]


def test_corners_edges_inside_and_outside_of_a_square():
    xy = [[0, 0], [4, 4], [2, 0], [0, 1], [4, 3], [3, 4], [2, 2], [-1, 0], [5, 4], [2, -1], [-1, 2]]
    assert sides(xy, [SQUARE]).tolist() == [0, 0, 0, 0, 0, 0, 1, -1, -1, -1, -1]


def test_direction_of_a_ring_does_not_matter():
    xy = np.stack(np.meshgrid(np.arange(-1, 6), np.arange(-1, 6)), -1).reshape(-1, 2)
    np.testing.assert_array_equal(sides(xy, [SQUARE]), sides(xy, [SQUARE[::-1]]))


def test_last_corner_may_repeat_the_first():
    xy = np.stack(np.meshgrid(np.arange(-1, 6), np.arange(-1, 6)), -1).reshape(-1, 2)
    np.testing.assert_array_equal(sides(xy, [SQUARE]), sides(xy, [[*SQUARE, SQUARE[0]]]))


def test_ring_within_a_ring_is_a_hole():
    hole = [[1, 1], [3, 1], [3, 3], [1, 3]]
    assert sides([[2, 2], [0.5, 2], [1, 2], [9, 9]], [SQUARE, hole]).tolist() == [-1, 1, 0, -1]


def test_bow_tie_has_two_insides():
    bow = [[0, 0], [4, 4], [4, 0], [0, 4]]
    assert sides([[2, 2], [1, 2], [3, 2], [2, 1], [2, 3]], [bow]).tolist() == [0, 1, 1, -1, -1]


@pytest.mark.parametrize("ring", [[], [[1, 1]], [[1, 1], [3, 1]], [[1, 1], [1, 1], [1, 1]]])
def test_ring_without_area_holds_nothing_but_itself(ring):
    require_as_oracle([[1, 1], [2, 1], [3, 1], [2, 2], [0, 1]], [ring])


def test_no_ring_and_no_place():
    assert sides([[1, 1]], []).tolist() == [-1]
    assert sides([], [SQUARE]).tolist() == []


@settings(max_examples=120)
@given(seeds, st.integers(2, 8), st.booleans())
def test_any_rings_on_a_small_grid(seed, side, is_utm):
    """Edges overlap, cross, and run through corners: parity is defined all the same."""
    rng = np.random.default_rng(seed)
    unit, origin = (30.1, UTM) if is_utm else (1.0, 0.0)
    rings = [
        rng.integers(0, side, (rng.integers(0, 14), 2)) * unit + origin
        for _ in range(rng.integers(0, 4))
    ]
    grid = np.stack(np.meshgrid(np.arange(-1, side + 1), np.arange(side)), -1).reshape(-1, 2)
    xy = np.concatenate([grid * unit + origin, rng.random((20, 2)) * side * unit + origin, *rings])
    require_as_oracle(xy, rings)


def test_places_on_long_slanting_edges():
    """Rounded places on an edge are beside it, by less than a unit in the last place."""
    rng = np.random.default_rng(3)
    ring = np.array([[0.0, 0.0], [1000.0, 333.0], [700.0, 1000.0]]) + UTM
    share = rng.random((60, 1))
    xy = ring[0] + share * (ring[1] - ring[0])
    require_as_oracle(np.concatenate([xy, ring, np.nextafter(xy, np.inf)]), [ring])


@pytest.mark.slow
def test_many_nested_rings_like_contours():
    rings = [circle(60, radius, UTM) for radius in np.linspace(1, 100, 20)]
    rng = np.random.default_rng(4)
    xy = rng.uniform(-110, 110, (250, 2)) + UTM
    require_as_oracle(xy, rings)


def test_long_star_with_many_small_holes():
    """Many places and chains: groups are halved often, and by threads."""
    rng = np.random.default_rng(5)
    star = circle(4000, 1000) * (1 + 0.3 * np.sin(np.arange(4000) * 0.7))[:, None]
    centers = rng.uniform(-600, 600, (300, 2))
    rings = [star, *(circle(8, 4, center) for center in centers)]
    xy = rng.uniform(-1400, 1400, (200_000, 2))
    found = sides(xy, rings)
    np.testing.assert_array_equal(sides(xy, rings, threads=3), found)
    np.testing.assert_array_equal(found, crossing_numbers(xy, rings))


def crossing_numbers(xy, rings):
    """Count crossings of the ray north with plain doubles: for places not within a rounding."""
    is_odd = np.zeros(len(xy), bool)
    order = np.argsort(xy[:, 0])
    x, y = xy[order].T
    for ring in rings:
        for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            west, east = sorted([tuple(a), tuple(b)])
            under = slice(*np.searchsorted(x, [west[0], east[0]]))
            rise = (east[1] - west[1]) / (east[0] - west[0])
            is_odd[order[under]] ^= y[under] < west[1] + (x[under] - west[0]) * rise
    return np.where(is_odd, 1, -1)


@pytest.mark.parametrize("offsets", [[], [1, 4], [0, 3], [0, 5], [0, 3, 2, 4]])
def test_offsets_that_do_not_fit_are_refused(offsets):
    with pytest.raises(ValueError, match="offsets must grow from 0"):
        _kernel.places_in_rings(
            np.zeros((1, 2)), np.array(SQUARE, float), np.array(offsets, np.int32)
        )


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e80])
def test_coordinates_out_of_range_are_refused(value):
    bad = np.array([[0.0, value]])
    with pytest.raises(ValueError, match="finite and within the exact range"):
        sides(bad, [SQUARE])
    with pytest.raises(ValueError, match="finite and within the exact range"):
        sides([[0, 0]], [[*SQUARE, *bad.tolist()]])
