"""``tinsmith inspect`` and ``build --drop-blunders``: files, summaries, JSON and refusals."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest
from support.commands import run_command as run

import tinsmith as ts

COUNT = 600


@pytest.fixture
def site(tmp_path):
    """Write a site with a spike, a digit too many and a point far away."""
    rng = np.random.default_rng(4)
    xy = rng.random((COUNT, 2)) * 100 + [500_000, 4_000_000]
    z = 300 + 0.1 * (xy[:, 0] - 500_000) + rng.normal(0, 0.02, COUNT)
    z[40] += 6.0
    z[50] *= 10.0
    xy[60, 1] += 3_000
    path = tmp_path / "site.csv"
    names = {"point": np.arange(1, COUNT + 1), "easting": xy[:, 0], "northing": xy[:, 1]}
    pd.DataFrame(names | {"elevation": z}).to_csv(path, index=False)
    return path


def test_findings_to_tables_a_map_and_json(site, tmp_path):
    table, record, picture = (tmp_path / f"a.{end}" for end in ("csv", "json", "png"))
    result = run(
        *("inspect", site, "--crs", "EPSG:32616", "--json"),
        *("-o", table, "-o", record, "-o", picture),
    )
    facts = json.loads(result.stdout)
    assert {(one["row"], one["reason"]) for one in facts["blunders"]} == {
        (40, "spike"),
        (50, "factor"),
        (60, "isolated"),
    }
    rows = pd.read_csv(table)
    assert rows["row"].tolist() == [one["row"] for one in facts["blunders"]]
    assert rows["number"].tolist() == [one["row"] + 1 for one in facts["blunders"]]
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert record.stat().st_size > 100
    assert "Point 51 (line 52 of 'site.csv')" in result.stderr
    assert "max-edge" not in result.stderr or "--max-edge" in result.stderr


def test_a_build_tells_of_blunders_and_leaves_them_in(site, tmp_path):
    result = run("build", site, "--crs", "EPSG:32616", "-o", tmp_path / "a.ply")
    line = next(line for line in result.stderr.splitlines() if line.startswith("Blunders"))
    assert "3 points look like blunders: point 41 (line 42 of 'site.csv'); point 51 (" in line
    assert "'tinsmith inspect' lists them" in line
    assert len(ts.read(tmp_path / "a.ply").points) == COUNT


def test_a_build_leaves_them_out_when_asked_and_reports_each(site, tmp_path):
    report = tmp_path / "report.json"
    result = run(
        *("build", site, "--crs", "EPSG:32616", "-o", tmp_path / "a.ply", "--drop-blunders"),
        *("--report", report, "--json"),
    )
    told = json.loads(report.read_text())
    assert {one["row"]: one["dropped"] for one in told["blunders"]} == {40: 1, 50: 1, 60: 1}
    assert told["left_out"] == {"looks like a blunder": [40, 50, 60]}
    assert "3 rows: 3 look like blunders\n" in result.stderr
    assert json.loads(result.stdout)["report"]["blunders"] == told["blunders"]
    points = ts.read(site, crs="EPSG:32616").points
    rest = ts.triangulate(np.delete(points, [40, 50, 60], axis=0))
    np.testing.assert_array_equal(ts.read(tmp_path / "a.ply").points, rest.points)


def test_a_clean_build_says_nothing(tmp_path):
    points = np.random.default_rng(2).random((200, 3)) * [100, 100, 1]
    ts.write(ts.Survey(points=points), tmp_path / "clean.csv")
    result = run("build", tmp_path / "clean.csv", "-o", tmp_path / "a.ply")
    assert "Blunders" not in result.stderr
    assert "none" in run("inspect", tmp_path / "clean.csv").stderr


def test_a_format_that_holds_no_table_is_refused_before_any_work(site, tmp_path):
    result = run("inspect", site, "-o", tmp_path / "a.vtu", code=1)
    assert "Table" in result.stderr
    assert not (tmp_path / "a.vtu").exists()


@pytest.mark.parametrize("suffix", ["gpkg", "fgb"])
def test_findings_are_points_of_gis(site, tmp_path, suffix):
    out = tmp_path / f"a.{suffix}"
    run("inspect", site, "--crs", "EPSG:32616", "-o", out)
    found = ts.read(out, z_field="geometry")
    points = ts.read(site, crs="EPSG:32616").points
    assert str(found.crs) == "EPSG:32616"
    np.testing.assert_array_equal(found.points, points[found.attributes["row"].astype(int)])
    assert set(found.attributes["certainty"]) <= {"high", "medium", "low"}
    assert set(found.attributes["reason"]) == {"spike", "factor", "isolated"}


def test_no_finding_is_an_empty_layer(tmp_path):
    pyogrio = pytest.importorskip("pyogrio")
    points = np.random.default_rng(2).random((200, 3)) * [100, 100, 1]
    ts.write(ts.Survey(points=points), tmp_path / "clean.csv")
    run("inspect", tmp_path / "clean.csv", "--crs", "EPSG:32616", "-o", tmp_path / "a.gpkg")
    told = pyogrio.read_info(tmp_path / "a.gpkg")
    assert (told["features"], told["geometry_type"]) == (0, "Point Z")
    assert "certainty" in told["fields"]
