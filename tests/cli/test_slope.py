"""``tinsmith slope`` and ``tinsmith hillshade``: files, summaries, JSON and refusals."""

from __future__ import annotations

import json

import geopandas
import numpy as np
import pandas as pd
import pytest
import rasterio
from support.commands import run_command as run


@pytest.fixture
def site(tmp_path):
    """Write a hill of 60 points."""
    xy = np.random.default_rng(4).uniform(0, 50, (60, 2)) + np.array([500_000, 4_000_000])
    z = 300 - 0.01 * ((xy - [500_025, 4_000_025]) ** 2).sum(axis=1)
    path = tmp_path / "site.csv"
    pd.DataFrame({"easting": xy[:, 0], "northing": xy[:, 1], "elevation": z}).to_csv(path)
    return path


def test_classes_to_a_map_and_a_table(site, tmp_path):
    map_path, table = tmp_path / "a.gpkg", tmp_path / "a.csv"
    result = run(
        *("slope", site, "--crs", "EPSG:32616", "--unit", "percent", "--breaks", "10,20.5"),
        *("-o", map_path, "-o", table, "--json"),
    )
    facts = json.loads(result.stdout)
    frame, rows = geopandas.read_file(map_path), pd.read_csv(table)
    labels = [one["label"] for one in facts["classes"]]
    assert labels == frame["label"].tolist() == rows["label"].tolist()
    assert labels[0] == "0 to 10 %"
    assert frame.area.sum() == pytest.approx(facts["slope"]["area"])
    assert rows["area (m²)"].sum() == pytest.approx(facts["slope"]["area"])
    assert facts["slope_units"]["mean"] == "%"
    assert facts["outputs"] == [str(map_path), str(table)]
    assert "Classes" in result.stderr
    assert "taken to be the metre" in result.stderr


def test_aspects(site, tmp_path):
    run("slope", site, "--crs", "EPSG:32616", "--aspect", "-o", tmp_path / "a.geojson", "-q")
    names = {one["properties"]["label"] for one in features(tmp_path / "a.geojson")}
    assert names == {"N", "NE", "E", "SE", "S", "SW", "W", "NW"}


def features(path):
    return json.loads(path.read_text())["features"]


def test_hillshade(site, tmp_path):
    path = tmp_path / "a.tif"
    result = run(
        *("hillshade", site, "--crs", "EPSG:32616", "--spacing", "0.5", "--smooth"),
        *("--azimuth", "100", "--altitude", "30", "--exaggeration", "2", "-o", path, "--json"),
    )
    facts = json.loads(result.stdout)["raster"]
    with rasterio.open(path) as raster:
        assert list(raster.shape) == facts["shape"]
        assert raster.crs.to_epsg() == 32616
        assert raster.nodata == 0
        assert raster.descriptions == ("hillshade",)
        assert raster.read(1).max() > 100
    assert "rows by" in result.stderr


@pytest.mark.parametrize(
    ("command", "code", "words"),
    [
        (["slope", "--breaks", "5,x"], 2, "Invalid --breaks '5,x': it must be numbers"),
        (["slope", "--breaks", "5,3"], 2, "--breaks"),
        (["slope", "--breaks", "5", "--aspect"], 2, "--breaks is for slopes"),
        (["slope", "--unit", "radians"], 2, "radians"),
        (["hillshade", "--spacing", "0"], 2, "Invalid --spacing 0"),
        (["hillshade", "--spacing", "1e-9"], 2, "--spacing"),
        (["hillshade", "--altitude", "100"], 2, "--altitude"),
    ],
)
def test_wrong_options(site, tmp_path, command, code, words):
    name, *options = command
    output = tmp_path / ("a.tif" if name == "hillshade" else "a.gpkg")
    result = run(name, site, "--crs", "EPSG:32616", *options, "-o", output, code=code)
    assert words in result.stderr
    assert "Traceback" not in result.stderr
    assert not output.exists()


@pytest.mark.parametrize(("name", "suffix"), [("slope", ".tif"), ("hillshade", ".gpkg")])
def test_formats_that_do_not_fit_are_refused_before_any_work(site, tmp_path, name, suffix):
    result = run(name, site, "-o", tmp_path / f"a{suffix}", code=1)
    assert "can be written to" in result.stderr
    assert "Raster" in result.stderr


def test_the_input_is_never_overwritten(site):
    before = site.read_bytes()
    result = run("slope", site, "-o", site, code=2)
    assert "the input" in result.stderr
    assert site.read_bytes() == before
