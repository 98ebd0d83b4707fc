"""The skeleton: hulls of parts joined are the hull of all, and few points stand for a cell."""

from __future__ import annotations

import numpy as np
import pytest
from support import oracles

import tinsmith as ts
from tinsmith.tin.tiling.skeleton import find_outermost, reduce_to_hull
from tinsmith.tin.tiling.sources import NumberedPoints


def numbered(xy):
    return NumberedPoints(np.column_stack([xy, np.zeros(len(xy))]), np.arange(len(xy)))


@pytest.mark.parametrize("seed", range(12))
def test_the_hull_of_hulls_is_the_hull_of_all(seed):
    rng = np.random.default_rng(seed)
    xy = rng.random((400, 2)) if seed % 2 else np.round(rng.random((200, 2)) * 9)
    whole = numbered(xy)
    part = rng.integers(0, 6, len(xy))
    parts = [reduce_to_hull(whole.choose(np.flatnonzero(part == k))) for k in range(6)]
    found = reduce_to_hull(NumberedPoints.join(parts))
    tin = ts.triangulate(whole.points)
    wanted = {oracles.place(row) for row in tin.points[tin.hull]}
    assert {oracles.place(row) for row in found.points} >= corners_of(wanted)
    assert len(found.numbers) <= len(wanted)


def corners_of(hull):
    """Return the strict corners of points on a hull."""
    return {
        p
        for p in hull
        if not any(
            oracles.orientation(a, b, p) == 0 and min(a, b) < p < max(a, b)
            for a in hull - {p}
            for b in hull - {p}
            if a < b
        )
    }


def test_the_ends_of_collinear_points():
    points = numbered(np.column_stack([np.arange(9.0)[::-1], np.arange(9.0)[::-1] * 3]))
    assert sorted(reduce_to_hull(points).numbers.tolist()) == [0, 8]
    assert reduce_to_hull(points.choose(np.array([4]))).numbers.tolist() == [4]
    assert len(reduce_to_hull(points.choose(np.arange(0))).numbers) == 0


def test_the_outermost_points_of_a_cell():
    rng = np.random.default_rng(3)
    points = numbered(rng.random((5000, 2)) + np.array([4e5, 5e6]))
    found = find_outermost(points)
    assert len(found.numbers) <= 16
    for axis in (0, 1):
        for extreme in (np.argmin, np.argmax):
            assert extreme(points.points[:, axis]) in found.numbers
    assert len(find_outermost(points.choose(np.arange(0))).numbers) == 0
