"""``tinsmith corridor`` as people run it."""

import json

import numpy as np
import pytest
from support.commands import run

import tinsmith as ts

GROUND = [[0, 0, 5], [400, 0, 5], [400, 400, 5], [0, 400, 5]]
AXIS = [[100, 200, 7], [300, 200, 7]]
TEMPLATES = """station,side,name,width,slope,use,ratio
50,both,lane,3.5,-0.02,turns,
150,both,lane,5.5,-0.02,turns,
,both,,,,cut,1
,both,,,,fill,2
"""
TURNS = [[60, -0.02, -0.02], [120, 0.05, -0.05]]


@pytest.fixture
def site(tmp_path):
    for name, points in (("ground", GROUND), ("axis", AXIS)):
        rows = [",".join(map(str, row)) for row in points]
        (tmp_path / f"{name}.csv").write_text("\n".join(["easting,northing,elevation", *rows]))
    (tmp_path / "road.csv").write_text(TEMPLATES)
    table = [dict(zip(("station", "left", "right"), row, strict=True)) for row in TURNS]
    (tmp_path / "turns.json").write_text(json.dumps(table))
    return tmp_path


def lay_out(folder, *more):
    files = [folder / f"{name}.csv" for name in ("ground", "axis", "road")]
    return run("corridor", *files, "-o", folder / "out.ply", *more)


def test_templates_and_superelevation_by_station_are_those_of_the_library(site):
    done = lay_out(site, "--superelevation", site / "turns.json")
    assert done.exit_code == 0, done.output
    lanes = [ts.Part("lane", width, -0.02, turns=True) for width in (3.5, 5.5)]
    first, last = (ts.Template(ts.Side([one], cut_slope=1, fill_slope=2)) for one in lanes)
    ground = ts.triangulate(GROUND)
    made = ts.corridor(ground, AXIS, {50: first, 150: last}, superelevation=TURNS)
    found = ts.read(site / "out.ply")
    assert len(found.points) == len(made.points)
    places = np.array([[130.0, 203.5], [190.0, 196.0], [280.0, 205.5], [280.0, 194.5]])
    wanted = [7 - 0.02 * 3.5, 7 - 0.035 * 4.0, 7 + 0.05 * 5.5, 7 - 0.05 * 5.5]
    assert found.interpolate(places) == pytest.approx(wanted, abs=0.011)


def test_a_ring_is_closed(site):
    ring = [[150, 150, 8], [250, 150, 8], [250, 250, 8], [150, 250, 8], [150, 150, 8]]
    rows = [",".join(map(str, row)) for row in ring]
    (site / "axis.csv").write_text("\n".join(["easting,northing,elevation", *rows]))
    (site / "road.csv").write_text(TEMPLATES.replace("150,both,lane,5.5,-0.02,turns,\n", ""))
    done = lay_out(site)
    assert done.exit_code == 0, done.output
    assert "was cut off where both are as near" in done.output
    found = ts.read(site / "out.ply")
    assert found.interpolate([[200, 200], [200, 150]]) == pytest.approx([5, 8], abs=1e-6)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[]", "no row"),
        ('[{"station": 1, "left": 2}]', "row 1 has the columns station, left"),
        ('[{"station": 1, "left": 4, "right": 0}]', "slope of superelevation"),
    ],
)
def test_bad_superelevation_is_refused(site, text, sentence):
    (site / "turns.json").write_text(text)
    done = lay_out(site, "--superelevation", site / "turns.json")
    assert done.exit_code in (1, 2)
    assert sentence in done.output
    assert not (site / "out.ply").exists()
