"""The command that draws contours."""

from __future__ import annotations

import json
from pathlib import Path

import pyogrio
import pytest
from support import commands

import tinsmith as ts

SURVEY = Path(__file__).parents[2] / "sample_data" / "site_survey.csv"
HOW = ["contours", str(SURVEY), "--crs", "EPSG:32616"]


def run(*arguments):
    return commands.run(*HOW, *arguments)


@pytest.fixture(scope="module")
def tin():
    return ts.triangulate(ts.read(SURVEY, crs="EPSG:32616"))


def test_lines_go_to_several_files(tmp_path, tin):
    files = [tmp_path / name for name in ("a.gpkg", "a.geojson")]
    done = run("--interval", 0.5, "-o", files[0], "-o", files[1], "--json")
    assert done.exit_code == 0, done.stderr
    expected = ts.contours(tin, interval=0.5)
    facts = json.loads(done.stdout)
    assert facts["features"] == len(expected)
    assert facts["closed"] == expected.columns["is_closed"].sum()
    assert facts["length"] == pytest.approx(expected.columns["length"].sum())
    assert facts["outputs"] == list(map(str, files))
    assert "43 lines, 26 of them closed" in done.stderr
    for file in files:
        assert pyogrio.read_info(file)["features"] == len(expected)


def test_bands_and_labels(tmp_path, tin):
    done = run("--interval", 1, "--bands", "-o", tmp_path / "b.gpkg", "--json")
    areas = [band["area"] for band in json.loads(done.stdout)["bands"]]
    assert sum(areas) == pytest.approx(tin.area, rel=1e-9)
    done = run("--interval", 1, "--labels", "-o", tmp_path / "l.gpkg")
    assert done.exit_code == 0
    expected = ts.contour_labels(ts.contours(tin, interval=1))
    assert pyogrio.read_info(tmp_path / "l.gpkg")["features"] == len(expected)


def test_explicit_levels_and_index(tmp_path):
    done = run("--levels", "320,325.5", "--index", 0, "-o", tmp_path / "a.gpkg", "--json")
    assert json.loads(done.stdout)["levels"] == [320.0, 325.5]


def test_tolerances_are_those_of_the_library(tmp_path, tin):
    done = run("--interval", 0.5, "--smooth", 0.1, "--simplify", 0.05, "-o",
               tmp_path / "a.gpkg", "--json")  # fmt: skip
    expected = ts.contours(tin, interval=0.5, smooth=0.1, simplify=0.05)
    assert json.loads(done.stdout)["points"] == len(expected.coordinates)


def test_levels_outside_are_told_and_the_file_is_empty(tmp_path):
    done = run("--levels", "1,2", "-o", tmp_path / "a.gpkg")
    assert done.exit_code == 0
    assert "2 of 2 levels lie outside the elevations of the surface" in done.stderr
    assert pyogrio.read_info(tmp_path / "a.gpkg")["features"] == 0


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--interval", "0"], "Invalid --interval 0.0: it must be a finite number > 0."),
        (["--interval", "nan"], "Invalid --interval nan"),
        (["--interval", "1e-7"], "at most 100,000 levels, and here there would be 167,890,001"),
        (["--levels", "1;2"], "it must be numbers with commas between them"),
        (["--levels", "1,nan"], "Invalid --levels nan: it must be finite."),
        ([], "Either --interval or --levels is needed, and not both."),
        (["--interval", "1", "--levels", "3"], "Either --interval or --levels"),
        (["--interval", "1", "--index", "-1"], "Invalid value for '--index'"),
        (["--interval", "1", "--smooth", "-1"], "Invalid --smooth -1.0: it must be"),
        (["--interval", "1", "--bands", "--simplify", "1"], "--simplify is for lines"),
        (["--interval", "1", "--bands", "--labels"], "two products"),
        (["--interval", "1", "--label-spacing", "9"], "--label-spacing needs --labels"),
        (["--interval", "1", "--labels", "--label-spacing", "0"], "Invalid --label-spacing 0.0"),
        (
            ["--interval", "1", "--thickness", "2"],
            "only stl can.",
        ),
    ],
)
def test_wrong_options_are_refused_and_nothing_is_written(tmp_path, options, sentence):
    said = commands.refuse(*HOW, *options, "-o", tmp_path / "a.gpkg", code=2, folder=tmp_path)
    assert sentence in " ".join(said.split())


def test_a_mesh_format_is_no_place_for_lines(tmp_path):
    done = run("--interval", 1, "-o", tmp_path / "a.ply")
    assert done.exit_code == 1
    assert "not Features" in done.stderr
