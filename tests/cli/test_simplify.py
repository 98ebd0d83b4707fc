"""``tinsmith simplify`` as people run it."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.commands import run
from support.simplification import errors

import tinsmith as ts

SAMPLES = Path(__file__).parents[2] / "sample_data"
SITE = str(SAMPLES / "site_survey.csv")


def test_a_survey_with_lines_becomes_a_light_surface(tmp_path):
    path = tmp_path / "light.gpkg"
    out = run(*("simplify", SITE, "--codes", "--tolerance", 0.1, "-o", path, "--json"))
    assert out.exit_code == 0, out.output
    told = json.loads(out.stdout)["simplification"]
    simple = ts.read(path)
    assert told["vertices"] == len(simple.points) < told["points"]
    assert run("build", SITE, "--codes", "-o", tmp_path / "given.gpkg").exit_code == 0
    given = ts.read(tmp_path / "given.gpkg")
    assert len(given.points) == told["points"]
    found = errors(given.points, simple)
    assert told["largest_error"] == pytest.approx(found.max(), abs=1e-9)
    assert told["largest_error"] <= 0.1
    assert "largest" in out.stderr


def test_a_raster_keeps_its_voids(tmp_path):
    rows = [" ".join(str((r * c) % 7) for c in range(12)) for r in range(12)]
    for row in (5, 6, 7):
        cells = rows[row].split()
        cells[5:8] = ["-9999"] * 3
        rows[row] = " ".join(cells)
    head = "ncols 12\nnrows 12\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n"
    path = tmp_path / "dem.asc"
    path.write_text(head + "\n".join(rows) + "\n")
    out = run("simplify", path, "--tolerance", 1, "-o", tmp_path / "dem.ply")
    assert out.exit_code == 0, out.output
    simple = ts.read(tmp_path / "dem.ply")
    assert simple.area == pytest.approx(11 * 11 - 16 + 2)
    assert np.isnan(simple.interpolate([[6.5, 5.5]])).all()


def test_points_of_a_file_stay(tmp_path):
    survey = ts.read(SITE)
    benchmarks = survey.points[[5, 50, 500]]
    keep = tmp_path / "keep.xyz"
    keep.write_text("".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in benchmarks.tolist()))
    path = tmp_path / "a.ply"
    out = run("simplify", SITE, "--points", 300, "--keep", keep, "-o", path)
    assert out.exit_code == 0, out.output
    left = {tuple(point) for point in ts.read(path).points.tolist()}
    assert len(left) == 300
    assert {tuple(point) for point in benchmarks.tolist()} <= left
    keep.write_text("1 2 3\n1 3 3\n4 5 3\n")
    out = run("simplify", SITE, "--points", 300, "--keep", keep, "-o", path)
    assert out.exit_code == 1
    assert (
        "3 points of 3 to be kept are not vertices of the surface; the first is at 1, 2."
        in out.stderr
    )


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "--tolerance or --points: give one of them"),
        (["--tolerance", 1, "--points", 9], "--tolerance or --points: not both"),
        (["--tolerance", -1], "Invalid --tolerance -1.0"),
        (["--points", 2], "Invalid --points 2"),
        (["--points", 10**6], "there are no more"),
    ],
)
def test_wrong_usage_is_told(tmp_path, options, words):
    out = run("simplify", SITE, *options, "-o", tmp_path / "a.ply")
    assert out.exit_code == 2
    assert words in out.stderr
    assert not (tmp_path / "a.ply").exists()
