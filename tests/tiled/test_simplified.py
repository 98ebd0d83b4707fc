"""A surface simplified in squares: within the tolerance, without a crack, for any tiles."""

from __future__ import annotations

import numpy as np
import pytest
from support.many_files import Shuffled

import tinsmith as ts

TOLERANCE = 0.3
OPTIONS = {"tolerance": TOLERANCE, "node_points": 300}


@pytest.fixture(scope="module")
def made(lidar, tmp_path_factory):
    """Return the file of one tile."""
    path = tmp_path_factory.mktemp("made") / "made.ply"
    return ts.tiles(lidar, classes=2).simplify(path, **OPTIONS, executor=Shuffled())


def test_every_point_is_within_the_tolerance_of_few_vertices(made, tin):
    simple = ts.read(made)
    away = np.abs(simple.interpolate(tin.points[:, :2]) - tin.points[:, 2])
    assert away.max() <= TOLERANCE * (1 + 1e-12)
    assert len(simple.points) < len(tin.points) / 5
    assert simple.crs.is_same(tin.crs)


def test_the_whole_surface_is_covered_once_without_a_crack(made, tin):
    simple = ts.read(made)
    assert ts.check(simple, level=2).is_surface
    assert simple.area == pytest.approx(tin.area, rel=1e-12)
    assert len(np.unique(simple.points[:, :2], axis=0)) == len(simple.points)
    is_rim = np.zeros(len(simple.points), np.bool_)
    for triangle, corner in np.argwhere(simple.neighbors < 0).tolist():
        is_rim[np.delete(simple.triangles[triangle], corner)] = True
    hull = tin.points[tin.boundary[0], :2]
    after = np.roll(hull, -1, axis=0)
    for x, y in simple.points[is_rim, :2].tolist():  # no side within has one triangle only
        along, off = after - hull, np.array([x, y]) - hull
        apart = np.abs(along[:, 0] * off[:, 1] - along[:, 1] * off[:, 0])
        assert (apart / np.hypot(*along.T)).min() < 1e-8


@pytest.mark.parametrize("tiles", [4, 16])
def test_the_same_bytes_for_any_tiles(lidar, made, tmp_path, tiles):
    cloud = ts.tiles(lidar, classes=2)
    path = cloud.simplify(tmp_path / "a.ply", **OPTIONS, tiles=tiles, executor=Shuffled(tiles))
    assert path.read_bytes() == made.read_bytes()
    assert [one.name for one in tmp_path.iterdir()] == ["a.ply"]


@pytest.mark.parametrize("workers", [1, 2])
def test_the_same_bytes_for_any_workers(lidar, made, tmp_path, workers):
    cloud = ts.tiles(lidar, classes=2)
    path = cloud.simplify(tmp_path / "a.ply", **OPTIONS, tiles=4, workers=workers)
    assert path.read_bytes() == made.read_bytes()


def test_what_cannot_be_is_refused(lidar, tmp_path):
    cloud = ts.tiles(lidar)
    for given in ({"tolerance": 0}, {"tolerance": np.nan}, {"tolerance": 1, "node_points": 3}):
        with pytest.raises(ts.OptionError):
            cloud.simplify(tmp_path / "a.ply", **given, executor=Shuffled())
    with pytest.raises(ts.OptionError, match="others need all of it at a time"):
        cloud.simplify(tmp_path / "a.obj", 1.0, executor=Shuffled())
    with pytest.raises(ts.FormatError):
        cloud.simplify(tmp_path / "a", 1.0, executor=Shuffled())
    line = [[500_005, 4_000_030, 301.0], [500_120, 4_000_090, 309.0]]
    with_line = ts.tiles(lidar, breaklines=[line])
    with pytest.raises(ts.OptionError, match="none where a surface is simplified"):
        with_line.simplify(tmp_path / "a.ply", 1.0, executor=Shuffled())
    assert list(tmp_path.iterdir()) == []


def test_a_surface_narrower_than_rounding_is_refused(tmp_path):
    x = np.array([76.8, 77.3, 78.9, 79.7, 80.6, 81.4, 82.2]) + 0.02843790880735
    for seed in range(30):
        z = np.random.default_rng(seed).normal(0, 5, len(x))
        points = np.column_stack([x, x * 0.1 + seed / 97, z])
        try:
            tin = ts.triangulate(points)
        except ts.PointsError:
            continue
        cloud = ts.tiles(ts.write(ts.Survey(points=points), tmp_path / f"{seed}.ply"))
        ts.simplify(tin, tolerance=1.0)
        try:
            made = cloud.simplify(tmp_path / "a.ply", 1.0, node_points=16, executor=Shuffled())
        except ts.ReadError as error:
            assert "so narrow there that its triangles lie over each other" in str(error)  # noqa: PT017
            assert "tries" not in str(error)  # noqa: PT017
            return
        assert ts.check(ts.read(made), level=1).ok
    pytest.fail("no surface was refused")
