"""Proof of surfaces in tiles: faults of every kind are found, with the tile and the edge."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from support.tiled import divide, sum_areas

import tinsmith as ts
from tinsmith.base.errors import CheckError
from tinsmith.tin.tiling.exact_sum import ExactSum
from tinsmith.tin.tiling.local_triangulation import triangulate_box
from tinsmith.tin.tiling.proof import TileTriangles, check_tiles

POINTS = np.random.default_rng(1).random((400, 3)) * [100, 100, 5]
WHOLE = ts.triangulate(POINTS)
HULL = WHOLE.points[WHOLE.hull]


def tiles(side=3):
    source = divide(POINTS, side)
    for key in source.list_cells():
        local = triangulate_box(source, source.box_of(key))
        yield TileTriangles(key, local.points, local.numbers, local.triangles[local.owned])


def change(number, **made):
    """Return all tiles, one of them with other values."""
    parts = list(tiles())
    parts[number] = parts[number]._replace(**{k: v(parts[number]) for k, v in made.items()})
    return parts


def test_a_sound_surface_is_counted():
    proof = check_tiles(tiles(), hull=HULL)
    assert proof.tiles == 9
    assert (proof.vertices, proof.triangles) == (len(WHOLE.points), len(WHOLE.triangles))
    assert proof.edges == len(WHOLE.edges)
    assert proof.boundary_edges == len(WHOLE.hull)
    assert proof.boundary_rings == 1
    assert 0 < proof.edges_between < proof.edges
    assert proof.area == sum_areas(WHOLE.points[WHOLE.triangles])


def test_tiles_may_come_in_any_order():
    parts = list(tiles())
    assert check_tiles(parts, hull=HULL) == check_tiles(parts[::-1], hull=HULL)


def drop_last(part):
    return part.triangles[:-1]


def repeat_first(part):
    return np.concatenate([part.triangles, part.triangles[:1]])


def turn_first(part):
    return np.concatenate([part.triangles[:1, ::-1], part.triangles[1:]])


def lift_all(part):
    return np.add(part.points, [0, 0, 1e-9])


def test_a_missing_triangle_is_found():
    with pytest.raises(CheckError, match=r"has no triangle on its right|Vertices - edges"):
        check_tiles(change(4, triangles=drop_last), hull=HULL)


def test_a_triangle_that_is_there_twice_is_found():
    with pytest.raises(CheckError, match=r"Tile \(1, 1\) has two triangles left of the edge from"):
        check_tiles(change(4, triangles=repeat_first), hull=HULL)


def test_a_triangle_of_two_tiles_is_found():
    parts = list(tiles())
    with pytest.raises(CheckError, match=r"both have a triangle left of the edge|no triangle|Vert"):
        check_tiles([*parts, parts[4]._replace(tile="more")], hull=HULL)
    first = parts[4]._replace(triangles=parts[4].triangles[:1], tile="more")
    with pytest.raises(CheckError):
        check_tiles([*parts, first], hull=HULL)
    with pytest.raises(CheckError):
        check_tiles([first, *parts], hull=HULL)


def test_a_clockwise_triangle_is_found():
    with pytest.raises(CheckError, match=r"Tile \(1, 1\) has a triangle that is not counter-clock"):
        check_tiles(change(4, triangles=turn_first), hull=HULL)


def test_vertices_that_lie_elsewhere_are_found():
    with pytest.raises(CheckError, match=r"Vertex \d+ lies at .* in tile \(1, 2\), but at"):
        check_tiles(change(5, points=lift_all), hull=HULL)


def test_a_missing_tile_is_found():
    parts = list(tiles())
    for gone in range(9):
        with pytest.raises(CheckError, match=r"does not fill the convex hull|No tile has|Vertices"):
            check_tiles(parts[:gone] + parts[gone + 1 :], hull=HULL)


def test_another_area_than_wanted_is_found():
    area = sum_areas(WHOLE.points[WHOLE.triangles])
    assert check_tiles(tiles(), area=area).area == area
    with pytest.raises(CheckError, match="and its boundary and holes leave"):
        check_tiles(tiles(), area=area + Fraction(1, 2**60))


def test_a_vertex_of_a_tile_twice_is_found():
    def repeat(part):
        numbers = part.numbers.copy()
        numbers[1] = numbers[0]
        return numbers

    with pytest.raises(CheckError, match=r"Tile \(0, 0\) has vertex \d+ twice"):
        check_tiles(change(0, numbers=repeat))


def test_no_triangles_are_no_surface():
    with pytest.raises(CheckError, match="no triangles"):
        check_tiles([])


def test_sums_are_exact():
    rng = np.random.default_rng(5)
    a, b = ((1 + rng.random(3000)) * 10.0 ** rng.integers(-50, 50, 3000) for _ in range(2))
    a *= rng.choice([-1.0, 1.0], 3000)
    found = ExactSum()
    found.add_products(a, b)
    found.add_products(-b[::-1], a[::-1])
    found.add(a)
    assert found.value == sum(map(Fraction, a.tolist()))
    alone = ExactSum()
    alone.add_products(a, b)
    assert alone.value == sum(
        Fraction(x) * Fraction(y) for x, y in zip(a.tolist(), b.tolist(), strict=True)
    )
