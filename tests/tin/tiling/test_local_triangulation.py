"""Triangles that meet a box, from the points near by: those of the whole triangulation."""

from __future__ import annotations

import numpy as np
import pytest
from support.point_cells import PointCells
from support.tiled import divide, find_triangles_at, require_triangles_of_the_whole

import tinsmith as ts
from tinsmith.tin import PointsError, _kernel
from tinsmith.tin.tiling import local_triangulation
from tinsmith.tin.tiling.boxes import list_sides, widen
from tinsmith.tin.tiling.local_triangulation import triangulate_box


def rng(seed=0):
    return np.random.default_rng(seed)


def lift(xy, seed=0):
    return np.column_stack([xy, rng(seed).random(len(xy)) * 50])


def lattice(side):
    x, y = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float))
    return np.column_stack([x.ravel(), y.ravel()])


def circle(count):
    turns = 2 * np.pi * rng(5).random(count)
    return 1000 * np.column_stack([np.cos(turns), np.sin(turns)])


CLOUDS = {
    "uniform": rng(1).random((4000, 2)) * 1000,
    "clusters": np.concatenate(
        [rng(k).normal(rng(k).random(2) * 900, 4, (300, 2)) for k in range(9)]
    ),
    "lattice": lattice(40),
    "lattice with duplicates": np.round(rng(2).random((3000, 2)) * 40),
    "scan lines": np.column_stack(
        [np.repeat(np.arange(30.0) * 30, 90), np.tile(np.arange(90.0), 30)]
    ),
    "circle": circle(1500),
    "far from the origin": rng(3).random((3000, 2)) * 3 + np.array([4e6, 5e6]),
    "two corners": np.concatenate([rng(4).random((500, 2)), rng(5).random((500, 2)) + 900]),
}


@pytest.mark.each_value
@pytest.mark.parametrize("side", [1, 2, 4, pytest.param(8, marks=pytest.mark.proof)])
@pytest.mark.parametrize("name", CLOUDS)
def test_the_parts_are_those_of_the_whole(name, side):
    points = lift(CLOUDS[name])
    source = divide(points, side)
    require_triangles_of_the_whole(points, source, margin=float(np.ptp(points[:, 0])) / 50)


@pytest.mark.parametrize("name", CLOUDS)
def test_looking_at_some_points_first_changes_nothing(name, monkeypatch):
    """Which is done only of more points than are in these boxes."""
    monkeypatch.setattr(local_triangulation, "_WORTH_LOOKING", 0)
    points = lift(CLOUDS[name])
    margin = float(np.ptp(points[:, 0])) / 50
    require_triangles_of_the_whole(points, divide(points, 2), margin=margin)


def test_few_points_are_read():
    """Of an even cloud no more than the tile, its margin and the skeleton."""
    points = lift(rng(7).random((40_000, 2)) * 1000)
    source = divide(points, 8)
    before = source.rows_read
    local = triangulate_box(
        source, source.box_of((3, 3)), around=widen(source.box_of((3, 3)), 50.0)
    )
    assert len(local.points) > 500
    assert source.rows_read - before < len(points) / 8
    assert local.rounds <= 2


def test_no_margin_asks_more_often_and_finds_the_same():
    points = lift(rng(8).random((3000, 2)))
    source = divide(points, 4)
    box = source.box_of((1, 2))
    one, other = (triangulate_box(source, box, around=widen(box, margin)) for margin in (0.0, 0.2))
    for name in ("points", "numbers", "triangles", "neighbors", "owned"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    assert one.rounds > 0


def test_neighbors_are_those_with_the_same_edge():
    points = lift(rng(9).random((500, 2)))
    source = divide(points, 3)
    local = triangulate_box(source, source.box_of((1, 1)))
    edges = {
        (int(t[k - 2]), int(t[k - 1])): n for n, t in enumerate(local.triangles) for k in range(3)
    }
    for (start, end), number in edges.items():
        k = next(k for k in range(3) if local.triangles[number][k - 2] == start)
        assert local.neighbors[number, k] == edges.get((end, start), -1)


@pytest.mark.parametrize("duplicates", ["mean", "first", "last", "lowest", "highest"])
def test_rows_at_one_place_have_the_elevation_of_the_whole(duplicates):
    points = lift(np.round(rng(10).random((2000, 2)) * 25))
    require_triangles_of_the_whole(points, divide(points, 3), margin=1.0, duplicates=duplicates)


def test_collinear_points_are_refused():
    points = lift(np.column_stack([np.arange(50.0), np.arange(50.0)]))
    source = divide(points, 2)
    with pytest.raises(PointsError, match="collinear"):
        triangulate_box(source, source.box_of((0, 0)))


def test_triangles_that_meet_a_box():
    """By shapely, in coordinates that doubles hold."""
    shapely = pytest.importorskip("shapely")
    tin = ts.triangulate(lift(np.round(rng(11).random((300, 2)) * 64)))
    for west, south, width, height in rng(12).integers(0, 40, (60, 4)):
        box = ts.Bounds(west, south, west + width, south + height)
        corners = shapely.polygons(tin.points[tin.triangles][:, :, :2])
        drawn = shapely.box(box.xmin, box.ymin, box.xmax, box.ymax)
        wanted = np.flatnonzero(shapely.intersects(corners, drawn))
        np.testing.assert_array_equal(find_triangles_at(tin.points, tin.triangles, box), wanted)
        places = np.ascontiguousarray(tin.points[:, :2])
        found = _kernel.find_in_box(places, tin.triangles, list_sides(box), list_sides(box))
        np.testing.assert_array_equal(found.chosen, wanted)


def test_the_cells_of_a_source_hold_every_point_once():
    points = lift(lattice(9))
    source = PointCells(points, [3.0, 6.0], [4.0])
    numbers = np.concatenate([cell.numbers for cell in source.cells.values()])
    assert sorted(numbers.tolist()) == list(range(81))


@pytest.mark.parametrize("name", ["uniform", "lattice with duplicates", "scan lines"])
def test_the_order_in_which_triangles_are_found_holds_the_same_triangles(name):
    points = lift(CLOUDS[name])
    source = divide(points, 3)
    one, other = (
        triangulate_box(source, source.box_of((1, 1)), ordered=ordered) for ordered in (True, False)
    )
    order = np.lexsort(other.triangles.T[1::-1])
    np.testing.assert_array_equal(one.points, other.points)
    np.testing.assert_array_equal(one.numbers, other.numbers)
    np.testing.assert_array_equal(one.triangles, other.triangles[order])
    np.testing.assert_array_equal(one.owned, other.owned[order])
    place = np.append(np.argsort(order), -1)
    np.testing.assert_array_equal(one.neighbors, place[other.neighbors[order]])


def test_discs_whose_products_of_sides_overflow_are_not_taken_for_small():
    places = np.array([[-1.9e59, 0.0], [0.0, -1e57], [0.0, -1.25e55]])
    triangles = np.array([[0, 1, 2]], np.int32)
    found = _kernel.find_in_box(
        places, triangles, (-np.inf, -np.inf, -5e57, np.inf), (-np.inf, -np.inf, -5e57, np.inf)
    )
    assert found.chosen.tolist() == found.open.tolist() == [0]
    assert found.firsts.tolist() == [0]
    assert found.owned.tolist() == [True]
