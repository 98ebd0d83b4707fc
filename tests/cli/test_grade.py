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
        "--elevation-unit",
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
    ground = ts.triangulate(ts.read(SITE, crs="EPSG:32616", elevation_unit="m"))
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


def write_pad(path, crs, level):
    ring = np.column_stack([np.vstack([PAD, PAD[:1]]), np.full(5, level)])
    ts.write(
        ts.Features(kind="polygons", coordinates=ring, offsets=[[0, 5], [0, 1]], crs=crs), path
    )


@pytest.fixture
def ground_in_feet(tmp_path):
    metres = ts.triangulate(
        ts.read(SITE, crs="EPSG:32616", elevation_unit="m").points,
        crs="EPSG:32616",
        elevation_unit="m",
    )
    ts.write(ts.reproject(metres, "EPSG:2274"), tmp_path / "ground.ply")
    table = ts.volume(metres, ts.grade(metres, PAD, 327.0, cut_slope=2, fill_slope=3))
    return tmp_path / "ground.ply", table["fill"][0] / (1200 / 3937) ** 3


@pytest.mark.parametrize(
    ("crs", "options"), [("EPSG:32616+5703", ()), ("EPSG:32616", ("--lines-elevation-unit", "m"))]
)
def test_a_pad_in_metres_on_a_ground_in_feet(tmp_path, ground_in_feet, crs, options):
    ground, fill = ground_in_feet
    write_pad(tmp_path / "pad.gpkg", crs, 327.0)
    given = ("--pad", tmp_path / "pad.gpkg", *options, *SLOPES, "-o", tmp_path / "made.ply")
    done = run("grade", ground, *given, "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert told["volume"]["fill"] == pytest.approx(fill, rel=1e-3)
    assert any("converted from metre to US survey foot" in note for note in told["notes"])


def test_a_pad_that_does_not_tell_its_unit_is_no_pad_in_feet(tmp_path, ground_in_feet):
    ground, _ = ground_in_feet
    write_pad(tmp_path / "pad.gpkg", "EPSG:32616", 1072.0)
    given = ("--pad", tmp_path / "pad.gpkg", *SLOPES, "-o", tmp_path / "made.ply")
    done = run("grade", ground, *given)
    assert done.exit_code == 1, done.output
    assert "does not tell the unit of its elevations" in done.stderr
    assert not (tmp_path / "made.ply").exists()


SITE_OPTIONS = ("--crs", "EPSG:32616", "--elevation-unit", "m")


def test_a_pad_in_balance_is_told_and_written(tmp_path, pad):
    outputs = ("-o", tmp_path / "graded.ply", "-o", tmp_path / "pad.csv")
    more = ("--balance", "--shrink-factor", 0.9, "--swell-factor", 1.25, "--gradient", "0.02,0")
    done = run("grade", SITE, *SITE_OPTIONS, "--pad", pad, *more, *SLOPES, *outputs, "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)["balance"]
    ground = ts.triangulate(ts.read(SITE, crs="EPSG:32616", elevation_unit="m"))
    found = ts.balance(
        ground,
        PAD,
        cut_slope=2,
        fill_slope=3,
        gradient=(0.02, 0.0),
        shrink_factor=0.9,
        swell_factor=1.25,
    )
    for name in ("elevation", "cut", "fill", "sensitivity", "haul"):
        assert told[name] == pytest.approx(found.table[name][0], rel=1e-9), name
    assert "m³ less for each cm higher" in done.stderr
    assert "elevation (m)" in (tmp_path / "pad.csv").read_text(encoding="utf-8")
    assert len(ts.read(tmp_path / "graded.ply").points) == len(found.tin.points)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--balance", "--elevation", 327), "--elevation and --balance are both given"),
        (("--elevation", 327, "--shrink-factor", 0.9), "--shrink-factor is for --balance"),
        (("--balance", "--shrink-factor", 0), "--shrink-factor"),
        (("--elevation", 327, "--gradient", "0.9,0"), "--gradient"),
    ],
)
def test_what_cannot_be_balanced_is_refused(tmp_path, pad, options, text):
    out = tmp_path / "graded.ply"
    done = run("grade", SITE, *SITE_OPTIONS, "--pad", pad, *options, *SLOPES, "-o", out)
    assert done.exit_code == 2, done.output
    assert text in done.stderr
    assert not out.exists()


def write_fixed(path, *levels, **columns):
    """Write squares of 6 m in a row within the pad, with the levels of their corners if given."""
    corners = np.array([[0.0, 0], [6, 0], [6, 6], [0, 6], [0, 0]])
    rings = [corners + PAD[0] + [4 + 16 * k, 8] for k in range(len(levels))]
    if not all(level is None for level in levels):
        rings = [np.column_stack([r, np.full(5, z)]) for r, z in zip(rings, levels, strict=True)]
    ends, count = np.arange(len(levels) + 1), 5 * np.arange(len(levels) + 1)
    coordinates = np.concatenate(rings)
    made = ts.Features.of_polygons(coordinates, count, ends, columns=columns, crs="EPSG:32616")
    ts.write(made, path)
    return [ring[:4] for ring in rings]


def test_fixed_regions_of_a_file_are_those_of_the_library(tmp_path, pad):
    rings = write_fixed(tmp_path / "fixed.gpkg", None, None, elevation=[np.nan, 326.0])
    more = ("--fixed", tmp_path / "fixed.gpkg", "--balance", "-o", tmp_path / "graded.ply")
    done = run("grade", SITE, *SITE_OPTIONS, "--pad", pad, *SLOPES, *more, "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    ground = ts.triangulate(ts.read(SITE, crs="EPSG:32616", elevation_unit="m"))
    fixed = [rings[0], np.column_stack([rings[1], np.full(4, 326.0)])]
    found = ts.balance(ground, PAD, cut_slope=2, fill_slope=3, fixed=fixed)
    assert told["balance"]["elevation"] == pytest.approx(found.elevation, abs=1e-6)
    assert any("Fixed region 2 is held at 326" in note for note in told["notes"])
    at_level = write_fixed(tmp_path / "level.gpkg", 326.0)
    given = ("--fixed", tmp_path / "level.gpkg", "--elevation", 327, "-o", tmp_path / "one.ply")
    done = run("grade", SITE, *SITE_OPTIONS, "--pad", pad, *SLOPES, *given)
    assert done.exit_code == 0, done.output
    middle = at_level[0][:, :2].mean(axis=0)[None]
    assert ts.read(tmp_path / "one.ply").interpolate(middle)[0] == pytest.approx(326.0)


@pytest.mark.parametrize(
    ("columns", "text"),
    [
        ({"elevation": ["floor", "326"]}, "has the elevation 'floor': a number is needed"),
        ({"elevation": [326.0, 326.0], "z": [325.0, 326.0]}, "several columns that may hold"),
        ({"elevation": [300.0, 326.0]}, "too near to each other for their elevations"),
    ],
)
def test_fixed_regions_that_are_refused(tmp_path, pad, columns, text):
    write_fixed(tmp_path / "fixed.gpkg", None, None, **columns)
    out = tmp_path / "graded.ply"
    more = ("--fixed", tmp_path / "fixed.gpkg", "--elevation", 327, "-o", out)
    done = run("grade", SITE, *SITE_OPTIONS, "--pad", pad, *SLOPES, *more)
    assert done.exit_code == 1, done.output
    assert text in done.stderr
    assert not out.exists()


def test_levels_in_metres_on_a_ground_in_feet_are_not_guessed(tmp_path, ground_in_feet):
    ground, _ = ground_in_feet
    write_pad(tmp_path / "pad.gpkg", "EPSG:32616+5703", 327.0)
    write_fixed(tmp_path / "fixed.gpkg", None, elevation=[326.0])
    given = ("--pad", tmp_path / "pad.gpkg", "--fixed", tmp_path / "fixed.gpkg", *SLOPES)
    done = run("grade", ground, *given, "-o", tmp_path / "made.ply")
    assert done.exit_code == 1, done.output
    assert "does not tell the unit of its elevations" in done.stderr
    more = ("--lines-elevation-unit", "m", "-o", tmp_path / "made.ply", "--json")
    done = run("grade", ground, *given, *more)
    assert done.exit_code == 0, done.output
    notes = " ".join(json.loads(done.stdout)["notes"])
    assert f"is held at {326 * 3937 / 1200:.2f}"[:18] in notes
