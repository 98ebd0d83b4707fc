"""``tinsmith volume`` and ``diff`` as people run them."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from support.commands import run_command as run

import tinsmith as ts

SAMPLES = Path(__file__).parents[2] / "sample_data"
SITE, PAD = SAMPLES / "site_survey.csv", SAMPLES / "design_pad.csv"
CRS = ("--crs", "EPSG:32616", "--elevation-unit", "m")
PNG = b"\x89PNG"


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A level square and a ramp, as TINs in UTM."""
    folder = tmp_path_factory.mktemp("tins")
    corners = np.array([[0, 0], [40, 0], [40, 40], [0, 40]], float)
    corners += [752_000, 4_024_000]
    return [
        ts.write(
            ts.triangulate(np.column_stack([corners, z]), crs="EPSG:32616", elevation_unit="m"),
            folder / f"{name}.ply",
        )
        for name, z in (("flat", [1, 1, 1, 1]), ("ramp", [0, 4, 4, 0]))
    ]


def test_the_pad_is_measured_drawn_and_written(tmp_path):
    names = ["pad.csv", "pad.json", "pad.gpkg", "pad.png"]
    outputs = [part for name in names for part in ("-o", tmp_path / name)]
    result = run("volume", SITE, PAD, "--codes", *CRS, *outputs, "--json")
    (row,) = json.loads(result.stdout)["rows"]
    tins = [
        ts.triangulate(ts.lines_from_codes(ts.read(path, crs="EPSG:32616", elevation_unit="m")))
        for path in (SITE, PAD)
    ]
    table = ts.volume(*tins)
    assert row["cut"] == table["cut"][0]
    assert row["fill"] == table["fill"][0]
    with (tmp_path / "pad.csv").open(encoding="utf-8", newline="") as file:
        (written,) = csv.DictReader(file)
    assert float(written["cut (m³)"]) == table["cut"][0]
    assert (tmp_path / "pad.png").read_bytes().startswith(PNG)
    pyogrio = pytest.importorskip("pyogrio")
    _, _, shapes, _ = pyogrio.raw.read(tmp_path / "pad.gpkg")
    areas = shapely.area(shapely.from_wkb(shapes))
    assert areas.sum() == pytest.approx(table["area"][0], rel=1e-6)
    assert "Cut" in result.stderr
    assert "m³ over" in result.stderr


def test_a_level_is_a_base(files):
    (row,) = json.loads(run("volume", files[1], "--base", 1, "--json").stdout)["rows"]
    assert row["cut"] == pytest.approx(40 * 4.5 * 10, rel=1e-9)
    assert row["fill"] == pytest.approx(40 * 0.5 * 10, rel=1e-9)


def test_volumes_come_by_region(files, tmp_path):
    west = [[752_000, 4_024_000], [752_010, 4_024_000], [752_010, 4_024_040], [752_000, 4_024_040]]
    east = [[752_010, 4_024_000], [752_040, 4_024_000], [752_040, 4_024_040], [752_010, 4_024_040]]
    rings = np.array([*west, west[0], *east, east[0]], float)
    regions = ts.Features.of_polygons(rings, [0, 5, 10], [0, 1, 2], crs="EPSG:32616")
    ts.write(regions, tmp_path / "regions.gpkg")
    result = run("volume", *files, "--regions", tmp_path / "regions.gpkg", "--json")
    rows = json.loads(result.stdout)["rows"]
    assert [row["cut"] for row in rows] == pytest.approx([200, 0], abs=1e-6)
    assert [row["fill"] for row in rows] == pytest.approx([0, 1800], abs=1e-6)


def test_rounding_is_no_area_without_ground(files, tmp_path):
    turns = np.linspace(0, 2 * np.pi, 11)
    circle = np.column_stack([np.cos(turns), np.sin(turns)])
    circle[-1] = circle[0]
    places = np.random.default_rng(3).uniform([752_010, 4_024_010], [752_030, 4_024_030], (8, 2))
    rings = (places[:, None] + 9.7 * circle).reshape(-1, 2)
    regions = ts.Features.of_polygons(rings, np.arange(0, 89, 11), np.arange(9), crs="EPSG:32616")
    ts.write(regions, tmp_path / "regions.gpkg")
    told = run("volume", *files, "--regions", tmp_path / "regions.gpkg").stderr
    assert told.count("m² compared\n") == 8
    assert "without ground" not in told


@pytest.mark.parametrize("column", ["name", "ID"])
def test_regions_of_a_file_have_its_names(files, tmp_path, column):
    x, y = 752_000, 4_024_000
    ring = [[x, y], [x + 10, y], [x + 10, y + 40], [x, y + 40], [x, y]]
    rings = np.array([*ring, *([a + 10, b] for a, b in ring)], float)
    named = {column: np.array(["west", "east"], object)}
    regions = ts.Features.of_polygons(rings, [0, 5, 10], [0, 1, 2], columns=named, crs="EPSG:32616")
    ts.write(regions, tmp_path / "regions.gpkg")
    result = run("volume", *files, "--regions", tmp_path / "regions.gpkg", "--json")
    assert [row["region"] for row in json.loads(result.stdout)["rows"]] == ["west", "east"]
    result = run("volume", files[1], "--stage-storage", "--level", 2, "--regions",
                 tmp_path / "regions.gpkg", "--json")  # fmt: skip
    assert json.loads(result.stdout)["rows"][0]["volume"] == pytest.approx(2 * 20 * 20 / 2 * 2)


def test_stages_are_tabulated(files):
    result = run("volume", files[1], "--stage-storage", "--interval", 2, "--json")
    rows = json.loads(result.stdout)["rows"]
    assert [row["level"] for row in rows] == [0, 2, 4]
    assert [row["volume"] for row in rows] == pytest.approx([0, 800, 3200], rel=1e-9)
    assert "reaches the boundary" in result.stderr


def test_a_summary_has_some_rows_and_counts_the_others(files):
    short = run("volume", files[1], "--stage-storage", "--interval", 1).stderr
    assert " more" not in short
    long = run("volume", files[1], "--stage-storage", "--interval", 0.25).stderr
    assert "... 5 more" in long


def test_the_difference_goes_to_files_of_every_kind(files, tmp_path):
    names = ["d.ply", "d.csv", "zones.geojson", "d.png"]
    outputs = [part for name in names for part in ("-o", tmp_path / name)]
    answer = json.loads(run("diff", *files, *outputs, "--json").stdout)
    assert answer["statistics"]["mean"] == pytest.approx(1, rel=1e-9)
    assert answer["fill"] == pytest.approx(1800, rel=1e-9)
    tin = ts.read(tmp_path / "d.ply")
    assert (tin.points[:, 2].min(), tin.points[:, 2].max()) == (-1.0, 3.0)
    found = json.loads((tmp_path / "zones.geojson").read_text(encoding="utf-8"))
    assert {one["properties"]["kind"] for one in found["features"]} == {"cut", "fill"}
    assert (tmp_path / "d.png").read_bytes().startswith(PNG)


def test_the_longest_edge_is_for_each_of_two_files_of_points(tmp_path):
    """An L of 7,500 square units, whose bay a surface of all points would span."""
    x, y = np.meshgrid(np.arange(0.0, 101.0, 10.0), np.arange(0.0, 101.0, 10.0))
    inside = ~((x > 50) & (y > 50))
    for name, z in (("low.xyz", 10.0), ("high.xyz", 11.0)):
        np.savetxt(
            tmp_path / name, np.column_stack([x[inside], y[inside], np.full(inside.sum(), z)])
        )
    names = [tmp_path / "low.xyz", tmp_path / "high.xyz"]
    assert "Fill        8,750.00" in run("volume", *names).stderr
    # A half of the cell in the corner is left: its edges are no longer than others.
    assert "Fill        7,550.00" in run("volume", *names, "--max-edge", "16").stderr
    tins = []
    for name in names:
        run("build", name, "-o", name.with_suffix(".ply"))
        tins.append(name.with_suffix(".ply"))
    refused = run("volume", *tins, "--max-edge", "16", code=1)
    assert "--max-edge needs a file of points" in refused.stderr


def test_the_zero_line_is_written_in_place_of_zones(files, tmp_path):
    run("diff", *files, "--zero-line", "-o", tmp_path / "line.geojson")
    (feature,) = json.loads((tmp_path / "line.geojson").read_text(encoding="utf-8"))["features"]
    assert feature["geometry"]["type"] == "LineString"


@pytest.mark.parametrize(
    ("arguments", "code", "part"),
    [
        (["volume", "flat"], 2, "One of these is needed"),
        (["volume", "flat", "ramp", "--base", 3], 2, "One of these is needed"),
        (["volume", "flat", "ramp", "flat"], 2, "3 files are given"),
        (["volume", "flat", "--base", 3, "--interval", 1], 2, "are for --stage-storage"),
        (["volume", "flat", "--stage-storage", "--interval", 0], 2, "Invalid --interval 0"),
        (["volume", "ramp", "--stage-storage", "--interval", 1e-9], 2, "at most 100,000"),
        (["volume", "flat", "--stage-storage", "--level", 1, "--interval", 1], 2, "choose one"),
        (["volume", "flat", "ramp", "-o", "x.ply"], 1, "not a Table"),
        (["volume", "flat", "ramp", "--codes"], 1, "--codes needs a file of points"),
        (["diff", "flat", "ramp", "-o", "flat"], 2, "input"),
    ],
)
def test_what_cannot_be_is_refused(files, tmp_path, monkeypatch, arguments, code, part):
    monkeypatch.chdir(tmp_path)
    named = {"flat": files[0], "ramp": files[1]}
    result = run(*(named.get(one, one) for one in arguments), code=code)
    assert part in " ".join(result.stderr.split())
    assert not list(tmp_path.iterdir())


# ----------------------------------------------------------------- standard errors


def test_standard_errors_and_a_level_are_told_and_written(files, tmp_path):
    given = ["--standard-error", "0.3", "--other-standard-error", "0.4", "--confidence", "0.95"]
    more = ["--systematic", "0.1", "--correlation-range", "20", "--correlation", "spherical"]
    outputs = ["-o", tmp_path / "change.csv", "-o", tmp_path / "change.gpkg"]
    result = run("volume", *files, *given, *more, *outputs, "--json")
    (row,) = json.loads(result.stdout)["rows"]
    how = {"correlation_range": 20.0, "correlation": "spherical"}
    table = ts.volume(
        *map(ts.read_tin, files),
        standard_error=ts.ErrorModel(0.3, systematic=0.1, **how),
        other_standard_error=ts.ErrorModel(0.4, **how),
        confidence=0.95,
    )
    for name in ("net_error", "cut_error", "thresholded_cut", "level_of_detection"):
        assert row[name] == table[name][0], name
    assert "±" in result.stderr
    assert "where the difference exceeds 0.9994 m" in result.stderr
    with (tmp_path / "change.csv").open(encoding="utf-8", newline="") as file:
        (written,) = csv.DictReader(file)
    assert float(written["net_error (m³)"]) == table["net_error"][0]
    pyogrio = pytest.importorskip("pyogrio")
    _, _, _, (kinds, *_) = pyogrio.raw.read(tmp_path / "change.gpkg")
    assert sorted(kinds) == ["cut", "fill", "unchanged"]


def test_the_column_of_a_survey_is_the_standard_error(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text("x,y,z,sz\n0,0,5,0.1\n6,0,5,0.1\n6,4,5,0.2\n0,4,5,0.2\n", encoding="utf-8")
    result = run("volume", path, "--base", "4", "--standard-error", "sz", "--json")
    (row,) = json.loads(result.stdout)["rows"]
    survey = ts.triangulate(ts.read(path))
    assert row["cut_error"] == ts.volume(survey, base=4.0, standard_error="sz")["cut_error"][0]
    wrong = run("volume", path, "--base", "4", "--standard-error", "sigma", code=2)
    assert "'sigma'" in wrong.stderr


def test_a_difference_up_to_the_level_of_detection_is_unchanged(files, tmp_path):
    found = tmp_path / "zones.gpkg"
    result = run("diff", *files, "--level-of-detection", "0.5", "-o", found, "--json")
    record = json.loads(result.stdout)
    # The ramp rises by 0.1 a metre from -1: beyond 0.5 up to 5 m and from 15 m on.
    assert record["volumes"]["thresholded_cut_area"] == pytest.approx(5 * 40, rel=1e-9)
    assert record["volumes"]["thresholded_fill_area"] == pytest.approx(25 * 40, rel=1e-9)
    assert "by more than 0.5 m" in result.stderr


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (["--correlation-range", "20"], "--correlation-range needs a --standard-error"),
        (["--confidence", "0.95"], "--standard-error"),
        (["--standard-error=-1"], "Invalid --standard-error -1"),
        (["--level-of-detection", "0"], "Invalid --level-of-detection 0"),
    ],
)
def test_wrong_errors_are_refused_in_the_words_of_the_command(files, given, sentence):
    assert sentence in run("volume", *files, *given, code=2).stderr


def test_a_stage_storage_table_has_no_errors(files):
    given = ["--stage-storage", "--interval", "1", "--standard-error", "0.1"]
    refused = run("volume", files[0], *given, code=2).stderr
    assert "--standard-error is not for --stage-storage" in refused
