"""Refusals leave nothing, full disks and folders that cannot be written lose nothing."""

from __future__ import annotations

import errno
import filecmp
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from support.many_files import Shuffled, lose

import tinsmith as ts
from tinsmith.base import atomic


def list_tree(folder):
    return sorted(str(one.relative_to(folder)) for one in folder.rglob("*"))


# ---------------------------------------------------------------------------- refusals


def test_what_no_further_call_can_cure_leaves_nothing(lidar, tmp_path):
    cloud = ts.tiles(lidar, where={"classification": 2})
    way = {"tiles": 3, "executor": Shuffled()}
    with pytest.raises(ts.OptionError, match="number of cells"):
        cloud.rasterize(tmp_path / "a.tif", spacing=1e-5, **way)
    grid = ts.Grid(ts.Bounds(0.0, 0.0, 2.0, 2.0), (2, 2), 1.0)
    away = ts.Raster({"a": np.zeros((2, 2))}, grid, crs="EPSG:32616")
    with pytest.raises(ts.PointsError, match="do not meet"):
        cloud.rasterize(tmp_path / "a.tif", like=away, **way)
    line = ts.Features.of_lines([[0, 0], [1, 1]], [0, 2], crs="EPSG:32617")
    with pytest.raises(ts.CrsError):
        cloud.profile(tmp_path / "a.csv", line, **way)
    with pytest.raises(ts.TinsmithError):
        cloud.drape(tmp_path / "a.gpkg", [[0.0, 0.0], [1.0, 1.0]], **way)
    assert list_tree(tmp_path) == []


def test_files_that_do_not_fit_together_leave_nothing(tmp_path):
    (tmp_path / "in").mkdir()
    for name, crs in (("a", "EPSG:32616"), ("b", "EPSG:32617")):
        points = [[500_000, 4_000_000, 1], [500_009, 4_000_000, 1], [500_000, 4_000_009, 2]]
        ts.write(ts.Survey(points=points, crs=crs), tmp_path / "in" / f"{name}.laz")
    cloud = ts.tiles(tmp_path / "in")
    with pytest.raises(ts.CrsError, match="not in one CRS"):
        cloud.rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    assert list_tree(tmp_path) == ["in", "in/a.laz", "in/b.laz"]


def test_failed_tasks_keep_what_is_done(lidar, tmp_path):
    folder = tmp_path / "lidar"
    folder.mkdir()
    for one in lidar.iterdir():
        (folder / one.name).write_bytes(one.read_bytes())
    bad = folder / "tile1.laz"
    whole = bad.read_bytes()
    bad.write_bytes(whole[:2_000] + bytes(len(whole) - 2_100) + whole[-100:])
    with pytest.raises(ts.ReadError, match="1 task of 3 failed"):
        ts.tiles(folder, classes=2).rasterize(tmp_path / "a.tif", spacing=1.0, executor=Shuffled())
    kept = list_tree(tmp_path / "a.tif.run")
    assert [one for one in kept if one.startswith("points/inputs/")] != []


def test_ground_that_is_refused_leaves_no_folder(lidar, tmp_path):
    with pytest.raises(ts.TinsmithError):
        ts.tiles(lidar, classes=3).ground(tmp_path / "out", executor=Shuffled())
    with pytest.raises(ts.OptionError):
        ts.tiles(lidar).ground(tmp_path / "out", cell=-1.0, executor=Shuffled())
    assert list_tree(tmp_path) == []
    (tmp_path / "mine").mkdir()
    with pytest.raises(ts.OptionError):
        ts.tiles(lidar).ground(tmp_path / "mine", cell=-1.0, executor=Shuffled())
    assert list_tree(tmp_path) == ["mine"]


# ---------------------------------------------------------------------------- warnings


@pytest.mark.parametrize("kind", ["processes", "threads", "here"])
def test_warnings_of_tasks_are_given_once_here(lidar, tmp_path, kind):
    cloud = ts.tiles(lidar, classes=2)
    way = {"tiles": 4, "workers": 2, "keep": True}
    with ThreadPoolExecutor(2) as threads:
        if kind != "processes":
            way["executor"] = threads if kind == "threads" else Shuffled()
        for _ in range(2):  # a run that goes on has them, too
            with pytest.warns(ts.LossWarning) as caught:
                made = cloud.map(lose, run=tmp_path / "run", **way)
            assert len(made) == 4
            (only,) = caught
            assert "ply' does not hold" in str(only.message)
            assert str(only.message).endswith("(3 further files likewise.)")
            assert only.filename == __file__


def test_what_files_of_tiles_lose_is_told_once(lidar, tmp_path):
    survey = ts.read(lidar, classes=2)
    named = ts.Survey(points=survey.points, crs="EPSG:32616", elevation_unit="ft")
    cloud = ts.tiles(ts.write(named, tmp_path / "a.csv"), crs="EPSG:32616", elevation_unit="ft")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        cloud.build(tmp_path / "made", format="flatgeobuf", tiles=4, executor=Shuffled())
    told = [str(one.message) for one in caught]
    assert len(told) == len({one.partition("'")[2] for one in told}) <= 1


# ---------------------------------------------------------------------------- full disks

LIMITED = """
import resource, signal, sys
resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, resource.RLIM_INFINITY))
from tinsmith.cli import main
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.every_case("slow")
@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_files_that_become_too_large_are_told_and_the_run_goes_on(lidar, tmp_path, workers):
    """The limit on the size of files stands for a disk that is full: no rights are needed."""
    words = ["raster", lidar, "--spacing", "2", "--tiles", "3", "--workers", workers, "-q", "-o"]
    words = [str(word) for word in words]
    path, wanted = tmp_path / "a.tif", tmp_path / "wanted.tif"
    command = [sys.executable, "-c", LIMITED.format(size=20_000), *words, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "the disk is full" in done.stderr
    assert "Traceback" not in done.stderr
    assert list_tree(tmp_path)[0] == "a.tif.run"
    assert not path.exists()
    for one in (path, wanted):
        command = [sys.executable, "-m", "tinsmith", *words, str(one)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
        assert done.returncode == 0, done.stderr
    assert filecmp.cmp(path, wanted, shallow=False)
    assert list_tree(tmp_path) == ["a.tif", "wanted.tif"]


@pytest.mark.parametrize("fails", range(0, 24, 3))
def test_a_full_disk_at_any_file_loses_nothing(lidar, tmp_path, fails, monkeypatch):
    cloud = ts.tiles(lidar, classes=2)
    way = {"spacing": 5.0, "tiles": 3}
    cloud.rasterize(tmp_path / "wanted.tif", executor=Shuffled(), **way)
    left = [fails]
    sync = atomic.os.replace

    def fill(*given, **options):
        left[0] -= 1
        if left[0] < 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        return sync(*given, **options)

    with monkeypatch.context() as patched:
        patched.setattr(atomic.os, "replace", fill)
        with pytest.raises(ts.WriteError, match="No space left on device"):
            cloud.rasterize(tmp_path / "a.tif", executor=Shuffled(), **way)
    assert not (tmp_path / "a.tif").exists()
    cloud.rasterize(tmp_path / "a.tif", executor=Shuffled(), **way)
    assert filecmp.cmp(tmp_path / "a.tif", tmp_path / "wanted.tif", shallow=False)
    assert list_tree(tmp_path) == ["a.tif", "wanted.tif"]


def test_folders_that_cannot_be_written_are_told(lidar, tmp_path):
    file = tmp_path / "file"
    file.write_text("mine")
    cloud = ts.tiles(lidar, classes=2)
    places = {
        "output": (file / "a.tif", {}),
        "run": (tmp_path / "a.tif", {"run": file / "run"}),
        "the run in a folder that is none": (tmp_path / "a.tif", {"run": file}),
    }
    for path, more in places.values():
        with pytest.raises(ts.WriteError, match=r"^Cannot write .*\.$"):
            cloud.rasterize(path, spacing=5.0, executor=Shuffled(), **more)
    kept = ts.tiles(lidar, classes=2, store=file / "store")
    with pytest.raises(ts.WriteError, match=r"^Cannot write .*\.$"):
        kept.rasterize(tmp_path / "a.tif", spacing=5.0, executor=Shuffled())
    assert file.read_text() == "mine"
    path = cloud.rasterize(tmp_path / "a.tif", spacing=5.0, executor=Shuffled())
    assert list_tree(tmp_path) == ["a.tif", "file"]
    assert path.stat().st_size > 1_000
