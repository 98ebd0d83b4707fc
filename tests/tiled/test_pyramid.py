"""3D Tiles: contents that fit, cover the surface once on each level, and err as they say."""

from __future__ import annotations

import filecmp
from collections import Counter
from functools import partial

import numpy as np
import pyproj
import pytest
from support.many_files import Shuffled
from support.tiles_3d import read_tileset

import tinsmith as ts
from tinsmith.terrain.simplification.pyramid import Node, Quadtree, make_finest

pytestmark = pytest.mark.filterwarnings("ignore:The elevations are not known above")

POINTS = 300
"""Of a square."""


@pytest.fixture(scope="module")
def made(lidar, tmp_path_factory):
    """Return a folder of 3D Tiles."""
    path = tmp_path_factory.mktemp("pyramid") / "made"
    return ts.tiles(lidar, classes=2).write(path, node_points=POINTS, executor=Shuffled())


def to_map(tileset, positions, crs):
    """Return positions as eastings, northings and elevations, by PROJ."""
    matrix = np.array(tileset["root"]["transform"]).reshape(4, 4).T
    globe = positions @ matrix[:3, :3].T + matrix[:3, 3]
    transformer = pyproj.Transformer.from_crs("EPSG:4978", "EPSG:4979", always_xy=True)
    longitude, latitude, height = transformer.transform(*globe.T)
    plane = pyproj.Transformer.from_crs("EPSG:4326", crs, always_xy=True)
    return np.column_stack([*plane.transform(longitude, latitude), height])


def measure_areas(points, triangles):
    """Return areas in the plane."""
    a, b, c = ((points - points[0])[triangles[:, k], :2] for k in range(3))
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def test_each_level_covers_the_surface_once(made, tin):
    tileset, tiles = read_tileset(made)
    places = [to_map(tileset, tile.positions, "EPSG:32616") for tile in tiles]
    for level in range(max(tile.level for tile in tiles) + 1):
        areas = [
            measure_areas(points, tile.triangles)
            for tile, points in zip(tiles, places, strict=True)
            if tile.level == level
        ]
        # slivers across a square, turned over by steps of float32: 300 m times 2^-15 m
        assert min(one.min() for one in areas) > -0.01
        assert sum(one.sum() for one in areas) == pytest.approx(tin.area, rel=1e-6), level
    assert Counter(tile.level for tile in tiles)[0] == 1
    assert max(tile.level for tile in tiles) >= 2


def test_there_is_no_crack_within_a_level(made, tin):
    tileset, tiles = read_tileset(made)
    hull = tin.points[tin.boundary[0]]
    for level in range(max(tile.level for tile in tiles) + 1):
        edges = Counter()
        for tile in tiles:
            if tile.level == level:
                corners = list(map(tuple, tile.positions.tolist()))
                for a, b, c in tile.triangles.tolist():
                    for start, end in ((a, b), (b, c), (c, a)):
                        edges[corners[start], corners[end]] += 1
        assert set(edges.values()) == {1}
        open_edges = [edge for edge in edges if edge[::-1] not in edges]
        middles = np.mean([[start, end] for start, end in open_edges], axis=1)
        places = to_map(tileset, middles, "EPSG:32616")
        assert measure_from_ring(places, hull).max() < 1e-3, level


def measure_from_ring(places, ring):
    """Return the distance of places from the sides of a ring."""
    start, end = ring[:, :2], np.roll(ring, -1, axis=0)[:, :2]
    along = end - start
    found = []
    for place in places[:, :2]:
        away = place - start
        share = np.clip((away * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
        found.append(np.hypot(*(away - share[:, None] * along).T).min())
    return np.array(found)


def test_errors_are_bounds(made, tin):
    tileset, tiles = read_tileset(made)
    rng = np.random.default_rng(1)
    for tile in tiles:
        shares = rng.dirichlet([1, 1, 1], (len(tile.triangles), 5))
        inside = np.einsum("tsk,tkx->tsx", shares, tile.positions[tile.triangles])
        places = to_map(tileset, inside.reshape(-1, 3), "EPSG:32616")
        away = np.abs(tin.interpolate(places[:, :2]) - places[:, 2])
        steep = 1e-3  # of the rounding of positions, on triangles that are nearly upright
        assert np.nanquantile(away, 0.99) <= tile.error + steep
        assert np.nanmean(away) < 2.0
    finest = max(tile.level for tile in tiles)
    assert max(tile.error for tile in tiles if tile.level == finest) < 0.01
    assert sum(len(tile.triangles) for tile in tiles if tile.level == finest) >= len(tin.triangles)


def test_vertices_of_the_finest_level_are_those_of_the_surface(made, tin):
    tileset, tiles = read_tileset(made)
    finest = max(tile.level for tile in tiles)
    positions = np.concatenate([tile.positions for tile in tiles if tile.level == finest])
    places = np.round(to_map(tileset, positions, "EPSG:32616"), 2)
    found = set(map(tuple, places.tolist()))
    assert set(map(tuple, np.round(tin.points, 2).tolist())) <= found


def require_same(one, other):
    """Require two folders of the same bytes."""
    names = sorted(str(path.relative_to(one)) for path in one.rglob("*") if path.is_file())
    assert names == sorted(
        str(path.relative_to(other)) for path in other.rglob("*") if path.is_file()
    )
    assert filecmp.cmpfiles(one, other, names, shallow=False)[0] == names


@pytest.mark.parametrize("way", [{"tiles": 3}, {"tiles": 40}, {"tiles": 16, "workers": 2}])
def test_bytes_do_not_depend_on_tiles_order_or_workers(lidar, made, tmp_path, way):
    executor = {} if "workers" in way else {"executor": Shuffled(7)}
    cloud = ts.tiles(lidar, classes=2)
    require_same(made, cloud.write(tmp_path / "made", node_points=POINTS, **way, **executor))


@pytest.mark.parametrize("most", [4, 9, 20, 26])
def test_a_run_that_was_interrupted_goes_on(lidar, made, tmp_path, most):
    write = partial(
        ts.tiles(lidar, classes=2).write, tmp_path / "made", node_points=POINTS, tiles=16
    )
    with pytest.raises(KeyboardInterrupt):
        write(executor=Shuffled(1, most=most))
    require_same(made, write(executor=Shuffled(2)))
    assert [path.name for path in tmp_path.iterdir()] == ["made"]


def test_a_tolerance_leaves_out_vertices_of_the_finest_level(lidar, made, tmp_path):
    cloud = ts.tiles(lidar, classes=2)
    coarse = cloud.write(tmp_path / "made", node_points=POINTS, tolerance=0.5, executor=Shuffled())
    counts = [
        sum(len(tile.triangles) for tile in read_tileset(folder)[1]) for folder in (made, coarse)
    ]
    assert counts[1] < counts[0] / 2


def test_a_small_surface_is_one_content(tmp_path):
    survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    path = ts.write(survey, tmp_path / "points.csv")
    folder = ts.tiles(path, crs="EPSG:32616").write(tmp_path / "made", executor=Shuffled())
    (tile,) = read_tileset(folder)[1]
    assert (len(tile.positions), len(tile.triangles)) == (4, 2)
    assert tile.error < 1e-5


def test_edges_across_several_squares_are_cut_at_one_place(tmp_path):
    rng = np.random.default_rng(5)
    xy = np.concatenate([rng.random((40, 2)) * 100, rng.random((4, 2)) * [2_000, 1_500]])
    points = np.column_stack([xy + np.array([500_000.0, 4_000_000.0]), rng.normal(0, 30, len(xy))])
    whole = ts.triangulate(points)
    tree = Quadtree.over(whole.bounds, len(points), 2)
    for x, y in np.ndindex(1 << tree.levels, 1 << tree.levels):
        node = Node(tree.levels, x, y)
        box = tree.find_box(node)
        beyond = tree.find_box(node._replace(x=node.x + 1))
        mesh, east = (make_finest(whole.points, whole.triangles, one, 0.0) for one in (box, beyond))
        if mesh is not None and east is not None:
            sides = [one.points[one.points[:, 0] == box.xmax] for one in (mesh, east)]
            np.testing.assert_array_equal(*sides)


def test_what_is_refused(lidar, tmp_path):
    path = ts.write(ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]]), tmp_path / "points.csv")
    made = tmp_path / "made"
    with pytest.raises(ts.CrsError, match="declare it"):
        ts.tiles(path).write(made, executor=Shuffled(), run=tmp_path / "run")
    for given in ({"format": "gltf"}, {"tolerance": -1.0}, {"node_points": 3}):
        with pytest.raises(ts.OptionError):
            ts.tiles(lidar).write(made, executor=Shuffled(), **given)
    assert not made.exists()
