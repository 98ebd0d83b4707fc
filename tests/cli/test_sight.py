"""``tinsmith sight``: lines and viewsheds as the library has them."""

from __future__ import annotations

import json

import numpy as np
import pytest
from support.commands import run

import tinsmith as ts

RIDGE = [[0, 0, 0], [0, 4, 0], [4, 0, 2], [4, 4, 2], [8, 0, 0], [8, 4, 0]]


@pytest.fixture
def site(tmp_path):
    path = tmp_path / "site.ply"
    ts.write(ts.triangulate(np.array(RIDGE, float), crs="EPSG:32616", elevation_unit="m"), path)
    return path


def test_lines_and_the_viewshed_are_written(site, tmp_path):
    start = ("sight", site, "--from", "1", "2", "--eye-height", "0.5", "--json", "-o")
    done = run(*start, tmp_path / "a.csv", "--to", "3", "2", "--to", "7", "2")
    assert done.exit_code == 0, done.output
    assert [row["visible"] for row in json.loads(done.stdout)["found"]] == [True, False]
    done = run(*start, tmp_path / "a.geojson")
    assert done.exit_code == 0, done.output
    assert [row["class"] for row in json.loads(done.stdout)["found"]] == ["visible", "hidden"]
    assert (tmp_path / "a.csv").exists()
    assert (tmp_path / "a.geojson").exists()


def write_places(path, places, crs="EPSG:32616"):
    return ts.write(ts.Features.of_points(places, crs=crs), path)


def test_places_of_files_are_reprojected(site, tmp_path):
    degrees = ts.CRS("EPSG:4326")
    points = ts.Survey(points=[[1, 2, 0], [3, 2, 0], [7, 2, 0]], crs="EPSG:32616")
    around = ts.reproject(points, degrees).points[:, :2]
    eye = write_places(tmp_path / "eye.gpkg", around[:1], degrees)
    targets = write_places(tmp_path / "targets.gpkg", around[1:], degrees)
    start = ("sight", site, "--eye-height", "0.5", "--json", "-o", tmp_path / "a.csv")
    plain = json.loads(run(*start, "--from", 1, 2, "--to", 3, 2, "--to", 7, 2).stdout)["found"]
    done = run(*start, "--eye", eye, "--targets", targets)
    for found, wanted in zip(json.loads(done.stdout)["found"], plain, strict=True):
        assert found["visible"] == wanted["visible"]
        assert found["distance"] == pytest.approx(wanted["distance"], abs=1e-6)
    seen = json.loads(run(*start, "--eye", eye).stdout)["found"]
    assert [row["class"] for row in seen] == ["visible", "hidden"]


def test_each_place_is_given_once_and_by_points(site, tmp_path):
    eye = write_places(tmp_path / "eye.gpkg", [[1, 2]])
    line = ts.Features.of_lines([[1, 2], [3, 2]], [0, 2], crs="EPSG:32616")
    lines = ts.write(line, tmp_path / "lines.gpkg")
    out = ("-o", tmp_path / "a.csv")
    assert run("sight", site, "--from", 1, 2, "--eye", eye, *out).exit_code == 2
    double = ("--to", 3, 2, "--targets", eye)
    assert run("sight", site, "--from", 1, 2, *double, *out).exit_code == 2
    done = run("sight", site, "--eye", lines, *out)
    assert done.exit_code == 1
    assert "has lines: points are needed" in done.output
    assert not (tmp_path / "a.csv").exists()


def test_triangles_are_judged_as_wholes_if_asked(tmp_path):
    rng = np.random.default_rng(3)
    path = tmp_path / "hills.ply"
    ts.write(
        ts.triangulate(rng.uniform(0, [50, 50, 9], (90, 3)), crs="EPSG:32616", elevation_unit="m"),
        path,
    )
    start = ("sight", path, "--from", 25, 25, "--eye-height", 3, "--json", "-o")
    divided = run(*start, tmp_path / "a.geojson")
    assert [row["class"] for row in json.loads(divided.stdout)["found"]] == ["visible", "hidden"]
    whole = run(*start, tmp_path / "b.geojson", "--whole-triangles")
    classes = [row["class"] for row in json.loads(whole.stdout)["found"]]
    assert classes == ["visible", "partly", "hidden"]


def test_wrong_usage_exits_2_and_places_outside_1(site, tmp_path):
    out = ("-o", tmp_path / "a.csv")
    assert run("sight", site, *out).exit_code == 2
    assert run("sight", site, "--from", 1, 2, "--to", 7, 2, "--radius", 3, *out).exit_code == 2
    assert run("sight", site, "--from", 1, 2, "--sight-refraction", 0.2, *out).exit_code == 2
    assert (
        run("sight", site, "--from", 1, 2, "--to", 7, 2, "--whole-triangles", *out).exit_code == 2
    )
    assert run("sight", site, "--from", 99, 2, *out).exit_code == 1


def test_several_eyes_go_with_as_many_targets_and_no_viewshed(site, tmp_path):
    eyes = ("--from", "1", "2", "--from", "2", "2")
    targets = ("--to", "3", "2", "--to", "5", "2")
    start = ("sight", site, *eyes, "--eye-height", "3", "--json", "-o")
    done = run(*start, tmp_path / "lines.csv", *targets)
    assert done.exit_code == 0, done.output
    assert [row["distance"] for row in json.loads(done.stdout)["found"]] == [2.0, 3.0]
    refused = run(*start, tmp_path / "seen.gpkg")
    assert refused.exit_code == 1
    assert "There are 2 eyes: a viewshed has one." in refused.output
