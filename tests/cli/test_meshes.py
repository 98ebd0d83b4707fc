"""Meshes on the command line: formats, their flags, folders in and out."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.commands import run
from support.surfaces import hills

import tinsmith as ts

DATA = Path(__file__).parents[1] / "data" / "meshes"


def run_alone(*arguments):
    """Run in a process of its own, whose warnings are sentences on standard error."""
    command = [sys.executable, "-m", "tinsmith", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)


@pytest.fixture
def site(tmp_path):
    return ts.write(hills(80, unit=None), tmp_path / "site.ply")


@pytest.mark.parametrize("name", ["a.2dm", "a.nc", "a.off", "a.city.json"])
def test_convert_to_and_from(site, tmp_path, name):
    done = run("convert", site, "-o", tmp_path / name)
    assert done.exit_code == 0, done.stderr
    done = run("convert", tmp_path / name, "-o", tmp_path / "back.ply", "--elevation-unit", "m")
    assert done.exit_code == 0, done.stderr
    tin, back = ts.read(site), ts.read(tmp_path / "back.ply")
    assert np.array_equal(back.triangles, tin.triangles)
    assert np.abs(back.points - tin.points).max() < 2e-9


def test_an_esri_tin_folder_is_an_input(tmp_path):
    for place in (DATA / "esri_tin_dem", DATA / "esri_tin_dem" / "tnod.adf"):
        done = run("convert", place, "-o", tmp_path / "a.ply")
        assert done.exit_code == 0, done.stderr
        assert len(ts.read(tmp_path / "a.ply").triangles) == 528


def test_a_model_to_print(site, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    model = ("--solid", "--size", 120, "--thickness", 2, "--exaggeration", 1.5)
    done = run("convert", site, "-o", tmp_path / "a.stl", *model)
    assert done.exit_code == 0, done.stderr
    mesh = trimesh.load(tmp_path / "a.stl")
    assert mesh.is_volume
    assert mesh.extents[:2].max() == pytest.approx(120, rel=1e-6)


def test_tiles_are_a_folder_that_is_replaced(site, tmp_path):
    tiles = tmp_path / "tiles"
    for level in (13, 12):
        how = ("--output-format", "quantized-mesh", "--max-level", level)
        done = run_alone("convert", site, "-o", tiles, *how)
        assert done.returncode == 0, done.stderr
        assert "differ by the height of the geoid" in done.stderr
        assert json.loads((tiles / "layer.json").read_text())["maxzoom"] == level
    finest = next((tiles / "12").rglob("*.terrain"))
    assert run("info", finest).exit_code == 0
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").touch()
    done = run_alone("convert", site, "-o", tmp_path / "mine", "--output-format", "quantized-mesh")
    assert done.returncode == 1
    assert (tmp_path / "mine" / "notes.txt").exists()


def test_the_texture_cannot_be_the_output(site, tmp_path):
    picture = tmp_path / "a.glb"
    picture.write_bytes(b"\x89PNG\r\n\x1a\n")
    done = run("convert", site, "-o", picture, "--ortho", picture)
    assert done.exit_code == 2
    assert "--ortho: it cannot be the output too" in " ".join(done.stderr.split())
    assert picture.read_bytes() == b"\x89PNG\r\n\x1a\n"


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (("-o", "a.off", "--solid"), 2, "only stl can"),
        (("-o", "a.2dm", "--ortho", "x.png"), 2, "only glb, obj can|only obj, glb can"),
        (("-o", "a.stl", "--scale", "500", "--size", "9"), 2, "Invalid --size"),
        (("-o", "a.glb", "--ortho", "none.tif"), 1, "Cannot read"),
        (("-o", "a.city.json", "--precision", "0.3"), 2, "Invalid --precision"),
    ],
)
def test_flags_that_do_not_fit(site, tmp_path, monkeypatch, arguments, code, sentence):
    monkeypatch.chdir(tmp_path)
    done = run("convert", site, *arguments)
    assert done.exit_code == code, done.stderr
    text = " ".join(done.stderr.split())
    assert any(one in text for one in sentence.split("|")), text
    assert {one.name for one in tmp_path.iterdir()} == {"site.ply"}


def test_what_a_reader_asks_is_a_flag(tmp_path):
    city = {"type": "CityJSON", "version": "2.0", "vertices": [[0, 0, 1], [4, 0, 2], [0, 4, 3]]}
    city["transform"] = {"scale": [1, 1, 1], "translate": [0, 0, 0]}
    shape = {"type": "CompositeSurface", "lod": "1", "boundaries": [[[0, 1, 2]]]}
    relief = {"type": "TINRelief", "geometry": [shape]}
    city["CityObjects"] = {"old": relief, "new": relief}
    path = tmp_path / "a.city.json"
    path.write_text(json.dumps(city))
    assert run("info", path).exit_code == 1
    assert run("info", path, "--surface", "new").exit_code == 0
    tile = ("--tile", "15/33695/26068")
    assert run("info", DATA / "26068.terrain").exit_code == 1
    assert run("info", DATA / "26068.terrain", *tile).exit_code == 0
