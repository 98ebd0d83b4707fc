"""``tinsmith grade`` as people run it."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.commands import run

import tinsmith as ts

SITE = Path(__file__).parents[2] / "sample_data" / "site_survey.csv"
PAD = np.add([752_740.0, 4_024_290], [[0, 0], [40, 0], [40, 25], [0, 25]])
SLOPES = ("--cut-slope", 2, "--fill-slope", 3)


@pytest.fixture
def pad(tmp_path):
    path = tmp_path / "pad.geojson"
    ring = np.vstack([PAD, PAD[:1]]).tolist()
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32616"}}
    feature = {
        "type": "Feature",
        "properties": {},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    path.write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": [feature]}))
    return path


def test_a_pad_of_a_file_is_graded_as_by_the_library(tmp_path, pad):
    out = tmp_path / "graded.ply"
    done = run(
        "grade",
        SITE,
        "--crs",
        "EPSG:32616",
        "--z-unit",
        "m",
        "--pad",
        pad,
        "--elevation",
        327,
        *SLOPES,
        "-o",
        out,
        "--json",
    )
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)["volume"]
    ground = ts.triangulate(ts.read(SITE, crs="EPSG:32616", z_unit="m"))
    graded = ts.grade(ground, PAD, 327, cut_slope=2, fill_slope=3)
    expected = ts.volume(ground, graded)
    assert told["cut"] == pytest.approx(expected["cut"][0])
    assert told["fill"] == pytest.approx(expected["fill"][0])
    assert len(ts.read(out).points) == len(graded.points)


@pytest.mark.parametrize(
    ("options", "code", "text"),
    [
        (("--elevation", 327, "--cut-slope", 0, "--fill-slope", 3), 2, "2 is 2:1"),
        (("--elevation", 300, *SLOPES), 1, "does not meet the ground"),
        (("--elevation", 327, "--cut-slope", 2), 2, "--fill-slope"),
    ],
)
def test_refusals_leave_nothing_behind(tmp_path, pad, options, code, text):
    out = tmp_path / "graded.ply"
    done = run("grade", SITE, "--crs", "EPSG:32616", "--pad", pad, *options, "-o", out)
    assert done.exit_code == code, done.output
    assert text in done.output
    assert not out.exists()
