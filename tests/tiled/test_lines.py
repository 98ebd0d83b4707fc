"""Lines of many files: products with them are those of the surface in memory, to the last byte."""

from __future__ import annotations

import filecmp
import json
from dataclasses import replace

import numpy as np
import pytest
import rasterio
import shapely
from support.many_files import Shuffled

import tinsmith as ts
from tinsmith.tiled.computing import computing
from tinsmith.tiled.products.mapped import measure_area
from tinsmith.tiled.running.run_options import RunSettings

CRS = "EPSG:32616"
ORIGIN = np.array([500_000.0, 4_000_000.0])
AXIS = [[500_010.0, 4_000_020.0], [500_150.5, 4_000_180.0], [500_290.0, 4_000_030.0]]


def lift(xy):
    """Return places of the terrain of the points, with elevations of their own."""
    xy = np.asarray(xy, np.float64) + ORIGIN
    return np.column_stack([xy, 305.0 + 10 * np.sin(xy[:, 0] / 40)])


def ring(x, y, radius, corners=16):
    angles = 2 * np.pi * np.arange(corners) / corners
    return lift(np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)]))


WALL = lift([[5, 30], [120, 90], [210, 95], [295, 180]])
KERBS = [WALL, lift([[150, 5], [150, 195]]), lift([[20, 150], [280, 60]])]

LINES = {
    "breaklines": {"breaklines": KERBS},
    "lines that reach beyond the points": {"breaklines": [lift([[-40, 100], [340, 110]])]},
    "boundary": {"boundary": [ring(150, 100, 90)]},
    "boundary around the points": {
        "boundary": [lift([[-9, -9], [309, -9], [309, 209], [-9, 209]])]
    },
    "two boundaries": {"boundary": [ring(60, 60, 50), ring(230, 120, 60)]},
    "holes": {"holes": [ring(80, 80, 30), ring(220, 120, 40)]},
    "all of them": {
        "breaklines": KERBS,
        "boundary": [ring(150, 100, 95, 40)],
        "holes": [[ring(150, 100, 50), ring(150, 100, 20)]],
    },
}

FLAT = [line[:, :2] for line in KERBS]
"""Lines without elevations, which are draped."""

LINES |= {
    "draped breaklines": {"breaklines": FLAT},
    "draped boundary and hole": {
        "boundary": [ring(150, 100, 95)[:, :2]],
        "holes": [[ring(150, 100, 50)[:, :2], ring(150, 100, 20)[:, :2]]],
    },
    "draped lines that leave the points": {
        "breaklines": [lift([[-40, 100], [340, 110]])[:, :2], WALL],
        "boundary": [lift([[40, 20], [390, 120], [120, 170], [-80, 90]])[:, :2]],
        "holes": [ring(295, 100, 30)[:, :2], ring(150, 40, 20)],
    },
    "draped boundary around the points": {
        "boundary": [lift([[-9, -9], [309, -9], [309, 209], [-9, 209]])[:, :2]]
    },
}

PRODUCTS = {
    "contours": (ts.contours, "contours", ((1.3,), {}), ".shp"),
    "bands": (ts.contour_bands, "contours", ((4.0,), {}), ".shp"),
    "volume": (ts.volume, "volume", ((), {"base": 303.0}), ".csv"),
    "profile": (ts.profile, "profile", ((AXIS,), {"interval": 7.0}), ".csv"),
}

RASTERS = {
    "elevation": {"spacing": 3.0},
    "slope": {"spacing": 3.0, "value": "slope"},
    "smooth slope": {"spacing": 4.0, "value": "slope", "smooth": True},
    "means": {"spacing": 5.0, "at": "mean"},
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder of files of points, some of which lie on the lines and at one place."""
    found = tmp_path_factory.mktemp("points")
    rng = np.random.default_rng(5)
    xy = np.round(rng.random((2_500, 2)) * [300, 200], 1) + ORIGIN
    on_lines = np.concatenate([line[:, :2] for line in KERBS] + [[[500_150.0, 4_000_077.0]]])
    xy = np.concatenate([xy, on_lines, on_lines[:3]])
    z = 300 + 10 * np.sin(xy[:, 0] / 50) + rng.normal(0, 0.5, len(xy))
    points = np.column_stack([xy, np.round(z, 2)])
    for number, part in enumerate(np.array_split(rng.permutation(points), 3)):
        ts.write(ts.Survey(points=part), found / f"part{number}.ply")
    return found


@pytest.fixture(scope="module")
def points(folder):
    """Return all points in memory, in the order of the files."""
    return np.concatenate([ts.read(one).points for one in sorted(folder.glob("*.ply"))])


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    """Return the folder in which points are kept for all tests."""
    return tmp_path_factory.mktemp("store")


def without_notes(made):
    return replace(made, notes=())


def tile(folder, store, **lines):
    """Return the points with lines; ``sorted`` as the files of a folder are."""
    files = sorted(folder.glob("*.ply"))
    return ts.tiles(files, crs=CRS, store=store, **lines)


@pytest.mark.each_value
@pytest.mark.filterwarnings("ignore:.* is a shapefile")
@pytest.mark.parametrize(
    "product",
    [pytest.param(one, marks=[pytest.mark.slow] * (one == "contours")) for one in PRODUCTS],
)
@pytest.mark.parametrize("kind", LINES)
def test_products_are_those_in_memory(folder, store, points, tmp_path, kind, product):
    make, method, (given, options), suffix = PRODUCTS[product]
    tin = ts.triangulate(points, crs=CRS, **LINES[kind])
    target = ts.write(without_notes(make(tin, *given, **options)), tmp_path / f"whole{suffix}")
    cloud = tile(folder, store, **LINES[kind])
    extra = {"bands": True} if product == "bands" else {}
    several = (1, 9) if "draped" in kind else (1, 4, 16, 64)
    for tiles in several if product == "contours" else (7,):
        way = {"tiles": tiles, "executor": Shuffled(tiles)}
        path = getattr(cloud, method)(
            tmp_path / f"tiles{suffix}", *given, **options, **extra, **way
        )
        assert filecmp.cmp(path, target, shallow=False), tiles


@pytest.mark.each_value
@pytest.mark.parametrize("raster", RASTERS)
@pytest.mark.parametrize("kind", LINES)
def test_rasters_are_those_in_memory(folder, store, points, tmp_path, kind, raster):
    options = RASTERS[raster]
    wanted = ts.rasterize(ts.triangulate(points, crs=CRS, **LINES[kind]), **options)
    cloud = tile(folder, store, **LINES[kind])
    for tiles in (1, 16) if raster == "elevation" else (6,):
        path = cloud.rasterize(
            tmp_path / "tiles.tif", **options, tiles=tiles, executor=Shuffled(tiles)
        )
        with rasterio.open(path) as dataset:
            np.testing.assert_array_equal(dataset.read(1), wanted.bands[wanted.name])
            assert dataset.bounds[:2] == (wanted.grid.bounds.xmin, wanted.grid.bounds.ymin)


@pytest.mark.parametrize("kind", LINES)
def test_tiles_are_proven_and_mapped(folder, store, points, tmp_path, kind):
    tin = ts.triangulate(points, crs=CRS, **LINES[kind])
    cloud = tile(folder, store, **LINES[kind])
    proof = cloud.check(run=tmp_path / "run", tiles=9, executor=Shuffled())
    assert proof.triangles == len(tin.triangles)
    assert proof.vertices == len(tin.points)
    assert proof.edges == len(tin.edges)
    assert float(proof.area) == pytest.approx(tin.area, rel=1e-12)
    areas = cloud.map(measure_area, run=tmp_path / "run", tiles=9, executor=Shuffled())
    assert sum(areas) == pytest.approx(tin.area, rel=1e-12)


def test_files_of_lines_are_read_as_in_memory(folder, store, tmp_path):
    """In the CRS of the points, with what their reader tells, and as inputs of the run."""
    offsets = np.append(0, np.cumsum([len(line) for line in KERBS]))
    kerbs = ts.Features.of_lines(np.concatenate(KERBS), offsets, crs=CRS)
    file = ts.write(kerbs, tmp_path / "kerbs.gpkg")
    with_kerbs = ts.with_lines(ts.read(sorted(folder.glob("*.ply")), crs=CRS), breaklines=[file])
    wanted = ts.write(
        without_notes(ts.volume(ts.triangulate(with_kerbs), base=300.0)), tmp_path / "whole.csv"
    )
    for cloud in (
        tile(folder, store).with_lines(breaklines=[file]),
        tile(folder, store, breaklines=file),
        tile(folder, store, breaklines=kerbs),
        tile(folder, store, breaklines=kerbs.to_geodataframe()),
    ):
        assert repr(cloud).endswith("with lines>")
        path = cloud.volume(tmp_path / "a.csv", base=300.0, tiles=3, executor=Shuffled())
        assert filecmp.cmp(path, wanted, shallow=False)
    changed = tile(folder, store, breaklines=file)
    ts.write(ts.Features.of_lines(WALL, [0, 4], crs=CRS), file)
    with pytest.raises(ts.ReadError, match="changed since its lines were read"):
        changed.volume(tmp_path / "b.csv", base=300.0, executor=Shuffled())
    assert not (tmp_path / "b.csv.run").exists()


def test_a_run_goes_on_with_the_same_lines_only(folder, store, tmp_path):
    path = tmp_path / "a.csv"
    with pytest.raises(KeyboardInterrupt):
        tile(folder, store, breaklines=KERBS).volume(
            path, base=300.0, tiles=4, executor=Shuffled(most=5)
        )
    with pytest.raises(ts.ReadError, match=r"`breaklines` was '3 lines \(.*', and is '2 lines"):
        tile(folder, store, breaklines=KERBS[:2]).volume(path, base=300.0, executor=Shuffled())
    with pytest.raises(ts.ReadError, match=r"`breaklines` was '3 lines .*, and is None"):
        tile(folder, store).volume(path, base=300.0, executor=Shuffled())
    cloud = tile(folder, store, breaklines=KERBS)
    cloud.volume(path, base=300.0, tiles=4, executor=Shuffled())
    assert [one.name for one in tmp_path.iterdir()] == ["a.csv"]


@pytest.mark.parametrize(("most", "draped"), [(2, 0), (6, 3), (12, None)])
def test_draping_goes_on_where_it_was(folder, store, points, tmp_path, most, draped):
    """A run is killed while files are looked at, lines are draped, or tiles are computed."""
    lines = LINES["draped lines that leave the points"]
    path, wanted = tmp_path / "a.csv", tmp_path / "whole.csv"
    whole = ts.volume(ts.triangulate(points, crs=CRS, **lines), base=300.0)
    ts.write(without_notes(whole), wanted)
    tile(folder, store).volume(path, base=300.0, executor=Shuffled())  # reads the points
    cloud = tile(folder, store, **lines)
    with pytest.raises(KeyboardInterrupt):
        cloud.volume(path, base=300.0, tiles=6, executor=Shuffled(most=most))
    with pytest.raises(ts.ReadError, match=r"`breaklines` was '2 lines .*, and is '3 lines"):
        tile(folder, store, breaklines=FLAT).volume(path, base=300.0, executor=Shuffled())
    told = []
    cloud.volume(path, base=300.0, tiles=6, executor=Shuffled(), progress=told.append)
    assert filecmp.cmp(path, wanted, shallow=False)
    done = [one.done for one in told if one.step == "Draping lines"]
    assert done == ([] if draped is None else [*range(draped, 7)])
    assert [one.name for one in tmp_path.iterdir() if one.is_dir()] == []


def test_parts_of_draped_lines_beside_the_points_are_told(folder, store, tmp_path):
    lines = {"breaklines": [lift([[-40, 100], [340, 110]])[:, :2]]}
    how = RunSettings.of(tiles=2, executor=Shuffled())
    with computing(tile(folder, store, **lines), "volume", tmp_path / "a", how, base=300.0) as made:
        (note,) = (one for one in made.notes if "draped" in one)
    assert note == "Of 1 draped line the parts outside the surface of the points were left out."


def test_lines_of_files_are_draped_where_it_is_asked_for(folder, store, points, tmp_path):
    offsets = np.append(0, np.cumsum([len(line) for line in KERBS]))
    kerbs = ts.Features.of_lines(np.concatenate(KERBS), offsets, crs=CRS)
    file = ts.write(kerbs, tmp_path / "kerbs.gpkg")
    wanted = tmp_path / "whole.csv"
    whole = ts.volume(ts.triangulate(points, crs=CRS, breaklines=FLAT), base=300.0)
    ts.write(without_notes(whole), wanted)
    cloud = tile(folder, store).with_lines(breaklines=[file], drape=True)
    path = cloud.volume(tmp_path / "tiles.csv", base=300.0, tiles=5, executor=Shuffled())
    assert filecmp.cmp(path, wanted, shallow=False)
    with pytest.raises(ts.OptionError, match="Invalid drape"):
        tile(folder, store).with_lines(breaklines=[file], drape="no")


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        (
            {"boundary": [ring(90, 90, 50)[:, :2]], "holes": [ring(250, 100, 20)[:, :2]]},
            ts.LinesError,
            "Hole 0 lies outside the surface",
        ),
        (
            {"boundary": [ring(900, 90, 50)[:, :2]]},
            ts.LinesError,
            "The boundary and the holes leave no triangle",
        ),
        (
            {"breaklines": [WALL, lift([[5, 95], [60, 5]])[:, :2]], "crossing": "error"},
            ts.LinesError,
            "cross",
        ),
        (
            {"boundary": [ring(90, 90, 50)], "holes": [ring(250, 100, 20)]},
            ts.LinesError,
            "Hole 0 lies outside the surface",
        ),
        (
            {"breaklines": [WALL, lift([[5, 95], [60, 5]]) * [1, 1, 2]], "crossing": "error"},
            ts.LinesError,
            "cross",
        ),
        ({"breaklines": [[[0, 0, 1]]]}, ts.LinesError, "breakline"),
        ({"breaklines": ts.Features.of_lines(WALL, [0, 4], crs="EPSG:3857")}, ts.CrsError, "3857"),
        ({"water": [1]}, ts.OptionError, "Invalid water"),
        ({"max_edge": 5.0}, ts.OptionError, "Invalid max_edge"),
        ({"crossing": "both"}, ts.OptionError, "Invalid crossing"),
        ({"boundary": "nothing.shp"}, ts.ReadError, "nothing.shp"),
    ],
)
def test_lines_that_cannot_be_are_refused(folder, store, tmp_path, given, error, message):
    with pytest.raises(error, match=message):
        tile(folder, store, **given).volume(tmp_path / "a.csv", base=300.0, executor=Shuffled())


@pytest.mark.parametrize("tiles", [1, 12])
def test_tiles_beyond_a_boundary_count_where_the_surface_is_not_all(
    folder, store, points, tmp_path, tiles
):
    """Most tiles have nothing of a surface in one corner, but of others and of places."""
    lines = {"boundary": [ring(40, 40, 30)]}
    tin, cloud = ts.triangulate(points, crs=CRS, **lines), tile(folder, store, **lines)
    way = {"tiles": tiles, "executor": Shuffled(tiles)}
    other = ts.triangulate(points[::5] + np.array([0.0, 0.0, 1.0]), crs=CRS)
    target = ts.write(without_notes(ts.volume(tin, other)), tmp_path / "whole.csv")
    assert filecmp.cmp(cloud.volume(tmp_path / "a.csv", other, **way), target, shallow=False)
    places = np.concatenate([points[::50, :2], points[:3, :2] + 1e6])
    path = cloud.interpolate(tmp_path / "b.csv", places, **way)
    found = [float(row.split(",")[2] or "nan") for row in path.read_text().splitlines()[1:]]
    np.testing.assert_array_equal(found, tin.interpolate(places))
    features = shapely.points(places).tolist()
    made = cloud.drape(tmp_path / "c.geojson", features, outside="nan", **way)
    whole = ts.write(ts.drape(tin, features, outside="nan"), tmp_path / "d.geojson")
    first, second = (json.loads(one.read_text())["features"] for one in (made, whole))
    assert len(first) > 50
    assert str(first) == str(second)
    heights = cloud.rasterize_heights(tmp_path / "h.tif", tile(folder, None), spacing=9.0, **way)
    raster = ts.rasterize_heights(tin, points, spacing=9.0)
    with rasterio.open(heights) as dataset:
        np.testing.assert_array_equal(dataset.read(1), raster.bands["height"])
        assert raster.notes[-1] in dataset.tags()["notes"]
