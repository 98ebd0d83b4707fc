"""What a check measures lines by: inside and outside, in water or beside it, distances."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import tinsmith as ts
from tinsmith.tin.checking import inputs
from tinsmith.tin.checking.chain_matching import _project, distance
from tinsmith.tin.checking.inputs import _is_in_ring, _is_in_water, _is_inside, _measure_unit
from tinsmith.tin.constraints.constraint_set import gather_lines

ELL = np.array([[0, 0], [6, 0], [6, 2], [2, 2], [2, 6], [0, 6], [0, 0]], float)


def random_segments(seed, count=200):
    rng = np.random.default_rng(seed)
    return rng.integers(-5, 6, (3, count, 2)).astype(float)


@pytest.mark.parametrize("seed", range(3))
def test_distances_are_those_of_shapely(seed):
    p, a, b = random_segments(seed)
    wanted = [
        shapely.Point(place).distance(shapely.LineString([start, end]))
        for place, start, end in zip(p, a, b, strict=True)
    ]
    np.testing.assert_allclose(distance(p, a, b), wanted, atol=1e-12)


def test_the_foot_of_a_place_lies_so_far_along():
    a, b = np.array([[1.0, 1.0]]), np.array([[4.0, 5.0]])
    for along in (-2.0, 0.0, 2.5, 5.0, 9.0):
        foot = a + along * np.array([0.6, 0.8])
        for across in (-3.0, 0.0, 1.0):
            place = foot + across * np.array([-0.8, 0.6])
            assert _project(place, a, b) == pytest.approx(along, abs=1e-12)


@pytest.mark.parametrize("slack", [0.0, 0.25, 1.0])
def test_a_place_is_in_a_ring_or_nearly(slack):
    axis = np.linspace(-1, 7, 33)
    ring = shapely.Polygon(ELL)
    for turned in (ELL, ELL[::-1]):
        for x in axis:
            for y in axis:
                point = shapely.Point(x, y)
                wanted = ring.contains(point) or ring.exterior.distance(point) <= slack
                assert _is_in_ring(np.array([x, y]), turned, slack) == wanted, (x, y)


@pytest.mark.parametrize("slack", [0.0, 0.25])
def test_a_place_is_inside_if_it_is_further_from_the_rim(slack):
    axis = np.arange(7.0)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    tin = ts.triangulate(np.column_stack([x, y, x]), boundary=[ELL[:-1]])
    surface = shapely.Polygon(ELL)
    axis = np.linspace(-1, 7, 33)
    places = np.array([[x, y] for x in axis for y in axis])
    wanted = [
        surface.contains(shapely.Point(place))
        and surface.exterior.distance(shapely.Point(place)) > slack
        for place in places
    ]
    assert _is_inside(tin, places, slack).tolist() == wanted
    assert _is_inside(tin, places[:0], slack).tolist() == []


def test_water_is_where_a_shore_of_any_pond_is():
    ponds = [ts.Water(ELL[:-1] + shift, 1.0) for shift in (0.0, 20.0)]
    lines = gather_lines([[[0, 30, 1], [30, 30, 1]]], (), (), ponds)
    places = np.array([[1, 1], [4, 4], [21, 25], [25, 25], [15, 30], [6.1, 1]], float)
    assert _is_in_water(places, lines, 0.0).tolist() == [True, False, True, False, False, False]
    assert _is_in_water(places, lines, 0.2).tolist() == [True, False, True, False, False, True]
    assert _is_in_water(places[:0], lines, 0.2).tolist() == []


@pytest.mark.parametrize("shift", [0.0, 5e5, -5e5])
@pytest.mark.parametrize("snap", [0.0, 0.5])
def test_one_cut_moves_a_line_by_the_snap_and_some_roundings(shift, snap):
    tin = ts.triangulate([[shift, 0, 0], [shift + 1, 0, 0], [shift, 1, 0]], snap=snap / 1000)
    some = np.array([[3.0, -7.0]])
    largest = max(abs(shift), abs(shift + 1), 7.0)
    wanted = snap / 1000 + inputs._UNITS_OF_ROUNDING * np.spacing(largest)
    assert _measure_unit(tin, some) == pytest.approx(wanted, rel=1e-15)
    assert _measure_unit(tin, some[:0]) <= wanted
