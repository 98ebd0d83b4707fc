"""'convert' for every pair of formats: written and read back, or refused with the way out."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from support import matrix

import tinsmith as ts
from tinsmith.cli import main

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = pytest.mark.every_case

FORMATS = [one for one in ts.io.known_formats() if one.is_built_in]
WRITTEN = [one for one in FORMATS if one.write and set(one.writes) & {"TIN", "Survey", "Raster"}]


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    """Return files of a TIN, of points, and of points in a grid."""
    folder = tmp_path_factory.mktemp("inputs")
    easting, northing = np.meshgrid(
        np.arange(431000, 431060, 10.0), np.arange(3984000, 3984050, 10)
    )
    cells = np.c_[easting.ravel(), northing.ravel(), np.arange(easting.size) / 7 + 300]
    return {
        "TIN": ts.write(matrix.make_tin(), folder / "tin.gpkg"),
        "Survey": ts.write(matrix.make_survey(), folder / "points.csv"),
        "grid": ts.write(ts.Survey(points=cells), folder / "grid.csv"),
    }


def convert(*arguments):
    with warnings.catch_warnings():
        warnings.simplefilter("default", ts.LossWarning)  # a line on stderr
        return CliRunner().invoke(main, ["convert", *map(str, arguments)])


@pytest.mark.parametrize("kind", ["TIN", "Survey", "grid"])
@pytest.mark.parametrize("one", WRITTEN, ids=lambda one: one.name)
def test_every_pair_is_written_or_refused_with_the_way_out(inputs, tmp_path, one, kind):
    path = tmp_path / f"out{''.join(one.suffixes[:1])}"
    how = ["--output-format", one.name] + (["--crs", "EPSG:32616"] if kind != "TIN" else [])
    result = convert(inputs[kind], "-o", path, *how)
    own = "TIN" if kind == "TIN" else "Survey"
    by_suffix = [other for other in WRITTEN if f".{one.name}" in other.suffixes]
    if any(own in other.writes for other in (one, *by_suffix)) or (
        kind == "grid" and "Raster" in one.writes
    ):
        assert result.exit_code == 0, result.output
        assert path.stat().st_size
        return
    assert result.exit_code == 1
    assert not path.exists()
    way = "'tinsmith build'" if "TIN" in one.writes else "raster"
    assert way in result.stderr
    assert "bug" not in result.stderr


@pytest.mark.parametrize("one", WRITTEN, ids=lambda one: one.name)
def test_every_file_of_a_tin_becomes_points(inputs, tmp_path, one):
    if one.read is None or "TIN" not in one.writes:
        return
    middle = tmp_path / f"middle{''.join(one.suffixes[:1])}"
    assert convert(inputs["TIN"], "-o", middle, "--output-format", one.name).exit_code == 0
    in_degrees = ["--crs", "EPSG:32616"] if one.name.startswith("geojson") else []
    result = convert(middle, "-o", tmp_path / "points.csv", *in_degrees)
    assert result.exit_code == 0, result.output
    assert len(ts.read(tmp_path / "points.csv")) == len(matrix.make_tin().points)


def test_cells_of_a_grid_become_a_raster_and_come_back(inputs, tmp_path):
    tif = tmp_path / "a.tif"
    assert convert(inputs["grid"], "-o", tif, "--crs", "EPSG:32616").exit_code == 0
    assert convert(tif, "-o", tmp_path / "b.tif").exit_code == 0
    given, found = ts.read(inputs["grid"]), ts.read(tmp_path / "b.tif")
    rows = [np.lexsort(one.points[:, :2].T) for one in (given, found)]
    assert given.points[rows[0]].tolist() == found.points[rows[1]].tolist()
    assert found.crs == "EPSG:32616"


@pytest.mark.parametrize(
    ("points", "reason"),
    [
        ([[0, 0, 1], [1, 0, 2], [0.3, 1, 3]], "off its centre"),
        ([[0, 0, 1], [1, 0, 2], [0, 1, 3], [1, 0, 2]], "in the cell of another"),
        ([[0, 0, 1], [1, 0, 2], [5000, 7000, 3], [0, 1, 3]], "cells"),
        ([[0, 0, 1], [0, 0, 1]], "at one place"),
        ([[0, 0, 1], [1, 0, 2], [0, 2.5, 3]], "off its centre"),
    ],
)
def test_points_that_are_no_grid_are_no_raster(tmp_path, points, reason):
    path = ts.write(ts.Survey(points=np.array(points, float)), tmp_path / "a.csv")
    result = convert(path, "-o", tmp_path / "a.tif")
    assert result.exit_code == 1
    assert "are not the cells of a grid" in result.stderr
    assert reason in result.stderr
    assert not Path(tmp_path / "a.tif").exists()


def test_nothing_is_written_where_the_points_are_no_grid(inputs, tmp_path):
    result = convert(inputs["Survey"], "-o", tmp_path / "a.csv", "-o", tmp_path / "a.tif")
    assert result.exit_code == 1
    assert list(tmp_path.iterdir()) == []
