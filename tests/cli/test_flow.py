"""``tinsmith flow``: what it finds, and what it refuses."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from support.commands import run

import tinsmith as ts


@pytest.fixture
def site(tmp_path):
    corners = [[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3]]
    bowl = [*corners, [3, 0, 2], [3, 3, 0], [6, 3, 3], [3, 6, 3], [0, 3, 3]]
    path = tmp_path / "site.ply"
    ts.write(ts.triangulate(np.array(bowl, float), crs="EPSG:32616", elevation_unit="m"), path)
    return path


def test_what_is_found_is_what_the_library_finds(site, tmp_path):
    tin = ts.read(site)
    cases = {
        "depressions": ([], ts.depressions(tin)),
        "pits": ([], ts.pits(tin)),
        "ponds": (["--level", "1.5"], ts.ponds(tin, 1.5)),
        "ridges": (["--min-angle", "10"], ts.ridges_and_valleys(tin, min_angle=10)),
        "accumulation": (["--min-area", "1"], ts.flow_accumulation(tin, min_area=1)),
        "catchments": ([], ts.catchments(tin)),
        "paths": (["--from", "1", "2", "--from", "5", "5"], ts.flow_path(tin, [[1, 2], [5, 5]])),
        "full paths": (
            ["--find", "paths", "--from", "1", "2", "--fill-depressions"],
            ts.flow_path(tin, [[1, 2]], fill_depressions=True),
        ),
        "full catchments": (
            ["--find", "catchments", "--fill-depressions"],
            ts.catchments(tin, fill_depressions=True),
        ),
        "full accumulation": (
            ["--find", "accumulation", "--fill-depressions"],
            ts.flow_accumulation(tin, fill_depressions=True),
        ),
    }
    for find, (options, wanted) in cases.items():
        out = tmp_path / f"{find}.json"
        chosen = options if "--find" in options else ["--find", find, *options]
        done = run("flow", site, *chosen, "-o", out, "--json")
        assert done.exit_code == 0, done.stderr
        told = json.loads(done.stdout)
        for name, column in wanted.columns.items():
            assert [row[name] for row in told["found"]] == column.tolist()


def test_numbers_of_vertices_are_whole(site, tmp_path):
    done = run("flow", site, "--find", "accumulation", "-o", tmp_path / "a.json")
    assert done.exit_code == 0, done.stderr
    ends = re.findall(r"end (\S+?),", done.output)
    assert ends
    assert all(one.isdecimal() for one in ends)


def test_outlets_are_places_or_those_of_a_file(site, tmp_path):
    ts.write(ts.Features.of_points([[1, 2]], crs="EPSG:32616"), tmp_path / "outlet.geojson")
    wanted = ts.catchments(ts.read(site), [[1, 2]]).columns["area"].tolist()
    for given in (["--from", "1", "2"], ["--points", tmp_path / "outlet.geojson"]):
        out = tmp_path / f"catchments{given[0]}.json"
        done = run("flow", site, "--find", "catchments", *given, "-o", out, "--json")
        assert done.exit_code == 0, done.stderr
        assert [row["area"] for row in json.loads(done.stdout)["found"]] == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--find", "paths"], "Where drops fall is needed"),
        (["--find", "ponds"], "A level is needed"),
        (["--level", "3"], "--level is for --find ponds, not depressions"),
        (["--find", "pits", "--nested"], "--nested is for --find depressions, not pits"),
        (["--min-area", "2"], "--min-area is for --find accumulation, not depressions"),
        (["--min-depth", "-1"], "min"),
        (["--fill-depressions"], "--fill-depressions is for --find paths, not depressions"),
    ],
)
def test_wrong_usage_exits_2(site, tmp_path, options, sentence):
    done = run("flow", site, *options, "-o", tmp_path / "a.geojson")
    assert done.exit_code == 2
    assert sentence in done.stderr
    assert not (tmp_path / "a.geojson").exists()


def test_a_place_outside_exits_1(site, tmp_path):
    done = run("flow", site, "--find", "paths", "--from", "99", "9", "-o", tmp_path / "a.geojson")
    assert done.exit_code == 1
    assert "outside the surface" in done.stderr
