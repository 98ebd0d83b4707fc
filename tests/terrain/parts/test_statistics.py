"""Statistics of the slope of tiles, added up: those of the whole surface."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from support.each_value import list_seeds
from support.parts import CLOUDS, TURNS, find_tilings

import tinsmith as ts
from tinsmith.terrain.parts import statistics
from tinsmith.terrain.relief.statistics import (
    find_weighted_percentiles,
    select_weighted_percentiles,
)


@pytest.mark.each_value
@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("unit", ["degrees", "percent"])
@pytest.mark.parametrize("turn", TURNS)
def test_statistics_are_those_of_the_whole(name, unit, turn):
    whole = ts.slope_statistics(ts.triangulate(CLOUDS[name]), unit=unit)
    options = statistics.StatisticsOptions(unit)
    for tiling in find_tilings(name, turn):
        parts = tiling.compute(lambda part, box: statistics.compute_part(part, box, options))
        found = statistics.join(lambda parts=parts: parts)
        assert found == {key: float(column[0]) for key, column in whole.columns.items()}


@pytest.mark.parametrize("seed", list_seeds(20, few=6))
def test_percentiles_are_those_of_exact_sums(seed):
    rng = np.random.default_rng(seed)
    values = rng.choice([0.0, 1e-300, 0.25, 1.0, 45.0, 90.0, 1e300], 60)
    if seed % 2:
        values = rng.random(60) * 90
    weights = rng.integers(0, 50, 60) * 2.0 ** rng.integers(-3, 3)
    weights[0] = 1.0
    shares = np.array([0.0, 0.1, 25.0, 50.0, 50.5, 99.9, 100.0])
    whole = float(weights.sum())
    found = select_weighted_percentiles(
        lambda: zip(np.array_split(values, 7), np.array_split(weights, 7), strict=True),
        shares,
        whole,
    )
    for share, value in zip(shares.tolist(), found.tolist(), strict=True):
        enough = [
            one
            for one in sorted(values)
            if sum(map(Fraction, weights[values <= one])) >= Fraction(share) * Fraction(whole) / 100
        ]
        assert value == enough[0]
    np.testing.assert_array_equal(found, find_weighted_percentiles(values, weights, shares, whole))


def test_statistics_do_not_depend_on_how_points_are_numbered():
    points = CLOUDS["uniform"]
    other = points[np.random.default_rng(2).permutation(len(points))]
    one, two = (ts.slope_statistics(ts.triangulate(some)) for some in (points, other))
    assert [one[key][0] for key in one.columns] == [two[key][0] for key in two.columns]


def test_an_even_slope_has_no_deviation():
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0))
    ramp = np.column_stack([x.ravel(), y.ravel(), 0.25 * x.ravel()])
    table = ts.slope_statistics(ts.triangulate(ramp), unit="percent")
    assert table["mean"][0] == 25.0
    assert table["standard deviation"][0] == 0.0
