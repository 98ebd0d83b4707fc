"""Predicates: the compiled ones and the vectorised ones against rational arithmetic."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import oracles

from tinsmith.tin import _kernel
from tinsmith.tin import predicates as exact

N_ROWS = 300


def random_places(rng, k):
    return rng.random((k, 4, 2))


def small_grid(rng, k):
    return rng.integers(0, 4, (k, 4, 2)).astype(float)


def large_integers(rng, k):
    """Sums of squares of 2^40: beyond doubles, within 128-bit integers."""
    return rng.integers(0, 3, (k, 4, 2)) * (2.0**40 - 87.0)


def utm_raster(rng, k):
    return rng.integers(0, 4, (k, 4, 2)) * 30.1 + [500_000.0, 4_000_000.0]


def tenths(rng, k):
    """Differences of 0.1, 0.2, 0.30000000000000004: nearly cocircular, and not exact."""
    return rng.integers(-3, 4, (k, 4, 2)) * 0.1


def near_circle(rng, k):
    angle = rng.uniform(0, 2 * np.pi, (k, 4))
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def near_line(rng, k):
    x = rng.random((k, 4))
    return np.stack([x, 3 * x + rng.integers(-2, 3, (k, 4)) * 2.0**-52], axis=-1)


def nudged_rectangles(rng, k):
    """Rectangles with corners moved by at most two units in the last place."""
    corner, size = rng.random((k, 1, 2)), rng.random((k, 1, 2))
    unit = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    quads = corner + size * unit[rng.permuted(np.tile(range(4), (k, 1)), axis=1)]
    return quads + rng.integers(-2, 3, quads.shape) * np.spacing(quads)


def huge(rng, k):
    return rng.integers(-2, 3, (k, 4, 2)) * 1e70


def tiny(rng, k):
    return rng.integers(-2, 3, (k, 4, 2)) * 1e-55


def huge_beside_tiny(rng, k):
    return rng.integers(-2, 3, (k, 4, 2)) * rng.choice([1e-55, 1.0, 1e70], (k, 4, 2))


def any_magnitude(rng, k):
    return rng.choice([-1.0, 1.0], (k, 4, 2)) * 2.0 ** rng.uniform(-199, 249, (k, 4, 2))


def limits_of_range(rng, k):
    return rng.choice([0.0, 2.0**-200, -(2.0**-200), 2.0**250, -(2.0**250), 1.0], (k, 4, 2))


def tiny_circle_beside_far_point(rng, k):
    quads = small_grid(rng, k) * 2.0**-190
    quads[:, 3] = rng.choice([1.0, -1.0], (k, 2)) * 2.0**240
    return quads


FAMILIES = [
    random_places,
    small_grid,
    large_integers,
    utm_raster,
    tenths,
    near_circle,
    near_line,
    nudged_rectangles,
    huge,
    tiny,
    huge_beside_tiny,
    any_magnitude,
    limits_of_range,
    tiny_circle_beside_far_point,
]
TIED_FAMILIES = {small_grid, large_integers, utm_raster, huge, tiny}


def compiled(name, quads):
    corners = [np.ascontiguousarray(quads[:, corner]) for corner in range(4)]
    if name == "orientation":
        return _kernel.orientation(*corners[:3])
    return _kernel.in_circle(*corners)


def vectorised(name, quads):
    xy = exact.columns(quads.reshape(-1, 2))
    corners = [np.arange(corner, 4 * len(quads), 4) for corner in range(4)]
    if name == "orientation":
        return exact.orientation(xy, *corners[:3])
    return exact.in_circle(xy, *corners)


def rational(name, quads):
    places = [[oracles.place(point) for point in quad] for quad in quads]
    if name == "orientation":
        return np.array([oracles.orientation(*quad[:3]) for quad in places])
    return np.array([oracles.in_circle(*quad) for quad in places])


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
@pytest.mark.parametrize("name", ["orientation", "in_circle"])
def test_signs_are_those_of_rational_arithmetic(name, family):
    quads = family(np.random.default_rng(7), N_ROWS)
    wanted = rational(name, quads)
    np.testing.assert_array_equal(compiled(name, quads), wanted)
    np.testing.assert_array_equal(vectorised(name, quads), wanted)
    assert {-1, 1} <= set(wanted.tolist())
    if family in TIED_FAMILIES:
        assert 0 in wanted


def on_circles_about_the_first(rng, k):
    """Places nearly equally far from the first, at UTM size, in the unit square, on integers."""
    angle = rng.uniform(0, 2 * np.pi, (k, 3))
    center = rng.choice([0.0, 0.1, 1 / 3, 5e5 + 0.37], (k, 1, 1)) + rng.random((k, 1, 2))
    radius = rng.choice([1e-3, 1.0, 12.7, 4e4], (k, 1, 1))
    around = center + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    around += rng.integers(-1, 2, around.shape) * np.spacing(around)
    return np.concatenate([center, around], axis=1)


@pytest.mark.parametrize(
    "family", [*FAMILIES, on_circles_about_the_first], ids=lambda family: family.__name__
)
def test_distances_are_compared_as_by_rational_arithmetic(family):
    quads = family(np.random.default_rng(9), 1000)
    v, p, q = (np.ascontiguousarray(quads[:, corner]) for corner in range(3))
    wanted = []
    for (vx, vy), (px, py), (qx, qy) in (map(oracles.place, quad[:3]) for quad in quads):
        far = (px - vx) ** 2 + (py - vy) ** 2 - (qx - vx) ** 2 - (qy - vy) ** 2
        wanted.append(oracles.sign(far))
    np.testing.assert_array_equal(_kernel.compare_distances(v, p, q), wanted)
    assert {-1, 1} <= set(wanted)


@pytest.mark.proof
@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
@pytest.mark.parametrize("name", ["orientation", "in_circle"])
def test_signs_of_many_rows(name, family):
    quads = family(np.random.default_rng(8), 30_000)
    wanted = rational(name, quads)
    np.testing.assert_array_equal(compiled(name, quads), wanted)
    np.testing.assert_array_equal(vectorised(name, quads), wanted)


coordinates = st.one_of(
    st.just(0.0),
    st.builds(
        lambda sign, mantissa, exponent: sign * math.ldexp(mantissa, exponent),
        st.sampled_from([-1.0, 1.0]),
        st.integers(2**52, 2**53 - 1).map(float),
        st.integers(-200 - 52, 249 - 52),
    ),
)
quads_of_any_size = st.lists(coordinates, min_size=8, max_size=8).map(
    lambda values: np.array(values).reshape(1, 4, 2)
)


@st.composite
def nearly_degenerate_quads(draw):
    """Points of a small grid, scaled and shifted, then moved by units in the last place."""
    cells = draw(st.lists(st.integers(0, 3), min_size=8, max_size=8))
    scale = draw(st.sampled_from([1.0, 0.1, 30.1, 2.0**-60, 1e-20, 1e20, math.pi]))
    shift = draw(st.sampled_from([0.0, 0.1, 5e5, 4e6, 1e12, -3.0]))
    nudges = draw(st.lists(st.integers(-1, 1), min_size=8, max_size=8))
    quads = np.array(cells).reshape(1, 4, 2) * scale + shift
    return quads + np.array(nudges).reshape(1, 4, 2) * np.spacing(quads)


@given(st.one_of(quads_of_any_size, nearly_degenerate_quads()))
def test_signs_of_any_four_points(quads):
    quads = np.where(np.abs(quads) < exact.EXACT_RANGE[0], 0.0, quads)
    for name in ("orientation", "in_circle"):
        wanted = rational(name, quads)
        np.testing.assert_array_equal(compiled(name, quads), wanted)
        np.testing.assert_array_equal(vectorised(name, quads), wanted)


def test_signs_of_every_limb_count():
    """Differences of 1 to 440 bits: a rectangle is cocircular, and not once a corner moves."""
    for bits in range(1, 440):
        far = 2.0 ** (bits - 200)
        unit = 2.0**-200
        # (0, 0), (far, 0), (far, unit), (0, unit), then the last corner doubled in height
        rectangle = np.array([[[0, 0], [far, 0], [far, unit], [0, unit]]])
        nudged = np.array([[[0, 0], [far, 0], [far, unit], [0, 2 * unit]]])
        assert vectorised("in_circle", rectangle) == compiled("in_circle", rectangle) == 0
        assert vectorised("in_circle", nudged) == compiled("in_circle", nudged) == -1


def test_both_state_the_same_range():
    assert exact.EXACT_RANGE == _kernel.EXACT_RANGE


def test_rows_beyond_one_block_are_all_decided():
    quads = np.tile(small_grid(np.random.default_rng(1), 50), (700, 1, 1))
    wanted = np.tile(rational("in_circle", quads[:50]), 700)
    np.testing.assert_array_equal(vectorised("in_circle", quads), wanted)


def test_arrays_of_different_length_are_refused():
    one, two = np.zeros((1, 2)), np.zeros((2, 2))
    with pytest.raises(ValueError, match="same number of rows"):
        _kernel.orientation(one, two, one)
    with pytest.raises(ValueError, match="same number of rows"):
        _kernel.in_circle(one, one, one, two)


def test_no_rows_have_no_signs():
    none = np.empty((0, 2))
    assert len(_kernel.orientation(none, none, none)) == 0
    assert len(vectorised("in_circle", np.empty((0, 4, 2)))) == 0


def test_the_core_refuses_places_that_are_not_finite():
    good = np.zeros((1, 2))
    bad = np.array([[np.nan, 0.0]])
    with pytest.raises(ValueError, match="finite"):
        _kernel.orientation(good, good, bad)
    with pytest.raises(ValueError, match="finite"):
        _kernel.in_circle(good, bad, good, good)


@pytest.mark.parametrize("n", [1, 3, 7])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_no_row_and_no_argument_may_hold_what_is_not_finite(n, bad):
    for predicate, count in (
        (_kernel.orientation, 3),
        (_kernel.in_circle, 4),
        (_kernel.compare_distances, 3),
    ):
        for argument in range(count):
            for row in range(n):
                for axis in (0, 1):
                    given = [np.zeros((n, 2)) for _ in range(count)]
                    assert len(predicate(*given)) == n
                    given[argument][row, axis] = bad
                    with pytest.raises(ValueError, match="finite"):
                        predicate(*given)


def test_both_implementations_are_exact_in_the_same_range():
    assert exact.EXACT_RANGE == _kernel.EXACT_RANGE
