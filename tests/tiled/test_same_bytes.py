"""A product of many files has the same bytes: any tiles, order, workers and interruptions."""

from __future__ import annotations

import filecmp
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from pathlib import Path

import distributed
import numpy as np
import pytest
import rasterio
from support.many_files import Shuffled

import tinsmith as ts
from tinsmith.tiled.running.executors import connect_to_dask

PRODUCTS = {
    ".tif": lambda made, path, **way: made.rasterize(path, spacing=1.0, **way),
    ".shp": lambda made, path, **way: made.contours(path, 0.5, **way),
}


@contextmanager
def dask():
    """Yield the way of a run on two workers of Dask."""
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
        ) as cluster,
        connect_to_dask(cluster.scheduler_address) as executor,
    ):
        yield {"executor": executor, "workers": 2}


@contextmanager
def threads(count):
    """Yield the way of a run in threads."""
    with ThreadPoolExecutor(count) as executor:
        yield {"executor": executor, "workers": count}


WAYS = {
    "shuffled": lambda: nullcontext({"executor": Shuffled(5)}),
    "shuffled otherwise": lambda: nullcontext({"executor": Shuffled(6)}),
    "a thread": lambda: threads(1),
    "two threads": lambda: threads(2),
    "a process": lambda: nullcontext({"workers": 1}),
    "two processes": lambda: nullcontext({"workers": 2}),
    "Dask": dask,
}


def write_survey(folder, count):
    """Write points of an uneven density in files that overlap; return the folder."""
    folder.mkdir()
    rng = np.random.default_rng(9)
    xy = np.concatenate(
        [
            rng.random((count // 2, 2)) * [600, 400],
            rng.normal([250, 150], 40, (count // 2, 2)),
        ]
    )
    z = 100 + 15 * np.sin(xy[:, 0] / 60) * np.cos(xy[:, 1] / 45) + rng.normal(0, 0.05, count)
    points = np.round(np.column_stack([np.add(xy, [500_000, 4_000_000]), z]), 2)
    order = np.argsort(points[:, 0] + rng.normal(0, 20, count))
    for k, rows in enumerate(np.array_split(order, 5)):
        ts.write(ts.Survey(points=points[np.sort(rows)], crs="EPSG:32616"), folder / f"p{k}.laz")
    return folder


@pytest.mark.proof
@pytest.mark.filterwarnings("ignore")  # of distributed, and of files that hold no notes
@pytest.mark.timeout(3600)
def test_any_tiles_order_and_workers(tmp_path):
    lidar = write_survey(tmp_path / "lidar", 120_000)
    tin = ts.triangulate(ts.read(lidar))
    cloud = ts.tiles(lidar)
    one = {
        suffix: make(cloud, tmp_path / f"one{suffix}", tiles=1, executor=Shuffled())
        for suffix, make in PRODUCTS.items()
    }
    with rasterio.open(one[".tif"]) as dataset:
        cells = ts.rasterize(tin, spacing=1.0).bands["elevation"]
        np.testing.assert_array_equal(dataset.read(1), cells)
    contours = ts.write(ts.contours(tin, 0.5), tmp_path / "whole.shp")
    assert filecmp.cmp(one[".shp"], contours, shallow=False)
    for name, start in WAYS.items():
        for tiles in (1, 4, 16, 64):
            with start() as way:
                for suffix, make in PRODUCTS.items():
                    path = make(cloud, tmp_path / f"tiles{suffix}", tiles=tiles, **way)
                    assert filecmp.cmp(path, one[suffix], shallow=False), (name, tiles, suffix)


def test_few_tiles_and_workers(tmp_path):
    """A small form of the proof."""
    lidar = write_survey(tmp_path / "lidar", 4_000)
    tin = ts.triangulate(ts.read(lidar))
    wanted = ts.write(ts.rasterize(tin, spacing=2.0), tmp_path / "wanted.tif")
    for name in ("shuffled", "two threads", "two processes"):
        with WAYS[name]() as way:
            path = ts.tiles(lidar).rasterize(tmp_path / "a.tif", spacing=2.0, tiles=16, **way)
        assert filecmp.cmp(path, wanted, shallow=False), name


CASE = {
    "product": "raster",
    "seed": 1,
    "tiles": 6,
    "kills": [{"at": 14, "delay": 0.0, "victim": "parent"}],
}


def fuzz(*arguments):
    """Run the campaign `kills` in a process of its own, which has no threads when it forks."""
    tests = Path(__file__).parent.parent
    command = [sys.executable, "-m", "fuzz", *map(str, arguments)]
    done = subprocess.run(command, cwd=tests, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.every_case("slow")
@pytest.mark.slow
@pytest.mark.parametrize(
    "more",
    [
        {},
        {"in_place": True},
        {"in_place": True, "kills": [{**CASE["kills"][0], "victim": "worker"}]},
    ],
    ids=["copied", "in place", "a worker in place"],
)
def test_a_run_that_is_killed_goes_on(tmp_path, more):
    find = tmp_path / "case.json"
    find.write_text(json.dumps({"campaign": "kills", "seed": 1, "case": CASE | more}))
    assert fuzz("--module", "fuzz.kills", "--replay", find) == "killed 1 times\n"


@pytest.mark.proof
@pytest.mark.timeout(3600)
def test_runs_that_are_killed_at_random_go_on(tmp_path):
    fuzz("--module", "fuzz.kills", "--campaign", "kills", "--cases", 10, "--folder", tmp_path)
