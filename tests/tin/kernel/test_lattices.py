"""Lattices: rasters with and without gaps, whose triangles are written without a search."""

from __future__ import annotations

import numpy as np
import pytest
from support import oracles
from support.kernel_datasets import (
    Method,
    make_points,
    require_same_growth,
    require_sound,
    with_heights,
)
from support.point_sets import UTM_CORNER, grid

import tinsmith as ts
from tinsmith.tin import _kernel

THREADS = (1, 2, 5)


def is_written_as_lattice(points):
    counts = _kernel.count_work(points)
    return counts["searches"] == counts["walk_steps"] == 0


def require_same_by_every_engine(points):
    wanted = _kernel.grow(points, method=Method.INSERTION)
    for method in (Method.AUTOMATIC, Method.GROWTH):
        for threads in THREADS:
            require_same_growth(_kernel.grow(points, method=method, threads=threads), wanted)


def require_lattice(xy):
    """The points are a lattice to the kernel, and every engine gives the same arrays."""
    points = np.ascontiguousarray(with_heights(xy))
    assert is_written_as_lattice(points)
    require_same_by_every_engine(points)
    return points


def require_no_lattice(xy):
    points = np.ascontiguousarray(with_heights(xy))
    assert not is_written_as_lattice(points)
    require_same_by_every_engine(points)


def kept(keep, step=(30.0, 30.0), corner=UTM_CORNER):
    """Centres of the cells of a raster that are kept: (rows, columns) of bool to (n, 2)."""
    rows, columns = keep.shape
    return corner + grid(columns, rows)[keep.ravel()] * np.asarray(step)


def full(columns=40, rows=30):
    return np.ones((rows, columns), bool)


# ------------------------------------------------------------------ full rasters


@pytest.mark.each_value
@pytest.mark.parametrize("corner", [(0, 0), UTM_CORNER, (-1e9, 1e9), (1e-20, 0.1), (3e60, -1e60)])
@pytest.mark.parametrize("step", [1.0, 0.1, 1 / 3, 30.0, 1e6])
def test_full_raster_is_a_lattice_at_any_origin(corner, step):
    corner = np.asarray(corner, float)
    size = np.maximum(step, np.abs(corner) * 1e-12)  # else its points are one place in doubles
    require_lattice(kept(full(), size, corner))


@pytest.mark.parametrize("exponent", [-190, -60, 60, 240])
def test_size_of_the_steps_does_not_matter(exponent):
    require_lattice(kept(full(), np.full(2, 2.0**exponent), np.zeros(2)))


@pytest.mark.parametrize("shape", [(2, 2), (2, 3), (3, 2), (2, 50), (7, 3), (64, 65)])
def test_shape_does_not_matter(shape):
    require_lattice(kept(np.ones(shape, bool)))


@pytest.mark.parametrize("ratio", [0.3, 0.7, 1.4, 3.0, 5.0])
def test_cells_may_be_oblong(ratio):
    require_lattice(kept(full(), (1.0, ratio)))


@pytest.mark.parametrize("ratio", [1 / 40, 40.0])
def test_cells_that_the_index_would_nest_are_searched(ratio):
    require_no_lattice(kept(full(), (1.0, ratio)))


def test_steps_may_vary_as_long_as_columns_and_rows_stay_apart():
    """The empty circle of a cell does not depend on the steps, only recognition does."""
    rng = np.random.default_rng(1)
    x = np.arange(40) + rng.uniform(-0.05, 0.05, 40)
    y = np.arange(30) + rng.uniform(-0.05, 0.05, 30)
    require_lattice(np.stack(np.meshgrid(x, y), -1).reshape(-1, 2))


def test_growing_steps_are_searched():
    x, y = 1.3 ** np.arange(30), 1.2 ** np.arange(25)
    require_no_lattice(np.stack(np.meshgrid(x, y), -1).reshape(-1, 2))


def test_order_of_the_rows_does_not_matter():
    points = with_heights(kept(full()))
    wanted = _kernel.grow(points)
    for seed in range(3):
        row = np.random.default_rng(seed).permutation(len(points))
        assert is_written_as_lattice(points[row])
        found = _kernel.grow(points[row], threads=2)
        np.testing.assert_array_equal(row[found.triangles], wanted.triangles)
        np.testing.assert_array_equal(found.neighbors, wanted.neighbors)


def test_rows_of_cells_may_be_given_column_by_column():
    points = kept(full(33, 21)).reshape(21, 33, 2)
    require_lattice(points.transpose(1, 0, 2).reshape(-1, 2))


@pytest.mark.parametrize("name", ["raster", "decimal raster"])
def test_raster_needs_no_decision(name):
    counts = _kernel.count_work(make_points(name, 3_000))
    del counts["triangles"]
    assert not any(counts.values())


def test_lattice_numbered_in_the_sweep():
    keep = full()
    keep[10:14, 7:20] = False
    keep[3, 3] = False
    points = require_lattice(kept(keep))
    plain, swept = _kernel.grow(points), _kernel.sweep(points, threads=2)
    np.testing.assert_array_equal(swept.rows[swept.triangles], plain.triangles)
    np.testing.assert_array_equal(swept.neighbors, plain.neighbors)
    np.testing.assert_array_equal(swept.places, points[swept.rows, :2])


# ------------------------------------------------------------------ gaps

GAPS = {
    "one": [(5, 5)],
    "two side by side": [(5, 5), (5, 6)],
    "two above each other": [(5, 5), (6, 5)],
    "two at a corner": [(5, 5), (6, 6)],
    "two at the other corner": [(5, 6), (6, 5)],
    "two apart by one": [(5, 5), (5, 7)],
    "three in an angle": [(5, 5), (5, 6), (6, 5)],
    "plus": [(5, 5), (4, 5), (6, 5), (5, 4), (5, 6)],
    "checkerboard": [(r, c) for r in range(4, 11) for c in range(4, 11) if (r + c) % 2],
    "ring about a point": [(r, c) for r in (4, 5, 6) for c in (4, 5, 6) if (r, c) != (5, 5)],
    "ring about a pair": [(r, c) for r in (4, 5, 6) for c in (4, 5, 6, 7) if r != 5 or c in (4, 7)],
    "ring about a block": [
        (r, c) for r in range(4, 13) for c in range(4, 13) if r in (4, 12) or c in (4, 12)
    ],
    "diagonal": [(i, i) for i in range(3, 15)],
    "long slit": [(9, c) for c in range(2, 38)],
    "south-west corner": [(0, 0)],
    "all corners": [(0, 0), (0, 39), (29, 0), (29, 39)],
    "one of the edge": [(0, 7)],
    "bay": [(r, c) for r in range(6) for c in range(10, 20)],
    "cut through": [(r, 20) for r in range(30)],
    "empty column and row": [(r, c) for r in range(30) for c in range(40) if r == 9 or c == 25],
    "stairs at a corner": [(r, c) for r in range(12) for c in range(12) if r + c < 12],
    "point alone at a corner": [(r, c) for r in range(4) for c in range(4) if r + c > 0],
}


@pytest.mark.each_value
@pytest.mark.parametrize("ratio", [1.0, 1.7])
@pytest.mark.parametrize("name", GAPS)
def test_gaps(name, ratio):
    keep = full()
    keep[tuple(np.transpose(GAPS[name]))] = False
    require_lattice(kept(keep, (0.1, 0.1 * ratio)))


def distance_from(column, row, columns, rows):
    at = grid(columns, rows) - (column, row)
    return np.hypot(*at.T).reshape(rows, columns)


@pytest.mark.parametrize("radius", [3.0, 9.5, 20.0])
def test_large_round_hole_with_an_island(radius):
    keep = full(80, 70)
    far = distance_from(37, 33, 80, 70)
    keep &= (far > radius) | (far < radius / 3)
    require_lattice(kept(keep))


def test_round_raster():
    require_lattice(kept(distance_from(40, 40, 81, 81) < 40))


def test_raster_turned_within_its_box():
    column, row = grid(90, 90).T - 45.0
    a = np.deg2rad(27)
    along, across = column * np.cos(a) + row * np.sin(a), row * np.cos(a) - column * np.sin(a)
    require_lattice(kept(((abs(along) < 33) & (abs(across) < 28)).reshape(90, 90)))


def test_islands():
    """Several parts that touch nowhere: between them lies one hole that is no ring."""
    keep = np.zeros((60, 80), bool)
    keep[2:30, 3:40] = keep[35:60, 5:33] = keep[10:50, 45:78] = True
    keep[0, 0] = keep[59, 79] = keep[32, 42] = True
    require_lattice(kept(keep))


@pytest.mark.each_value
@pytest.mark.parametrize("share", [0.001, 0.01, 0.05, 0.1, 0.15])
@pytest.mark.parametrize("name", ["raster", "decimal raster"])
def test_missing_cells(name, share):
    points = make_points(name, 10_000)
    rng = np.random.default_rng(int(1000 * share))
    points = require_lattice(points[rng.random(len(points)) > share, :2])
    tin = require_sound(points)
    assert len(tin.triangles) == 2 * len(points) - 2 - oracles.hull_size(points)


@pytest.mark.parametrize("share", [0.25, 0.5, 0.8])
def test_raster_with_many_gaps_is_searched(share):
    keep = np.random.default_rng(5).random((50, 50)) > share
    require_no_lattice(kept(keep))


# ------------------------------------------------------------------ what is no lattice


def test_repeated_point_is_merged():
    xy = kept(full())
    points = with_heights(np.vstack([xy, xy[70:72]]))
    assert not is_written_as_lattice(points)
    tin = ts.triangulate(points)
    assert len(tin.points) == len(xy)
    np.testing.assert_array_equal(tin.triangles, ts.triangulate(points[: len(xy)]).triangles)


@pytest.mark.parametrize("row", [0, 1, 617, 1198, 1199])
def test_one_point_beside_its_place(row):
    for axis in (0, 1):
        xy = kept(full(), corner=np.zeros(2))
        xy[row, axis] = np.nextafter(xy[row, axis], 2000.0)
        require_no_lattice(xy)


def test_point_in_the_middle_of_a_cell():
    require_no_lattice(np.vstack([kept(full()), UTM_CORNER + 45.0]))


def test_one_row_is_refused():
    points = with_heights(np.column_stack([np.arange(50.0), np.full(50, 3.0)]))
    with pytest.raises(ts.PointsError, match="collinear"):
        ts.triangulate(points)
    with pytest.raises(ts.PointsError, match="collinear"):
        ts.triangulate(points[:, [1, 0, 2]])


@pytest.mark.parametrize("n", [3, 4, 9])
def test_diagonal_of_a_raster_is_refused(n):
    diagonal = np.repeat(np.arange(float(n)), 2).reshape(n, 2)
    for xy in (diagonal, diagonal * [1, -1]):
        with pytest.raises(ts.PointsError, match="collinear"):
            ts.triangulate(with_heights(xy))


def test_turned_raster_is_searched():
    a = np.deg2rad(10)
    turn = np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
    require_no_lattice(kept(full(), corner=np.zeros(2)) @ turn)


# ------------------------------------------------------------------ at random


def random_raster(rng):
    columns, rows = rng.integers(2, rng.choice([5, 12, 40]), 2)
    step = float(rng.choice([1.0, 0.1, 30.0, 1 / 3, 1e-9, 1e6])) * np.array(
        [1.0, rng.choice([1.0, 1.0, 2.0, 0.5, 1.1, 7.0])]
    )
    keep = rng.random((rows, columns)) >= rng.choice([0.0, 0.02, 0.1, 0.3, 0.5])
    for _ in range(rng.integers(0, 3)):
        far = distance_from(rng.uniform(0, columns), rng.uniform(0, rows), columns, rows)
        keep &= far > rng.uniform(0, max(columns, rows) / 2.5)
    corner = np.array([[0.0, 0.0], UTM_CORNER, [-7.3, 2.1]][rng.integers(3)])
    xy = kept(keep, step, corner)
    return rng.permutation(xy) if rng.random() < 0.3 else xy


def require_random_rasters(rng, count):
    written = 0
    for _ in range(count):
        xy = np.unique(random_raster(rng), axis=0)
        points = np.ascontiguousarray(with_heights(rng.permutation(xy)))
        if oracles.are_collinear(xy):
            continue
        require_same_by_every_engine(points)
        written += is_written_as_lattice(points)
    assert written > count / 8


def test_random_rasters():
    require_random_rasters(np.random.default_rng(1), 60)


@pytest.mark.proof
@pytest.mark.parametrize("seed", range(4))
def test_hundreds_of_random_rasters(seed):
    require_random_rasters(np.random.default_rng(10 + seed), 300)
