"""Every way through the kernel, and the claim that all of them give the same arrays."""

from __future__ import annotations

import numpy as np

import tinsmith as ts
from benchmarks.datasets.points import DATASETS, make_points
from tinsmith.tin import _kernel

__all__ = [
    "DATASETS",
    "Method",
    "make_points",
    "require_same_by_threads",
    "require_same_growth",
    "require_sound",
    "with_heights",
]

Method = _kernel.Method


def with_heights(xy):
    """Rows of x, y and their own number as the height: distinct, so that a mix-up shows."""
    xy = np.asarray(xy, float)
    return np.column_stack([xy, np.arange(len(xy))])


def require_same_growth(found, wanted):
    np.testing.assert_array_equal(found.triangles, wanted.triangles)
    np.testing.assert_array_equal(found.neighbors, wanted.neighbors)
    assert (found.kept_row is None) == (wanted.kept_row is None)
    if wanted.kept_row is not None:
        np.testing.assert_array_equal(found.kept_row, wanted.kept_row)


def require_same_by_threads(points, threads, *, methods=(Method.GROWTH,)):
    wanted = _kernel.grow(points, method=methods[0])
    for method in methods:
        for count in threads:
            require_same_growth(_kernel.grow(points, method=method, threads=count), wanted)


def require_sound(points):
    """Triangulate, check all levels against the rows, and hold ties to the rule."""
    tin = ts.triangulate(points)
    result = ts.check(tin, level=3, points=points)
    result.raise_if_failed()
    assert result.counts["ties_against_rule"] == 0
    return tin
