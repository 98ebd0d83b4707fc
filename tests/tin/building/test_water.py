"""Waters over and in each other: what is left is what taking one after the other leaves."""

import numpy as np
import pytest
from fuzz.uneven import examine_water, generate_water
from support.each_value import list_seeds

import tinsmith as ts

SQUARE = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
GRID = np.array([[x, y, 9.0] for x in range(-12, 13) for y in range(-12, 13)])


@pytest.mark.parametrize("seed", list_seeds(60, few=20))
def test_waters_together_leave_what_one_after_the_other_leaves(seed):
    assert examine_water(generate_water(np.random.default_rng(seed))) in ("same", "refused")


@pytest.mark.parametrize("order", [1, -1])
def test_only_the_shore_of_the_outer_one_of_nested_waters_is_left(order):
    sizes = np.arange(1, 11)[::order]
    tin = ts.triangulate(GRID, water=[ts.Water(size * SQUARE, 5.0) for size in sizes])
    away = np.abs(tin.points[:, :2]).max(axis=1)
    assert (away >= 10).all()
    assert (tin.points[:, 2] == np.where(away == 10, 5.0, 9.0)).all()


def test_the_last_of_waters_at_one_shore_tells_its_level():
    rings = [4 * SQUARE, 4 * SQUARE + [4.0, 0.0], 4 * SQUARE]
    tin = ts.triangulate(
        GRID, water=[ts.Water(ring, level) for ring, level in zip(rings, (1, 2, 3), strict=True)]
    )
    west, east = tin.interpolate([[-4.0, 0.0], [8.0, 0.0]])
    assert (west, east) == (3.0, 2.0)
    assert np.isclose(tin.points[tin.points[:, 2] == 3.0, 0].max(), 4.0)


def test_a_boundary_through_overlapping_waters_takes_the_last_level():
    rings = [5 * SQUARE, 5 * SQUARE + [4.0, 0.0]]
    boundary = np.array([[-10.0, 0], [12, 0], [12, 12], [-10, 12]])
    tin = ts.triangulate(
        GRID,
        water=[ts.Water(ring, level) for ring, level in zip(rings, (1.0, 2.0), strict=True)],
        boundary=boundary,
    )
    found = tin.interpolate([[-4.0, 0.0], [0.0, 0.0], [8.0, 0.0]])
    assert found.tolist() == [1.0, 2.0, 2.0]


def test_waters_in_a_star_shaped_lake_go_though_no_side_of_it_is_at_the_hull():
    angle = np.arange(10) * np.pi / 5
    star = (
        np.column_stack([np.cos(angle), np.sin(angle)])
        * np.where(np.arange(10) % 2, 4, 10)[:, None]
    )
    tin = ts.triangulate(GRID, water=[ts.Water(star, 5.0), ts.Water(0.5 * SQUARE, 4.0)])
    assert np.hypot(*tin.points[:, :2].T).min() > 3.9
