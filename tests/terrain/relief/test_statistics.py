"""Statistics of the slope against plain sums, and closed forms."""

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.relief.statistics import find_weighted_percentiles


def rough(n=300):
    random = np.random.default_rng(5)
    return ts.triangulate(
        np.column_stack([random.uniform(0, 100, (n, 2)), random.uniform(0, 9, n)]),
        crs="EPSG:32616",
        elevation_unit="m",
    )


@pytest.mark.parametrize("unit", ["degrees", "percent", "ratio"])
def test_against_plain_sums(unit):
    tin = rough()
    row = ts.slope_statistics(tin, unit=unit)
    steepness, area = ts.slope(tin, unit=unit), tin.triangle_areas
    mean = (steepness * area).sum() / area.sum()
    expected = {
        "area": area.sum(),
        "minimum": steepness.min(),
        "mean": mean,
        "standard deviation": np.sqrt((area * (steepness - mean) ** 2).sum() / area.sum()),
        "maximum": steepness.max(),
    }
    for name, value in expected.items():
        assert row[name][0] == pytest.approx(value, rel=1e-12)
    for share in (5, 25, 50, 75, 95):
        value = row[f"p{share}"][0]
        assert area[steepness <= value].sum() >= share / 100 * area.sum() * (1 - 1e-12)
        assert area[steepness < value].sum() < share / 100 * area.sum()
    assert row.units["mean"] == {"degrees": "°", "percent": "%", "ratio": "ratio"}[unit]
    assert row.notes == tin.notes


def test_extreme_percentiles_are_the_extremes():
    row = ts.slope_statistics(rough(), percentiles=[0, 100])
    assert (row["p0"][0], row["p100"][0]) == (row["minimum"][0], row["maximum"][0])


def test_equal_weights_are_those_of_numpy():
    values = np.random.default_rng(1).normal(size=101)
    shares = np.array([1.0, 33.0, 50.0, 99.5])
    found = find_weighted_percentiles(values, np.ones(101), shares, 101.0)
    np.testing.assert_array_equal(found, np.percentile(values, shares, method="inverted_cdf"))


def test_the_unit_of_areas_is_known_unknown_or_square_metres():
    assert ts.slope_statistics(rough()).units["area"] == "m²"
    without = ts.triangulate(rough().points)
    assert ts.slope_statistics(without).units["area"] is None
    assert "not known" in ts.slope_statistics(without).notes[-1]


@pytest.mark.parametrize("given", [[-1], [101], [np.nan], "x", [[50]]])
def test_percentiles_that_are_none(given):
    with pytest.raises(ts.OptionError, match="Invalid percentiles"):
        ts.slope_statistics(rough(), percentiles=given)
