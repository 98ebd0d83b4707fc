"""The ground of many files: every file again, with the classes of all points at once."""

from __future__ import annotations

import json
import shutil

import laspy
import numpy as np
import pytest
from support.many_files import Shuffled

import tinsmith as ts

CRS = "EPSG:32616"


def make_points():
    """Return points on hills with houses across the borders of files, trees and low noise."""
    rng = np.random.default_rng(11)
    x, y = rng.random((2, 12_000)) * [[220.0], [150.0]]
    z = 200 + 9 * np.sin(x / 40) * np.cos(y / 55) + rng.normal(0, 0.03, len(x))
    is_house = (np.abs(x - 110) < 14) & (np.abs(y - 75) < 9)
    is_tree = (rng.random(len(x)) < 0.3) & (np.sin(x / 17) > 0.3) & ~is_house
    z[is_house] += 7
    z[is_tree] += rng.uniform(1, 15, int(is_tree.sum()))
    z[:4] -= 25
    points = np.column_stack([x + 500_000, y + 4_000_000, z]).round(2)
    returns = np.where(is_tree, 1, 2).astype(np.uint8)
    classes = np.zeros(len(x), np.uint8)
    classes[4:9] = 18
    return points, {
        "return_number": returns,
        "number_of_returns": np.full(len(x), 2, np.uint8),
        "classification": classes,
        "gps_time": rng.random(len(x)),
        "height_of_tree": rng.random(len(x)).astype(np.float32),
    }


@pytest.fixture(scope="module")
def lidar(tmp_path_factory):
    """Return a folder of three files."""
    folder = tmp_path_factory.mktemp("lidar")
    points, attributes = make_points()
    strip = np.minimum((points[:, 0] - 500_000) // 75, 2)
    strip[::41] = 0
    for number in range(3):
        chosen = strip == number
        survey = ts.Survey(
            points=points[chosen],
            attributes={name: values[chosen] for name, values in attributes.items()},
            crs=CRS,
        )
        ts.write(survey, folder / f"strip{number}.laz")
    return folder


@pytest.fixture(scope="module")
def whole(lidar):
    """Return what is found in memory."""
    return ts.ground(ts.read(lidar, attributes="all"))


def read_classes(folder):
    return np.concatenate(
        [np.asarray(laspy.read(path).classification) for path in sorted(folder.glob("*.la[sz]"))]
    )


def test_labels_are_those_of_all_points_for_any_tiles(lidar, whole, tmp_path):
    """The house and the hills reach less far than the margin, so that none differs."""
    assert set(np.unique(whole.classification)) == {1, 2, 7, 18}
    cloud = ts.tiles(lidar, store=tmp_path / "points")
    for tiles in (1, 4, 16):
        made = cloud.ground(tmp_path / f"of{tiles}", tiles=tiles, executor=Shuffled(tiles))
        assert made.name == f"of{tiles}.vpc"
        np.testing.assert_array_equal(read_classes(made.parent), whole.classification)


def test_everything_else_of_the_files_is_kept(lidar, tmp_path):
    made = ts.tiles(lidar).ground(tmp_path / "out", workers=1)
    for path in sorted(lidar.iterdir()):
        before, after = laspy.read(path), laspy.read(made.parent / path.name)
        for name in before.point_format.dimension_names:
            if name != "classification":
                np.testing.assert_array_equal(before[name], after[name], err_msg=name)
        np.testing.assert_array_equal(before.header.scales, after.header.scales)
        assert after.header.parse_crs() == before.header.parse_crs()


@pytest.mark.parametrize("kind", list(laspy.header.GpsTimeType))
def test_what_times_count_from_is_kept(kind, lidar, tmp_path):
    file = laspy.read(lidar / "strip0.laz")
    file.header.global_encoding.gps_time_type = kind
    file.write(tmp_path / "a.laz")
    made = ts.tiles(tmp_path / "a.laz").ground(tmp_path / "out", executor=Shuffled())
    with laspy.open(made.parent / "a.laz") as written:
        assert written.header.global_encoding.gps_time_type == kind


def test_other_programs_find_the_files_by_the_virtual_cloud(lidar, tmp_path):
    made = ts.tiles(lidar).ground(tmp_path / "out", workers=1)
    assert len(ts.read(made)) == len(ts.read(lidar))
    assert ts.tiles(made).files == tuple(sorted(made.parent.glob("*.laz")))
    items = json.loads(made.read_text())["features"]
    for item, path in zip(items, sorted(lidar.iterdir()), strict=True):
        file = laspy.read(path)
        assert item["properties"]["pc:count"] == len(file)
        np.testing.assert_allclose(item["properties"]["proj:bbox"][:3], file.xyz.min(axis=0))
        west, south, _, east, north, _ = item["bbox"]
        assert -88 < west < east < -86
        assert 36 < south < north < 37


def test_ground_alone_and_chosen_points(lidar, whole, tmp_path):
    made = ts.tiles(lidar).ground(tmp_path / "ground", workers=1, ground_only=True)
    assert len(ts.read(made)) == whole.counts["ground"]
    chosen = ts.tiles(lidar, where={"return_number": 2}).ground(tmp_path / "last", workers=1)
    survey = ts.read(lidar, attributes="all")
    is_last = survey.attributes["return_number"] == 2
    last = ts.Survey(
        points=survey.points[is_last],
        attributes={name: values[is_last] for name, values in survey.attributes.items()},
        crs=survey.crs,
    )
    np.testing.assert_array_equal(read_classes(chosen.parent), ts.ground(last).classification)


def test_a_run_that_is_interrupted_goes_on(lidar, tmp_path):
    cloud = ts.tiles(lidar)
    wanted = cloud.ground(tmp_path / "once", tiles=3, executor=Shuffled())
    ends = []
    for tasks in range(3, 40, 2):
        try:
            cloud.ground(tmp_path / "out", tiles=3, executor=Shuffled(tasks, most=2))
        except KeyboardInterrupt:
            ends.append(tasks)
        else:
            break
    assert len(ends) >= 3
    files = sorted(one.name for one in wanted.parent.iterdir() if one.suffix == ".laz")
    assert sorted(one.name for one in (tmp_path / "out").iterdir()) == sorted([*files, "out.vpc"])
    for name in files:
        made = (tmp_path / "out" / name).read_bytes()
        assert made == (wanted.parent / name).read_bytes()


def test_inputs_are_never_replaced(lidar, tmp_path):
    folder = shutil.copytree(lidar, tmp_path / "lidar")
    before = {one.name: one.read_bytes() for one in folder.iterdir()}
    with pytest.raises(ts.WriteError, match=r"strip0\.laz': it is read\. Name another folder"):
        ts.tiles(folder).ground(folder, workers=1)
    assert {one.name: one.read_bytes() for one in folder.iterdir()} == before
    (tmp_path / "file").touch()
    with pytest.raises(ts.WriteError, match="a file is there"):
        ts.tiles(folder).ground(tmp_path / "file", workers=1)


def test_what_cannot_be_written_as_classes_is_refused(lidar, tmp_path):
    points, _ = make_points()
    path = ts.write(ts.Survey(points=points), tmp_path / "points.csv")
    with pytest.raises(ts.ReadError, match=r"points\.csv' is no lidar file"):
        ts.tiles(path).ground(tmp_path / "out")
    cloud = ts.tiles(lidar, crs="EPSG:32617")
    with pytest.raises(ts.ReadError, match=r"were converted to another CRS or unit"):
        cloud.ground(tmp_path / "out", workers=1, executor=Shuffled())
    noise = ts.Survey(
        points=points, attributes={"classification": np.full(len(points), 7, np.uint8)}, crs=CRS
    )
    ts.write(noise, tmp_path / "noise.laz")
    with pytest.raises(ts.TinsmithError, match=r"[Nn]o.* points?|None of"):
        ts.tiles(tmp_path / "noise.laz").ground(tmp_path / "noise", executor=Shuffled())
    with pytest.raises(ts.OptionError, match="reach"):
        ts.tiles(lidar).ground(tmp_path / "out2", reach=-1.0)


def test_without_a_crs_there_is_no_virtual_cloud(tmp_path):
    points, _ = make_points()
    file = ts.write(ts.Survey(points=points - [500_000, 4_000_000, 0]), tmp_path / "a.las")
    made = ts.tiles([file]).ground(tmp_path / "out", workers=1)
    assert made == tmp_path / "out"
    assert [one.name for one in made.iterdir()] == ["a.las"]


def test_names_are_given_once(tmp_path):
    points, _ = make_points()
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        ts.write(ts.Survey(points=points, crs=CRS), tmp_path / name / "a.laz")
    files = [tmp_path / name / "a.laz" for name in ("one", "two")]
    made = ts.tiles(files).ground(tmp_path / "out", workers=1)
    assert sorted(one.name for one in made.parent.iterdir()) == ["a-2.laz", "a.laz", "out.vpc"]
