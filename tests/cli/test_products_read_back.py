"""Products are read back by the commands that take them: every format by every command."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from support.commands import run

import tinsmith as ts

CRS = "EPSG:32616"
FOOT = 0.3048
LINE_FORMATS = (".geojson", ".geojsonl", ".gpkg", ".fgb", ".shp", ".parquet", ".xml", ".dxf")
pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")


@pytest.fixture(scope="module")
def points():
    rng = np.random.default_rng(18)
    inside = np.column_stack([752_700 + 180 * rng.random(40), 4_024_240 + 140 * rng.random(40)])
    corners = [
        [752_690, 4_024_230],
        [752_890, 4_024_230],
        [752_690, 4_024_390],
        [752_890, 4_024_390],
    ]
    places = np.vstack([inside, corners]).round(2)
    return np.column_stack([places, (320 + 6 * np.sin(places[:, 0] / 60)).round(3)])


def make(points, unit):
    """Return the same ground with elevations in a unit."""
    z = points[:, 2:] / (FOOT if unit == "ft" else 1.0)
    return ts.triangulate(np.column_stack([points[:, :2], z]), crs=CRS, elevation_unit=unit)


@pytest.mark.each_value
@pytest.mark.parametrize("unit", ["m", "ft"])
@pytest.mark.parametrize("suffix", LINE_FORMATS)
@pytest.mark.parametrize("command", ["--from-contours", "--breaklines"])
def test_contours_are_read_back(points, tmp_path, unit, suffix, command):
    tin = make(points, unit)
    interval = 1.0 if unit == "m" else 5.0
    lines = ts.contours(tin, interval=interval)
    file = tmp_path / f"c{suffix}"
    ts.write(lines, file)
    declared = ["--elevation-unit", unit] if suffix == ".shp" else []  # which has no place for it
    if command == "--from-contours":
        crs = ["--crs", CRS] if "json" in suffix else []
        arguments = ["--from-contours", file, *crs, *declared]
    else:
        ts.write(ts.Survey(points=tin.points, crs=CRS, elevation_unit=unit), tmp_path / "p.gpkg")
        declared = ["--lines-elevation-unit", unit] if suffix == ".shp" else []
        arguments = [tmp_path / "p.gpkg", "--breaklines", file, *declared]
    out = run("build", *arguments, "-o", tmp_path / "o.ply", "-q")
    assert out.exit_code == 0, out.output
    found = ts.read(tmp_path / "o.ply")
    metres = 1.0 if str(found.elevation_unit) == "metre" else FOOT
    assert found.elevation_unit is not None
    assert str(found.elevation_unit) in ("metre", "foot")
    levels = np.unique(lines.columns["elevation"]) * (1.0 if unit == "m" else FOOT)
    heights = found.points[:, 2] * metres
    for level in levels:
        assert (np.abs(heights - level) < 2e-3).sum() >= 2, level
    ground = points[:, 2]
    assert heights.min() > ground.min() - 0.5
    assert heights.max() < ground.max() + 0.5


COMMANDS = {
    "contours": ["--interval", "1"],
    "contours --bands": ["--interval", "1", "--bands"],
    "contours --labels": ["--interval", "1", "--labels"],
    "slope": [],
    "slope --aspect": ["--aspect"],
    "flow --find pits": ["--find", "pits"],
}


@pytest.fixture(scope="module")
def site(points, tmp_path_factory):
    file = tmp_path_factory.mktemp("site") / "site.ply"
    ts.write(make(points, "m"), file)
    return file


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".txt", ".json"])
@pytest.mark.parametrize("command", COMMANDS)
def test_features_are_written_to_tables(site, tmp_path, command, suffix):
    table, layer = tmp_path / f"t{suffix}", tmp_path / "t.gpkg"
    verb = command.split()[0]
    out = run(verb, site, *COMMANDS[command], "-o", table, "-o", layer, "--json")
    assert out.exit_code == 0, out.output
    import geopandas

    expected = geopandas.read_file(layer)
    rows = read_table(table)
    assert len(rows) == len(expected)
    names = {name.split(" (")[0] for name in rows[0]} if rows else set()
    assert {*expected.columns} - {"geometry", "fid"} <= names or not rows
    if command == "contours":
        name = next(one for one in rows[0] if one.startswith("elevation"))
        assert [float(row[name]) for row in rows] == expected["elevation"].tolist()
    if command.startswith("contours") and "labels" not in command:
        assert "not their geometries" in " ".join(json.loads(out.stdout)["notes"])


def read_table(file):
    if file.suffix == ".json":
        return json.loads(file.read_text())["rows"]
    delimiter = "\t" if file.suffix == ".tsv" else ","
    with file.open(newline="") as stream:
        return list(csv.DictReader(stream, delimiter=delimiter))


def test_draped_lines_are_written_to_tables(site, tmp_path):
    lines = ts.Features.of_lines(
        [[752_700, 4_024_250], [752_860, 4_024_370]], [0, 2], columns={"name": ["a"]}, crs=CRS
    )
    ts.write(lines, tmp_path / "line.gpkg")
    run("drape", site, tmp_path / "line.gpkg", "-o", tmp_path / "d.csv", "-q")
    assert [row["name"] for row in read_table(tmp_path / "d.csv")] == ["a"]


@pytest.mark.parametrize("name", ["x.city.json", "x.cityjson", "x.ply", "x.tif"])
@pytest.mark.parametrize("verb", ["slope", "contours"])
def test_formats_of_other_things_are_refused_before_work(site, tmp_path, verb, name):
    options = ["--interval", "1"] if verb == "contours" else []
    out = run(verb, site, *options, "-o", tmp_path / name)
    assert out.exit_code != 0
    assert not Path(tmp_path, name).exists()
    assert "Triangulat" not in out.output
    assert "Cannot write" in out.output or "No format" in out.output, out.output


def test_a_level_that_differs_from_its_geometry_by_more_than_the_unit_is_refused(points, tmp_path):
    file = tmp_path / "c.geojson"
    ts.write(ts.contours(make(points, "ft"), interval=5.0), file)
    content = json.loads(file.read_text())
    content["features"][0]["properties"]["elevation"] += 1.0
    file.write_text(json.dumps(content))
    out = run("build", "--from-contours", file, "--crs", CRS, "-o", tmp_path / "o.ply")
    assert out.exit_code == 1
    assert "two elevations for each point that differ" in out.output
