"""``tinsmith plan`` as people run it."""

import json
from pathlib import Path

import numpy as np
import pyogrio
import pytest
import shapely
from support.commands import refuse, run
from support.printed import read_pdf, read_svg

import tinsmith as ts

SITE = Path(__file__).parents[2] / "sample_data" / "site_survey.csv"
UTM = "EPSG:32616"


@pytest.fixture
def road(tmp_path):
    x = np.arange(0.0, 1000.0, 20.0)
    points = [[500000 + a, 4e6 + b, 300 + a / 50] for a in x for b in (0.0, 15.0)]
    return ts.write(ts.triangulate(points, crs=UTM, elevation_unit="m"), tmp_path / "road.ply")


def test_a_survey_becomes_pdf_svg_and_png(tmp_path):
    outputs = [tmp_path / f"site.{kind}" for kind in ("pdf", "svg", "png")]
    options = [one for path in outputs for one in ("-o", path)]
    out = run("plan", SITE, "--crs", UTM, "--codes", "--scale", 1000, "--date", "2026-11-22",
              "--dpi", 50, *options, "--json")  # fmt: skip
    assert out.exit_code == 0, out.output
    facts = json.loads(out.stdout)
    assert facts["scale"] == 1000
    assert facts["paper"] == [420.0, 297.0]
    assert facts["outputs"] == [str(path) for path in outputs]
    (page,) = read_pdf(outputs[0])
    assert {"site survey", "1:1000", "2026-11-22"} <= {text.text for text in page.texts}
    assert "Note" in out.stderr
    assert "metre" in out.stderr


def test_strips_follow_the_axis_of_a_file(road, tmp_path):
    line = shapely.LineString([[501000, 4e6 + 7], [500000, 4e6 + 7]])
    axis = tmp_path / "axis.gpkg"
    pyogrio.raw.write(
        axis, shapely.to_wkb([line]), [], [], crs=UTM, geometry_type="LineString"
    )  # fmt: skip
    out = run("plan", road, "--layout", "strips", "--scale", 500, "--paper", "A4", "--axis", axis,
              "-o", tmp_path / "road.svg", "--json")  # fmt: skip
    assert out.exit_code == 0, out.output
    facts = json.loads(out.stdout)
    assert facts["sheets"] == len(facts["outputs"]) > 5
    middles = np.array(facts["frames"])[1:].mean(axis=1)
    assert (np.diff(middles[:, 0]) < 0).all()
    assert read_svg(Path(facts["outputs"][1])).paths["match-lines"]


def test_papers_are_named_or_measured(road, tmp_path):
    for text, size in (("arch-d", [914.4, 609.6]), ("900x600", [900.0, 600.0])):
        out = run("plan", road, "--paper", text, "-o", tmp_path / "a.pdf", "--json")
        assert json.loads(out.stdout)["paper"] == pytest.approx(size)


def test_what_does_not_fit_is_refused_with_the_scale_that_does(road, tmp_path):
    said = refuse("plan", road, "--scale", 500, "-o", tmp_path / "a.pdf", code=2)
    assert "--scale '1:500': it must be 1:5000 or smaller on A3 landscape" in " ".join(said.split())
    assert list(tmp_path.iterdir()) == [road]


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["--paper", "B9"], 2, "--paper"),
        (["--scale", "large"], 2, "--scale"),
        (["--layout", "rows"], 2, "--layout"),
        (["--interval", "0.0001"], 2, "--interval"),
        (["--axis", "none.gpkg", "--layout", "strips", "--scale", "500"], 1, "none.gpkg"),
        (["--points", "numbers"], 2, "--points"),
        (["--dpi", "5"], 2, "--dpi"),
        (["--ground-unit", "ft"], 2, "--ground-unit"),
    ],
)
def test_wrong_options_are_named(road, tmp_path, options, code, words):
    said = refuse("plan", road, *options, "-o", tmp_path / "a.pdf", code=code)
    assert words in said
    assert not (tmp_path / "a.pdf").exists()


def test_inputs_are_never_overwritten(road, tmp_path):
    copy = tmp_path / "plan.pdf"
    copy.write_bytes(road.read_bytes())
    said = refuse("plan", copy, "--format", "ply", "-o", copy, code=2)
    assert "cannot be the output too" in said
    assert refuse("plan", road, "-o", tmp_path / "plan.docx", code=2).count("must end in") == 1
