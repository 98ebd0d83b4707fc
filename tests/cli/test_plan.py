"""``tinsmith plan`` as people run it."""

import json
from pathlib import Path

import ezdxf
import numpy as np
import pyogrio
import pytest
import shapely
from PIL import Image
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


# ---------------------------------------------------------------- title blocks and marks

BLOCK = 'company = "Holm Surveying"\nlogo = "logo.png"\n[rows]\nJob = 2026014\n'


@pytest.fixture
def block(tmp_path):
    Image.new("RGB", (30, 10), "red").save(tmp_path / "logo.png")
    path = tmp_path / "block.toml"
    path.write_text(BLOCK)
    return path


def test_a_title_block_stands_on_plans_sections_and_reports(road, block, tmp_path):
    axis = tmp_path / "axis.csv"
    axis.write_text("easting,northing\n500010,4000007\n500100,4000007\n")
    calls = (
        ("plan", road),
        ("sections", road, road, "--line", axis, "--interval", 50, "--width", 10),
        ("volume", road, "--base", 305),
    )
    for words in calls:
        out = run(*words, "--title-block", block, "-o", tmp_path / f"{words[0]}.pdf")
        assert out.exit_code == 0, out.output
        for page in read_pdf(tmp_path / f"{words[0]}.pdf"):
            assert {"Holm Surveying", "Job", "2026014"} <= {text.text for text in page.texts}


def test_no_output_goes_over_a_title_block_or_its_logo(road, block):
    for name in ("block.toml", "logo.png"):
        before = block.with_name(name).read_bytes()
        text = refuse("plan", road, "--title-block", block, "-o", block.with_name(name), code=2)
        assert block.with_name(name).read_bytes() == before
        assert name == "block.toml" or "the logo of --title-block" in text


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('clinet = "x"', "Invalid field in 'block.toml' 'clinet': it must be one of company"),
        ("client = 2.5", "Invalid client in 'block.toml' 2.5: it must be text. (--title-block)"),
        ("client = ", "as TOML: Invalid value (at end of document)."),
        ('logo = "none.png"', "none.png': No such file or directory."),
    ],
)  # fmt: skip
def test_a_title_block_that_cannot_be_is_refused(road, block, text, sentence, tmp_path):
    block.write_text(text)
    assert sentence in refuse("plan", road, "--title-block", block, "-o", tmp_path / "a.pdf")
    assert not (tmp_path / "a.pdf").exists()


def test_a_title_block_is_for_what_is_drawn(road, block, tmp_path):
    text = refuse("volume", road, "--base", 305, "--title-block", block, "-o", tmp_path / "a.csv",
                  code=2)  # fmt: skip
    assert "--title-block is for a report" in text


def test_spot_heights_come_from_a_spacing_peaks_or_a_file(road, tmp_path):
    places = tmp_path / "spots.gpkg"
    points = [shapely.Point(500010.0, 4000005.0), shapely.Point(500500.0, 4000010.0)]
    pyogrio.raw.write(places, shapely.to_wkb(points), [], [], crs=UTM, geometry_type="Point")
    svg = tmp_path / "a.svg"
    for given, wanted in ((places, ["300.2", "310.0"]), ("peaks", []), ("500", 2)):
        out = run("plan", road, "--spots", given, "--decimals", 1, "--scale", 5000, "-o", svg)
        assert out.exit_code == 0, out.output
        found = [text.text for text in read_svg(svg).named("spot-elevation")]
        assert len(found) == wanted if isinstance(wanted, int) else found == wanted
    assert "none.gpkg" in refuse("plan", road, "--spots", "none.gpkg", "-o", svg)
    assert "--spots" in refuse("plan", road, "--spots", "-5", "-o", svg)


def test_labels_of_points_say_what_is_asked_for(tmp_path):
    svg, drawing = tmp_path / "a.svg", tmp_path / "a.dxf"
    how = ("--crs", UTM, "--codes", "--scale", 500, "--paper", "A1")
    out = run("plan", SITE, *how, "--points", "numbers,codes", "--label-size", 1.4, "-o", svg,
              "-o", drawing)  # fmt: skip
    assert out.exit_code == 0, out.output
    page = read_svg(svg)
    assert "TR PINE, 300mm" in {text.text for text in page.named("point-code")}
    survey = ts.read(SITE, crs=UTM)
    numbers = dict(zip(map(str, survey.attributes["number"]), survey.points, strict=True))
    document = ezdxf.readfile(drawing)
    found = document.modelspace().query('TEXT[layer=="POINT_NUMBERS"]')
    assert len(found) == len(page.named("point-number")) > 500
    for text in found:
        place = numbers[text.dxf.text][:2]
        at = text.dxf.insert if text.dxf.halign == 0 else text.dxf.align_point
        assert np.hypot(at[0] - place[0], at[1] - place[1]) < 1.5
        assert text.dxf.height == pytest.approx(1.4 * 0.5)
    assert "--points" in refuse("plan", SITE, *how, "--points", "names", "-o", svg)


def test_contours_of_a_drawing_have_their_heights(tmp_path):
    drawing = tmp_path / "a.dxf"
    how = ("--crs", UTM, "--codes", "--scale", 500, "--paper", "A1", "--elevation-unit", "m")
    out = run("plan", SITE, *how, "-o", drawing)
    assert out.exit_code == 0, out.output
    ground = ts.triangulate(ts.lines_from_codes(ts.read(SITE, crs=UTM, elevation_unit="m")))
    space = ezdxf.readfile(drawing).modelspace()
    contours = [one for one in space.query("LWPOLYLINE") if "CONTOURS" in one.dxf.layer]
    assert len(contours) > 10
    for one in contours:
        found = ground.interpolate(np.array(one.get_points("xy")))
        assert np.nanmax(np.abs(found - one.dxf.elevation)) < 1e-3
    others = [one for one in space.query("LWPOLYLINE") if "CONTOURS" not in one.dxf.layer]
    assert {one.dxf.elevation for one in others} == {0.0}
