"""``tinsmith build`` of a TIN and further points: both stay."""

import json

import numpy as np
import pytest
from support.commands import run_command as run

import tinsmith as ts

CORNER = np.array([752_000.0, 4_024_000.0])


@pytest.fixture
def files(tmp_path):
    rng = np.random.default_rng(3)
    made = {}
    for name, count, first in (("site", 100, 1), ("extra", 20, 501), ("more", 10, 701)):
        xy = np.round(rng.random((count, 2)) * 100 + CORNER, 3)
        rows = [f"{first + i},{x:.3f},{y:.3f},{320 + x % 7:.2f},GR" for i, (x, y) in enumerate(xy)]
        made[name] = tmp_path / f"{name}.csv"
        made[name].write_text("\n".join(["number,easting,northing,elevation,code", *rows]))
    kerb = ts.Breakline([[*(CORNER + 10), 321.0], [*(CORNER + 80), 322.0]], name="kerb")
    made["tin"] = tmp_path / "site.gpkg"
    survey = ts.read(made["site"], crs="EPSG:32616", elevation_unit="m")
    ts.write(ts.triangulate(survey, breaklines=[kerb]), made["tin"])
    return made


KNOWN = ("--crs", "EPSG:32616", "--elevation-unit", "m")


def test_points_and_lines_of_both_stay(files, tmp_path):
    out = tmp_path / "new.gpkg"
    done = run("build", files["tin"], files["extra"], files["more"], *KNOWN, "-o", out, "--json")
    made = ts.read(out)
    assert ts.check(made).ok
    surveys = [ts.read(files[name], crs="EPSG:32616") for name in ("site", "extra", "more")]
    kerb = ts.read(files["tin"]).lines
    points = np.concatenate([one.points for one in surveys])
    assert {tuple(row) for row in points.tolist()} <= {tuple(row) for row in made.points.tolist()}
    assert made.lines.names == kerb.names == ("kerb",)
    numbers = made.attributes["number"][made.vertex_of]
    assert [int(number) for number in numbers] == [
        *range(1, 101),
        *range(501, 521),
        *range(701, 711),
    ]
    assert json.loads(done.stdout)["tin"]["vertices"] == len(made.points)
    assert "Inserted    30 points from" in done.stderr


@pytest.mark.parametrize(
    ("flags", "code", "words"),
    [
        (["--max-edge", 3], 1, "holds a TIN already, and --max-edge needs points"),
        (["--conforming"], 1, "--conforming needs points"),
        (["--drop-blunders"], 2, "--drop-blunders is for points"),
    ],
)
def test_options_of_a_build_of_points_are_refused(files, tmp_path, flags, code, words):
    out = tmp_path / "new.gpkg"
    done = run("build", files["tin"], files["extra"], *KNOWN, *flags, "-o", out, code=code)
    assert words in " ".join(done.stderr.split())
    assert not out.exists()


def test_a_tin_behind_the_points_is_refused(files, tmp_path):
    out = tmp_path / "new.gpkg"
    done = run("build", files["extra"], files["tin"], *KNOWN, "-o", out, code=1)
    assert "holds a TIN" in done.stderr
