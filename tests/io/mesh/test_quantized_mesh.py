"""Quantized-mesh tiles: decoded by hand, joined without cracks, on the surface, damaged."""

from __future__ import annotations

import gzip
import json
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
from support.quantized_mesh import load_folder
from support.surfaces import hills, punched

import tinsmith as ts
from tinsmith.io.mesh.quantized_mesh.levels import GridMesh, cut_along_grid
from tinsmith.io.mesh.quantized_mesh.tile import find_horizon_point, to_cartesian

DATA = Path(__file__).parents[2] / "data" / "meshes"
pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")
A, B = 6_378_137.0, 6_356_752.314245179


def cross(u, v):
    """Return the areas that pairs of vectors in the plane span."""
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def ground(n=400, size=3000.0, **how):
    return hills(n, size=size, unit=None, **how)


@pytest.fixture(scope="module")
def pyramid(tmp_path_factory):
    tin = ground()
    folder = tmp_path_factory.mktemp("tiles") / "ground"
    with pytest.warns(ts.LossWarning, match="above the ellipsoid"):
        ts.write(tin, folder, format="quantized-mesh")
    return tin, folder, load_folder(folder)


def in_degrees(tin):
    points = ts.transform_points(tin.points, tin.crs, "EPSG:4326")
    return ts.TIN.from_triangles(points, tin.triangles)


def test_layer_json_lists_just_the_tiles_that_are_there(pyramid):
    _, folder, tiles = pyramid
    layer = json.loads((folder / "layer.json").read_text())
    assert layer["format"] == "quantized-mesh-1.0"
    assert (layer["scheme"], layer["projection"]) == ("tms", "EPSG:4326")
    listed = {
        (level, x, y)
        for level, ranges in enumerate(layer["available"])
        for one in ranges
        for x in range(one["startX"], one["endX"] + 1)
        for y in range(one["startY"], one["endY"] + 1)
    }
    assert listed == set(tiles)
    assert {(0, 0, 0), (0, 1, 0)} <= listed
    for ranges in layer["available"]:  # none continues another upwards
        columns = [(one["startX"], one["endX"], one["startY"], one["endY"]) for one in ranges]
        assert not any((a, b, d + 1) == other[:3] for a, b, _, d in columns for other in columns)
    for level, x, y in listed:  # each has its parent, down to both roots
        assert level == 0 or (level - 1, x // 2, y // 2) in listed


def test_the_finest_tiles_lie_on_the_surface(pyramid):
    tin, _, tiles = pyramid
    surface = in_degrees(tin)
    finest = max(level for level, _, _ in tiles)
    area = 0.0
    for (level, _, _), tile in tiles.items():
        if level < finest:
            continue
        z = surface.interpolate(tile["places"][:, :2])
        inside = np.isfinite(z)
        assert inside.mean() > 0.9
        # Half a step in the plane, on the steepest triangle, and half a step of height.
        assert np.median(np.abs(z - tile["places"][:, 2])[inside]) < 0.01
        a, b, c = (tile["places"][tile["triangles"][:, k], :2] for k in range(3))
        area += np.abs(cross(b - a, c - a)).sum() / 2
    assert area == pytest.approx(surface.area, rel=1e-4)


def test_coarser_levels_keep_their_tolerance(pyramid):
    tin, _, tiles = pyramid
    surface = in_degrees(tin)
    levels = sorted({level for (level, _, _), tile in tiles.items() if tile["header"][4] > 0})
    assert len(levels) > 1
    for level in levels[:-1]:
        parts = [ts.TIN.from_triangles(tile["places"], tile["triangles"])
                 for (own, _, _), tile in tiles.items() if own == level]  # fmt: skip
        found = np.stack([part.interpolate(surface.points[:, :2]) for part in parts])
        seen = np.isfinite(found).any(axis=0)
        assert seen.mean() > 0.9
        z = np.nanmax(found[:, seen], axis=0)
        error = np.abs(z - surface.points[seen, 2])
        assert np.quantile(error, 0.98) <= 77_067.34 / 2**level / 4 * 1.05
        assert sum(len(part.triangles) for part in parts) < len(tin.triangles) * 1.5


def test_neighbours_have_the_same_vertices_on_their_edge(pyramid):
    _, _, tiles = pyramid
    compared = 0
    for (level, x, y), tile in tiles.items():
        for axis, name in ((0, (level, x + 1, y)), (1, (level, x, y + 1))):
            if name not in tiles:
                continue
            mine = tile["steps"][:, axis] == 32767
            theirs = tiles[name]["steps"][:, axis] == 0
            one, other = tile["places"][mine], tiles[name]["places"][theirs]
            one, other = (rows[np.argsort(rows[:, 1 - axis])] for rows in (one, other))
            assert one.shape == other.shape
            assert np.abs(one - other).max(initial=0.0) < 1e-9
            normals = [part["normals"][keep][np.argsort(part["places"][keep][:, 1 - axis])]
                       for part, keep in ((tile, mine), (tiles[name], theirs))]  # fmt: skip
            assert np.array_equal(*normals)
            compared += len(one)
    assert compared > 100


def test_triangles_edges_and_normals_of_each_tile(pyramid):
    _, _, tiles = pyramid
    for tile in tiles.values():
        a, b, c = (tile["steps"][tile["triangles"][:, k], :2] for k in range(3))
        assert (cross(b - a, c - a) > 0).all()
        for edge, (axis, value) in zip(
            tile["edges"], ((0, 0), (1, 0), (0, 32767), (1, 32767)), strict=True
        ):
            assert set(edge) == set(np.flatnonzero(tile["steps"][:, axis] == value))
        up = to_cartesian(tile["places"] + (0, 0, 1.0)) - to_cartesian(tile["places"])
        assert ((tile["normals"] * up).sum(axis=1) > 0).all()


def test_headers_bound_their_tiles(pyramid):
    _, _, tiles = pyramid
    for (level, _, _), tile in tiles.items():
        header = tile["header"]
        points = _to_space(tile["places"])
        assert np.linalg.norm(points - header[5:8], axis=1).max() <= header[8] * (1 + 1e-9)
        assert header[3] <= tile["places"][:, 2].min()
        assert header[4] >= tile["places"][:, 2].max()
        if level >= 5:
            assert 1.0 <= np.linalg.norm(header[9:12]) < 1.1


def _to_space(places):
    lon, lat, h = np.radians(places[:, 0]), np.radians(places[:, 1]), places[:, 2]
    n = A**2 / np.hypot(A * np.cos(lat), B * np.sin(lat))
    across = (n + h) * np.cos(lat)
    up = (n * B**2 / A**2 + h) * np.sin(lat)
    return np.column_stack([across * np.cos(lon), across * np.sin(lon), up])


def test_the_horizon_point_hides_only_what_is_hidden():
    """Where a camera does not see the horizon point, the globe hides every vertex from it."""
    rng = np.random.default_rng(5)
    places = np.column_stack([rng.uniform(10, 12, 40), rng.uniform(45, 47, 40),
                              rng.uniform(0, 3000, 40)])  # fmt: skip
    radii = np.array([A, A, B])
    points = _to_space(places)
    horizon = find_horizon_point(points, points.mean(axis=0))
    cameras = rng.normal(size=(4000, 3))
    cameras *= rng.uniform(1.01, 3, (4000, 1)) / np.linalg.norm(cameras, axis=1, keepdims=True)
    hidden = _is_hidden(cameras, horizon[None])[:, 0]
    assert 0.1 < hidden.mean() < 0.9
    assert _is_hidden(cameras[hidden], points / radii).all()


def test_the_horizon_point_is_no_higher_than_the_tangents_ask_for():
    """It lies where the tangent from the highest vertex to the sphere meets its direction."""
    rng = np.random.default_rng(6)
    for height in (0.0, 50.0, 8000.0, 300_000.0):
        places = np.column_stack(
            [rng.uniform(10, 12, 9), rng.uniform(45, 47, 9), np.full(9, height)]
        )
        points = _to_space(places)
        scaled = points / np.array([A, A, B])
        middle = points.mean(axis=0) / np.array([A, A, B])
        middle /= np.linalg.norm(middle)
        length = np.maximum(np.linalg.norm(scaled, axis=1), 1.0)
        aside = np.arccos(np.clip(scaled @ middle / np.linalg.norm(scaled, axis=1), -1, 1))
        wanted = (1 / np.cos(aside + np.arccos(1 / length))).max()
        found = find_horizon_point(points, points.mean(axis=0))
        assert np.linalg.norm(found) == pytest.approx(wanted, rel=1e-7)


def _is_hidden(cameras, points):
    """Whether the unit sphere lies between cameras and points."""
    way = points[None] - cameras[:, None]
    closest = -(way * cameras[:, None]).sum(axis=2) / (way**2).sum(axis=2)
    on_way = (closest > 0) & (closest < 1)
    nearest = np.linalg.norm(cameras[:, None] + closest[..., None] * way, axis=2)
    return on_way & (nearest < 1 + 1e-12)


@pytest.mark.parametrize("seed", range(20))
def test_cutting_keeps_area_heights_and_matching_edges(seed):
    rng = np.random.default_rng(seed)
    xy = np.unique(rng.integers(0, 3000, (int(rng.integers(4, 150)), 2)), axis=0)
    tin = ts.triangulate(np.column_stack([xy, xy @ [0.01, 0.02] + 5]).astype(float))
    mesh = GridMesh(xy.astype(np.int64), tin.points[:, 2], tin.triangles.astype(np.int64))
    cut = cut_along_grid(mesh, spacing := int(rng.integers(300, 2000)))
    a, b, c = (cut.steps[cut.triangles[:, k]] for k in range(3))
    areas = cross(b - a, c - a) / 2
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(tin.area, rel=0.02)
    corners = cut.steps[cut.triangles]
    assert (corners.max(axis=1) <= (corners.min(axis=1) // spacing + 1) * spacing).all()
    assert np.abs(cut.heights - cut.steps @ [0.01, 0.02] - 5).max() < 0.02
    boundary = _list_single_edges(cut)
    on_line = (cut.steps[boundary] % spacing == 0).all(axis=1).any(axis=1)
    outer = np.isnan(tin.interpolate(_move_out(cut.steps[boundary[on_line]], tin)))
    assert outer.all()  # an edge on a line that has one triangle is of the boundary, no crack


def _list_single_edges(mesh):
    edges = np.sort(np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]],
                                    mesh.triangles[:, [2, 0]]]), axis=1)  # fmt: skip
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return unique[counts == 1]


def _move_out(edges, tin):
    """Return a place three steps away from edges, off the middle of the surface."""
    middle = edges.mean(axis=1)
    way = np.diff(edges, axis=1)[:, 0]
    normal = np.column_stack([-way[:, 1], way[:, 0]]) / np.linalg.norm(way, axis=1)[:, None]
    side = np.sign(((middle - tin.points[:, :2].mean(axis=0)) * normal).sum(axis=1))
    return middle + 3 * normal * np.where(side == 0, 1, side)[:, None]


def test_a_foreign_tile():
    tin = ts.read(DATA / "26068.terrain", tile="15/33695/26068")
    assert tin.crs == "EPSG:4979"
    width = 180 / 2**15
    assert tin.triangulation.area == pytest.approx(width**2, rel=1e-5)
    assert tin.bounds.xmin == pytest.approx(33695 * width - 180)
    assert tin.points[:, 2].min() == pytest.approx(40.7189, abs=1e-3)
    assert "turned over by rounding" in tin.report.notes[1]


def test_a_tile_comes_back_where_its_path_tells(pyramid):
    _, folder, tiles = pyramid
    name = max(tiles, key=lambda one: (one[0], len(tiles[one]["steps"])))
    tin = ts.read(folder / f"{name[0]}/{name[1]}/{name[2]}.terrain")
    assert np.abs(np.sort(tin.points, axis=0) - np.sort(tiles[name]["places"], axis=0)).max() < 1e-9


def test_gzipped_tiles_hold_the_same(tmp_path):
    tin = ground(60)
    plain = ts.write(tin, tmp_path / "a", format="quantized-mesh", max_level=12)
    packed = ts.write(tin, tmp_path / "b", format="quantized-mesh", max_level=12, gzipped=True)
    for one in plain.rglob("*.terrain"):
        other = packed / one.relative_to(plain)
        assert gzip.decompress(other.read_bytes()) == one.read_bytes()
        assert len(ts.read(other).triangles) == len(ts.read(one).triangles)


@pytest.mark.parametrize("seed", [1, 4])
def test_holes_and_parts_stay_open(tmp_path, seed):
    small = punched(seed)
    tin = ts.TIN.from_triangles(small.points * (100, 100, 1) + (745_000, 4_033_000, 0),
                                small.triangles, crs="EPSG:32616")  # fmt: skip
    tiles = load_folder(ts.write(tin, tmp_path / "a", format="quantized-mesh", max_level=17))
    surface = in_degrees(tin)
    for level in (15, 16, 17):
        area = 0.0
        for (own, _, _), tile in tiles.items():
            if own == level:
                a, b, c = (tile["places"][tile["triangles"][:, k], :2] for k in range(3))
                area += cross(b - a, c - a).sum() / 2
        assert area == pytest.approx(surface.area, rel=1e-3)


@pytest.mark.parametrize(
    ("crs", "metres", "is_stated"),
    [("UTM 3D", 1.0, False), ("EPSG:32616+5703", 1.0, True), ("EPSG:2274+6360", 1200 / 3937, True)],
)
def test_heights_above_the_ellipsoid(tmp_path, crs, metres, is_stated):
    """A 3D CRS has them; of a geoid there is no grid here, and feet become metres all the same."""
    pyproj = pytest.importorskip("pyproj")
    system = pyproj.CRS("EPSG:32616").to_3d() if crs == "UTM 3D" else crs
    points = np.array([[745_000, 4_033_000, 1000], [745_900, 4_033_000, 1100],
                       [745_000, 4_033_900, 1200]]) * 1.0  # fmt: skip
    if crs.startswith("EPSG:2274"):
        points += (1_000_000, -3_400_000, 0)
    tin = ts.triangulate(points, crs=system)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        tiles = load_folder(ts.write(tin, tmp_path / "a", format="quantized-mesh", max_level=15))
    assert [one.category for one in told] == [ts.LossWarning] * is_stated
    finest = [tile["places"][:, 2] for (level, _, _), tile in tiles.items() if level == 15]
    z = np.concatenate(finest)
    assert z.min() == pytest.approx(1000 * metres, abs=0.2)
    assert z.max() == pytest.approx(1200 * metres, abs=0.2)


def test_folders_of_something_else_are_left_alone(tmp_path):
    tin = ground(60)
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "notes.txt").write_text("mine")
    with pytest.raises(ts.WriteError, match="not empty"):
        ts.write(tin, tmp_path / "a", format="quantized-mesh")
    assert (tmp_path / "a" / "notes.txt").read_text() == "mine"
    ts.write(tin, tmp_path / "b", format="quantized-mesh", max_level=11)
    ts.write(tin, tmp_path / "b", format="quantized-mesh", max_level=10)
    assert json.loads((tmp_path / "b" / "layer.json").read_text())["maxzoom"] == 10
    assert {one.name for one in tmp_path.iterdir()} == {"a", "b"}


def test_what_cannot_be_written(tmp_path):
    with pytest.raises(ts.CrsError, match="not known"):
        ts.write(ground(60, crs=None), tmp_path / "a", format="quantized-mesh")
    with pytest.raises(ts.OptionError, match="max_level"):
        ts.write(ground(60), tmp_path / "a", format="quantized-mesh", max_level=99)
    wide = ts.triangulate(np.array([[-179, 0, 1], [179, 0, 1], [0, 5, 2]]), crs="EPSG:4326")
    with pytest.raises(ts.WriteError, match="antimeridian"):
        ts.write(wide, tmp_path / "a", format="quantized-mesh")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("keep", [0, 50, 91, 500, 20_000])
def test_cut_tiles_are_refused(tmp_path, keep):
    path = tmp_path / "a.terrain"
    path.write_bytes((DATA / "26068.terrain").read_bytes()[:keep])
    with pytest.raises(ts.ReadError):
        ts.read(path, tile="15/33695/26068")


def test_tiles_whose_place_is_not_known(tmp_path):
    with pytest.raises(ts.ReadError, match="does not tell where the tile lies"):
        ts.read(DATA / "26068.terrain")
    with pytest.raises(ts.OptionError, match="level/column/row"):
        ts.read(DATA / "26068.terrain", tile="2/99/0")
    older = tmp_path / "a.terrain"
    older.write_bytes(struct.pack("<H", 5013) * 4225 + b"\x00\x00")
    with pytest.raises(ts.ReadError, match=r"heightmap-1\.0"):
        ts.read(older, tile="15/33695/26068")
