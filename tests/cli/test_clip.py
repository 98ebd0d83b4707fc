"""``tinsmith clip`` as people run it."""

import json

import numpy as np
import pytest
from support.commands import run_command as run

import tinsmith as ts

CORNER = np.array([752_000.0, 4_024_000.0, 0.0])
SQUARE = np.array([[0.0, 0, 1], [40, 0, 2], [40, 40, 1], [0, 40, 5]]) + CORNER
RING = np.array([[10.0, 10], [30, 12], [25, 33], [10, 10]]) + CORNER[:2]


@pytest.fixture
def files(tmp_path):
    tin = ts.triangulate(SQUARE, crs="EPSG:32616", elevation_unit="m")
    polygons = ts.Features.of_polygons(RING, [0, 4], [0, 1], crs="EPSG:32616")
    return {
        "tin": tin,
        "site": ts.write(tin, tmp_path / "site.gpkg"),
        "by": ts.write(polygons, tmp_path / "parcels.gpkg"),
        "out": tmp_path / "part.gpkg",
    }


@pytest.mark.parametrize("keep", ["inside", "outside"])
def test_the_part_is_that_of_the_library(files, keep):
    flags = ["--outside"] if keep == "outside" else []
    done = run("clip", files["site"], "--by", files["by"], *flags, "-o", files["out"], "--json")
    wanted = ts.clip(files["tin"], [RING], keep=keep)
    assert ts.read(files["out"]) == wanted
    told = json.loads(done.stdout)
    assert told["tin"]["triangles"] == len(wanted.triangles)
    assert wanted.report.notes[0] in told["notes"]


def test_what_lies_beside_is_refused(files, tmp_path):
    beside = ts.Features.of_polygons(RING + 99, [0, 4], [0, 1], crs="EPSG:32616")
    by = ts.write(beside, tmp_path / "beside.gpkg")
    done = run("clip", files["site"], "--by", by, "-o", files["out"], code=1)
    assert "lie outside the surface" in done.stderr
    assert not files["out"].exists()


def test_the_help_says_what_a_boundary_does_instead():
    done = run("clip", "--help")
    assert "--boundary" in done.stdout
    assert "triangulates the others anew" in " ".join(done.stdout.split())


def test_polygons_are_needed(files):
    done = run("clip", files["site"], "-o", files["out"], code=2)
    assert "--by" in done.stderr
