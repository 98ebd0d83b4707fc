"""Discs around circumscribed circles, against fractions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from support.point_cells import may_meet

from tinsmith.base.types import Bounds
from tinsmith.tin.tiling.circles import bound_discs

TRIANGLES = {
    "even": np.random.default_rng(1).random((200, 3, 2)),
    "far from the origin": np.random.default_rng(2).random((200, 3, 2)) + np.array([5e6, -4e6]),
    "needles": np.random.default_rng(3).random((200, 3, 2)) * [1e6, 1e-9],
    "nearly flat": np.array([[[0, 0], [1, 2.0**-60], [2, 0]], [[0, 0], [3, 1], [6, 2 + 2.0**-50]]]),
    "tiny": np.random.default_rng(4).random((50, 3, 2)) * 1e-60,
    "huge": np.random.default_rng(5).random((50, 3, 2)) * 1e74,
}


def circle_of(corners):
    """Return centre and squared radius, exactly."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(v) for v in corner] for corner in corners)
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    double = 2 * (bx * cy - by * cx)
    b, c = bx * bx + by * by, cx * cx + cy * cy
    x, y = (cy * b - by * c) / double, (bx * c - cx * b) / double
    return (ax + x, ay + y), x * x + y * y


@pytest.mark.parametrize("name", TRIANGLES)
def test_discs_hold_the_circles_and_little_more(name):
    corners = TRIANGLES[name]
    discs = bound_discs(corners.reshape(-1, 2), np.arange(corners.shape[0] * 3).reshape(-1, 3))
    for one, center, radius in zip(
        corners.tolist(), discs.centers.tolist(), discs.radii, strict=True
    ):
        (x, y), square = circle_of(one)
        if not np.isfinite(radius):
            assert square > Fraction(10) ** 600
            continue
        room = Fraction(float(radius))
        off = (x - Fraction(center[0])) ** 2 + (y - Fraction(center[1])) ** 2
        # sqrt(square) + sqrt(off) <= room, without roots
        left = room * room - square - off
        assert left >= 0
        assert left * left >= 4 * square * off
        size = Fraction(max(abs(v) for corner in one for v in corner)) ** 2
        assert room * room <= square * Fraction(1.00001) + size * Fraction(2) ** -80


def test_discs_within_a_box_and_those_that_meet_it():
    corners = np.array([[[0.0, 0], [2, 0], [0, 2]], [[10, 10], [12, 10], [10, 12]]])
    discs = bound_discs(corners.reshape(-1, 2), np.arange(6).reshape(-1, 3))  # radius sqrt(2)
    assert discs.are_within(Bounds(-1, -1, 3, 3)).tolist() == [True, False]
    assert discs.are_within(Bounds(0, 0, 2, 2)).tolist() == [False, False]
    assert may_meet(discs, Bounds(1, 1, 1, 1)).tolist() == [True, False]
    assert may_meet(discs, Bounds(2.5, 1, 10.1, 10.1)).tolist() == [False, True]
    assert may_meet(discs, Bounds(2.1, 2.1, 3, 3)).tolist() == [False, False]
