"""What is found out about an input arrives at every command: for people and as JSON."""

import json
import re
import shutil

import pytest
from support.commands import run_command

from tinsmith.cli.command_list import SUMMARIES

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = pytest.mark.every_case

RING = [[700_030, 4_000_030], [700_060, 4_000_030], [700_060, 4_000_060], [700_030, 4_000_060]]
CRS = ("--crs", "EPSG:32616", "--elevation-unit", "m", "--skip-bad")
SLOPES = ("--cut-slope", 2, "--fill-slope", 2)

COMMANDS = {
    "build": ["-o", "out.gpkg"],
    "check": [],
    "clip": ["--by", "ring.geojson", "-o", "out.ply"],
    "compare": ["--sample", 50],
    "contours": ["--interval", 1, "-o", "out.gpkg"],
    "convert": ["-o", "out.xyz"],
    "coregister": ["clean.csv", "-o", "out.ply"],
    "corridor": ["road.geojson", "template.csv", "-o", "out.ply"],
    "diff": ["flat.csv", "-o", "out.ply"],
    "drape": ["ring.geojson", "-o", "out.gpkg"],
    "edit": ["edits.json", "-o", "out.ply"],
    "flow": ["--find", "pits", "-o", "out.gpkg"],
    "grade": ["--pad", "ring.geojson", "--elevation", 322, *SLOPES, "-o", "out.ply"],
    "ground": ["--any-return", "-o", "out.csv"],
    "hillshade": ["--spacing", 5, "-o", "out.tif"],
    "hydroflatten": [
        *("--stream", "stream.geojson", "--downstream", "along", "--spacing", 5, "-o", "out.ply")
    ],
    "info": [],
    "inspect": ["-o", "out.csv"],
    "interpolate": ["--at", "places.csv", "-o", "out.csv"],
    "merge": ["flat.csv", "-o", "out.ply"],
    "paste": ["flat.csv", "-o", "out.ply"],
    "plan": ["-o", "out.pdf"],
    "profile": ["--from", 700_003, 4_000_003, "--to", 700_090, 4_000_080, "-o", "out.csv"],
    "raster": ["--spacing", 5, "-o", "out.tif"],
    "refine": ["-o", "out.ply"],
    "sections": [
        *("flat.csv", "--line", "axis.geojson", "--interval", 20, "--width", 9, "-o", "out.csv")
    ],
    "sight": ["--from", 700_040, 4_000_041, "--eye-height", 2, "-o", "out.gpkg"],
    "simplify": ["--tolerance", 0.1, "-o", "out.ply"],
    "slope": ["-o", "out.gpkg"],
    "stakeout": ["--at", "places.csv", "-o", "out.csv"],
    "view": ["-o", "out.html"],
    "volume": ["--base", 318, "-o", "out.csv"],
}
"""Arguments behind a file of points, of every command that reads one."""

NO_INPUT = {"formats", "completion", "alignment", "riverbed"}  # which takes sections
POINTS_ALONE = {"compare", "convert", "ground", "info"}
"""Commands that make no surface, or none of all points: they know what the reader found."""


TEMPLATE = "side,name,width,slope,use,ratio\nboth,lane,3,-0.02,,\nboth,,,,cut,1\nboth,,,,fill,1\n"


def write_hill(folder):
    """Write a hill of which one row is bad and one elevation is 0; return the file."""
    rows = ["number,easting,northing,elevation"]
    for i in range(400):
        x, y = divmod(i, 20)
        z = 0.0 if i == 213 else 320 + 0.05 * x * (20 - x) + 0.1 * y
        rows.append(f"{1000 + i},{700_000 + 5 * x},{4_000_000 + 5 * y},{z:.3f}")
    (folder / "clean.csv").write_text("\n".join(rows))
    path = folder / "hill.csv"
    path.write_text("\n".join([*rows, "1400,700003,4000003,320..5"]))
    return path


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Return the surface of the hill, in a file."""
    folder = tmp_path_factory.mktemp("built")
    run_command("build", write_hill(folder), *CRS, "-o", folder / "hill.gpkg")
    return folder / "hill.gpkg"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a folder with the hill, and what commands take beside it."""
    monkeypatch.chdir(tmp_path)
    write_hill(tmp_path)
    flat = [f"{700_001 + 5 * x},{4_000_001 + 5 * y},321" for x in range(10) for y in range(10)]
    (tmp_path / "flat.csv").write_text("\n".join(["easting,northing,elevation", *flat]))
    (tmp_path / "places.csv").write_text("easting,northing\n700040,4000041\n")
    polygon = {"type": "Polygon", "coordinates": [[*RING, RING[0]]]}
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32616"}}
    feature = {"type": "Feature", "properties": {}, "geometry": polygon}
    collection = {"type": "FeatureCollection", "crs": crs, "features": [feature]}
    (tmp_path / "ring.geojson").write_text(json.dumps(collection))
    axis = {"type": "LineString", "coordinates": [[700_005, 4_000_005], [700_040, 4_000_040]]}
    collection["features"] = [feature | {"geometry": axis}]
    (tmp_path / "axis.geojson").write_text(json.dumps(collection))
    road = {
        "type": "LineString",
        "coordinates": [[700_020, 4_000_020, 322], [700_030, 4_000_020, 322]],
    }
    collection["features"] = [feature | {"geometry": road}]
    (tmp_path / "road.geojson").write_text(json.dumps(collection))
    stream = [
        [700_005, 4_000_050],
        [700_090, 4_000_050],
        [700_090, 4_000_060],
        [700_005, 4_000_060],
    ]
    polygon = {"type": "Polygon", "coordinates": [[*stream, stream[0]]]}
    collection["features"] = [feature | {"geometry": polygon}]
    (tmp_path / "stream.geojson").write_text(json.dumps(collection))
    (tmp_path / "template.csv").write_text(TEMPLATE)
    edits = [{"op": "insert", "points": [[700_004, 4_000_004, 321]]}]
    (tmp_path / "edits.json").write_text(json.dumps(edits))
    return tmp_path


def list_needed(command):
    """Return what must be told of the hill."""
    bad_row = re.compile("1 bad row")
    return [bad_row] if command in POINTS_ALONE else [bad_row, re.compile("looks like a blunder")]


def test_every_command_is_listed():
    assert set(COMMANDS) | NO_INPUT == set(SUMMARIES)


@pytest.mark.parametrize("command", COMMANDS)
def test_people_are_told(command, folder):
    done = run_command(command, "hill.csv", *COMMANDS[command], *CRS)
    told = " ".join((done.stdout + done.stderr).split())
    assert [one.pattern for one in list_needed(command) if not one.search(told)] == []


@pytest.mark.parametrize("command", COMMANDS)
def test_programs_are_told(command, folder):
    done = run_command(command, "hill.csv", *COMMANDS[command], *CRS, "--json")
    notes = " ".join(map(str, json.loads(done.stdout)["notes"]))
    assert [one.pattern for one in list_needed(command) if not one.search(notes)] == []


@pytest.mark.parametrize("command", sorted({*COMMANDS} - POINTS_ALONE - {"build", "inspect"}))
def test_what_a_build_found_is_told_of_its_file(command, folder, built):
    shutil.copy(built, "hill.gpkg")
    done = run_command(command, "hill.gpkg", *COMMANDS[command], "--json", *take_crs(command))
    notes = " ".join(map(str, json.loads(done.stdout)["notes"]))
    assert [one.pattern for one in list_needed(command) if not one.search(notes)] == []


def take_crs(command):
    """Return the reference of a second file, where there is one."""
    return CRS[:4] if {"flat.csv", "clean.csv"} & {*COMMANDS[command]} else []
