"""Lines on the command line: options that mirror triangulate, summaries that count, sentences."""

import inspect
import json
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import shapely
from support.commands import run_command as run

import tinsmith as ts
from tinsmith.base.policies import TrimPolicy
from tinsmith.cli.options import Triangulating

pyogrio = pytest.importorskip("pyogrio")

SURVEY = Path(__file__).parents[2] / "sample_data" / "site_survey.csv"
UTM = "EPSG:32616"
SIDE = np.arange(0.0, 101.0, 10.0)
CORNER = np.array([752_640.0, 4_024_180.0])


def facts(*arguments):
    return json.loads(run(*arguments, "--json", "-q").stdout)


def write(path, *shapes, **columns):
    pyogrio.raw.write(
        str(path),
        geometry=shapely.to_wkb(np.array(shapes, object)),
        field_data=[np.array(values) for values in columns.values()],
        fields=list(columns),
        geometry_type="Unknown",
        crs=UTM,
        driver="GPKG",
    )
    return path


def at(*place):
    return CORNER + np.array(place)


def line(*corners):
    return shapely.LineString([(*(CORNER + corner[:2]), *corner[2:]) for corner in corners])


def box(x0, y0, x1, y1):
    return shapely.box(*at(x0, y0), *at(x1, y1))


@pytest.fixture
def points(tmp_path):
    x, y = (part.ravel() for part in np.meshgrid(SIDE, SIDE))
    rows = [f"{752_640 + a},{4_024_180 + b},{300 + a / 100}" for a, b in zip(x, y, strict=True)]
    path = tmp_path / "points.csv"
    path.write_text("easting,northing,elevation\n" + "\n".join(rows) + "\n")
    return path


@pytest.fixture
def files(tmp_path):
    """One file of each kind, over a field of 11 by 11 points, 10 m apart."""
    return {
        "breaklines": write(
            tmp_path / "hard.gpkg", line((5, 5, 301.0), (95, 5, 301.0)), name=["kerb"]
        ),
        "soft-breaklines": write(tmp_path / "soft.gpkg", line((5, 15), (95, 15))),
        "boundary": write(tmp_path / "site.gpkg", box(-1, -1, 101, 85)),
        "holes": write(tmp_path / "holes.gpkg", box(22, 22, 38, 38)),
        "erase": write(tmp_path / "cars.gpkg", box(62, 22, 78, 38)),
        "water": write(tmp_path / "ponds.gpkg", box(42, 62, 58, 78), level=[299.0]),
    }


def test_every_option_of_triangulate_has_its_own():
    others = {"points", "crs", "elevation_unit", "progress"}
    of_python = set(inspect.signature(ts.triangulate).parameters) - others
    of_command = set(Triangulating.__dataclass_fields__)
    assert of_python <= of_command
    assert of_command - of_python == {
        "soft_breaklines",
        "water_z",
        "lines_elevation_unit",
        "drape",
        "codes",
        "code_table",
        "code_style",
        "arc_tolerance",
        "shot_order",
    }
    defaults = {
        name: inspect.signature(ts.triangulate).parameters[name].default
        for name in Triangulating().method
    }
    assert Triangulating().method == defaults


def test_all_lines_at_once_are_counted_and_held(points, files, tmp_path):
    options = [part for name, path in files.items() for part in (f"--{name}", path)]
    out, report = tmp_path / "out.ply", tmp_path / "report.json"
    arguments = ("build", points, "--crs", UTM, *options, "-o", out, "--report", report)
    found = facts(*arguments)
    given = {name: found["survey"][name] for name in ("breaklines", "boundary", "holes", "water")}
    assert given == {"breaklines": 2, "boundary": 1, "holes": 1, "water": 1}
    assert found["counts"]["left_out"] == {
        "erased": 1,
        "in water": 1,
        "outside the boundary": 22,
        "in a hole": 1,
    }
    assert found["counts"]["lines"] == 5
    assert found["tin"]["lines"]["hard"] == 1
    assert json.loads(report.read_text())["left_out"]["in a hole"] == [36]
    tin = ts.read(out)
    shape = shapely.union_all(
        [shapely.Polygon(tin.points[t, :2]) for t in tin.triangles.tolist()], grid_size=1e-6
    )
    assert shape.area == pytest.approx(100 * 85 - 16 * 16, abs=1e-3)
    assert tin.interpolate([at(50, 70), at(50, 5)]).tolist() == [299.0, 301.0]
    assert found["tin"]["constrained_edges"] == facts("info", out)["constrained_edges"] > 50
    words = run(*arguments).stderr
    assert "2 breaklines, 1 boundary ring, 1 hole, 1 part to erase, 1 water polygon" in words
    assert "25 rows: 1 erased, 1 in water, 22 outside the boundary, 1 in a hole" in words


def test_a_crossing_is_told_with_both_heights_or_refused(points, files, tmp_path):
    other = write(tmp_path / "x.gpkg", line((50, 1, 302.0), (50, 9, 302.0)), name=["wall"])
    lines = ("--breaklines", files["breaklines"], "--breaklines", other)
    arguments = ("build", points, "--crs", UTM, *lines, "-o", tmp_path / "a.ply")
    words = " ".join(run(*arguments).stderr.split())
    assert "at 1 place, elevations differ most by 1.000 at x" in words
    assert "breakline 0 'kerb' at 301.000, breakline 1 'wall' at 302.000, taken 301.000" in words
    (crossing,) = facts(*arguments)["report"]["crossings"]
    assert (crossing["elevations"], crossing["elevation"]) == ([301.0, 302.0], 301.0)
    refused = run(*arguments[:-2], "--crossing", "error", "-o", tmp_path / "no.ply", code=1)
    assert "kerb" in refused.stderr
    assert "wall" in refused.stderr
    assert not (tmp_path / "no.ply").exists()


def test_soft_options_make_soft_lines(points, files, tmp_path):
    path = tmp_path / "a.geojson"
    run("build", points, "--crs", UTM, "--soft-breaklines", files["breaklines"], "--projected",
        "--kind", "lines", "-o", path)  # fmt: skip
    (feature,) = json.loads(path.read_text())["features"]
    assert feature["properties"] == {"id": 0, "kind": "soft", "name": "kerb", "source": 0}


def test_draping_leaves_the_heights_of_the_file(points, files, tmp_path):
    out = tmp_path / "a.ply"
    run("build", points, "--crs", UTM, "--breaklines", files["breaklines"], "--drape", "-o", out)
    assert ts.read(out).interpolate([at(50, 5)]) == pytest.approx([300.5])


@pytest.mark.parametrize(("z", "expected"), [("298.25", 298.25), ("level", 299.0)])
def test_the_height_of_water_is_a_number_or_a_column(points, files, tmp_path, z, expected):
    out = tmp_path / "a.ply"
    water = ("--water", files["water"], "--water-z", z)
    run("build", points, "--crs", UTM, *water, "-o", out)
    assert ts.read(out).interpolate([at(50, 70)]).tolist() == [expected]


def test_max_edge_and_trim(points, files, tmp_path):
    trimmed = ("--erase", files["erase"], "--max-edge", 15, "--trim")
    areas = [
        facts("build", points, *trimmed, trim, "-o", tmp_path / "a.ply")["tin"]["area"]
        for trim in get_args(TrimPolicy)
    ]
    # Without the point in the middle, a square on its corners is left, of side 14.14.
    assert areas == [10_000.0, 10_000.0 - 200.0]


def test_conforming_splits_lines(points, files, tmp_path):
    arguments = ("build", points, "--breaklines", files["breaklines"], "-o", tmp_path / "a.ply")
    plain, split = facts(*arguments), facts(*arguments, "--conforming")
    assert split["tin"]["vertices"] > plain["tin"]["vertices"]


def test_codes_make_the_lines_of_the_sample(tmp_path):
    found = facts("build", SURVEY, "--crs", UTM, "--codes", "-o", tmp_path / "a.ply")
    assert found["tin"]["lines"] == {"hard": 11, "water": 1}
    assert found["counts"]["left_out"] == {"in water": 25}
    assert facts("check", SURVEY, "--codes")["ok"]


def test_notes_say_what_was_assumed(points, files, tmp_path):
    words = run("build", points, "--breaklines", files["breaklines"], "-o", tmp_path / "a.ply")
    assert "taken to be the CRS of the points" in words.stderr


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--breaklines", "none.gpkg"), 1, "There is no file 'none.gpkg'."),
        (("--water-z", "3"), 2, "--water-z needs --water"),
        (("--codes",), 1, "no descriptions"),
        (("--max-edge", "-1"), 2, "Invalid --max-edge"),
        (("--crossing", "ignore"), 2, "'ignore' is not one of"),
    ],
)
def test_faults_are_sentences_and_nothing_is_written(points, tmp_path, arguments, code, words):
    result = run("build", points, *arguments, "-o", tmp_path / "a.ply", code=code)
    assert words in " ".join(result.stderr.split())
    assert "Traceback" not in result.stderr
    assert not (tmp_path / "a.ply").exists()


def test_a_boundary_that_leaves_nothing_is_a_sentence(points, tmp_path):
    site = write(tmp_path / "far.gpkg", box(300, 300, 320, 320))
    result = run(
        "build", points, "--crs", UTM, "--boundary", site, "-o", tmp_path / "a.ply", code=1
    )
    assert result.stderr.startswith("Error: ")
    assert not (tmp_path / "a.ply").exists()


def test_a_tin_takes_no_lines_from_files(points, files, tmp_path):
    run("build", points, "--crs", UTM, "-o", tmp_path / "a.ply")
    lines = ("--breaklines", files["breaklines"])
    for command in ("check", "view"):
        result = run(command, tmp_path / "a.ply", *lines, code=1)
        assert "--breaklines needs points" in result.stderr


def test_view_takes_the_same_options(points, files, tmp_path, can_draw):
    options = ("--breaklines", files["breaklines"], "--crs", UTM, "--exaggeration", 5, "-q")
    options += ("--size", "500x400")
    for name, extra in (("a.png", ()), ("b.png", ("--no-lines",))):
        run("view", points, *options, *extra, "-o", tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() != (tmp_path / "b.png").read_bytes()


def test_edges_in_geojson_tell_the_kind_of_their_line(tmp_path):
    path = tmp_path / "a.geojson"
    run("build", SURVEY, "--crs", UTM, "--codes", "--kind", "edges", "-o", path, "-q")
    kinds = [f["properties"]["kind"] for f in json.loads(path.read_text())["features"]]
    flags = [f["properties"]["constrained"] for f in json.loads(path.read_text())["features"]]
    assert {kind: kinds.count(kind) for kind in set(kinds)} == {
        "hard": 446,
        "water": 32,
        None: 5789,
    }
    assert [kind is not None for kind in kinds] == flags


@pytest.mark.parametrize("suffix", [".ply", ".vtp", ".vtu"])
def test_constrained_edges_come_back_from_files(tmp_path, suffix):
    if suffix != ".ply":
        pytest.importorskip("pyvista")
    survey = ts.io.lines_from_codes(ts.read(SURVEY, crs=UTM))
    built = ts.triangulate(survey, boundary=[at([10, 10], [240, 12], [200, 170], [20, 150])])
    ts.write(built, tmp_path / f"a{suffix}")
    again = ts.read(tmp_path / f"a{suffix}")
    assert np.array_equal(again.constrained, built.constrained)
    assert np.array_equal(again.triangles, built.triangles)


def test_lines_are_refused_where_there_are_none(points, tmp_path):
    result = run(
        "build", points, "--crs", UTM, "--kind", "lines", "-o", tmp_path / "a.json", code=1
    )
    assert "has no lines" in result.stderr
    assert not (tmp_path / "a.json").exists()


def test_lines_with_two_elevations_are_walls_where_that_is_asked_for(tmp_path):
    ground = [[x, y, 10.0 if x < 50 else 5.0] for x in range(0, 101, 20) for y in (0, 50, 100)]
    rows = [",".join(map(str, [*at(*one[:2]).tolist(), one[2]])) for one in ground]
    points = tmp_path / "points.csv"
    points.write_text("\n".join(["easting,northing,elevation", *rows]))
    top, foot = (line((50, 0, z), (50, 100, z)) for z in (10.0, 5.0))
    lines = write(tmp_path / "lines.gpkg", top, foot, name=["top", "foot"])
    out = tmp_path / "out.ply"
    done = run("build", points, "--crs", UTM, "--breaklines", lines, "--walls", 0.25, "-o", out)
    assert "1 wall: of breaklines along one line the lower one was moved by 0.25" in done.output
    assert "'foot' lies to the right of" in done.output
    found = ts.read(out).interpolate([at(50, 40), at(50.25, 40), at(50.125, 40)])
    assert found == pytest.approx([10.0, 5.0, 7.5], abs=1e-6)
    done = run("build", out, points, "--walls", 0.25, "-o", tmp_path / "more.ply", code=1)
    assert "--walls needs points to build from" in done.output
    run("build", points, "--breaklines", lines, "--crs", UTM, "--walls", 0, "-o", out, code=2)
