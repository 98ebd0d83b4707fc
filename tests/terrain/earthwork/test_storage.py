"""Stage and storage against closed forms, volumes to a level, and a numerical integral."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.earthwork.planes import level_surface

POND = ts.triangulate([[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3], [3, 3, 0]])


def rough(n, seed):
    rng = np.random.default_rng(seed)
    return ts.triangulate(np.column_stack([rng.random((n, 2)) * 50, rng.random(n) * 4 + 300]))


def test_a_pyramid_of_water_has_its_closed_form():
    levels = np.array([-1.0, 0.0, 0.3, 1.0, 2.9, 3.0, 4.5])
    table = ts.stage_storage(POND, levels=levels)
    depth = np.clip(levels, 0, 3)
    np.testing.assert_allclose(table["area"], 4 * depth**2, rtol=1e-12)
    above = 36 * np.maximum(levels - 3, 0)
    np.testing.assert_allclose(table["volume"], 4 / 3 * depth**3 + above, rtol=1e-12)
    np.testing.assert_allclose(table["wetted_area"], 4 * depth**2 * math.sqrt(2), rtol=1e-12)
    np.testing.assert_array_equal(table["depth"], np.maximum(levels, 0))
    assert table["is_contained"].tolist() == [True] * 6 + [False]


def test_rows_are_the_fill_to_their_level():
    tin = rough(300, 1)
    table = ts.stage_storage(tin, interval=0.25)
    for level, area, volume in zip(table["level"], table["area"], table["volume"], strict=True):
        filled = ts.volume(tin, base=float(level))
        assert volume == pytest.approx(filled["fill"][0], rel=1e-12)
        assert area == pytest.approx(filled["fill_area"][0], rel=1e-12)


def test_the_volume_is_the_integral_of_the_area():
    tin = rough(50, 2)
    levels = np.linspace(300, 304, 4001)
    table = ts.stage_storage(tin, levels=levels)
    integral = np.sum((table["area"][1:] + table["area"][:-1]) / 2 * np.diff(levels))
    assert table["volume"][-1] - table["volume"][0] == pytest.approx(integral, rel=1e-6)


def test_the_order_of_levels_and_the_other_rows_change_nothing():
    tin = rough(100, 3)
    levels = [303.0, 301.0, 302.0, 301.0]
    together = ts.stage_storage(tin, levels=levels)
    for row, level in enumerate(levels):
        alone = ts.stage_storage(tin, levels=[level])
        assert together["volume"][row] == pytest.approx(alone["volume"][0], rel=1e-14)
        assert together["area"][row] == alone["area"][0]


def test_a_region_holds_its_part():
    half = ts.stage_storage(POND, levels=[1, 2, 3], region=[[0, 0], [3, 0], [3, 6], [0, 6]])
    whole = ts.stage_storage(POND, levels=[1, 2, 3])
    np.testing.assert_allclose(half["volume"], whole["volume"] / 2, rtol=1e-12)
    assert half["is_contained"].tolist() == [False] * 3  # its edge runs through the lowest place


def test_the_usual_levels_are_round_and_few():
    table = ts.stage_storage(rough(100, 4))
    assert 10 <= len(table) <= 21
    np.testing.assert_allclose(np.diff(table["level"]), 0.2)


def test_multiples_of_the_interval_reach_the_top():
    assert ts.stage_storage(POND, interval=2)["level"].tolist() == [0, 2, 4]


@pytest.mark.parametrize(
    ("options", "part"),
    [
        ({"interval": 0}, "Invalid interval 0: it must be a finite number > 0"),
        ({"interval": -1.0}, "> 0"),
        ({"interval": math.nan}, "> 0"),
        ({"interval": 1e-6}, "at most 100,000"),
        ({"interval": 1.0, "levels": [1]}, "None where levels are given"),
        ({"levels": []}, "number of levels 0"),
        ({"levels": [1, math.inf]}, "Invalid levels inf"),
        ({"levels": "all"}, "Invalid levels"),
    ],
)
def test_levels_that_are_none_are_refused(options, part):
    with pytest.raises(ts.OptionError, match=part):
        ts.stage_storage(POND, **options)


def test_a_region_outside_is_refused():
    with pytest.raises(ts.PointsError, match="outside the surface"):
        ts.stage_storage(POND, levels=[1], region=[[9, 9], [10, 9], [9, 10]])


def test_degrees_are_refused():
    with pytest.raises(ts.CrsError, match="cannot be measured in degrees"):
        ts.stage_storage(POND.replace(crs="EPSG:4326"), levels=[1])


def test_a_level_surface_covers_the_tin_at_its_level():
    tin = rough(40, 5)
    plane = [[0, 0, 1.0], [10, 0, 2.0], [0, 10, 1.5]]
    for base in (302.0, plane):
        by_surface = ts.volume(tin, level_surface(tin, base))
        for name in ("cut", "fill", "area"):
            assert by_surface[name][0] == pytest.approx(
                ts.volume(tin, base=base)[name][0], rel=1e-9
            )
