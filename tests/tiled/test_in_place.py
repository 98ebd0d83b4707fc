"""Files that are read in place give what copies of their points give, and what memory gives."""

from __future__ import annotations

import filecmp
import os
import shutil
import threading

import numpy as np
import pytest
import rasterio
from support.lidar_files import CORNER
from support.many_files import Shuffled
from support.sources_in_place import (
    SOURCES,
    write_groups,
    write_octree,
    write_raster,
    write_source,
)

import tinsmith as ts
from tinsmith.tiled import chunks, in_place
from tinsmith.tiled.products.mapped import measure_area

WEST, SOUTH = CORNER[:2].tolist()
LINE = [[WEST + 5.0, SOUTH + 8.0], [WEST + 60.5, SOUTH + 70.0], [WEST + 110.0, SOUTH + 20.0]]
SQUARE = {"a": [(WEST + 20, SOUTH + 20), (WEST + 90, SOUTH + 25), (WEST + 60, SOUTH + 80)]}
PLACES = np.add(LINE, [3.25, 1.75])
BREAKLINE = [[WEST + 10.0, SOUTH + 15.0, 330.0], [WEST + 100.0, SOUTH + 70.0, 331.0]]


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch):
    """Let few points be many: blocks are read one by one, and let go."""
    monkeypatch.setattr(chunks, "_POINTS_OF_A_CELL", 20)
    monkeypatch.setattr(in_place, "_POINTS_OF_A_BLOCK", 100)
    monkeypatch.setattr(in_place, "_POINTS_OF_A_PART", 200)
    monkeypatch.setattr(in_place, "_WORTH_READING", 10)
    monkeypatch.setattr(in_place, "_HELD_POINTS", 700)


PRODUCTS = {
    "raster": ("a.tif", lambda c, path, **way: c.rasterize(path, spacing=1.5, **way)),
    "COG": ("a.tif", lambda c, path, **way: c.rasterize(path, spacing=1.5, format="cog", **way)),
    "hillshade": (
        "a.tif",
        lambda c, path, **way: c.rasterize(path, spacing=1.5, value="hillshade", **way),
    ),
    "means": ("a.tif", lambda c, path, **way: c.rasterize(path, spacing=7.0, at="mean", **way)),
    "contours": ("a.shp", lambda c, path, **way: c.contours(path, 1.0, **way)),
    "bands": ("a.fgb", lambda c, path, **way: c.contours(path, 2.0, bands=True, **way)),
    "volume": (
        "a.csv",
        lambda c, path, **way: c.volume(path, base=321.0, regions=SQUARE, **way),
    ),
    "volume between": ("a.csv", lambda c, path, **way: c.volume(path, c, **way)),
    "slope": ("a.csv", lambda c, path, **way: c.slope_statistics(path, **way)),
    "profile": ("a.csv", lambda c, path, **way: c.profile(path, LINE, **way)),
    "drape": ("a.geojson", lambda c, path, **way: c.drape(path, PLACES, **way)),
    "places": ("a.csv", lambda c, path, **way: c.interpolate(path, PLACES, **way)),
    "counts": ("a.tif", lambda c, path, **way: c.rasterize_counts(path, spacing=8.0, **way)),
    "heights": ("a.tif", lambda c, path, **way: c.rasterize_heights(path, c, spacing=8.0, **way)),
    "surface": ("a", lambda c, path, **way: c.build(path, **way)),
    "one file": ("a.ply", lambda c, path, **way: c.build(path, **way)),
    "simplified": (
        "a.ply",
        lambda c, path, **way: c.simplify(path, 0.5, node_points=200, **way),
    ),
    "3D Tiles": ("a", lambda c, path, **way: c.write(path, node_points=200, **way)),
    "quantized-mesh": (
        "a",
        lambda c, path, **way: c.write(path, format="quantized-mesh", max_level=14, **way),
    ),
}


def list_files(path):
    """Return the bytes of a file, or of all files of a folder by their names."""
    if path.is_file():
        return {path.name: path.read_bytes()}
    return {
        str(one.relative_to(path)): one.read_bytes() for one in path.rglob("*") if one.is_file()
    }


@pytest.mark.each_value
@pytest.mark.filterwarnings("ignore")  # of formats that hold no notes, and of the geoid
@pytest.mark.parametrize("product", PRODUCTS)
@pytest.mark.parametrize("kind", SOURCES)
def test_every_product_has_the_bytes_of_that_of_copied_points(kind, product, tmp_path):
    copied, there = write_source(kind, tmp_path)
    assert there.plan().in_place == 1
    assert (there.plan().disk, there.plan().copied) == (0, {})
    name, make = PRODUCTS[product]
    found = []
    tiles = 1 if product == "surface" else 4  # which triangles share a file depends on tiles
    for number, cloud in enumerate((copied, there)):
        (tmp_path / str(number)).mkdir()
        path = tmp_path / str(number) / name
        make(cloud, path, tiles=tiles, executor=Shuffled(number))
        found.append(list_files(path))
    assert found[0] == found[1]


@pytest.mark.parametrize("kind", SOURCES)
def test_cells_are_those_in_memory_for_any_tiles_and_lines(kind, tmp_path):
    write, name, options = SOURCES[kind]
    path = write(tmp_path / name)
    lines = {"breaklines": [BREAKLINE]}
    for given, several in (({}, (1, 16)), (lines, (4,))):
        tin = ts.triangulate(ts.read(path, **options), **given)
        wanted = ts.rasterize(tin, spacing=1.0).bands["elevation"]
        cloud = ts.tiles(path, in_place=True, **options, **given)
        for tiles in several:
            made = cloud.rasterize(
                tmp_path / "made.tif", spacing=1.0, tiles=tiles, executor=Shuffled(tiles)
            )
            with rasterio.open(made) as dataset:
                np.testing.assert_array_equal(dataset.read(1), wanted)
        proof = cloud.check(run=tmp_path / "run", tiles=5, executor=Shuffled())
        assert (proof.triangles, proof.vertices) == (len(tin.triangles), len(tin.points))


VOIDS = [(slice(8, 14), slice(10, 20)), (slice(0, 9), slice(0, 12)), (29, slice(None))]


@pytest.mark.parametrize("options", [{}, {"cells": (3, 2, 33, 25), "stride": 2}])
def test_the_surface_of_a_raster_ends_at_voids_as_in_memory(tmp_path, options):
    path = write_raster(tmp_path / "a.tif", VOIDS)
    tin = ts.triangulate(ts.read(path, **options))
    cloud = ts.tiles(path, in_place=True, **options)
    made = cloud.rasterize(tmp_path / "b.tif", spacing=1.0, tiles=6, executor=Shuffled(2))
    with rasterio.open(made) as dataset:
        wanted = ts.rasterize(tin, spacing=1.0).bands["elevation"]
        np.testing.assert_array_equal(dataset.read(1), wanted)
    proof = cloud.check(run=tmp_path / "run", tiles=6, executor=Shuffled())
    assert proof.triangles == len(tin.triangles)


def test_ground_of_points_in_place(tmp_path):
    path = write_octree(tmp_path / "a.copc.laz")
    found = []
    for name, here in (("copied", False), ("there", True)):
        ts.tiles(path, in_place=here).ground(
            tmp_path / name, building=10.0, tiles=4, executor=Shuffled()
        )
        found.append((tmp_path / name / "a.laz").read_bytes())
    assert found[0] == found[1]


def test_values_of_attributes_and_functions_of_tiles(tmp_path):
    path = write_octree(tmp_path / "a.copc.laz")
    where = {"classification": 5, "number_of_returns": [1, 2]}
    copied, there = (ts.tiles(path, where=where, in_place=one) for one in (False, True))
    areas = [
        cloud.map(measure_area, run=tmp_path / f"run{k}", tiles=1, executor=Shuffled(k))
        for k, cloud in enumerate((copied, there))
    ]
    assert areas[0] == areas[1]
    made = [
        cloud.build(tmp_path / f"made{k}.ply", tiles=3, executor=Shuffled(k))
        for k, cloud in enumerate((copied, there))
    ]
    assert filecmp.cmp(*made, shallow=False)


# ---------------------------------------------------------------------- which files


def test_a_plan_tells_which_files_are_copied_and_why(tmp_path):
    octree = write_octree(tmp_path / "a.copc.laz")
    survey = ts.Survey(points=ts.read(octree).points[:50], crs="EPSG:32616")
    files = [octree, *(ts.write(survey, tmp_path / name) for name in ("b.laz", "c.laz"))]
    plan = ts.tiles(files, in_place=True).plan()
    assert (plan.in_place, plan.copied) == (1, {"has no octree (COPC)": 2})
    assert 0 < plan.disk < ts.tiles(files).plan().disk
    assert ts.tiles(files).plan().copied == {}
    text = ts.tiles(ts.write(survey, tmp_path / "d.csv"), in_place=True).plan()
    assert text.copied == {"has no index of where its points lie": 1}
    way = {"spacing": 2.0, "tiles": 3, "executor": Shuffled()}
    made = [
        ts.tiles(files, in_place=one).rasterize(tmp_path / f"{one}.tif", **way)
        for one in (False, True)
    ]
    assert filecmp.cmp(*made, shallow=False)


@pytest.mark.parametrize("kind", SOURCES)
def test_points_that_are_moved_are_copied(kind, tmp_path):
    write, name, options = SOURCES[kind]
    path = write(tmp_path / name)
    plan = ts.tiles(path, in_place=True, crs="EPSG:32617", **options).plan()
    assert plan.copied == {"would be reprojected": 1}


def test_what_has_no_order_is_copied(tmp_path):
    octree = write_octree(tmp_path / "a.copc.laz")
    thinned = ts.tiles(octree, in_place=True, every=2)
    assert thinned.plan().copied == {"is thinned by the option `every`, all over": 1}
    points = ts.read(octree).points
    mixed = points[np.random.default_rng(1).permutation(len(points))]
    plan = ts.tiles(write_groups(tmp_path / "a.parquet", mixed), in_place=True).plan()
    (why,) = plan.copied
    assert "no order in space" in why
    whole = ts.write(ts.Survey(points=points), tmp_path / "b.parquet")
    assert ts.tiles(whole, in_place=True).plan().copied == {
        "tells no bounds of its groups of rows": 1
    }


def test_rasters_in_wide_strips_are_copied(tmp_path):
    path = tmp_path / "a.tif"
    place = {"crs": "EPSG:32616", "transform": rasterio.Affine(1.0, 0.0, WEST, 0.0, -1.0, SOUTH)}
    size = {"count": 1, "width": 5_000, "height": 3}
    with rasterio.open(path, "w", driver="GTiff", dtype="float32", **size, **place) as dataset:
        dataset.write(np.zeros((3, 5_000), np.float32), 1)
    (why,) = ts.tiles(path, in_place=True).plan().copied
    assert why == "holds its cells in strips of 5,000, and not in tiles (as a COG does)"


def test_only_true_and_false_are_taken(tmp_path):
    path = write_raster(tmp_path / "a.tif")
    with pytest.raises(ts.OptionError, match="in_place"):
        ts.tiles(path, in_place="yes")


# --------------------------------------------------------------------------- faults


class Meddling(Shuffled):
    """Changes a file once the first task has ended."""

    def __init__(self, change):
        super().__init__(0)
        self._change = change
        self._is_done = False

    def submit(self, function, /, *given, **named):
        """Run a task."""
        future = super().submit(function, *given, **named)
        if not self._is_done:
            self._is_done = True
            self._change()
        return future


@pytest.mark.parametrize("kind", SOURCES)
def test_a_file_that_changes_during_the_run_is_refused(kind, tmp_path, monkeypatch):
    _, cloud = write_source(kind, tmp_path)
    (file,) = cloud.files
    whole = file.read_bytes()

    def touch():
        os.utime(file, ns=(1, 1))

    way = {"spacing": 1.0, "tiles": 4}
    with pytest.raises(ts.ReadError, match="was changed while it was read"):
        cloud.rasterize(tmp_path / "b.tif", executor=Meddling(touch), **way)
    assert not (tmp_path / "b.tif").exists()
    with pytest.raises(ts.ReadError, match="has changed"):
        cloud.rasterize(tmp_path / "b.tif", executor=Shuffled(), **way)
    file.write_bytes(whole)
    made = cloud.rasterize(tmp_path / "b.tif", executor=Shuffled(), restart=True, **way)
    wanted = cloud.rasterize(tmp_path / "c.tif", executor=Shuffled(1), **way)
    assert filecmp.cmp(made, wanted, shallow=False)


def test_a_file_that_is_gone_is_refused(tmp_path):
    _, cloud = write_source("GeoTIFF", tmp_path)
    with pytest.raises(ts.ReadError, match="Cannot read"):
        cloud.rasterize(
            tmp_path / "b.tif", spacing=1.0, tiles=4, executor=Meddling(cloud.files[0].unlink)
        )


@pytest.mark.parametrize("kind", SOURCES)
def test_an_index_that_hides_points_is_refused(kind, tmp_path, monkeypatch):
    _, cloud = write_source(kind, tmp_path)
    read = in_place.read_box

    def hide(*given, **options):
        return read(*given, **options).take(slice(1, None))

    monkeypatch.setattr(in_place, "read_box", hide)
    with pytest.raises(ts.ReadError, match="other points in a box than in all of it"):
        cloud.rasterize(tmp_path / "b.tif", spacing=1.0, tiles=4, executor=Shuffled())


def test_copies_are_not_taken_for_files_in_place(tmp_path):
    copied, there = write_source("COPC", tmp_path)
    store = tmp_path / "points"
    (file,) = there.files
    kept = ts.tiles(file, classes=2, in_place=True, store=store)
    one = kept.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    other = kept.rasterize(tmp_path / "b.tif", spacing=1.0, tiles=3, executor=Shuffled(0, 3))
    assert filecmp.cmp(one, other, shallow=False)
    assert sum(path.stat().st_size for path in store.glob("*.npy")) < 20_000
    with pytest.raises(ts.ReadError, match="`in_place` was True, and is None"):
        ts.tiles(file, classes=2, store=store).rasterize(
            tmp_path / "c.tif", spacing=1.0, executor=Shuffled()
        )
    with pytest.raises(KeyboardInterrupt):
        there.rasterize(tmp_path / "d.tif", spacing=1.0, executor=Shuffled(0, 1), workers=1)
    with pytest.raises(ts.ReadError, match="`in_place` was True, and is None"):
        copied.rasterize(tmp_path / "d.tif", spacing=1.0, executor=Shuffled())
    made = there.rasterize(tmp_path / "d.tif", spacing=1.0, executor=Shuffled())
    assert filecmp.cmp(one, made, shallow=False)


def test_workers_give_the_same_and_leave_nothing(tmp_path):
    copied, there = write_source("COPC", tmp_path)
    wanted = copied.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    made = there.rasterize(tmp_path / "b.tif", spacing=1.0, tiles=6, workers=2)
    assert filecmp.cmp(wanted, made, shallow=False)
    assert sorted(one.name for one in tmp_path.iterdir()) == ["a.copc.laz", "a.tif", "b.tif"]


# --------------------------------------------------------------------------- blocks


def read_counted(tmp_path):
    """Return a file in place, with all of its points."""
    path = write_octree(tmp_path / "a.copc.laz")
    cloud = ts.tiles(path, in_place=True, store=tmp_path / "points")
    cloud.rasterize(tmp_path / "a.tif", spacing=5.0, executor=Shuffled())
    from tinsmith.tiled.reading import open_store

    return open_store(tmp_path / "points"), ts.read(path).points


def test_every_point_of_a_box_is_read_once_in_order(tmp_path):
    store, points = read_counted(tmp_path)
    rng = np.random.default_rng(2)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    boxes = [ts.Bounds.of(low + (high - low) * rng.random((2, 2))) for _ in range(20)]
    boxes += [ts.Bounds.of(points[rng.integers(0, len(points), 2)]) for _ in range(20)]
    boxes += [ts.Bounds(-np.inf, -np.inf, np.inf, np.inf), ts.Bounds(0, 0, 1, 1)]
    for box in boxes:
        x, y = points[:, 0], points[:, 1]
        inside = (x >= box.xmin) & (x <= box.xmax) & (y >= box.ymin) & (y <= box.ymax)
        found = store.read_box(box)
        assert (found.numbers == np.flatnonzero(inside)).all()
        assert (found.points == points[inside]).all()


def test_parts_hold_all_points_and_few_each(tmp_path):
    store, points = read_counted(tmp_path)
    (chunk,) = store.chunks
    found = [store.read_box(box).numbers for box in chunk.list_parts()]
    assert set(np.concatenate(found).tolist()) == set(range(len(points)))
    assert max(map(len, found)) < 500
    assert chunk.firsts.tolist() == [0]


def test_blocks_are_held_up_to_a_number_of_points(tmp_path):
    store, points = read_counted(tmp_path)
    whole = ts.Bounds.of(points)
    assert len(store.read_box(whole).numbers) == len(points)
    assert in_place._HELD._count <= 700
    held = sum(len(one.cells) for one in in_place._HELD._blocks.values())
    assert held == in_place._HELD._count


@pytest.mark.slow
def test_threads_share_blocks(tmp_path):
    store, points = read_counted(tmp_path)
    wrong = []

    def read(seed):
        rng = np.random.default_rng(seed)
        for _ in range(10):
            box = ts.Bounds.of(points[rng.integers(0, len(points), 2)])
            x, y = points[:, 0], points[:, 1]
            inside = (x >= box.xmin) & (x <= box.xmax) & (y >= box.ymin) & (y <= box.ymax)
            if not np.array_equal(store.read_box(box).numbers, np.flatnonzero(inside)):
                wrong.append(box)

    threads = [threading.Thread(target=read, args=(seed,)) for seed in range(3)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert wrong == []


def test_another_run_in_the_same_folder_has_blocks_of_its_own(tmp_path):
    (tmp_path / "one").mkdir()
    store, points = read_counted(tmp_path / "one")
    assert len(store.read_box(ts.Bounds.of(points)).numbers) == len(points)
    shutil.rmtree(tmp_path / "one")
    (tmp_path / "one").mkdir()
    write = write_octree

    path = write(tmp_path / "one" / "a.copc.laz", 1_000)
    cloud = ts.tiles(path, in_place=True)
    made = cloud.rasterize(tmp_path / "one" / "b.tif", spacing=5.0, executor=Shuffled())
    tin = ts.triangulate(ts.read(path))
    with rasterio.open(made) as dataset:
        wanted = ts.rasterize(tin, spacing=5.0).bands["elevation"]
        np.testing.assert_array_equal(dataset.read(1), wanted)
