"""Rasters of many files: the same bytes as in memory, for any tiles, workers and interruptions."""

from __future__ import annotations

import filecmp
import itertools
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import rasterio
from support.many_files import Shuffled

import tinsmith as ts
from tinsmith.tiled import tasks


@pytest.fixture(scope="module")
def wanted(lidar, tmp_path_factory):
    """Return the raster of the same points in memory."""
    tin = ts.triangulate(ts.read(lidar, classes=2))
    return ts.rasterize(tin, spacing=1.0).bands["elevation"]


def read(path):
    """Return the cells of a file."""
    with rasterio.open(path) as dataset:
        assert dataset.crs.to_epsg() == 32616
        return dataset.read(1)


@pytest.fixture(scope="module")
def of_one_tile(lidar, tmp_path_factory):
    """Return the file of one tile."""
    path = tmp_path_factory.mktemp("tile") / "b.tif"
    return ts.tiles(lidar, classes=2).rasterize(path, spacing=1.0, tiles=1, executor=Shuffled())


@pytest.mark.parametrize("tiles", [1, 4, 16, 64])
def test_cells_are_those_in_memory_and_files_the_same(lidar, wanted, of_one_tile, tmp_path, tiles):
    path = tmp_path / "a.tif"
    with ThreadPoolExecutor(2) as threads:
        ts.tiles(lidar, classes=2).rasterize(path, spacing=1.0, tiles=tiles, executor=threads)
    np.testing.assert_array_equal(read(path), wanted)
    assert filecmp.cmp(path, of_one_tile, shallow=False)
    assert [one.name for one in tmp_path.iterdir()] == ["a.tif"]


def test_processes_and_a_choice_by_attribute(lidar, wanted, tmp_path):
    told = []
    cloud = ts.tiles([*sorted(lidar.iterdir())], where={"classification": 2})
    path = cloud.rasterize(
        tmp_path / "a.tif", spacing=1.0, tiles=5, workers=2, progress=told.append
    )
    np.testing.assert_array_equal(read(path), wanted)
    assert [one.step for one in told][:: len(told) - 1] == ["Reading", "Triangulating"]
    assert (told[-1].done, told[-1].total) == (5, 5)


def test_a_level_surface_has_no_aspect_as_in_memory(tmp_path):
    """It was refused, for no centre of a cell to lie on the surface."""
    survey = ts.Survey(points=[[0, 0, 5], [10, 0, 5], [0, 10, 5], [10, 10, 5]], crs="EPSG:32616")
    cloud = ts.tiles(ts.write(survey, tmp_path / "level.csv"), crs="EPSG:32616")
    path = cloud.rasterize(tmp_path / "a.tif", value="aspect", spacing=2.0, workers=1)
    wanted = ts.rasterize(ts.triangulate(survey), value="aspect", spacing=2.0)
    np.testing.assert_array_equal(read(path), wanted.bands["aspect"])
    assert np.isnan(wanted.bands["aspect"]).all()


@pytest.mark.parametrize("most", range(8))
def test_a_run_that_was_interrupted_goes_on(lidar, wanted, tmp_path, most, monkeypatch):
    path = tmp_path / "a.tif"
    cloud = ts.tiles(lidar, classes=2)
    with pytest.raises(KeyboardInterrupt):
        cloud.rasterize(path, spacing=1.0, tiles=5, executor=Shuffled(most, most), workers=1)
    assert not path.exists()
    again = Shuffled(most + 1)
    calls = itertools.count()
    submit = again.submit
    monkeypatch.setattr(
        again, "submit", lambda *given: (next(calls), submit(*given))[1], raising=True
    )
    cloud.rasterize(path, spacing=1.0, tiles=5, executor=again)
    assert next(calls) == 8 - most
    np.testing.assert_array_equal(read(path), wanted)


def test_other_options_of_a_run_are_refused(lidar, tmp_path):
    path = tmp_path / "a.tif"
    with pytest.raises(KeyboardInterrupt):
        ts.tiles(lidar).rasterize(path, spacing=1.0, executor=Shuffled(0, 2), workers=1)
    with pytest.raises(ts.ReadError, match=r"`spacing` was 1\.0, and is 2\.0"):
        ts.tiles(lidar).rasterize(path, spacing=2.0, executor=Shuffled())
    with pytest.raises(ts.ReadError, match="`classes` was None, and is 2"):
        ts.tiles(lidar, classes=2).rasterize(path, spacing=1.0, executor=Shuffled())
    ts.tiles(lidar, classes=2).rasterize(path, spacing=1.0, executor=Shuffled(), restart=True)


def test_a_damaged_file_is_named_and_the_run_goes_on_when_it_is_whole(lidar, wanted, tmp_path):
    folder = tmp_path / "lidar"
    folder.mkdir()
    for one in lidar.iterdir():
        (folder / one.name).write_bytes(one.read_bytes())
    bad = folder / "tile1.laz"
    whole = bad.read_bytes()
    bad.write_bytes(whole[:2_000] + bytes(len(whole) - 2_100) + whole[-100:])
    cloud = ts.tiles(folder, classes=2)
    with pytest.raises(ts.ReadError, match=r"Reading: 1 task of 3 failed\. .*tile1\.laz"):
        cloud.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    assert not (tmp_path / "a.tif").exists()
    bad.write_bytes(whole)
    with pytest.raises(ts.ReadError, match=r"tile1\.laz' has changed"):
        cloud.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    path = cloud.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled(), restart=True)
    np.testing.assert_array_equal(read(path), wanted)


def test_tiles_that_need_too_much_memory_are_divided(lidar, wanted, tmp_path, monkeypatch):
    triangulate = tasks.triangulate_box

    def limited(source, box, **options):
        if len(source.read_box(box).numbers) > 700:
            raise MemoryError
        return triangulate(source, box, **options)

    monkeypatch.setattr(tasks, "triangulate_box", limited)
    cloud = ts.tiles(lidar, classes=2)
    path = cloud.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    np.testing.assert_array_equal(read(path), wanted)


def test_points_are_kept_for_further_products(lidar, wanted, tmp_path):
    cloud = ts.tiles(lidar, classes=2, store=tmp_path / "points")
    cloud.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    only_tiles = Shuffled(1, 4)
    path = cloud.rasterize(tmp_path / "b.tif", spacing=1.0, tiles=4, executor=only_tiles)
    np.testing.assert_array_equal(read(path), wanted)


@pytest.mark.parametrize(
    "options",
    [
        {"workers": 0},
        {"tiles": 0},
        {"memory": 10},
        {"executor": "all"},
        {"dask": 5},
        {"progress": 5},
        {"restart": "yes"},
        {"spacing": -1.0},
        {"spacing": None},
        {"method": "natural"},
    ],
)
def test_options_that_are_none_are_refused_before_the_work(lidar, tmp_path, options):
    with pytest.raises((ts.OptionError, TypeError)):
        ts.tiles(lidar).rasterize(tmp_path / "a.tif", **{"spacing": 1.0, **options})
    assert list(tmp_path.iterdir()) == []


def test_inputs_that_are_none_are_refused(lidar, tmp_path):
    with pytest.raises(ts.ReadError, match="has no files of points"):
        ts.tiles(tmp_path)
    with pytest.raises(ts.OptionError, match="paths"):
        ts.tiles([])
    with pytest.raises(ts.ReadError, match="nothing"):
        ts.tiles(tmp_path / "nothing.laz")
    with pytest.raises(ts.OptionError, match="where"):
        ts.tiles(lidar, where={"classification": "ground"})
    with pytest.raises(ts.WriteError, match="there is no folder"):
        ts.tiles(lidar).rasterize(tmp_path / "no" / "a.tif", spacing=1.0, executor=Shuffled())


def test_text_tiles_and_a_plan(tmp_path):
    rng = np.random.default_rng(5)
    points = np.round(rng.random((3_000, 3)) * [100, 100, 5], 2)
    for number in range(2):
        survey = ts.Survey(points=points[number::2], crs="EPSG:32616")
        ts.write(survey, tmp_path / f"part{number}.csv")
    cloud = ts.tiles(
        [tmp_path / "part0.csv", tmp_path / "part1.csv"], crs="EPSG:32616", check_crs=False
    )
    path = cloud.rasterize(tmp_path / "a.tif", spacing=0.5, tiles=9, executor=Shuffled())
    tin = ts.triangulate(np.concatenate([points[::2], points[1::2]]), crs="EPSG:32616")
    np.testing.assert_array_equal(read(path), ts.rasterize(tin, spacing=0.5).bands["elevation"])
    plan = cloud.plan(workers=3, tiles=4)
    assert (plan.tiles, plan.workers) == (4, 3)
    assert 1_000 < plan.count < 6_000


def test_points_at_one_place_are_named_by_file_and_row(tmp_path):
    points = np.array([[0, 0, 1], [9, 0, 2], [0, 9, 3], [9, 9, 4], [5, 5, 5]], float)
    others = np.array([[9, 7, 4], [5, 5, 5], [20, 0, 0]], float)
    files = [
        ts.write(ts.Survey(points=one, crs="EPSG:32616"), tmp_path / name)
        for name, one in (("a.laz", points), ("b.laz", others))
    ]
    cloud = ts.tiles(files, duplicates="error", check_crs=False)
    for _ in range(2):
        with pytest.raises(ts.ReadError, match=r"row 4 of 'a\.laz', row 1 of 'b\.laz'") as caught:
            cloud.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
        assert str(caught.value).endswith(
            "The same call refuses it again: change the points or the options, and begin anew "
            "(`restart`)."
        )
    again = ts.tiles(files, duplicates="mean", check_crs=False)
    path = again.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled(), restart=True)
    assert path.is_file()


def write_raster(path, voids=()):
    """Write a raster of 40 by 30 cells, some of which have no elevation; return the file."""
    grid = ts.Grid(ts.Bounds(500_000.0, 4_000_000.0, 500_120.0, 4_000_090.0), (30, 40), 3.0)
    row, column = np.mgrid[:30, :40]
    cells = 50 + 3 * np.sin(row / 4.0) * np.cos(column / 5.0) + 0.01 * (row * 7 % 11)
    for rows, columns in voids:
        cells[rows, columns] = np.nan
    return ts.write(ts.Raster({"elevation": cells}, grid, crs="EPSG:32616"), path)


VOIDS = {
    "none": [],
    "a hole": [(slice(8, 14), slice(10, 20))],
    "a rim": [(slice(0, 9), slice(0, 12)), (29, slice(None)), (slice(None), 39)],
    "islands": [(slice(14, 16), slice(None)), (slice(None), slice(19, 22)), (5, 5), (6, 6)],
    "scattered": [([3, 4, 9, 20, 20, 21], [3, 4, 30, 7, 8, 8])],
    "a cell alone": [(slice(0, 5), slice(0, 5)), (slice(20, 25), slice(5, 10))],
}


@pytest.mark.each_value
@pytest.mark.filterwarnings("ignore:.* is a shapefile")
@pytest.mark.parametrize("name", VOIDS)
@pytest.mark.parametrize("options", [{}, {"cells": (3, 2, 33, 25), "stride": 2}])
def test_the_surface_of_a_raster_ends_at_voids_as_in_memory(tmp_path, name, options):
    path = write_raster(tmp_path / "a.tif", VOIDS[name])
    tin = ts.triangulate(ts.read(path, **options))
    cloud = ts.tiles(path, store=tmp_path / "points", **options)
    way = {"tiles": 6, "executor": Shuffled(2)}
    for value in ("elevation", "slope"):
        made = cloud.rasterize(tmp_path / "b.tif", spacing=1.0, value=value, **way)
        wanted = ts.rasterize(tin, spacing=1.0, value=value)
        np.testing.assert_array_equal(read(made), wanted.bands[value])
    whole = ts.write(ts.contours(tin, 0.5), tmp_path / "whole.shp")
    made = cloud.contours(tmp_path / "tiles.shp", 0.5, **way)
    assert filecmp.cmp(made, whole, shallow=False)
    proof = cloud.check(run=tmp_path / "run", **way)
    assert (proof.triangles, proof.vertices) == (len(tin.triangles), len(tin.points))


def test_voids_and_lines_together(tmp_path):
    path = write_raster(tmp_path / "a.tif", VOIDS["a hole"])
    line = [[500_010.0, 4_000_015.0, 60.0], [500_110.0, 4_000_080.0, 61.0]]
    ring = [[500_020.0, 4_000_010, 50], [500_100.0, 4_000_010, 50], [500_060.0, 4_000_085, 50]]
    lines = {"breaklines": [line], "boundary": [ring]}
    tin = ts.triangulate(ts.read(path), **lines)
    made = ts.tiles(path, **lines).rasterize(
        tmp_path / "b.tif", spacing=1.0, tiles=5, executor=Shuffled()
    )
    np.testing.assert_array_equal(read(made), ts.rasterize(tin, spacing=1.0).bands["elevation"])


def test_voids_that_no_tiles_can_have_are_refused(tmp_path):
    path = write_raster(tmp_path / "a.tif", VOIDS["a hole"])
    other = write_raster(tmp_path / "b.tif")
    way = {"executor": Shuffled()}
    with pytest.raises(ts.ReadError, match=r"'a\.tif' has voids.*cannot be joined"):
        ts.tiles([path, other]).rasterize(tmp_path / "c.tif", spacing=1.0, **way)
    with pytest.raises(ts.ReadError, match="not available in tiles for this product"):
        ts.tiles(path).write(tmp_path / "terrain", **way)
    with pytest.raises(ts.ReadError, match="not available in tiles for the other surface"):
        ts.tiles(other).volume(tmp_path / "d.csv", ts.tiles(path), **way)
    grid = np.full((30, 40), np.nan)
    grid[::2, ::2] = 5.0
    sparse = write_raster(tmp_path / "e.tif", [(np.isnan(grid).nonzero())])
    with pytest.raises(ts.ReadError):
        ts.tiles(sparse).rasterize(tmp_path / "f.tif", spacing=1.0, **way)


def test_rows_far_apart_are_kept_apart():
    from tinsmith.tiled.chunks import split_numbers
    from tinsmith.tin.tiling import NumberedPoints

    numbers = np.array([0, 5, 2**32 - 1, 2**32, 2**32 + 7, 2**33 + 1])
    parts = split_numbers(NumberedPoints(np.zeros((6, 3)), numbers))
    assert [part.numbers.tolist() for part in parts] == [
        [0, 5, 2**32 - 1],
        [2**32, 2**32 + 7],
        [2**33 + 1],
    ]


def test_data_around_a_bay(tmp_path, monkeypatch):
    """Triangles across the bay have discs that hold most of the points."""
    monkeypatch.setattr("tinsmith.tiled.store._MANY", 50)
    rng = np.random.default_rng(11)
    points = np.round(rng.random((6_000, 3)) * [300, 300, 5] + [500_000, 4_000_000, 100], 2)
    x, y = points[:, 0] - 500_000, points[:, 1] - 4_000_000
    points = points[(x < 60) | (y < 60) | (np.abs(x - y) < 4)]
    path = ts.write(ts.Survey(points=points, crs="EPSG:32616"), tmp_path / "a.laz")
    wanted = ts.rasterize(ts.triangulate(ts.read(path)), spacing=2.0).bands["elevation"]
    for tiles in (1, 12):
        made = ts.tiles(path).rasterize(
            tmp_path / "b.tif", spacing=2.0, tiles=tiles, executor=Shuffled()
        )
        np.testing.assert_array_equal(read(made), wanted)


def test_cells_of_another_raster_are_in_the_same_crs(lidar, wanted, tmp_path):
    tin = ts.triangulate(ts.read(lidar, classes=2))
    like = ts.rasterize(tin, spacing=1.0)
    cloud = ts.tiles(lidar, classes=2)
    path = cloud.rasterize(tmp_path / "a.tif", like=like, tiles=3, executor=Shuffled())
    np.testing.assert_array_equal(read(path), wanted)
    other = ts.Raster(like.bands, like.grid, crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="the other raster"):
        cloud.rasterize(tmp_path / "b.tif", like=other, executor=Shuffled())


@pytest.mark.parametrize(
    "transform",
    [
        (7.0, 0.0, 500_020.0, 0.0, 3.0, 4_000_010.0),
        (-7.0, 0.0, 500_220.0, 0.0, -3.0, 4_000_190.0),
        (4.0, 3.0, 500_030.0, 3.0, -4.0, 4_000_080.0),
        (4.0, 1.0, 500_030.0, 2.0, 5.0, 4_000_020.0),
    ],
)
@pytest.mark.parametrize(
    "how",
    [
        {},
        {"at": "mean"},
        {"value": "slope"},
        {"value": "hillshade", "smooth": True},
        {"value": "roughness"},
        {"value": "tri", "compute_edges": True},
    ],
)
def test_cells_of_any_geotransform(lidar, tmp_path, transform, how):
    tin = ts.triangulate(ts.read(lidar, classes=2))
    grid = ts.Grid.of_transform(transform, (37, 28))
    like = ts.Raster({"a": np.zeros((37, 28))}, grid, crs="EPSG:32616")
    wanted = ts.rasterize(tin, like=like, **how)
    file = ts.write(like, tmp_path / "like.tif")
    cloud = ts.tiles(lidar, classes=2)
    path = cloud.rasterize(tmp_path / "a.tif", like=file, tiles=7, executor=Shuffled(), **how)
    np.testing.assert_array_equal(read(path), next(iter(wanted.bands.values())))
    with rasterio.open(path) as made:
        assert tuple(made.transform)[:6] == transform
    counts = cloud.rasterize_counts(tmp_path / "c.tif", like=file, tiles=7, executor=Shuffled())
    survey = ts.read(lidar, classes=2)
    np.testing.assert_array_equal(
        read(counts), ts.rasterize_counts(survey, like=like).bands["count"]
    )
    if "value" in how and transform[1] and "smooth" not in how:
        with pytest.raises(ts.OptionError, match="rotated or sheared"):
            cloud.rasterize(tmp_path / "b.tif", like=file, value="slope", operator="horn")


def test_too_many_cells_are_refused_before_anything_is_read(lidar, tmp_path):
    fine = {"spacing": 1e-5}
    for cloud in (ts.tiles(lidar), ts.tiles(lidar, classes=2)):
        with pytest.raises(ts.OptionError, match="number of cells") as tiled:
            cloud.rasterize(tmp_path / "a.tif", executor=Shuffled(), **fine)
        with pytest.raises(ts.OptionError, match="number of cells") as whole:
            ts.rasterize(ts.triangulate(ts.read(lidar, **cloud.options)), lazy=True, **fine)
        assert str(tiled.value) == str(whole.value)
        assert list(tmp_path.iterdir()) == []


def test_cells_beside_the_surface_are_refused_as_in_memory(lidar, tmp_path):
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 2.0, 2.0), (2, 2), 1.0)
    away = ts.Raster({"a": np.zeros((2, 2))}, grid, crs="EPSG:32616")
    with pytest.raises(ts.PointsError) as whole:
        ts.rasterize(ts.triangulate(ts.read(lidar)), like=away)
    with pytest.raises(ts.PointsError) as tiled:
        ts.tiles(lidar).rasterize(tmp_path / "a.tif", like=away, executor=Shuffled())
    assert str(tiled.value) == str(whole.value)


def test_counts_of_all_files_are_told_as_of_one_survey(tmp_path):
    folder = tmp_path / "lidar"
    folder.mkdir()
    rng = np.random.default_rng(4)
    for k, kind in enumerate((2, 2, 9)):  # the last one is of water alone
        points = np.round(rng.random((400, 3)) * [40, 40, 5] + [40 * k, 0, 0], 2)
        classes = np.where(rng.random(400) < 0.2 * (kind == 2), 5, kind).astype(np.uint8)
        survey = ts.Survey(points=points, attributes={"classification": classes})
        ts.write(survey, folder / f"{k}.laz")
    whole = ts.rasterize(ts.triangulate(ts.read(folder, classes=2)), spacing=2.0)
    wanted = ts.write(whole, tmp_path / "whole.tif")
    cloud = ts.tiles(folder, where={"classification": 2})
    made = cloud.rasterize(tmp_path / "made.tif", spacing=2.0, tiles=4, workers=1)
    assert made.read_bytes() == wanted.read_bytes()
    assert any("9 water (400); taken: 2" in note for note in whole.notes)
    nothing = ts.tiles(folder, where={"classification": 12})
    with pytest.raises(ts.ReadError, match=r"no points in the inputs.*9 water \(400\); taken: 12"):
        nothing.rasterize(tmp_path / "nothing.tif", spacing=2.0, workers=1)


@pytest.mark.parametrize("edges", [False, True])
@pytest.mark.parametrize("tiles", [1, 7])
@pytest.mark.parametrize(("value", "operator"), [("slope", "horn"), ("plan-curvature", None)])
def test_cells_and_their_neighbors_are_those_in_memory(
    lidar, tmp_path, value, operator, tiles, edges
):
    path = tmp_path / "a.tif"
    options = {"spacing": 1.0, "value": value, "operator": operator, "compute_edges": edges}
    with ThreadPoolExecutor(2) as threads:
        ts.tiles(lidar, classes=2).rasterize(path, tiles=tiles, executor=threads, **options)
    wanted = ts.rasterize(ts.triangulate(ts.read(lidar, classes=2)), **options)
    with rasterio.open(path) as dataset:
        np.testing.assert_array_equal(dataset.read(1), wanted.bands[value])
        assert wanted.notes[-1] in str(dataset.tags())


def test_neighbors_that_no_cell_has_are_refused_in_tiles(lidar, tmp_path):
    cloud = ts.tiles(lidar, classes=2)
    side = ts.read(lidar, classes=2).bounds.width
    with pytest.raises(ts.PointsError, match="No cell has a value of tpi"):
        cloud.rasterize(tmp_path / "a.tif", spacing=side, value="tpi")
    with pytest.raises(ts.OptionError, match="riley or wilson for tri"):
        cloud.rasterize(tmp_path / "a.tif", spacing=1.0, value="tri", operator="horn")
