"""Openings and least values around cells, against loops over every cell."""

from __future__ import annotations

import numpy as np
import pytest

from tinsmith.terrain.ground_filter import morphology
from tinsmith.terrain.ground_filter.frame import Frame, lay_cells
from tinsmith.terrain.ground_filter.morphology import (
    find_covered,
    least_around,
    list_windows,
    open_grid,
    split_columns,
)


def make_octagon(window):
    """Return offsets of the cells of the octagon, as the sum of four lines."""
    oblique = int(window * (1 - np.sqrt(0.5)))
    straight, short = (range(-n, n + 1) for n in (window - 2 * oblique, oblique))
    return {
        (a + c + d, b + c - d) for a in straight for b in straight for c in short for d in short
    }


def choose_within(grid, offsets, choose, outside):
    result = np.full(grid.shape, outside)
    for i, j in np.ndindex(*grid.shape):
        near = [(i + di, j + dj) for di, dj in offsets]
        held = [grid[a, b] for a, b in near if 0 <= a < grid.shape[0] and 0 <= b < grid.shape[1]]
        result[i, j] = choose([outside, *held])
    return result


@pytest.fixture
def grid():
    rng = np.random.default_rng(2)
    values = rng.integers(0, 50, (17, 13)).astype(float)
    values[rng.uniform(size=values.shape) < 0.3] = np.inf
    return values


@pytest.mark.parametrize("window", [1, 2, 3, 4, 7])
def test_opening(grid, window):
    octagon = make_octagon(window)
    eroded = choose_within(grid, octagon, min, np.inf)
    eroded[np.isinf(eroded)] = -np.inf
    assert (open_grid(grid, window) == choose_within(eroded, octagon, max, -np.inf)).all()


@pytest.mark.parametrize("window", [1, 2, 4])
def test_opening_with_windows_centred_where_data_are(grid, window):
    is_covered = np.isfinite(grid)
    is_covered[3:6, 2:5] = True
    octagon = make_octagon(window)
    eroded = choose_within(grid, octagon, min, np.inf)
    eroded[np.isinf(eroded) | ~is_covered] = -np.inf
    expected = choose_within(eroded, octagon, max, -np.inf)
    assert (open_grid(grid, window, is_covered) == expected).all()


@pytest.mark.parametrize("gap", [1, 2, 4])
def test_covered_cells(grid, gap):
    is_full = np.isfinite(grid)
    is_full[8:, 7:] = False
    octagon = make_octagon(gap)
    reached = choose_within(is_full, octagon, max, 0.0)
    closed = choose_within(reached, octagon, min, 1.0) > 0
    assert (find_covered(is_full, gap) == closed).all()
    assert (find_covered(is_full, gap) >= is_full).all()


def test_what_is_beyond_an_oblique_border_is_not_covered():
    rows, columns = np.indices((60, 60))
    is_full = rows + 2 * columns >= 60
    covered = find_covered(is_full, 4)
    assert (covered == is_full)[4:50, 4:50].all()  # a corner beyond it closes at the grid's border


def test_an_opening_lifts_nothing_and_is_done_once(grid):
    opened = open_grid(np.where(np.isinf(grid), 7.0, grid), 3)
    assert (opened <= np.where(np.isinf(grid), 7.0, grid)).all()
    assert (open_grid(opened, 3) == opened).all()


@pytest.mark.parametrize(("core", "reach"), [(2, 7), (1, 4), (0, 1), (0, 3), (3, 10)])
def test_least_around(grid, core, reach):
    away = range(-reach, reach + 1)
    ring = {(i, j) for i in away for j in away if max(abs(i), abs(j)) > core}
    assert (least_around(grid, core, reach) == choose_within(grid, ring, min, np.inf)).all()


@pytest.mark.parametrize("halo", [1, 4, 40])
def test_blocks_make_the_same_grid(grid, halo, monkeypatch):
    monkeypatch.setattr(morphology, "_BLOCK", 13 * 3)
    made = np.full(grid.shape, np.nan)
    for wide, inner, own in split_columns(grid.shape, halo):
        made[own] = grid[wide][inner]
    assert (made == grid).all()


def test_windows_grow_to_the_largest():
    for largest in range(1, 60):
        windows = list_windows(largest)
        assert windows[0] == 1
        assert windows[-1] == largest
        assert sorted(set(windows)) == windows


@pytest.mark.parametrize("steps", [1, 3, 1000])
@pytest.mark.parametrize("count", [1, 2, 500])
def test_points_of_cells_lie_from_the_lowest_up_then_by_coordinates(count, steps):
    """Also those of one elevation, those of one place, and zeros of both signs."""
    rng = np.random.default_rng(count + steps)
    points = rng.integers(0, steps + 1, (count, 3)) * (8 / steps)
    points[rng.random(count) < 0.1, 2] = -0.0
    frame = Frame((8.0, 8.0), 2.0, (0, 0), (5, 5))
    cells = lay_cells(points, frame)
    column, row = np.floor(points[:, :2] / 2).astype(int).T
    assert cells.number.tolist() == (5 * column + row).tolist()
    x, y, z = points.T
    assert cells.order.tolist() == np.lexsort((y, x, z, cells.number)).tolist()
