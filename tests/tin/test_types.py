"""Bounds, and what they are made of."""

import numpy as np
import pytest

import tinsmith as ts


def test_bounds_of_lists_are_those_of_arrays():
    points = [[0, 1, 9], [3, 5, 7]]
    assert (
        ts.Bounds.of(points)
        == ts.Bounds.of(np.array(points, float))
        == ts.Bounds(0.0, 1.0, 3.0, 5.0)
    )


@pytest.mark.parametrize("points", [[], None, [1.0, 2.0], "ab", np.zeros((0, 3)), [[1], [2, 3]]])
def test_bounds_of_no_points_are_refused(points):
    with pytest.raises(ts.OptionError, match=r"^Invalid points .*one row or more\.$"):
        ts.Bounds.of(points)
