"""``tinsmith ground``: classes in LAS, points and TINs of the ground, summaries and refusals."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import laspy
import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main

LIDAR = Path(__file__).parents[1] / "data" / "isprs_samp11_crop.laz"


@pytest.fixture
def house(tmp_path):
    """Write a house on a plane as LAZ, with attributes of its own."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(30.0)))
    z = np.where((abs(x - 15) < 5) & (abs(y - 15) < 5), 6.0, 0.0)
    rows = np.arange(len(x))
    survey = ts.Survey(
        points=np.column_stack([x + 500_000, y + 4_000_000, z]),
        crs="EPSG:32616+5703",
        attributes={"gps_time": rows * 0.5, "user_data": (rows % 7).astype(np.uint8)},
    )
    return ts.write(survey, tmp_path / "house.laz")


def run(*args, code=0):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        result = CliRunner().invoke(main, [str(arg) for arg in args])
    assert result.exit_code == code, result.output
    return result


def test_classes_are_written_and_attributes_kept(house, tmp_path):
    result = run("ground", house, "-o", tmp_path / "a.laz", "--json")
    record = json.loads(result.stdout)
    cloud = laspy.read(tmp_path / "a.laz")
    classes, counts = np.unique(cloud.classification, return_counts=True)
    assert dict(zip(classes.tolist(), counts.tolist(), strict=True)) == {1: 81, 2: 819}
    assert record["classes"] == {"ground": 819, "others": 81, "low noise": 0}
    assert record["parameters"]["building"] == 40.0
    assert (cloud.gps_time == np.arange(900) * 0.5).all()
    assert (cloud.user_data == np.arange(900) % 7).all()
    assert "819 points, 91.0%" in result.stderr


def test_each_file_holds_what_it_can(house, tmp_path):
    names = ("a.laz", "b.csv", "c.ply", "d.las")
    run("ground", house, *[part for name in names for part in ("-o", tmp_path / name)])
    assert len(ts.read(tmp_path / "a.laz")) == 900
    assert len(ts.read(tmp_path / "b.csv", crs="EPSG:32616")) == 819
    assert isinstance(ts.read(tmp_path / "c.ply"), ts.TIN)
    run("ground", house, "--ground-only", "-o", tmp_path / "d.las")
    assert len(ts.read(tmp_path / "d.las")) == 819
    run("ground", house, "--as-points", "-o", tmp_path / "c.ply")
    assert isinstance(ts.read(tmp_path / "c.ply"), ts.Survey)


def test_a_narrower_house_is_told(house, tmp_path):
    run("ground", house, "--building", "4", "-o", tmp_path / "a.laz", "-q")
    assert np.count_nonzero(laspy.read(tmp_path / "a.laz").classification == 2) > 819


def test_real_points_are_mostly_told_right(tmp_path):
    run("ground", LIDAR, "-o", tmp_path / "a.laz", "-q")
    found, given = laspy.read(tmp_path / "a.laz"), laspy.read(LIDAR)
    assert len(found) == len(given)
    wrong = (found.classification == 2) != (given.classification == 2)
    assert wrong.mean() < 0.25  # a strip of the hardest of the ISPRS samples, steep and overgrown


def test_refusals(house, tmp_path):
    assert "--cell" in run("ground", house, "--cell", "0", "-o", tmp_path / "a.laz", code=2).output
    run("ground", house, "-o", tmp_path / "tin.ply", "--quiet")
    told = run("ground", tmp_path / "tin.ply", "-o", tmp_path / "a.laz", code=1).output
    assert "holds a TIN" in told
    assert not (tmp_path / "a.laz").exists()
    assert "input" in run("ground", house, "-o", house, code=2).output
