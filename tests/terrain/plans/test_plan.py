"""What a plan says, takes and refuses."""

import datetime as dt
import os
import subprocess
import sys
from xml.etree import ElementTree as ET

import matplotlib as mpl
import numpy as np
import pytest
import shapely
from PIL import Image
from support.printed import read_pdf, read_svg

import tinsmith as ts
from tinsmith.terrain.plans.contents import find_lines

SQUARE = [[500000, 4e6, 5], [500040, 4e6, 6], [500040, 4e6 + 30, 7], [500000, 4e6 + 30, 9]]


def square(**how):
    return ts.triangulate(SQUARE, crs="EPSG:32616", elevation_unit="m", **how)


def draw(tin, folder, **how):
    made = ts.plan(tin, **how)
    return made, [read_svg(file) for file in made.save(folder / "plan.svg")]


def texts(page, name=None):
    return [text.text for text in page.texts if name in (None, text.name)]


# ---------------------------------------------------------------- what it says


def test_title_block_says_what_the_plan_is(tmp_path):
    made, (page,) = draw(
        square(), tmp_path, scale=250, title="Yard", date=dt.date(2026, 11, 22), interval=0.5
    )
    assert texts(page, "title") == ["Yard"]
    facts = texts(page, "fact")
    for fact in (
        "WGS 84 / UTM zone 16N (EPSG:32616)",
        "Elevations in m",
        "Contour interval 0.5 m",
        "4 points, 2 triangles",
        "Scale factor of the CRS here 0.999600",
        "1:250",
        "2026-11-22",
        "Sheet 1 of 1",
    ):
        assert fact in facts
    assert made.notes == ()


def test_the_date_is_never_the_clock(tmp_path):
    _, (page,) = draw(square(), tmp_path)
    assert not any(str(dt.date.today().year) in text for text in texts(page))


def test_what_is_chosen_or_assumed_is_told():
    tin = ts.triangulate(SQUARE, crs="EPSG:32616")
    notes = " ".join(ts.plan(tin).notes)
    assert "taken to be the metre" in notes
    assert "interval 0.2 was chosen" in notes


def test_legend_explains_what_is_drawn_and_nothing_else(tmp_path):
    soft = ts.Breakline([[500005, 4e6 + 20, 7], [500010, 4e6 + 25, 7]], kind="soft")
    lines = [[[500005, 4e6 + 5, 6], [500035, 4e6 + 25, 7]], soft]
    _, (page,) = draw(square(breaklines=lines), tmp_path, points="marks")
    assert set(texts(page, "legend")) == {
        "contour", "index contour", "breakline", "soft breakline", "edge of the surface",
        "survey point", "coordinate grid",
    }  # fmt: skip


def test_lines_have_their_kinds(tmp_path):
    ring = [[500002, 4e6 + 2], [500038, 4e6 + 2], [500038, 4e6 + 28], [500002, 4e6 + 28]]
    hole = [[500008, 4e6 + 8], [500012, 4e6 + 8], [500012, 4e6 + 12], [500008, 4e6 + 12]]
    pond = np.array(hole) + np.array([15, 5])
    tin = square(boundary=[ring], holes=[hole], water=[ts.Water(pond, 6.0)])
    _, (page,) = draw(tin, tmp_path)
    assert {"boundary-lines", "hole-lines", "water-lines", "water"} <= set(page.paths)
    (water,) = page.paths["water"]
    assert np.ptp(water, axis=0) == pytest.approx(4.0 * 1000 / ts.plan(tin).scale, rel=1e-5)


def test_constrained_edges_of_a_foreign_mesh_are_lines_but_for_its_rim():
    tin = ts.TIN.from_triangles(
        SQUARE, [[0, 1, 2], [0, 2, 3]], constrained=[[False, True, True], [True, False, False]]
    )
    assert len(tin.lines) == 0
    found = find_lines(tin)
    assert {frozenset(pair) for pair in found.pairs.tolist()} == {frozenset((0, 2))}
    assert len(found.kinds) == 1


def water_area(tin, folder):
    _, (page,) = draw(tin, folder, scale=250)
    return sum(shapely.Polygon(ring).area for ring in page.paths.get("water", [])) / 16.0


POND = np.array([[500005, 4e6 + 5], [500035, 4e6 + 5], [500035, 4e6 + 25], [500005, 4e6 + 25]])


def test_level_ground_around_a_pond_is_no_water(tmp_path):
    level = [[x, y, 6.0] for x, y, _ in SQUARE]
    tin = ts.triangulate(level, crs="EPSG:32616", water=[ts.Water(POND, 6.0)])
    assert water_area(tin, tmp_path) == pytest.approx(600.0, rel=1e-5)


def test_a_pond_that_the_boundary_cuts_is_filled_as_far_as_it_goes(tmp_path):
    ring = [[500000, 4e6], [500020, 4e6], [500020, 4e6 + 30], [500000, 4e6 + 30]]
    tin = square(boundary=[ring], water=[ts.Water(POND, 6.0)])
    assert water_area(tin, tmp_path) == pytest.approx(300.0, rel=1e-5)


def test_points_have_their_numbers_and_elevations(tmp_path):
    survey = ts.Survey(
        points=SQUARE, attributes={"number": np.array([7, 8, 9, 10])}, crs="EPSG:32616"
    )
    tin = ts.triangulate(survey)
    _, (page,) = draw(tin, tmp_path, survey=survey, points="both", labels="none")
    assert texts(page, "point-number") == ["7", "8", "9", "10"]
    assert texts(page, "point-elevation") == ["5", "6", "7", "9"]


def test_labels_of_points_that_would_meet_are_left_out_and_told(tmp_path):
    near = [[500020 + 0.1 * k, 4e6 + 15, 7.123] for k in range(5)]
    made, (page,) = draw(
        ts.triangulate(SQUARE + near, crs="EPSG:32616"), tmp_path, points="elevations"
    )
    assert texts(page, "point-elevation").count("7.123") == 2  # one to either side of them all
    assert "3 labels of points were left out" in made.notes[-1]


@pytest.mark.parametrize("interval", [0.5, 0.25, 0.0125, 1])
def test_labels_have_the_decimals_of_their_levels(interval, tmp_path):
    tin = ts.triangulate([[0, 0, 0], [40, 0, 20 * interval], [0, 40, 0]])
    _, (page,) = draw(tin, tmp_path, interval=interval, ground_unit="m", labels="all")
    found = {float(text) for text in texts(page, "contour-label")}
    assert found
    assert all(round(value / interval, 9) % 1 == 0 for value in found)


def test_labels_of_high_levels_are_not_those_of_binary_numbers(tmp_path):
    tin = ts.triangulate([[0, 0, 200_000.05], [40, 0, 200_001.05], [0, 40, 200_000.05]])
    _, (page,) = draw(tin, tmp_path, interval=0.1, ground_unit="m", labels="all")
    found = texts(page, "contour-label")
    assert "200000.3" in found
    assert all(len(text) == 8 for text in found)


def test_no_labels_no_grid(tmp_path):
    _, (page,) = draw(square(), tmp_path, labels="none", grid="none")
    assert not texts(page, "contour-label")
    assert not texts(page, "grid-label")
    assert "grid-crosses" not in page.paths


def test_grid_as_lines(tmp_path):
    _, (page,) = draw(square(), tmp_path, grid="lines")
    assert len(page.paths["grid-lines"]) == len(page.named("grid-label")) / 2


# ---------------------------------------------------------------- hostile words


@pytest.mark.parametrize(
    "title",
    [
        "</svg><script>alert(1)</script>",
        pytest.param("$\\frac{1}{$ & \\undefined", marks=pytest.mark.slow),
        pytest.param("x" * 10_000, marks=pytest.mark.slow),
        pytest.param("two\nlines\r\n\tof it", marks=pytest.mark.slow),
        "\x00\x08\x1b[31m\ud800",
        pytest.param("%PDF-1.4 (\\)", marks=pytest.mark.slow),
        pytest.param("\u202eright to left \u56f3\u9762", marks=pytest.mark.slow),
        pytest.param(" ", marks=pytest.mark.slow),
    ],
)
def test_hostile_titles_are_only_text(title, tmp_path):
    made = ts.plan(square(), title=title, date=title)
    (svg,), (pdf,), (png,) = (
        made.save(tmp_path / f"plan.{kind}") for kind in ("svg", "pdf", "png")
    )
    root = ET.fromstring(svg.read_bytes())
    assert not any(one.tag.endswith("script") for one in root.iter())
    (written,) = [text.text for text in read_svg(svg).named("title")][:1]
    if title == "$\\frac{1}{$ & \\undefined":
        assert written == title
    assert len(read_pdf(pdf)) == 1
    assert png.read_bytes()[:4] == b"\x89PNG"
    if len(title) > 1000:
        assert any("were cut" in note for note in made.notes)
    if "\u56f3" in title:
        assert any("font has no" in note for note in made.notes)


def test_title_fits_its_cell(tmp_path):
    made, (page,) = draw(square(), tmp_path, title="Northern extension " * 4, paper="A4")
    assert " ".join(texts(page, "title")) == ("Northern extension " * 4).strip()
    assert not any("cut" in note for note in made.notes)


# ---------------------------------------------------------------- small and odd surfaces


def test_one_triangle():
    assert len(ts.plan(ts.triangulate(SQUARE[:3], crs="EPSG:32616"))) == 1


def test_a_flat_surface_has_no_contours_and_says_so(tmp_path):
    flat = np.array(SQUARE)
    flat[:, 2] = 7.0
    made, (page,) = draw(ts.triangulate(flat, crs="EPSG:32616", elevation_unit="m"), tmp_path)
    assert "contours" not in page.paths
    assert "No contours: no level lies within the elevations" in texts(page, "fact")
    assert any("there is no line" in note for note in made.notes)


def test_what_is_no_tin_is_refused():
    for wrong in (None, SQUARE, ts.TIN):
        with pytest.raises(ts.PointsError, match="one made by triangulate is needed"):
            ts.plan(wrong)


def test_ten_thousand_levels_are_refused():
    with pytest.raises(ts.OptionError, match=r"at most 2,000 levels on a plan, .* 10,000"):
        ts.plan(square(), interval=4 / 10_000)


@pytest.mark.parametrize("interval", [0, -1, float("nan"), float("inf"), "1", True])
def test_intervals_that_are_none(interval):
    with pytest.raises(ts.OptionError, match="interval"):
        ts.plan(square(), interval=interval)


# ---------------------------------------------------------------- scales and papers


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (500, "1:500"),
        ("1:500", "1:500"),
        (" 1 : 2,500 ", "1:2500"),
        ("1/1000", "1:1000"),
        (np.int64(750), "1:750"),
        ("1\"=20'", "1\" = 20'  (1:240)"),
        ("1 inch = 100 feet", "1\" = 100'  (1:1200)"),
    ],
)
def test_scales_as_they_are_written(given, text):
    assert ts.plan(square(), scale=given, paper="A0").scale_text == text


@pytest.mark.parametrize(
    "scale", [0, -5, 0.5, float("nan"), "1:0", "x", "2:500", True, [], "1:1e9"]
)
def test_scales_that_are_none(scale):
    with pytest.raises(ts.OptionError, match="scale"):
        ts.plan(square(), scale=scale)


def test_the_largest_usual_scale_that_fits_is_chosen():
    made = ts.plan(square(), paper="A4")
    assert made.scale_text == "1:250"
    with pytest.raises(ts.OptionError, match="1:250 or smaller on A4 landscape"):
        ts.plan(square(), paper="A4", scale=200)


@pytest.mark.parametrize(
    "paper", ["A5", "", "B3", (10, 10), (6000, 300), (1, 2, 3), 7, None, (np.nan, 300)]
)
def test_papers_that_are_none(paper):
    with pytest.raises(ts.OptionError, match="paper"):
        ts.plan(square(), paper=paper)


def test_orientation_is_the_better_one_or_the_given_one():
    tall = [[500000, 4e6, 5], [500010, 4e6, 6], [500010, 4e6 + 120, 7]]
    tin = ts.triangulate(tall, crs="EPSG:32616")
    assert ts.plan(tin).paper == (297.0, 420.0)
    assert ts.plan(tin, orientation="landscape").paper == (420.0, 297.0)


@pytest.mark.parametrize(
    "wrong",
    [
        {"orientation": "upright"},
        {"layout": "tiles"},
        {"labels": "some"},
        {"points": "all"},
        {"grid": "dots"},
        {"title": 5},
        {"date": 20261122},
        {"survey": "survey"},
        {"layout": "rows"},
        {"axis": [[500000, 4e6], [500040, 4e6]], "station_range": (0, 9)},
        {"points": "numbers"},
        {"ground_unit": "ft"},
        {"ground_unit": "furlongs"},
        {"smooth": -1},
        {"paper": (500, 300), "orientation": "portrait"},
    ],
)
def test_options_that_are_wrong_are_refused_in_a_sentence(wrong):
    with pytest.raises(ts.OptionError, match=r"\.$"):
        ts.plan(square(), **wrong)


# ---------------------------------------------------------------- CRS and units


def test_degrees_are_refused():
    tin = ts.TIN.from_triangles([[10, 50, 5], [10.1, 50, 6], [10, 50.1, 7]], [[0, 1, 2]], crs=4326)
    with pytest.raises(ts.CrsError, match="angles: reproject to a projected CRS first"):
        ts.plan(tin)


def test_an_unknown_unit_is_refused_or_given(tmp_path):
    tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 7]])
    with pytest.raises(ts.CrsError, match="unit of eastings and northings is not known"):
        ts.plan(tin, scale=500)
    sides = {}
    for unit in ("m", "ft"):
        _, (page,) = draw(tin, tmp_path, scale=500, ground_unit=unit)
        sides[unit] = np.ptp(page.paths["outline"][0], axis=0)
    assert sides["m"] == pytest.approx([80.0, 60.0], rel=1e-6)
    assert sides["ft"] == pytest.approx([24.384, 18.288], rel=1e-6)


def test_web_mercator_is_refused_where_its_scale_is_wrong():
    tin = ts.triangulate([[1e6, 6e6, 5], [1e6 + 40, 6e6, 6], [1e6, 6e6 + 30, 7]], crs="EPSG:3857")
    with pytest.raises(ts.CrsError, match=r"1\.\d+ times those on the ground"):
        ts.plan(tin)


def test_a_scale_factor_off_one_is_told():
    tin = ts.triangulate([[1e6, 4e6, 5], [1e6 + 40, 4e6, 6], [1e6, 4e6 + 30, 7]], crs="EPSG:32616")
    assert any("times those on the ground" in note for note in ts.plan(tin).notes)


def test_a_survey_in_another_crs_is_refused():
    survey = ts.Survey(points=SQUARE, crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="the survey"):
        ts.plan(square(), survey=survey)


# ---------------------------------------------------------------- files


@pytest.mark.slow
def test_files_are_the_same_in_every_process(tmp_path):
    script = (
        "import sys, tinsmith as ts\n"
        "made = ts.plan(ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]]), ground_unit='m',\n"
        "               title='Plan \\u56f3', points='elevations', paper='A4')\n"
        "for kind in ('pdf', 'svg', 'png'): made.save(f'{sys.argv[1]}.{kind}', dpi=50)\n"
    )
    for name in ("1", "2"):
        subprocess.run(
            [sys.executable, "-c", script, tmp_path / name],
            check=True,
            env=os.environ | {"PYTHONHASHSEED": name, "TZ": f"UTC+{name}"},
        )
    for kind in ("pdf", "svg", "png"):
        first, second = ((tmp_path / f"{name}.{kind}").read_bytes() for name in "12")
        assert first == second
    assert b"/Producer" not in (tmp_path / "1.pdf").read_bytes()


def test_the_callers_own_settings_change_nothing(tmp_path):
    (before,) = ts.plan(square()).save(tmp_path / "before.pdf")
    with mpl.rc_context({"savefig.bbox": "tight", "text.usetex": True, "font.size": 30}):
        (after,) = ts.plan(square()).save(tmp_path / "after.pdf")
        assert mpl.rcParams["text.usetex"]
    assert before.read_bytes() == after.read_bytes()


def test_letters_stay_text_in_a_pdf_with_its_font(tmp_path):
    (file,) = ts.plan(square(), title="Yard (north)").save(tmp_path / "plan.pdf")
    (page,) = read_pdf(file)
    assert "Yard (north)" in [text.text for text in page.texts]
    data = file.read_bytes()
    assert b"/FontFile2" in data
    assert b"/ToUnicode" in data


def test_without_matplotlib_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ts.MissingExtraError, match="plot"):
        ts.plan(square())


def test_a_png_has_the_pixels_of_its_paper(tmp_path):
    (file,) = ts.plan(square(), paper="A4").save(tmp_path / "plan.png", dpi=100)
    with Image.open(file) as picture:
        assert picture.size == (1169, 826)
        assert picture.info["dpi"] == pytest.approx((100, 100), abs=0.01)


@pytest.mark.parametrize("dpi", [0, 49, 1201, 2.5, None, "200"])
def test_dots_that_are_none(dpi, tmp_path):
    with pytest.raises(ts.OptionError, match="dpi"):
        ts.plan(square()).save(tmp_path / "plan.png", dpi=dpi)


def test_a_picture_with_too_many_pixels_is_refused(tmp_path):
    with pytest.raises(ts.OptionError, match=r"at most \d+ on this paper"):
        ts.plan(square(), paper="A0").save(tmp_path / "plan.png", dpi=1200)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "error"),
    [
        ("plan.jpg", ts.RenderError),
        ("plan", ts.RenderError),
        ("no/plan.pdf", ts.WriteError),
        (7, ts.OptionError),
    ],
)
def test_paths_that_cannot_be_written(name, error, tmp_path):
    path = tmp_path / name if isinstance(name, str) else name
    with pytest.raises(error):
        ts.plan(square()).save(path)
    assert list(tmp_path.iterdir()) == []


def test_a_failed_drawing_leaves_the_old_file(tmp_path, monkeypatch):
    from tinsmith.terrain.plans import production

    file = tmp_path / "plan.pdf"
    file.write_bytes(b"old")

    def fail(*_args, **_how):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(production, "draw_title_block", fail)
    with pytest.raises(ts.WriteError, match="No space left"):
        ts.plan(square()).save(file)
    assert file.read_bytes() == b"old"
    assert [one.name for one in tmp_path.iterdir()] == ["plan.pdf"]
