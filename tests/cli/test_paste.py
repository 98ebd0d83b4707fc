"""``tinsmith paste`` as people run it."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.commands import run_command as run

import tinsmith as ts

SAMPLES = Path(__file__).parents[2] / "sample_data"
SITE, PAD = SAMPLES / "site_survey.csv", SAMPLES / "design_pad.csv"
CORNER = np.array([752_000.0, 4_024_000.0, 0.0])
SQUARE = np.array([[0.0, 0, 1], [40, 0, 1], [40, 40, 1], [0, 40, 1]]) + CORNER
INNER = (SQUARE - CORNER) * (0.5, 0.5, 1) + CORNER + (10, 10, 2)


@pytest.fixture
def square(tmp_path):
    return write_tin(tmp_path / "square.ply", SQUARE, crs="EPSG:32616", elevation_unit="m")


def write_tin(path, points, **known):
    return ts.write(ts.triangulate(points, **known), path)


def test_points_are_pasted_as_by_the_library(tmp_path):
    out = tmp_path / "pasted.gpkg"
    known = ("--codes", "--crs", "EPSG:32616", "--elevation-unit", "m")
    done = run("paste", SITE, PAD, *known, "-o", out, "--json")
    base, patch = (
        ts.triangulate(ts.lines_from_codes(ts.read(path, crs="EPSG:32616", elevation_unit="m")))
        for path in (SITE, PAD)
    )
    pasted = ts.paste(base, patch)
    assert ts.read(out) == pasted
    told = json.loads(done.stdout)
    assert told["inputs"] == [str(SITE), str(PAD)]
    assert told["tin"]["triangles"] == len(pasted.triangles)
    assert told["report"]["notes"] == list(pasted.report.notes)
    for note in pasted.report.notes:
        told_note = note.replace("max_edge=", "--max-edge ").replace("trim=", "--trim ")
        assert told_note in " ".join(done.stderr.split())


def test_units_are_converted_and_events_told(tmp_path, square):
    feet = INNER * (1, 1, 1 / 0.3048)
    patch = write_tin(tmp_path / "patch.ply", feet, crs="EPSG:32616", elevation_unit="ft")
    out = tmp_path / "pasted.ply"
    done = run("paste", square, patch, "-o", out, "--events")
    events = [json.loads(line) for line in done.stderr.splitlines()]
    assert any("converted from foot" in one.get("text", "") for one in events)
    assert {"event": "step", "text": "Pasting", "fraction": None} in events
    made = ts.read(out)
    assert made.elevation_unit.symbol == "m"
    assert made.interpolate(CORNER[None, :2] + 20) == pytest.approx([3.0])


def test_a_patch_that_reaches_beyond_is_told(tmp_path, square):
    moved = np.add(INNER, [25, 0, 0])
    patch = write_tin(tmp_path / "patch.ply", moved, crs="EPSG:32616", elevation_unit="m")
    out = tmp_path / "pasted.ply"
    done = run("paste", square, patch, "-o", out)
    assert "reaches beyond the base, which becomes larger by" in " ".join(done.output.split())
    assert ts.read(out).bounds.xmax == moved[:, 0].max()


@pytest.mark.parametrize(
    ("points", "known", "text"),
    [
        (INNER, {"crs": "EPSG:32617", "elevation_unit": "m"}, "EPSG:32617"),
        (INNER, {}, "the CRS of the patch is not known"),
    ],
)
def test_refusals_leave_nothing_behind(tmp_path, square, points, known, text):
    patch = write_tin(tmp_path / "patch.ply", points, **known)
    out = tmp_path / "pasted.ply"
    done = run("paste", square, patch, "-o", out, code=1)
    assert text in " ".join(done.output.split())
    assert not out.exists()


@pytest.mark.parametrize(
    ("patch", "text"), [((), "Missing argument 'PATCH'"), (("none.ply",), "none.ply")]
)
def test_both_surfaces_are_needed(tmp_path, square, patch, text):
    done = run("paste", square, *patch, "-o", tmp_path / "pasted.ply", code=2 - len(patch))
    assert text in done.output
