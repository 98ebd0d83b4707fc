"""Every algorithm of the plugin in QGIS: results are those of the package itself."""

from __future__ import annotations

import csv
import json
import re
import shutil
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import rasterio
from click import Choice
from support.printed import read_pdf
from support.qgis_jobs import (
    CUT,
    DEM,
    KERB,
    RING,
    SURVEY,
    UTM,
    assert_same_tin,
    job,
    make_inputs,
    make_layer,
    read_layer,
    read_survey,
    require_done,
    take_layer,
)
from support.qgis_plugin import drive

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.cli.format_options import list_format_options

PLUGIN = Path(__file__).parents[2] / "qgis/tinsmith"
UP = np.array([0.0, 0.0, 1.0])

UNSOUND = "v 0 0 0\nv 1 0 0\nv 1.4 1.4 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
"""Two triangles with the longer diagonal between them."""


@pytest.fixture
def survey():
    return read_survey()


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_tins_are_those_of_the_package(tmp_path, survey):
    tin, layers = make_inputs(tmp_path, survey)
    jobs = {
        "lines": job("build", POINTS="points", BREAKLINES="kerb", BOUNDARY="site", MAX_EDGE=50,
                     WALLS=0.01, REPORT=tmp_path / "r.json", OUTPUT=tmp_path / "lines.ply"),
        "field": job("build", POINTS={"selected": "flat"}, POINTS_Z_FIELD="high",
                     DUPLICATES="first", OUTPUT=tmp_path / "field.nc"),
        "dem": job("build", DEM="dem", STRIDE=16, OUTPUT=tmp_path / "dem.2dm"),
        "file": job("build", FILE=SURVEY, CRS=UTM, EXTRA="--codes", OUTPUT=tmp_path / "file.gpkg"),
        "refine": job("refine", INPUT="ground", MAX_AREA=400, OUTPUT=tmp_path / "fine.ply"),
        "simplify": job("simplify", INPUT="ground", TOLERANCE=0.5, OUTPUT=tmp_path / "few.ply"),
        "check": job("check", INPUT="no crs", OUTPUT=tmp_path / "found.json"),
        "unsound": job("check", INPUT_FILE=tmp_path / "twice.obj"),
        "convert": job("convert", INPUT="no crs", OUTPUT=tmp_path / "again.gpkg"),
        "feet": job("build", FILE=SURVEY, CRS=UTM, ELEVATION_UNIT="ft",
                    OUTPUT=tmp_path / "feet.nc"),
        "unnamed": job("build", FILE=SURVEY, CRS=UTM, OUTPUT="TEMPORARY_OUTPUT"),
    }  # fmt: skip
    (tmp_path / "twice.obj").write_text(UNSOUND)
    told = drive(tmp_path, layers, jobs)
    require_done(told)
    check_lines(told["lines"], survey, tmp_path)
    selected = ts.Survey(points=survey.points[:300] + UP, crs=UTM)
    assert_same_tin(ts.read(tmp_path / "field.nc"), ts.triangulate(selected, duplicates="first"))
    assert_same_tin(ts.read(tmp_path / "dem.2dm", crs=UTM), ts.triangulate(ts.read(DEM, stride=16)))
    coded = ts.triangulate(ts.lines_from_codes(survey))
    assert_same_tin(ts.read(tmp_path / "file.gpkg"), coded)
    assert take_layer(told["file"], "file")["count"] == len(coded.triangles)
    mesh = take_layer(told["field"], "field")
    assert (mesh["crs"], mesh["type"]) == (UTM, "QgsMeshLayer")
    assert_same_tin(ts.read(tmp_path / "fine.ply"), ts.refine(tin, max_area=400))
    assert_same_tin(ts.read(tmp_path / "few.ply"), ts.simplify(tin, tolerance=0.5))
    assert_same_tin(ts.read(tmp_path / "again.gpkg"), tin)
    assert list(told["feet"]["layers"]) == ["feet (ft)"]
    assert list(told["unnamed"]["layers"]) == ["TIN"]
    assert told["file"]["layers"]["file"]["renderer"] == "graduatedSymbol"
    assert told["check"]["outputs"] == {
        "SOUND": True, "PROBLEMS": 0, "OUTPUT": str(tmp_path / "found.json")
    }  # fmt: skip
    assert json.loads((tmp_path / "found.json").read_text())["ok"] is True
    assert told["unsound"]["outputs"]["SOUND"] is False
    problems = [text for kind, text in told["unsound"]["log"] if kind == "error"]
    assert len(problems) == told["unsound"]["outputs"]["PROBLEMS"] > 0
    for one in told.values():
        assert "log" not in one or "tinsmith" in one["log"][0][1]


def check_lines(answer, survey, folder):
    """Check a TIN with lines, its layer and style, its report and what was said."""
    made = ts.read(folder / "lines.ply")
    wanted = ts.triangulate(
        survey, breaklines=[ts.Breakline(KERB, name="k1")], boundary=[RING], max_edge=50
    )
    assert_same_tin(made, wanted)
    assert str(made.lines) == str(wanted.lines)
    layer = take_layer(answer, "lines")
    assert (layer["crs"], layer["faces"]) == (UTM, len(wanted.triangles))
    low, high = wanted.points[:, 2].min(), wanted.points[:, 2].max()
    assert layer["range"] == pytest.approx([low, high], abs=1e-9)
    assert layer["edges"]
    assert layer["ramp"] >= 5
    assert json.loads((folder / "r.json").read_text())["rows"] == len(survey)
    assert any(kind == "warning" and ".nc, .gpkg or .2dm" in text for kind, text in answer["log"])
    assert answer["outputs"]["TRIANGLES"] == len(wanted.triangles)
    said = [text for kind, text in answer["log"] if kind == "info"]
    assert any(text.startswith("Points") and "from points" in text for text in said)
    assert not any("/tinsmith-" in text for text in said)
    assert max(answer["fractions"]) == 100


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_products_are_those_of_the_package(tmp_path, survey):
    tin, layers = make_inputs(tmp_path, survey)
    jobs = {
        "lines": job("contours", INPUT="ground", INTERVAL=1, OUTPUT=tmp_path / "lines.gpkg"),
        "bands": job("contours", INPUT="no crs", LEVELS="320,325", PRODUCT="bands",
                     OUTPUT=tmp_path / "bands.fgb"),
        "labels": job("contours", INPUT="points", INTERVAL=2, PRODUCT="labels",
                      OUTPUT=tmp_path / "labels.gpkg"),
        "slope": job("slope", INPUT="ground", UNIT="percent", BREAKS="5,15",
                     TABLE=tmp_path / "s.csv", OUTPUT=tmp_path / "slope.gpkg"),
        "profile": job("profile", INPUT="ground", SECOND="flat", SECOND_Z_FIELD="high", LINE="cut",
                       INTERVAL=10, OUTPUT=tmp_path / "profile.csv",
                       SHEETS=tmp_path / "profile.pdf"),
        "plan": job("plan", INPUT="ground", SCALE="2000", LAYOUT="strips", AXIS="cut", INTERVAL=2,
                    SPOTS="peaks", TITLE="Quarry", OUTPUT=tmp_path / "plan.pdf"),
        "sections": job("profile", INPUT_FILE=tmp_path / "ground.ply", LINE="cut",
                        SECTION_INTERVAL=50, SECTION_WIDTH=20, OUTPUT=tmp_path / "cross.csv",
                        SECTIONS=tmp_path / "across.gpkg"),
        "quantities": job("sections", INPUT="ground", DESIGN="flat", DESIGN_Z_FIELD="high",
                          LINE="cut", INTERVAL=50, WIDTH=20, OUTPUT=tmp_path / "quantities.csv",
                          SHEETS=tmp_path / "sections.dxf"),
        "stakes": job("stakeout", INPUT="ground", GROUND="flat", GROUND_Z_FIELD="high",
                      POINTS="points", LINE="cut", OUTPUT=tmp_path / "stakes.csv",
                      LAYER=tmp_path / "set_out.gpkg"),
        "volume": job("volume", INPUT="ground", BASE=325, REGIONS="site",
                      OUTPUT=tmp_path / "volume.csv", ZONES=tmp_path / "zones.gpkg",
                      REPORT=tmp_path / "report.pdf"),
        "stages": job("stagestorage", INPUT="ground", INTERVAL=5, OUTPUT=tmp_path / "stages.csv"),
        "raster": job("raster", INPUT="ground", SPACING=2, OUTPUT=tmp_path / "raster.tif"),
        "light": job("raster", INPUT="ground", LIKE="dem", VALUE="hillshade",
                     OUTPUT=tmp_path / "light.tif"),
        "operator": job("raster", INPUT="ground", LIKE="dem", VALUE="tri", OPERATOR="wilson",
                        COMPUTE_EDGES=True, OUTPUT=tmp_path / "tri.tif"),
    }  # fmt: skip
    told = drive(tmp_path, layers, jobs)
    require_done(told)
    check_contours(told, tin, tmp_path)
    check_slope(told["slope"], tin, tmp_path)
    check_sections(told, tin, survey, tmp_path)
    check_sheets(tin, tmp_path)
    check_stakes(told["stakes"], tin, survey, tmp_path)
    check_volumes(told, tin, tmp_path)
    check_rasters(told, tin, tmp_path)


def check_contours(told, tin, folder):
    wanted = ts.contours(tin, interval=1)
    layer = take_layer(told["lines"], "lines")
    assert (layer["count"], layer["crs"], layer["labels"]) == (len(wanted), UTM, True)
    assert layer["widths"][0] > layer["widths"][1]
    assert (layer["field"], layer["unclassified"]) == ("is_index", 0)
    again = ts.write(wanted, folder / "wanted.gpkg")
    assert read_layer(folder / "lines.gpkg") == read_layer(again)
    bands = ts.contour_bands(tin, levels=[320, 325])
    layer = take_layer(told["bands"], "bands")
    assert (layer["count"], layer["unclassified"]) == (len(bands), 0)
    labels = ts.contour_labels(ts.contours(tin, interval=2))
    layer = take_layer(told["labels"], "labels")
    assert (layer["count"], layer["labels"]) == (len(labels), True)


def check_slope(answer, tin, folder):
    wanted = ts.slope_classes(tin, breaks=[5, 15], unit="percent")
    layer = take_layer(answer, "slope")
    assert layer["count"] == len(wanted)
    assert layer["legend"] == wanted.columns["label"].tolist()
    assert layer["colors"] == [one.lower() for one in wanted.columns["color"].tolist()]
    assert layer["unclassified"] == 0
    with (folder / "s.csv").open() as file:
        assert len(list(csv.DictReader(file))) == len(wanted)


def read_numbers(path, name, missing=None):
    with path.open() as file:
        rows = list(csv.DictReader(file))
    (column,) = [key for key in rows[0] if key.split(" (")[0] == name]
    return np.array([float(row[column] or missing) for row in rows])


def check_sections(told, tin, survey, folder):
    raised = ts.triangulate(ts.Survey(points=survey.points + UP, crs=UTM))
    wanted = ts.profile({"ground": tin, "flat": raised}, CUT, interval=10)
    np.testing.assert_array_equal(
        read_numbers(folder / "profile.csv", "station"), wanted["station"]
    )
    for name in ("elevation_ground", "elevation_flat", "difference_flat"):
        found = read_numbers(folder / "profile.csv", name)
        np.testing.assert_array_equal(found, wanted[name])
    assert take_layer(told["profile"], "profile")["count"] == len(wanted)
    lines = ts.section_lines(tin, CUT, interval=50, width=20)
    assert take_layer(told["sections"], "across")["count"] == len(lines)
    quantities = ts.section_volumes(tin, raised, CUT, interval=50, width=20)
    for name in ("station", "cut_total", "fill_total"):
        found = read_numbers(folder / "quantities.csv", name)
        np.testing.assert_array_equal(found, quantities[name])
    texts = ezdxf.readfile(folder / "sections.dxf").modelspace().query("TEXT")
    heads = [one.dxf.text for one in texts if one.dxf.text.startswith("Station ")]
    assert len(heads) == len(quantities)


def check_sheets(tin, folder):
    """Check that the drawn plan and profile are the ones of the package, to the words on them."""
    axis = ts.Alignment.from_points(CUT, crs=UTM)
    options = {"scale": 2000, "layout": "strips", "axis": axis, "interval": 2, "spots": "peaks"}
    ts.plan(tin, title="Quarry", **options).save(folder / "wanted.pdf")
    made, wanted = (read_pdf(folder / name) for name in ("plan.pdf", "wanted.pdf"))
    assert [str(one.texts) for one in made] == [str(one.texts) for one in wanted]
    assert any(one.text == "Quarry" for one in made[0].texts)
    sheets = " ".join(one.text for page in read_pdf(folder / "profile.pdf") for one in page.texts)
    assert "Elevations" in sheets
    assert f"{ts.profile(tin, CUT)['elevation'][0]:.2f}" in sheets


def check_stakes(answer, tin, survey, folder):
    raised = ts.triangulate(ts.Survey(points=survey.points + UP, crs=UTM))
    road = ts.Alignment.from_points(CUT, crs=UTM)
    at = survey.points[:, :2]
    wanted = ts.stakeout(tin, at, ground=raised, alignment=road)
    for name in ("elevation", "cut", "fill", "station", "offset"):
        found = read_numbers(folder / "stakes.csv", name, missing=np.nan)
        np.testing.assert_array_equal(found, wanted[name])
    layer = take_layer(answer, "set_out")
    assert (layer["count"], layer["crs"]) == (len(at), UTM)


def check_volumes(told, tin, folder):
    closed = np.array([*RING, RING[0]], float)
    region = ts.Features.of_polygons(closed, np.array([0, 5]), np.array([0, 1]), crs=UTM)
    wanted = ts.volume(tin, base=325, regions=region)
    for name in ("cut", "fill", "net", "area"):
        assert told["volume"]["outputs"][name.upper()] == wanted[name].sum()
        np.testing.assert_array_equal(read_numbers(folder / "volume.csv", name), wanted[name])
    zones = take_layer(told["volume"], "zones")
    assert (zones["field"], zones["unclassified"], zones["crs"]) == ("kind", 0, UTM)
    stages = ts.stage_storage(tin, interval=5)
    np.testing.assert_array_equal(read_numbers(folder / "stages.csv", "volume"), stages["volume"])
    report = " ".join(one.text for page in read_pdf(folder / "report.pdf") for one in page.texts)
    for name in ("cut", "fill"):
        assert all(f"{value:,.2f}" in report for value in wanted[name])


def check_rasters(told, tin, folder):
    made = ts.rasterize(tin, spacing=2)
    ts.write(made, folder / "wanted.tif")
    with rasterio.open(folder / "raster.tif") as one, rasterio.open(folder / "wanted.tif") as other:
        np.testing.assert_array_equal(one.read(), other.read())
        assert str(one.profile) == str(other.profile)  # NaN is not NaN; tags tell of the inputs
    with rasterio.open(folder / "tri.tif") as one:
        options = {"value": "tri", "operator": "wilson", "compute_edges": True}
        wanted = ts.rasterize(tin, like=one, **options).bands["tri"]
        found = one.read(1, masked=True).filled(np.nan)  # type and nodata are those of LIKE
        np.testing.assert_array_equal(found, wanted.astype(found.dtype))
    layer = take_layer(told["raster"], "raster")
    assert (layer["renderer"], layer["crs"]) == ("singlebandpseudocolor", UTM)
    assert take_layer(told["light"], "light")["renderer"] == "singlebandgray"


# ------------------------------------------------------------------- what is refused


def make_program(path, text):
    path.write_text(f"#!{sys.executable}\n{text}")
    path.chmod(0o755)
    return str(path)


STUBBORN = """
import os, pathlib, signal, sys, time
if sys.argv[1:] == ["--version"]:
    print("tinsmith 9.9.9")
    sys.exit()
signal.signal(signal.SIGTERM, signal.SIG_IGN)
pathlib.Path(__file__).with_suffix(".pid").write_text(str(os.getpid()))
print('{"event": "warning", "text": "about to hang"}', file=sys.stderr, flush=True)
print("no event", file=sys.stderr, flush=True)
time.sleep(300)
"""

WAITING = """
import pathlib, sys, time

def wait(*_):
    print('{"event": "warning", "text": "about to replace"}', file=sys.stderr, flush=True)
    time.sleep(300)

pathlib.Path.replace = wait
from tinsmith.cli import main
from tinsmith.cli.format_options import list_format_options
main()
"""
"""The command itself, which waits where it would put its file in the place of the old one."""


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_what_cannot_be_is_refused_with_one_sentence(tmp_path, survey):
    _, layers = make_inputs(tmp_path, survey)
    layers["other crs"] = layers["ground"] | {"crs": "EPSG:26916"}
    layers["degrees"] = make_layer(
        "PointZ", [["Point Z(-84 36 1)", []], ["Point Z(-84 37 1)", []]], crs="EPSG:4326"
    )
    layers["none selected"] = layers["flat"] | {"selected": []}
    out = tmp_path / "out.ply"
    out.write_bytes(b"old")
    jobs = {
        "a layer of points, a DEM, or a file": job("build", OUTPUT=out),
        "POINTS and DEM given": job("build", POINTS="points", DEM="dem", OUTPUT=out),
        "'flat' has no Z in its geometry": job("build", POINTS="flat", OUTPUT=out),
        "has no field 'low'": job("build", POINTS="flat", POINTS_Z_FIELD="low", OUTPUT=out),
        "has no selected features": job("build", POINTS={"selected": "none selected"},
                                        POINTS_Z_FIELD="high", OUTPUT=out),
        "in degrees": job("build", POINTS="degrees", OUTPUT=out),
        "its file says EPSG:32616": job("contours", INPUT="other crs", INTERVAL=1,
                                        OUTPUT=tmp_path / "c.gpkg"),
        "Either --interval or --levels is needed": job("contours", INPUT="ground",
                                                       OUTPUT=tmp_path / "c.gpkg"),
        "choose a layer or a file": job("slope", OUTPUT=tmp_path / "s.gpkg"),
        "choose one of them": job("slope", INPUT="ground", INPUT_FILE=tmp_path / "ground.ply",
                                  OUTPUT=tmp_path / "s.gpkg"),
        "Incorrect parameter value for INPUT": job("slope", INPUT="nowhere",
                                                   OUTPUT=tmp_path / "s.gpkg"),
        "No closing quotation": job("check", INPUT="ground", EXTRA="--level '3"),
        "is not there or cannot be run": job("check", INPUT="ground")
        | {"command": str(tmp_path / "points.gpkg")},
        "is no tinsmith": job("check", INPUT="ground") | {"command": shutil.which("true")},
        "There is no command tinsmith": job("check", INPUT="ground")
        | {"environment": {"PATH": str(tmp_path)}},
    }  # fmt: skip
    told = drive(tmp_path, layers, jobs)
    for words, one in told.items():
        if words != "provider":
            assert words in (one["error"] or ""), (words, one)
            assert "Traceback" not in one["error"]
    assert out.read_bytes() == b"old"
    assert not (tmp_path / "c.gpkg").exists()
    compare_options(told["provider"]["algorithms"])


def test_every_algorithm_is_run_by_these_tests():
    folder = Path(__file__).parent
    source = "".join(one.read_text() for one in folder.glob("*.py"))
    declared = (PLUGIN / "algorithms").glob("*.py")
    verbs = {verb for one in declared for verb in re.findall(r'verb = "(\w+)"', one.read_text())}
    assert len(verbs) > 15
    assert verbs <= set(re.findall(r'job\(\s*"(\w+)"', source))


def compare_options(algorithms):
    """Compare the parameters with the command's own options: flags, choices, defaults."""
    compared = 0
    for name, one in algorithms.items():
        assert "<p>" in one["help"]
        assert not one["icon"][0], name
        for parameter in one["parameters"]:
            assert parameter["help"] or parameter["type"] == "vectorDestination", parameter
            if "In messages: --" not in parameter["help"] or not one["verb"]:
                continue
            flag = parameter["help"].rsplit("In messages: ", 1)[1].rstrip(".")
            compare_option(find_option(one["verb"], flag), parameter, name)
            compared += 1
    assert compared > 40
    assert len(algorithms) >= 11


def find_option(verb, flag):
    command = main.get_command(None, verb)
    of_formats = list_format_options(command.params, command.format_ways, [flag], lists=False)
    (found,) = [one for one in (*command.params, *of_formats) if flag in one.opts]
    return found


def compare_option(option, parameter, name):
    known = option.default if isinstance(option.default, (int, float, str)) else None
    if parameter["type"] == "enum":
        if isinstance(option.type, Choice):
            # An option without a default has a first choice that leaves it out.
            unset = {"as usual", "no elevation"} if known is None else set()
            chosen = set(parameter["choices"]) - unset
            assert sorted(option.type.choices) == sorted(chosen), (name, parameter)
            assert parameter["choices"][0] in {*unset, *option.type.choices}
        if known is not None:
            assert str(known) == parameter["default"], (name, parameter)
    elif parameter["type"] == "number" and parameter["name"] != "STRIDE":
        assert parameter["default"] == known, (name, parameter)


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_cancelling_ends_the_command_and_leaves_nothing(tmp_path, survey):
    _, layers = make_inputs(tmp_path, survey)
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "old.ply").write_bytes(b"old")
    stubborn = make_program(tmp_path / "stubborn", STUBBORN)
    waiting = make_program(tmp_path / "waiting", WAITING)
    at_replacing = {"command": waiting, "cancel_at": "about to replace"}
    jobs = {
        "new": job("build", DEM="dem", OUTPUT=folder / "new.ply") | at_replacing,
        "old": job("build", DEM="dem", OUTPUT=folder / "old.ply") | at_replacing,
        "stubborn": job("check", INPUT="ground")
        | {"command": stubborn, "cancel_at": "about to hang", "grace": 0.3},
    }
    told = drive(tmp_path, layers, jobs)
    for name in jobs:
        assert told[name]["error"].startswith("Cancelled"), told[name]
        assert told[name]["layers"] == {}
    assert [path.name for path in folder.iterdir()] == ["old.ply"]
    assert (folder / "old.ply").read_bytes() == b"old"
    said = told["stubborn"]["log"]
    assert ["warning", "about to hang"] in said
    assert said[0][1].startswith("tinsmith 9.9.9")
    number = (tmp_path / "stubborn.pid").read_text()
    assert not Path(f"/proc/{number}").exists()


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_choices_may_be_given_by_the_numbers_that_qgis_lists(tmp_path, survey):
    _, layers = make_inputs(tmp_path, survey)
    (tmp_path / "word").mkdir()
    (tmp_path / "number").mkdir()
    given = {"word": ("bands", "hillshade", "percent"), "number": (1, "3", 1)}
    jobs = {}
    for how, (product, value, unit) in given.items():
        folder = tmp_path / how
        jobs |= {
            f"contours {how}": job("contours", INPUT="ground", INTERVAL=5, PRODUCT=product,
                                   OUTPUT=folder / "a.fgb"),
            f"raster {how}": job("raster", INPUT="ground", SPACING=4, VALUE=value,
                                 OUTPUT=folder / "a.tif"),
            f"slope {how}": job("slope", INPUT="ground", UNIT=unit, BREAKS="5,15",
                                OUTPUT=folder / "a.gpkg", TABLE=folder / "a.csv"),
        }  # fmt: skip
    jobs["none"] = job("raster", INPUT="ground", SPACING=4, VALUE=99, OUTPUT=tmp_path / "b.tif")
    told = drive(tmp_path, layers, jobs)
    refused = told.pop("none")
    assert "VALUE" in refused["error"] or "Value" in refused["error"]
    require_done(told)
    for name in ("a.fgb", "a.tif", "a.csv"):
        assert (tmp_path / "word" / name).read_bytes() == (tmp_path / "number" / name).read_bytes()
