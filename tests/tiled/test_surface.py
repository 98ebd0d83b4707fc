"""The surface in tiles as a folder of files: the triangles and numbers of the one in memory."""

from __future__ import annotations

import filecmp
import json

import numpy as np
import pytest
from support.many_files import Shuffled

import tinsmith as ts
from tinsmith.tiled.assembling import Sweep, merge_triangles, write_turned
from tinsmith.tiled.numbering import NUMBER, number_vertices
from tinsmith.tiled.running.runs import hash_file


def turn(triangles):
    """Return triangles as a set, from their least corner on."""
    first = triangles.argmin(axis=1)
    turned = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    return set(map(tuple, turned.tolist()))


def read_index(folder):
    """Return what the index tells, every file of it held against the folder."""
    index = json.loads((folder / "surface.json").read_text())
    names = {one["file"] for one in index["files"]}
    assert {path.name for path in folder.iterdir()} == {*names, "surface.json"}
    for one in index["files"]:
        assert one["blake2b"] == hash_file(folder / one["file"])
        assert one["bytes"] == (folder / one["file"]).stat().st_size
    return index


@pytest.mark.each_value
@pytest.mark.parametrize("tiles", [1, 4, 16])
@pytest.mark.parametrize("name", ["ply", "tin"])
def test_triangles_and_numbers_are_those_in_memory(lidar, tin, tmp_path, tiles, name):
    cloud = ts.tiles(lidar, classes=2)
    folder = cloud.build(tmp_path / "made", format=name, tiles=tiles, executor=Shuffled(tiles))
    index = read_index(folder)
    assert [path.name for path in tmp_path.iterdir()] == ["made"]
    assert (index["vertices"], index["triangles"]) == (len(tin.points), len(tin.triangles))
    assert (index["crs"], index["elevation_unit"]) == ("EPSG:32616", None)
    assert tiles // 2 < len(index["files"]) <= tiles
    found = []
    for one in index["files"]:
        part = ts.read(folder / one["file"])
        numbers = part.attributes["vertex"].astype(np.int64)
        np.testing.assert_array_equal(part.points, tin.points[numbers])
        assert one["bounds"] == [*part.points.min(axis=0), *part.points.max(axis=0)]
        assert part.crs.is_same(tin.crs)
        found.append(numbers[part.triangles])
    every = np.concatenate(found)
    assert len(every) == len(tin.triangles)
    assert turn(every) == turn(tin.triangles)


def test_triangles_as_polygons(lidar, tin, tmp_path):
    pyarrow = pytest.importorskip("pyarrow.parquet")
    cloud = ts.tiles(lidar, classes=2)
    folder = cloud.build(tmp_path / "made", format="geoparquet", tiles=3, executor=Shuffled())
    tables = [pyarrow.read_table(folder / one["file"]) for one in read_index(folder)["files"]]
    corners = np.concatenate(
        [np.column_stack([table[name].to_numpy() for name in "abc"]) for table in tables]
    )
    assert turn(corners) == turn(tin.triangles)


def test_a_run_that_was_interrupted_gives_the_same_files(lidar, tmp_path):
    cloud = ts.tiles(lidar, classes=2)
    whole = cloud.build(tmp_path / "whole", tiles=4, executor=Shuffled())
    with pytest.raises(KeyboardInterrupt):
        cloud.build(tmp_path / "made", tiles=4, executor=Shuffled(1, most=5))
    made = cloud.build(tmp_path / "made", executor=Shuffled(2))
    names = [path.name for path in whole.iterdir()]
    assert filecmp.cmpfiles(whole, made, names, shallow=False)[0] == names


def test_a_folder_of_something_else_is_left_alone(lidar, tmp_path):
    (tmp_path / "made").mkdir()
    (tmp_path / "made" / "thesis.txt").write_text("mine")
    with pytest.raises(ts.WriteError, match=r"holds no surface\.json"):
        ts.tiles(lidar).build(tmp_path / "made", executor=Shuffled())
    assert [path.name for path in tmp_path.iterdir()] == ["made"]


@pytest.mark.parametrize("given", [{"format": "obj"}, {"format": "stl"}, {"write": {"size": 3}}])
def test_formats_without_numbers_and_wrong_options_are_refused(lidar, tmp_path, given):
    with pytest.raises(ts.OptionError):
        ts.tiles(lidar).build(tmp_path / "made", executor=Shuffled(), **given)
    assert list(tmp_path.iterdir()) == []


def test_numbers_range_by_range(tmp_path):
    rng = np.random.default_rng(2)
    rows = np.sort(rng.choice(10_000, 900, replace=False)).astype(np.int64)
    tile = rng.integers(0, 4, len(rows))
    files = {name: [tmp_path / f"{name}{k}" for k in range(4)] for name in ("own", "used", "made")}
    chosen = [np.sort(rng.choice(rows, 300, replace=False)) for _ in range(4)]
    for k in range(4):
        files["own"][k].write_bytes(rows[tile == k].tobytes())
        files["used"][k].write_bytes(chosen[k].tobytes())
    for firsts in ([0], [0, 1, 17, 5_000, 9_999, 20_000]):
        assert number_vertices(*files.values(), np.array(firsts)) == len(rows)
        for k in range(4):
            found = np.fromfile(files["made"][k], NUMBER)
            np.testing.assert_array_equal(rows[found], chosen[k])
    files["own"][0].write_bytes(b"")
    with pytest.raises(ts.CheckError, match="lies in no tile"):
        number_vertices(*files.values(), np.array([0]))
    files["own"][0].write_bytes(files["own"][1].read_bytes())
    with pytest.raises(ts.CheckError, match="lies in two tiles"):
        number_vertices(*files.values(), np.array([0]))


# --------------------------------------------------------------------------- one file


@pytest.fixture(scope="module")
def whole(lidar, tmp_path_factory):
    """Return the file that is written of the surface in memory."""
    tin = ts.triangulate(ts.read(lidar, classes=2, attributes=[]))
    return ts.write(tin, tmp_path_factory.mktemp("whole") / "whole.ply")


@pytest.mark.parametrize("tiles", [1, 4, 16])
def test_one_file_has_the_bytes_of_memory(lidar, whole, tmp_path, tiles):
    cloud = ts.tiles(lidar, classes=2)
    made = cloud.build(tmp_path / "made.ply", tiles=tiles, executor=Shuffled(tiles))
    assert made.read_bytes() == whole.read_bytes()
    assert [path.name for path in tmp_path.iterdir()] == ["made.ply"]


@pytest.mark.parametrize("workers", [1, 2])
def test_one_file_of_workers(lidar, whole, tmp_path, workers):
    made = ts.tiles(lidar, classes=2).build(tmp_path / "made.ply", tiles=4, workers=workers)
    assert made.read_bytes() == whole.read_bytes()


@pytest.mark.parametrize("most", [5, 40, 700])
def test_the_order_of_triangles_range_by_range(tmp_path, most):
    rng = np.random.default_rng(4)
    town = rng.random((800, 3)) * 1e-6
    lattice = np.stack(np.meshgrid(np.arange(30.0), np.arange(20.0), [0.0]), axis=-1).reshape(-1, 3)
    sets = {
        "even": rng.random((900, 3)),
        "a town and one far off": np.concatenate([rng.random((300, 3)), town, [[1e4, 1e4, 0]]]),
        "all but one in a cell": np.concatenate([rng.random((500, 3)), [[1e9, 1e9, 0]]]),
        "lattice": lattice,
        "a circle": np.column_stack([*circle(97), np.zeros(97)]),
    }
    for name, points in sets.items():
        tin = ts.triangulate(points)
        folder = tmp_path / name
        folder.mkdir()
        sweep = Sweep(tin.points, folder, most)
        owner = rng.integers(0, 3, len(tin.triangles))
        paths = [folder / f"tile{k}" for k in np.unique(owner)]
        for k, path in zip(np.unique(owner), paths, strict=True):
            write_turned(path, tin.triangles[owner == k], sweep)
        found = np.concatenate([*merge_triangles(paths, sweep, most=most)])
        np.testing.assert_array_equal(found, tin.triangles, err_msg=name)


def circle(count):
    """Return x and y of points on a circle and of its middle, nearest to all of them."""
    angle = np.arange(count) * (2 * np.pi / (count - 1))
    x, y = np.cos(angle), np.sin(angle)
    x[-1] = y[-1] = 0.0
    return x, y


def test_one_file_that_cannot_be(lidar, tmp_path):
    cloud = ts.tiles(lidar)
    with pytest.raises(ts.OptionError, match="others need all of it at a time"):
        cloud.build(tmp_path / "made.obj", executor=Shuffled())
    with pytest.raises(ts.OptionError, match="its writer has no options"):
        cloud.build(tmp_path / "made.ply", write={"size": 3}, executor=Shuffled())
    line = [[500_005, 4_000_030, 301.0], [500_120, 4_000_090, 309.0]]
    with_line = ts.tiles(lidar, breaklines=[line])
    with pytest.raises(ts.OptionError, match="write a folder"):
        with_line.build(tmp_path / "made.ply", executor=Shuffled())
    with pytest.raises(ts.WriteError, match="there is no folder"):
        cloud.build(tmp_path / "no" / "made.ply", executor=Shuffled())
    flat = ts.write(ts.Survey(points=[[0, 0, 1], [1, 1, 1], [2, 2, 1]]), tmp_path / "flat.csv")
    with pytest.raises(ts.ReadError, match="collinear"):
        ts.tiles(flat).build(tmp_path / "made.ply", executor=Shuffled())
    assert {path.name for path in tmp_path.iterdir()} <= {"flat.csv", "made.ply.run"}


def test_one_file_after_an_interruption(lidar, whole, tmp_path):
    cloud = ts.tiles(lidar, classes=2)
    with pytest.raises(KeyboardInterrupt):
        cloud.build(tmp_path / "made.ply", tiles=4, executor=Shuffled(1, most=5))
    made = cloud.build(tmp_path / "made.ply", executor=Shuffled(2))
    assert made.read_bytes() == whole.read_bytes()
