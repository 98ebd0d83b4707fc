"""Products of many files are those of the surface in memory, to the last bit and byte."""

from __future__ import annotations

import filecmp
from dataclasses import replace

import numpy as np
import pytest
import rasterio
from support.many_files import Shuffled
from support.product_parts import require_same_features

import tinsmith as ts
from tinsmith.tiled import given
from tinsmith.tiled.computing import computing
from tinsmith.tiled.products.mapped import measure_area
from tinsmith.tiled.running.run_options import RunSettings

SQUARES = {
    "a": [(500_010, 4_000_010), (500_080, 4_000_015), (500_070, 4_000_090)],
    "b": [(500_150, 4_000_050), (500_290, 4_000_050), (500_290, 4_000_150), (500_150, 4_000_150)],
}
LINE = [[500_010.0, 4_000_020.0], [500_150.5, 4_000_180.0], [500_290.0, 4_000_030.0]]


@pytest.fixture
def cloud(lidar, tmp_path):
    """Return the points, whose store is kept for all tilings."""
    return ts.tiles(lidar, classes=2, store=tmp_path / "points")


def without_notes(made):
    """Return a product without notes, which name files differently."""
    return replace(made, notes=())


def require_same_files(tmp_path, suffix, wanted, make):
    """Require the bytes of a product of 1 and 16 tiles to be those of the product in memory.

    Formats are such as do not hold notes.
    """
    target = ts.write(without_notes(wanted), tmp_path / f"whole{suffix}")
    for tiles in (1, 16):
        path = make(tmp_path / f"tiles{suffix}", tiles=tiles, executor=Shuffled(tiles))
        assert filecmp.cmp(path, target, shallow=False), tiles


@pytest.mark.filterwarnings("ignore:.* is a shapefile")
def test_contours(cloud, tin, tmp_path):
    def make(path, **way):
        return cloud.contours(path, 0.7, base=0.1, **way)

    require_same_files(tmp_path, ".shp", ts.contours(tin, 0.7, base=0.1), make)


@pytest.mark.filterwarnings("ignore:.* is a shapefile")
def test_contours_at_levels(cloud, tin, tmp_path):
    def make(path, **way):
        return cloud.contours(path, levels=[300.0, 310.3], index=None, **way)

    wanted = ts.contours(tin, levels=[300.0, 310.3], index=None)
    require_same_files(tmp_path, ".shp", wanted, make)


@pytest.mark.filterwarnings("ignore:.* is a shapefile")
def test_bands(cloud, tin, tmp_path):
    def make(path, **way):
        return cloud.contours(path, 5.0, bands=True, **way)

    require_same_files(tmp_path, ".shp", ts.contour_bands(tin, 5.0), make)


@pytest.mark.parametrize("regions", [None, SQUARES])
def test_volumes(cloud, tin, tmp_path, regions):
    def make(path, **way):
        return cloud.volume(path, base=301.0, regions=regions, **way)

    require_same_files(tmp_path, ".csv", ts.volume(tin, base=301.0, regions=regions), make)


@pytest.fixture(scope="module")
def design(tmp_path_factory):
    """Return points of another surface, that reaches beyond, in two files, in feet."""
    rng = np.random.default_rng(8)
    xy = rng.random((900, 2)) * [340, 220] + [499_980, 3_999_990]
    points = np.round(np.column_stack([xy, 990 + 30 * np.cos(xy[:, 1] / 40)]), 2)
    folder = tmp_path_factory.mktemp("design")
    for number, some in enumerate((points[:500], points[500:])):
        survey = ts.Survey(points=some, crs="EPSG:32616", elevation_unit="ft")
        ts.write(survey, folder / f"part{number}.ply")
    return folder


@pytest.mark.each_value
@pytest.mark.parametrize("regions", [None, SQUARES])
@pytest.mark.parametrize("in_files", [False, True])
def test_volumes_to_another_surface(lidar, design, tmp_path, regions, in_files):
    how = {"crs": "EPSG:32616", "elevation_unit": "ft"}
    files = sorted(design.iterdir())
    other = ts.triangulate(np.concatenate([ts.read(file, **how).points for file in files]), **how)
    tin = ts.triangulate(ts.read(lidar, classes=2, elevation_unit="m"))
    cloud = ts.tiles(lidar, classes=2, elevation_unit="m", store=tmp_path / "points")
    second = ts.tiles(files, store=tmp_path / "others", **how) if in_files else other

    def make(path, **way):
        return cloud.volume(path, second, regions=regions, **way)

    require_same_files(tmp_path, ".csv", ts.volume(tin, other, regions=regions), make)


def test_volumes_to_a_surface_of_another_crs_are_refused(cloud, design, tmp_path):
    points = ts.read(next(design.iterdir())).points
    others = [ts.triangulate(points, crs=crs) for crs in ("EPSG:32617", None)]
    for number, crs in enumerate(("EPSG:32617", None)):
        path = ts.write(ts.Survey(points=points, crs=crs), tmp_path / f"other{number}.ply")
        others.append(ts.tiles(path))
    for other in others:
        with pytest.raises(ts.CrsError, match="the other surface"):
            cloud.volume(tmp_path / "a.csv", other, executor=Shuffled(), restart=True)
    with pytest.raises(ts.OptionError, match="one of them"):
        cloud.volume(tmp_path / "a.csv", executor=Shuffled())
    with pytest.raises(ts.TinsmithError):
        cloud.volume(tmp_path / "a.csv", "design.ply", executor=Shuffled())


@pytest.mark.parametrize("unit", ["degrees", "percent", "ratio"])
def test_statistics_of_slopes(cloud, tin, tmp_path, unit):
    def make(path, **way):
        return cloud.slope_statistics(path, unit=unit, **way)

    wanted = ts.slope_statistics(tin, unit=unit)
    assert list(wanted.columns)[-2:] == ["p75", "p95"]
    require_same_files(tmp_path, ".csv", wanted, make)


def test_profiles(cloud, tin, tmp_path):
    def make(path, **way):
        return cloud.profile(path, LINE, interval=10.0, start=5.0, **way)

    require_same_files(tmp_path, ".csv", ts.profile(tin, LINE, interval=10.0, start=5.0), make)


def test_profiles_beside_the_surface_are_refused_as_in_memory(cloud, tin, tmp_path):
    line = [[499_000.0, 4_000_000.0], [499_100.0, 4_000_100.0]]
    with pytest.raises(ts.LinesError) as whole:
        ts.profile(tin, line)
    with pytest.raises(ts.LinesError) as tiled:
        cloud.profile(tmp_path / "a.csv", line, tiles=4, executor=Shuffled())
    assert str(tiled.value) == str(whole.value)


FEATURES = {
    "lines": ts.Features.of_lines(
        [*LINE, [500_200.0, 3_999_900.0], [500_210.0, 4_000_300.0]],
        [0, 3, 5],
        columns={"name": ["axis", "across"]},
        crs="EPSG:32616",
    ),
    "lines outside": ts.Features.of_lines([[0.0, 0.0], [9.0, 9.0]], [0, 2], crs="EPSG:32616"),
    "polygons": ts.Features.of_polygons(
        [*SQUARES["b"], SQUARES["b"][0]], [0, 5], [0, 1], columns={"plot": [7]}, crs="EPSG:32616"
    ),
    "points": ts.Features.of_points(
        [*LINE, [0.0, 0.0]], columns={"name": list("abcd")}, crs="EPSG:32616"
    ),
    "a polyline": LINE,
}


@pytest.mark.parametrize("name", FEATURES)
def test_draped_features(cloud, tin, tmp_path, name):
    wanted = ts.drape(tin, FEATURES[name], outside="nan")
    asked = {"features": FEATURES[name], "outside": "nan"}
    for tiles in (1, 16):
        how = RunSettings.of(tiles=tiles, executor=Shuffled(tiles))
        with computing(cloud, "drape", tmp_path / "a.gpkg", how, **asked) as made:
            require_same_features(made, wanted)
        assert made.crs == wanted.crs
        assert {*made.notes} >= {note for note in wanted.notes if "outside" in note}


@pytest.mark.filterwarnings("ignore:.* is a shapefile")
@pytest.mark.parametrize("name", ["lines", "points"])
def test_draped_features_are_cut_or_refused(cloud, tin, tmp_path, name):
    features = FEATURES[name]

    def make(path, **way):
        return cloud.drape(path, features, outside="cut", **way)

    require_same_files(tmp_path, ".shp", ts.drape(tin, features, outside="cut"), make)
    with pytest.raises(ts.LinesError) as whole:
        ts.drape(tin, features)
    with pytest.raises(ts.LinesError) as tiled:
        cloud.drape(tmp_path / "a.fgb", features, tiles=3, executor=Shuffled())
    assert str(tiled.value) == str(whole.value)


def test_only_tiles_that_lines_meet_are_triangulated(cloud, tmp_path):
    told = []
    line = [[500_010.0, 4_000_010.0], [500_030.0, 4_000_020.0]]
    cloud.profile(tmp_path / "a.csv", line, tiles=64, executor=Shuffled(), progress=told.append)
    assert told[-1].done == told[-1].total >= 64
    assert told[-1].points < 500


def list_places(tin):
    """Return places in the surface and off it, at vertices, on edges, and nowhere."""
    bounds = tin.bounds
    low, size = np.array([bounds.xmin, bounds.ymin]), np.array([bounds.width, bounds.height])
    free = low + (np.random.default_rng(2).random((2_000, 2)) * 1.2 - 0.1) * size
    middle = tin.points[tin.edges[::7], :2].mean(axis=1)
    return np.concatenate([free, tin.points[::5, :2], middle, [[np.nan, 0.0]]])


def test_elevations_at_places(cloud, tin, tmp_path):
    places = list_places(tin)
    columns = {"easting": places[:, 0], "northing": places[:, 1]}
    units = {"easting": "m", "northing": "m", "elevation": tin.elevation_unit}
    wanted = ts.Table({**columns, "elevation": tin.interpolate(places)}, units=units)

    def make(path, **way):
        return cloud.interpolate(path, places, **way)

    require_same_files(tmp_path, ".csv", wanted, make)


def test_few_or_no_places(cloud, tin, tmp_path):
    for places in (tin.points[:1, :2], [[0.0, 0.0]], np.zeros((0, 2))):
        path = cloud.interpolate(tmp_path / "a.csv", places, tiles=4, executor=Shuffled())
        found = [float(row.split(",")[2] or "nan") for row in path.read_text().splitlines()[1:]]
        np.testing.assert_array_equal(found, tin.interpolate(places))


def test_a_tile_reads_the_places_near_it_only(tmp_path, monkeypatch):
    monkeypatch.setattr(given, "_PLACES_OF_A_CHUNK", 30_000)
    xy = np.random.default_rng(5).random((100_000, 2)) * 100
    xy[::1000] = np.nan
    given.GivenPlaces(xy).store(tmp_path / "places")
    box = ts.Bounds(20.0, 20.0, 30.0, 40.0)
    found = given.read_places(tmp_path / "places", box)
    inside = ((xy >= (20, 20)) & (xy <= (30, 40))).all(axis=1)
    np.testing.assert_array_equal(found.numbers, np.flatnonzero(inside))
    np.testing.assert_array_equal(found.points[:, :2], xy[inside])


def test_places_in_another_crs_are_refused(cloud, tmp_path):
    places = ts.Features.of_points([[500_010.0, 4_000_020.0]], crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="EPSG:32617"):
        cloud.interpolate(tmp_path / "a.csv", places, executor=Shuffled())


@pytest.mark.each_value
@pytest.mark.parametrize("value", ["slope", "aspect", "hillshade"])
@pytest.mark.parametrize("smooth", [False, True])
def test_slopes_and_light(cloud, tin, tmp_path, value, smooth):
    wanted = ts.rasterize(tin, spacing=2.0, value=value, smooth=smooth).bands[value]
    for tiles in (1, 9):
        path = cloud.rasterize(
            tmp_path / "a.tif",
            spacing=2.0,
            value=value,
            smooth=smooth,
            tiles=tiles,
            executor=Shuffled(),
        )
        with rasterio.open(path) as dataset:
            np.testing.assert_array_equal(dataset.read(1), wanted)


@pytest.mark.parametrize("value", ["elevation", "slope"])
def test_means_of_cells(cloud, tin, tmp_path, value):
    wanted = ts.rasterize(tin, spacing=3.0, value=value, at="mean").bands[value]
    for tiles in (1, 9):
        path = cloud.rasterize(
            tmp_path / "a.tif",
            spacing=3.0,
            value=value,
            at="mean",
            tiles=tiles,
            executor=Shuffled(),
        )
        with rasterio.open(path) as dataset:
            np.testing.assert_array_equal(dataset.read(1), wanted)


def test_tiles_are_proven_and_mapped(cloud, tin, tmp_path):
    for tiles in (1, 7):
        proof = cloud.check(run=tmp_path / "run", tiles=tiles, executor=Shuffled(tiles))
        assert 1 <= proof.tiles <= tiles
        assert proof.triangles == len(tin.triangles)
        assert proof.vertices == len(tin.points)
        assert proof.edges == len(tin.edges)
        areas = cloud.map(measure_area, run=tmp_path / "run", tiles=tiles, executor=Shuffled(tiles))
        assert sum(areas) == pytest.approx(tin.area, rel=1e-12)
        assert float(proof.area) == pytest.approx(tin.area, rel=1e-12)


@pytest.mark.parametrize(
    ("method", "options"),
    [
        ("contours", {}),
        ("contours", {"interval": -1.0}),
        ("contours", {"interval": 1.0, "levels": [1.0]}),
        ("contours", {"levels": ["high"]}),
        ("volume", {"base": "low"}),
        ("volume", {"base": 5.0, "regions": {"a": [(0, 0), (1, 1)]}}),
        ("profile", {"line": [[0.0, 0.0]]}),
        ("profile", {"line": LINE, "interval": 0.0}),
        ("interpolate", {"places": [[0.0, 0.0, 0.0]]}),
        ("drape", {"features": [[0.0, 0.0]]}),
        ("slope_statistics", {"unit": "grads"}),
        ("drape", {"features": LINE, "outside": "away"}),
    ],
)
def test_options_that_are_none_are_refused_before_the_work(lidar, tmp_path, method, options):
    with pytest.raises(ts.TinsmithError):
        getattr(ts.tiles(lidar), method)(tmp_path / "a.csv", executor=Shuffled(), **options)
    assert list(tmp_path.iterdir()) == []


def test_functions_that_workers_cannot_import_are_refused(lidar, tmp_path):
    with pytest.raises(ts.OptionError, match="a function of a module"):
        ts.tiles(lidar).map(lambda tin, box: None, run=tmp_path / "run")
