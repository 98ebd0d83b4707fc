"""docs/examples/tinsmith-x3d, installed as its own distribution and used as one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from support import matrix

import tinsmith as ts

pytestmark = pytest.mark.slow

EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "tinsmith-x3d"


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Return the folder of an installed plug-in."""
    folder = tmp_path_factory.mktemp("installed")
    source = shutil.copytree(EXAMPLE, folder / "source")
    target = folder / "packages"
    how = ["--no-deps", "--no-build-isolation", "--no-index", "--quiet", "--target", str(target)]
    done = subprocess.run(
        [sys.executable, "-m", "pip", "install", *how, str(source)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return target


def run(installed, *arguments, code=0):
    script = "from tinsmith.cli import main; main()"
    surroundings = os.environ | {"PYTHONPATH": str(installed), "COLUMNS": "120"}
    command = [sys.executable, "-c", script, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, env=surroundings)
    assert done.returncode == code, done.stderr
    return done


def test_the_plug_in_is_listed(installed):
    listed = json.loads(run(installed, "formats", "--json").stdout)["formats"]
    (found,) = [one for one in listed if one["name"] == "x3d"]
    assert (found["reads"], found["writes"], found["suffixes"]) == ([], ["TIN"], [".x3d"])
    assert found["from"] == "tinsmith-x3d 0.1.0"
    shown = run(installed, "--help")
    assert shown.stdout.split("Commands of plug-ins:")[1].split()[0] == "x3d-summary"
    assert shown.stderr == ""


@pytest.mark.parametrize("crs", ["EPSG:32616", "EPSG:2274"])
def test_a_tin_becomes_a_scene_with_its_place(installed, tmp_path, crs):
    tin = matrix.make_tin().replace(crs=crs)
    path = tmp_path / "a.x3d"
    run(installed, "convert", ts.write(tin, tmp_path / "a.gpkg"), "-o", path)
    root = ET.parse(path).getroot()
    told = {meta.get("name"): meta.get("content") for meta in root.iter("meta")}
    (triangles,) = root.iter("IndexedTriangleSet")
    assert told["crs"] == crs
    index = np.array(triangles.get("index").split(), int).reshape(-1, 3)
    assert np.array_equal(index, tin.triangles)
    words = triangles.find("Coordinate").get("point").replace(",", " ").split()
    east, up, south = np.array(words, float).reshape(-1, 3).T
    origin = np.array(told["origin"].split(), float)
    scale = 1.0 if crs == "EPSG:32616" else 3937 / 1200  # metres as US survey feet
    np.testing.assert_allclose(
        np.column_stack([east, -south, up]) + origin, tin.points * [1, 1, scale], rtol=1e-15
    )
    summary = run(installed, "x3d-summary", path).stdout
    assert f"{len(tin.points)} vertices, {len(tin.triangles)} triangles" in summary


def test_the_file_is_the_same_each_time(installed, tmp_path):
    given = ts.write(matrix.make_tin(), tmp_path / "a.gpkg")
    for name in ("a.x3d", "b.x3d"):
        run(installed, "convert", given, "-o", tmp_path / name)
    assert (tmp_path / "a.x3d").read_bytes() == (tmp_path / "b.x3d").read_bytes()


def test_what_it_cannot_write_is_refused(installed, tmp_path):
    degrees = ts.triangulate([[9, 50, 1], [9.1, 50, 2], [9, 50.1, 3]], crs=4326)
    given = ts.write(degrees, tmp_path / "a.gpkg")
    done = run(installed, "convert", given, "-o", tmp_path / "a.x3d", code=1)
    assert "the scene needs eastings and northings" in done.stderr
    assert not (tmp_path / "a.x3d").exists()
    points = ts.write(ts.Survey(points=np.eye(3)), tmp_path / "a.csv")
    done = run(installed, "convert", points, "-o", tmp_path / "a.x3d", code=1)
    assert "'tinsmith build'" in done.stderr
