"""Kernels that products share: components, areas, sides of cells, and sorting by two keys."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tinsmith.terrain import _kernel
from tinsmith.terrain.surface import double_areas, join_components, number_components
from tinsmith.terrain.surface.sorting import sort_by

# --------------------------------------------------------------------------- components


def join_by_sets(count, pairs):
    """Return the smallest member of the set of each."""
    sets = {number: {number} for number in range(count)}
    for one, other in pairs:
        if sets[one] is not sets[other]:
            sets[one] |= sets[other]
            for member in sets[other]:
                sets[member] = sets[one]
    return [min(sets[number]) for number in range(count)]


@given(st.integers(1, 40), st.data())
def test_components_equal_joined_sets(count, data):
    number = st.integers(0, count - 1)
    pairs = data.draw(st.lists(st.tuples(number, number), max_size=60))
    one, other = np.array(pairs, np.int64).reshape(-1, 2).T
    assert join_components(count, one, other).tolist() == join_by_sets(count, pairs)


def test_a_long_chain_is_one_component():
    order = np.random.default_rng(1).permutation(100_000)
    assert not join_components(len(order), order[:-1], order[1:]).any()


@given(st.integers(1, 30), st.integers(0, 10_000))
def test_components_of_triangles_are_those_of_their_neighbors(count, seed):
    rng = np.random.default_rng(seed)
    neighbors = np.full((count, 3), -1, np.int32)
    for one, other in rng.integers(0, count, (count, 2)):
        if one != other and (neighbors[[one, other]] < 0).any(axis=1).all():
            for here, there in ((one, other), (other, one)):
                neighbors[here, np.argmax(neighbors[here] < 0)] = there
    pairs = [
        (row, other) for row in range(count) for other in neighbors[row].tolist() if other >= 0
    ]
    assert number_components(neighbors).tolist() == join_by_sets(count, pairs)


def test_numbers_out_of_range_are_refused():
    for one, other in (([0], [2]), ([-1], [0]), ([0, 1], [1])):
        with pytest.raises(ValueError, match="from 0 to count - 1"):
            _kernel.join_components(2, np.array(one), np.array(other))
    with pytest.raises(ValueError, match="triangles or -1"):
        _kernel.number_components(np.array([[1, -1, -1]], np.int32))


# --------------------------------------------------------------------------- areas


@pytest.mark.parametrize("columns", [2, 3, 5])
@pytest.mark.parametrize("threads", [1, 3])
def test_areas_equal_those_of_numpy_bit_for_bit(columns, threads):
    rng = np.random.default_rng(columns)
    points = rng.normal(size=(500, columns)) * 10.0 ** rng.integers(-6, 7, (500, 1))
    triangles = rng.integers(0, 500, (2000, 3)).astype(np.int32)
    a, b, c = (points[triangles[:, k], :2] for k in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    expected = (ux * vy - uy * vx).view(np.int64)
    assert (double_areas(points, triangles).view(np.int64) == expected).all()
    found = _kernel.double_areas(points, triangles, threads)
    assert (found.view(np.int64) == expected).all()


def test_no_triangles_have_no_areas():
    assert double_areas(np.zeros((0, 2)), np.zeros((0, 3), np.int32)).tolist() == []


# --------------------------------------------------------------------------- sorting

KEYS = st.sampled_from([-0.0, 0.0, 1.0, -1.0, 1e-300, 2.0**53, np.inf, -np.inf, 3.5])


@given(st.lists(st.tuples(KEYS, KEYS), max_size=30))
def test_order_by_two_keys_is_that_of_lexsort(rows):
    first, second = np.array(rows).reshape(-1, 2).T
    assert sort_by(first, second).tolist() == np.lexsort((second, first)).tolist()


@pytest.mark.parametrize("most", [3, 2**53 - 1, 2**53 + 1, 2**62])
def test_integers_that_doubles_do_not_hold_are_told_apart(most):
    first = most - np.random.default_rng(2).integers(0, 3, 1000)
    second = np.random.default_rng(3).integers(0, 4, 1000)
    assert (sort_by(first, second) == np.lexsort((second, first))).all()
    assert (sort_by(second, first) == np.lexsort((first, second))).all()


# --------------------------------------------------------------------------- sides of cells


def complete_by_dictionary(points, counts, corners, lines):
    """Give each side the vertices of its line that lie between its ends, one after the other."""
    cells, begin = [], 0
    for count in counts:
        cells.append(range(begin, begin + count))
        begin += count
    ends = {i: corners[cell[(k + 1) % len(cell)]] for cell in cells for k, i in enumerate(cell)}
    on_line: dict[int, list[int]] = {}
    for i, line in enumerate(lines):
        if line >= 0:
            on_line.setdefault(line, []).append(i)
    orders = {}
    for line, sides in on_line.items():
        ways = [points[ends[i]] - points[corners[i]] for i in sides]
        longest = max(range(len(sides)), key=lambda k: (np.hypot(*ways[k]), k))
        origin, way = points[corners[sides[longest]]], ways[longest]
        vertices = sorted({corners[i] for i in sides} | {ends[i] for i in sides})
        orders[line] = sorted(vertices, key=lambda v: float(((points[v] - origin) * way).sum()))
    found: tuple[list[int], list[int], list[int]] = ([], [], [])
    for cell in cells:
        before = len(found[1])
        for i in cell:
            passed = [corners[i]]
            if lines[i] >= 0:
                order = orders[lines[i]]
                first, last = order.index(corners[i]), order.index(ends[i])
                step = 1 if last > first else -1
                passed += [order[k] for k in range(first + step, last, step)] * (first != last)
            found[1].extend(passed)
            found[2].extend([lines[i]] * len(passed))
        found[0].append(len(found[1]) - before)
    return found


@given(st.integers(0, 10_000))
def test_sides_get_the_vertices_that_lie_on_them(seed):
    """Of cells whose corners lie anywhere, on few lines: order and ends are all that counts."""
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 4, (12, 2)).astype(float)
    counts = rng.integers(1, 6, rng.integers(1, 9))
    corners = rng.integers(0, len(points), counts.sum())
    lines = rng.integers(-1, 4, counts.sum())
    found = _kernel.complete_sides(points, counts, corners, lines, 4)
    expected = complete_by_dictionary(points, counts.tolist(), corners.tolist(), lines.tolist())
    assert tuple(one.tolist() for one in found) == expected


def test_cells_that_do_not_fit_are_refused():
    points, one = np.zeros((2, 2)), np.array([1])
    for counts, corners, lines in (
        ([2], [0], [0]),
        ([1], [2], [0]),
        ([1], [0], [1]),
        ([0, 1], [0], [0]),
    ):
        with pytest.raises(ValueError, match=r"corners must be of points|cells must have corners"):
            _kernel.complete_sides(points, *map(np.array, (counts, corners, lines)), len(one))
