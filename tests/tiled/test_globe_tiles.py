"""Quantized-mesh tiles of many files: those of memory on the finest level, and fitting above it."""

from __future__ import annotations

import json
import struct
from functools import partial

import numpy as np
import pytest
from support.many_files import Shuffled
from support.quantized_mesh import decode, load_folder

import tinsmith as ts

pytestmark = pytest.mark.filterwarnings("ignore:The elevations are not known above")

COARSEST_ERROR = 77_067.34
"""Metres: that Cesium expects of level 0."""


@pytest.fixture(scope="module")
def made(lidar, tmp_path_factory):
    """Return a folder of tiles."""
    path = tmp_path_factory.mktemp("globe") / "made"
    return ts.tiles(lidar, classes=2).write(
        path, format="quantized-mesh", tiles=5, executor=Shuffled()
    )


@pytest.fixture(scope="module")
def whole(tin, tmp_path_factory):
    """Return that of the surface in memory."""
    return ts.write(tin, tmp_path_factory.mktemp("globe") / "whole", format="quantized-mesh")


def read_files(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def list_levels(folder):
    """Return the coarsest level that shows the surface, and the finest."""
    layer = json.loads((folder / "layer.json").read_text())
    tiles = load_folder(folder)
    first = min(level for (level, _, _), tile in tiles.items() if len(set(tile["steps"][:, 2])) > 1)
    return first, layer["maxzoom"]


def test_finest_level_and_layer_are_those_of_memory(made, whole):
    found, wanted = read_files(made), read_files(whole)
    assert found.keys() == wanted.keys()
    assert found["layer.json"] == wanted["layer.json"]
    first, finest = list_levels(whole)
    assert finest - first >= 3
    for name, content in wanted.items():
        level = name.partition("/")[0]
        if name != "layer.json" and not first <= int(level) < finest:
            assert found[name] == content, name


@pytest.mark.parametrize(
    ("way", "options"),
    [
        ({"tiles": 1}, {}),
        ({"tiles": 40}, {}),
        ({"tiles": 9, "workers": 2}, {}),
        ({"tiles": 3}, {"max_level": 15, "gzipped": True}),
        ({"tiles": 3}, {"max_level": 12}),
    ],
)
def test_bytes_do_not_depend_on_tiles_order_or_workers(lidar, made, tin, tmp_path, way, options):
    if "workers" not in way:
        way = {**way, "executor": Shuffled(7)}
    cloud = ts.tiles(lidar, classes=2)
    path = cloud.write(tmp_path / "made", format="quantized-mesh", **options, **way)
    if not options:
        assert read_files(path) == read_files(made)
        return
    wanted = read_files(ts.write(tin, tmp_path / "whole", format="quantized-mesh", **options))
    found = read_files(path)
    assert found.keys() == wanted.keys()
    level = options["max_level"]
    for name in wanted:
        if name == "layer.json" or name.startswith(f"{level}/"):
            assert found[name] == wanted[name]


@pytest.mark.parametrize("most", [3, 9, 12, 15])
def test_a_run_that_was_interrupted_goes_on(lidar, made, tmp_path, most):
    write = partial(
        ts.tiles(lidar, classes=2).write, tmp_path / "made", format="quantized-mesh", tiles=5
    )
    with pytest.raises(KeyboardInterrupt):
        write(executor=Shuffled(1, most=most))
    assert read_files(write(executor=Shuffled(2))) == read_files(made)
    assert [path.name for path in tmp_path.iterdir()] == ["made"]


@pytest.mark.slow
def test_small_blocks_change_nothing(lidar, made, tmp_path, monkeypatch):
    from tinsmith.tiled.products import globe_tiles

    monkeypatch.setattr(globe_tiles, "_MOST_TRIANGLES", 500)
    monkeypatch.setattr(globe_tiles, "_GROUP", 1)
    path = ts.tiles(lidar, classes=2).write(
        tmp_path / "made", format="quantized-mesh", tiles=4, executor=Shuffled(3)
    )
    assert read_files(path) == read_files(made)


def test_neighbours_have_the_same_vertices_heights_and_normals_on_their_edge(made):
    tiles = load_folder(made)
    first, finest = list_levels(made)
    compared = 0
    for (level, x, y), tile in tiles.items():
        for dx, dy, axis in ((1, 0, 0), (0, 1, 1)):
            other = tiles.get((level, x + dx, y + dy))
            if other is None or not first <= level <= finest:
                continue
            sides = []
            for one, value in ((tile, 32767), (other, 0)):
                on = np.flatnonzero(one["steps"][:, axis] == value)
                places = np.column_stack(
                    [one["steps"][on, 1 - axis], one["places"][on, 2], one["normals"][on]]
                )
                sides.append(places[np.argsort(places[:, 0])])
            np.testing.assert_array_equal(sides[0][:, 0], sides[1][:, 0])
            np.testing.assert_allclose(sides[0], sides[1], atol=1e-9)
            compared += len(sides[0])
    assert compared > 100


def interpolate(tile, places):
    """Return the heights at places by the triangles of a tile, one after the other; NaN outside."""
    found = np.full(len(places), np.nan)
    for a, b, c in tile["places"][tile["triangles"]]:
        box = np.array([a, b, c])[:, :2]
        is_near = ((places >= box.min(axis=0)) & (places <= box.max(axis=0))).all(axis=1)
        u, v, w = b[:2] - a[:2], c[:2] - a[:2], places[is_near] - a[:2]
        area = u[0] * v[1] - u[1] * v[0]
        s = (w[:, 0] * v[1] - w[:, 1] * v[0]) / area
        t = (u[0] * w[:, 1] - u[1] * w[:, 0]) / area
        inside = (s >= 0) & (t >= 0) & (s + t <= 1)
        heights = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2])
        found[np.flatnonzero(is_near)[inside]] = heights[inside]
    return found


def test_levels_cover_the_surface_and_hold_its_vertices(made, tin):
    tiles = load_folder(made)
    first, finest = list_levels(made)
    places = ts.transform_points(tin.points, tin.crs, "EPSG:4326")
    surface = ts.TIN.from_triangles(places, tin.triangles)
    places = places[::5]
    counts = []
    for level in range(first, finest + 1):
        own = [tile for (one, _, _), tile in tiles.items() if one == level]
        area = 0.0
        for tile in own:
            corners = tile["places"][tile["triangles"]]
            u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
            area += (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2
        assert area == pytest.approx(surface.area, rel=1e-2 if level < finest else 1e-4), level
        found = np.array([interpolate(tile, places[:, :2]) for tile in own])
        away = np.abs(found - places[:, 2])
        assert np.isfinite(away).any(axis=0).mean() > 0.98
        assert np.nanmax(away) < COARSEST_ERROR / 2**level / 4, level
        counts.append(sum(len(tile["triangles"]) for tile in own))
    assert counts == sorted(counts)


def test_headers_are_sound(made):
    for path in made.rglob("*.terrain"):
        content = path.read_bytes()
        level, x, y = (int(part.partition(".")[0]) for part in path.parts[-3:])
        tile = decode(content, (level, x, y))
        low, high = struct.unpack_from("<2f", content, 24)
        assert low <= tile["places"][:, 2].min() + 1e-6
        assert high >= tile["places"][:, 2].max() - 1e-6


def test_what_is_refused(lidar, tmp_path):
    path = ts.write(ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]]), tmp_path / "points.csv")
    made, way = tmp_path / "made", {"executor": Shuffled(), "format": "quantized-mesh"}
    with pytest.raises(ts.CrsError, match="declare it"):
        ts.tiles(path).write(made, run=tmp_path / "run", **way)
    with pytest.raises(ts.PointsError, match="choose a finer one"):
        ts.tiles(path, crs="EPSG:32616").write(made, max_level=2, **way)
    for given in ({"tolerance": 0.5}, {"max_level": 24}, {"gzipped": 3}, {"node_points": 99}):
        with pytest.raises(ts.OptionError):
            ts.tiles(lidar).write(made, **given, **way)
    with pytest.raises(ts.OptionError, match="left out for 3dtiles"):
        ts.tiles(lidar).write(made, max_level=3, executor=Shuffled())
    assert sorted(one.name for one in tmp_path.iterdir()) == ["points.csv"]


def test_points_far_from_the_others_are_no_reason_for_millions_of_tiles(tmp_path):
    rng = np.random.default_rng(5)
    near = np.column_stack([rng.random((500, 2)) * 100 + [500_000, 4_000_000], rng.random(500)])
    far = [[500_000, 5_000_000, 0], [700_000, 4_000_000, 0]]
    survey = ts.Survey(points=np.vstack([near, far]), crs="EPSG:32616")
    path = ts.write(survey, tmp_path / "far.csv")
    words = (
        r"would have [\d,]+ tiles or more, and the surface has [\d,]+ triangles: leave out points"
    )
    with pytest.raises(ts.WriteError, match=words):
        ts.write(ts.triangulate(survey), tmp_path / "whole", format="quantized-mesh")
    with pytest.raises(ts.PointsError, match=words):
        ts.tiles(path, crs="EPSG:32616").write(tmp_path / "made", format="quantized-mesh", tiles=3)
    assert not (tmp_path / "whole").exists()
    assert not (tmp_path / "made").exists()
    ts.write(ts.triangulate(survey), tmp_path / "coarse", format="quantized-mesh", max_level=8)
