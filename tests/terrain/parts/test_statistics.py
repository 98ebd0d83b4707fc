"""Statistics of the slope of tiles, added up: those of the whole surface."""

from __future__ import annotations

import numpy as np
import pytest
from support.parts import CLOUDS, find_tilings

import tinsmith as ts
from tinsmith.terrain.parts import statistics


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("unit", ["degrees", "percent"])
def test_statistics_are_those_of_the_whole(name, unit):
    whole = ts.slope_statistics(ts.triangulate(CLOUDS[name]), unit=unit)
    options = statistics.StatisticsOptions(unit)
    for tiling in find_tilings(name)[::3]:
        parts = tiling.compute(lambda part, box: statistics.compute_part(part, box, options))
        found = statistics.join(parts)
        assert found == {key: float(whole[key][0]) for key in found}


def test_statistics_do_not_depend_on_how_points_are_numbered():
    points = CLOUDS["uniform"]
    other = points[np.random.default_rng(2).permutation(len(points))]
    one, two = (
        ts.slope_statistics(ts.triangulate(some), percentiles=[]) for some in (points, other)
    )
    assert [one[key][0] for key in one.columns] == [two[key][0] for key in two.columns]


def test_an_even_slope_has_no_deviation():
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0))
    ramp = np.column_stack([x.ravel(), y.ravel(), 0.25 * x.ravel()])
    table = ts.slope_statistics(ts.triangulate(ramp), unit="percent")
    assert table["mean"][0] == 25.0
    assert table["standard deviation"][0] == 0.0
