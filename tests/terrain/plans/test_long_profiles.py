"""Long profiles on sheets: read back, they measure like the surfaces and the gradient line."""

import math
import re
import subprocess
from itertools import pairwise

import ezdxf
import numpy as np
import pytest
from support.printed import read_svg

import tinsmith as ts

EAST, NORTH = 500_000.0, 4_000_000.0
UTM = "EPSG:32616"
LINE = np.array([[10.0, 40.0], [200.0, 40.0], [390.0, 90.0]]) + np.array([EAST, NORTH])
POINT = ts.VerticalPoint
RISE = ts.VerticalAlignment(
    [
        POINT(1000.0, 301.0),
        POINT(1120.0, 304.0, "parabola", 30.0, 50.0),
        POINT(1240.0, 303.0),
        POINT(1300.0, 303.5, "arc", radius=2000.0),
        POINT(1380.0, 306.0),
    ],
    "FG",
)
ROAD = ts.Alignment.from_points(LINE, start=1000.0, crs=UTM, verticals=[RISE])


def make(height, origin=(EAST, NORTH), crs=UTM, **how):
    x, y = np.meshgrid(np.arange(0.0, 401.0, 20.0), np.arange(0.0, 121.0, 20.0))
    z = height + 2.0 * np.sin(x / 37) + y / 50
    points = np.column_stack([x.ravel() + origin[0], y.ravel() + origin[1], z.ravel()])
    return ts.triangulate(points, crs=crs, **{"elevation_unit": "m", **how})


@pytest.fixture(scope="module")
def ground():
    return make(302.0)


def read_layer(document, name):
    query = document.modelspace().query(f'LWPOLYLINE[layer=="{name}"]')
    return [np.array(one.get_points("xy")) for one in query]


def test_a_drawing_measures_like_the_surfaces_and_the_gradient_line(ground, tmp_path):
    made = ts.profile_sheets({"EG": ground}, ROAD, scale=1000, exaggeration=5.0, paper="A2")
    assert (len(made), made.exaggeration, made.scale) == (1, 5.0, 1000.0)
    document = ezdxf.readfile(made.save(tmp_path / "a.dxf")[0])
    assert not document.audit().errors
    table = ts.profile(ground, ROAD)
    (eg,), (fg,) = (read_layer(document, name) for name in ("EG", "FG"))
    shift = eg[0, 0] - table["station"][0]
    found = np.interp(table["station"], eg[:, 0] - shift, eg[:, 1])
    assert np.ptp(found - 5.0 * table["elevation"]) < 1e-6
    assert np.isin(np.round(table["station"], 6), np.round(eg[:, 0] - shift, 6)).all()
    stations = np.linspace(1000.0, 1380.0, 500)
    heights = np.interp(stations, fg[:, 0] - shift, fg[:, 1])
    base = found[0] - 5.0 * table["elevation"][0]
    assert heights == pytest.approx(5.0 * RISE.elevations_at(stations) + base, abs=6e-4)


def find_texts(page, name):
    return sorted(page.named(name), key=lambda one: (round(-one.place[1], 1), one.place[0]))


def test_figures_stand_at_their_stations(ground, tmp_path):
    made = ts.profile_sheets({"EG": ground}, ROAD, scale=1000, paper="A2")
    page = read_svg(made.save(tmp_path / "a.svg")[0])
    rows = {}
    for one in page.named("figure"):
        rows.setdefault(round(float(one.place[1]), 1), []).append(one)
    stations, eg, fg, difference = (rows[key] for key in sorted(rows, reverse=True))
    at = np.array([float(one.text) for one in stations])
    assert (np.diff(at) > 0).all()
    assert np.diff([one.place[0] for one in stations]) == pytest.approx(np.diff(at), abs=1e-3)
    levels = ground.interpolate(ROAD.points_at(at))
    assert [float(one.text) for one in eg] == pytest.approx(levels, abs=0.0051)
    wanted = RISE.elevations_at(at)
    for one, value, level in zip(fg, wanted, levels, strict=True):
        assert one.text == (f"{value:.2f}" if math.isfinite(value) else "\N{EN DASH}")
        (beside,) = [d for d in difference if abs(d.place[0] - one.place[0]) < 1e-6]
        if math.isfinite(value):
            assert float(beside.text) == pytest.approx(value - level, abs=0.0051)
    heads = {one.text for one in page.named("figure-name")}
    assert heads == {"Station", "EG", "FG", "difference", "gradient"}
    assert {"EG", "FG", "datum", "grid"} == {one.text for one in page.named("legend")}
    assert "1:100  (10 times)" in {one.text for one in page.named("scale-of-sections")}


def test_the_gradient_line_is_told_tangent_by_tangent(ground, tmp_path):
    made = ts.profile_sheets({"EG": ground}, ROAD, scale=500, paper="A0")
    page = read_svg(made.save(tmp_path / "a.svg")[0])
    reach = 2000.0 * math.tan(abs(math.atan(2.5 / 80) - math.atan(0.5 / 60)) / 2)
    length = 2000.0 * abs(math.atan(2.5 / 80) - math.atan(0.5 / 60))
    texts = [one.text for one in find_texts(page, "gradient-label")]
    assert texts[:4] == [
        "+2.500 %, 90.00", "PVI 1120, 304.00; L 80.00", "-0.833 %, 70.00",
        f"+0.833 %, {60 - reach * math.cos(math.atan(0.5 / 60)):.2f}",
    ]  # fmt: skip
    assert texts[4] == f"PVI 1300, 303.50; L {length:.2f}, R 2000"
    assert texts[5].startswith("+3.125 %, ")
    boxes = sorted(page.paths["gradient"], key=lambda one: one[:, 0].min())
    widths = [float(np.ptp(one[:, 0])) * 0.5 for one in boxes]
    assert widths[:3] == pytest.approx([90.0, 80.0, 70.0], abs=1e-3)
    assert sum(widths) == pytest.approx(380.0, abs=1e-3)


def test_a_long_profile_goes_on_on_the_next_sheet(ground, tmp_path):
    made = ts.profile_sheets({"EG": ground}, ROAD, scale=250, exaggeration=2.0, paper="A4")
    assert len(made) > 1
    pages = [read_svg(file) for file in made.save(tmp_path / "a.svg")]
    heads = [page.named("station-label")[0].text for page in pages]
    ends = [tuple(map(float, re.findall(r"[\d.]+", head))) for head in heads]
    assert ends[0][0] == 1000.0
    assert ends[-1][1] == pytest.approx(ROAD.end, abs=1e-3)
    assert all(before[1] == after[0] for before, after in pairwise(ends))
    for page, (begin, end) in zip(pages, ends, strict=True):
        (frame,) = page.paths["frame-of-section"]
        assert np.ptp(frame[:, 0]) == pytest.approx((end - begin) * 4.0, abs=1e-2)
        for paths in page.paths.values():
            for path in paths:
                assert (path >= -1e-5).all()
                assert (path <= np.array(made.paper) + 1e-5).all()


def test_station_equations_are_written(ground, tmp_path):
    road = ts.Alignment.from_points(LINE, equations=[ts.StationEquation(100.0, ahead=500.0)])
    made = ts.profile_sheets(ground, road, scale=1000, paper="A2")
    page = read_svg(made.save(tmp_path / "a.svg")[0])
    texts = {one.text for one in page.named("figure")}
    assert {"0", "500", "600"} <= texts
    assert "100" not in texts


def test_a_gap_is_told_and_a_profile_of_one_surface_has_no_difference(ground, tmp_path):
    long = [LINE[0], LINE[-1] + [200.0, 50.0]]
    made = ts.profile_sheets(
        ground, long, scale=1000, paper="A1", title_block={"client": "Eastmoor"}
    )
    text = subprocess.run(
        ["pdftotext", "-layout", made.save(tmp_path / "a.pdf")[0], "-"],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    assert "difference" not in text
    assert "\N{EN DASH}" in text
    assert {"Eastmoor", "147 points"} <= set(re.split(r"\s{2,}|\n", text))


def test_grades_are_of_one_unit_where_elevations_have_another(tmp_path):
    feet = make(990.0, (2e6, 6e5), "EPSG:2274", elevation_unit="m")
    line = np.array([[10.0, 40.0], [390.0, 40.0]]) + np.array([2e6, 6e5])
    rise = ts.VerticalAlignment([POINT(0.0, 990.0), POINT(380.0, 1000.0)])
    made = ts.profile_sheets(feet, line, vertical=rise, exaggeration=1.0, paper="A1")
    page = read_svg(made.save(tmp_path / "a.svg")[0])
    (label,) = page.named("gradient-label")
    assert float(label.text.split()[0]) == pytest.approx(100 * 10 / 380 * 3937 / 1200, abs=1e-3)


@pytest.mark.parametrize(
    ("how", "sentence"),
    [
        ({"vertical": "none"}, "Invalid vertical 'none': it must be one of 'FG'."),
        ({"vertical": 5}, "Invalid vertical 5: it must be a VerticalAlignment or a name"),
        ({"scale": 5, "paper": "A4"}, "of the height, and A4 landscape has"),
        ({"exaggeration": 0.0}, "Invalid exaggeration 0.0"),
        ({"exaggeration": 100.0, "scale": 100}, "smaller, or the exaggeration less"),
        ({"line": LINE, "vertical": "FG"}, "a name in an alignment, and there is none"),
    ],
)
def test_what_cannot_be_drawn_is_refused(ground, how, sentence):
    line = how.pop("line", ROAD) if "line" in how else ROAD
    with pytest.raises(ts.OptionError) as raised:
        ts.profile_sheets(ground, line, **how)
    assert sentence in str(raised.value)


def test_one_line_and_one_unit_are_needed(ground):
    with pytest.raises(ts.LinesError, match="runs along one line, and there are 2"):
        ts.profile_sheets(ground, [LINE[:2], LINE[1:]])
    road = ts.Alignment.from_points(LINE, elevation_unit="ft", start=1000.0, verticals=[RISE])
    with pytest.raises(ts.OptionError, match="with elevations in foot"):
        ts.profile_sheets(ground, road)


def test_notes_of_surfaces_and_lines_reach_the_sheets(ground):
    noted = ts.Features.of_lines(LINE, [0, 3], columns={}).with_notes(["One row was left out."])
    made = ts.profile_sheets(make(302.0, elevation_unit=None), noted)
    assert "One row was left out." in made.notes
    assert any("taken to be the metre" in note for note in made.notes)


@pytest.mark.parametrize("kind", ["pdf", "svg", "dxf"])
def test_the_same_profile_makes_the_same_bytes(ground, kind, tmp_path):
    one, other = (
        ts.profile_sheets(ground, ROAD).save(tmp_path / f"{name}.{kind}")[0].read_bytes()
        for name in "ab"
    )
    assert one == other


def test_tangents_too_short_for_their_texts_are_told(ground, tmp_path):
    points = [POINT(1000.0 + k, 301.0 + k % 2 / 10) for k in range(200)]
    rise = ts.VerticalAlignment(points)
    made = ts.profile_sheets(ground, LINE, vertical=rise, start=1000.0)
    page = read_svg(made.save(tmp_path / "a.svg")[0])
    assert len(page.paths["gradient"]) == 199
    assert page.named("gradient-label") == []
    assert made.notes[-1].startswith("Texts were cut")
