"""Sections on paper measure right: read back from PDF, SVG and DXF by other programs."""

import re
import subprocess
from itertools import pairwise
from xml.etree import ElementTree as ET

import ezdxf
import numpy as np
import pytest
from support.printed import read_svg

import tinsmith as ts

UTM = "EPSG:32616"
EAST, NORTH = 500_000.0, 4_000_000.0
CORNERS = np.array([[-60, -60], [160, -60], [160, 60], [-60, 60]], float)
LINE = [[EAST, NORTH], [EAST + 95, NORTH]]
WHERE = {"interval": 10, "left": 20, "right": 30}
BORDER = 8.0
"""Millimetres of white around the border."""


def plane(height, corners=CORNERS, origin=(EAST, NORTH), **more):
    """A surface over corners from an origin, whose elevations are a function of both."""
    rows = [[origin[0] + x, origin[1] + y, height(x, y)] for x, y in corners.tolist()]
    return ts.triangulate(rows, **({"crs": UTM, "elevation_unit": "m"} | more))


@pytest.fixture(scope="module")
def site():
    rng = np.random.default_rng(5)
    xy = np.concatenate([CORNERS, rng.uniform([-50, -50], [150, 50], (300, 2))])
    z = 320 + xy[:, 0] / 40 + 2 * np.sin(xy[:, 1] / 9) + rng.uniform(0, 0.5, len(xy))
    rows = np.column_stack([xy + np.array([EAST, NORTH]), z])
    ground = ts.triangulate(rows, crs=UTM, elevation_unit="m")
    return {"ground": ground, "design": plane(lambda x, y: 321 + x / 50)}


def read_words(path):
    """Return the pages of a PDF: width, height, and words with their boxes, millimetres."""
    text = subprocess.run(
        ["pdftotext", "-bbox", path, "-"], capture_output=True, text=True, check=True
    ).stdout
    pages = []
    for page in ET.fromstring(text).iter("{http://www.w3.org/1999/xhtml}page"):
        words = [
            (
                one.text,
                [25.4 / 72 * float(one.attrib[f"{a}{b}"]) for b in ("Min", "Max") for a in "xy"],
            )
            for one in page
        ]
        size = [25.4 / 72 * float(page.attrib[side]) for side in ("width", "height")]
        pages.append((size, words))
    return pages


def list_stations(path):
    """Return the stations above sections, page by page, in columns from the bottom up."""
    found = []
    for _, words in read_words(path):
        placed = [
            (round(box[0]), -box[1], float(after))
            for (one, box), (after, _) in pairwise(words)
            if one == "Station"
        ]
        found.append([station for _, _, station in sorted(placed)])
    return found


def test_every_section_is_on_one_page_and_both_ends_are_there(site, tmp_path):
    made = ts.section_sheets(site, LINE, **WHERE, scale=200)
    (file,) = made.save(tmp_path / "road.pdf")
    pages = list_stations(file)
    assert len(pages) == len(made) > 1
    assert [one for page in pages for one in page] == [*range(0, 100, 10), 95]
    assert made.sections == 11


def test_pages_have_the_size_of_the_paper_and_words_stay_within_the_border(site, tmp_path):
    made = ts.section_sheets(site, LINE, **WHERE, paper="A2", title="Road", date="2026-11-27")
    (file,) = made.save(tmp_path / "road.pdf")
    for size, words in read_words(file):
        assert size == pytest.approx((594.0, 420.0), abs=1e-2)
        boxes = np.array([box for _, box in words])
        assert boxes.min() >= BORDER
        assert (boxes[:, 2:] <= np.array(size) - BORDER).all()
        assert {"Road", "2026-11-27", made.scale_text} <= {text for text, _ in words}


def test_words_do_not_meet(site, tmp_path):
    (file,) = ts.section_sheets(site, LINE, **WHERE).save(tmp_path / "road.pdf")
    for _, words in read_words(file):
        boxes = np.array([box for _, box in words])
        middles = (boxes[:, 1] + boxes[:, 3]) / 2
        for box, middle in zip(boxes, middles, strict=True):
            meets = (boxes[:, 0] < box[2] - 0.05) & (boxes[:, 2] > box[0] + 0.05)
            meets &= abs(middles - middle) < 1.0
            assert meets.sum() == 1


def test_an_svg_measures_true_to_scale_against_the_table(site, tmp_path):
    made = ts.section_sheets(
        site, LINE, stations=[40], left=20, right=30, scale=250, exaggeration=2
    )
    (file,) = made.save(tmp_path / "one.svg")
    page = read_svg(file)
    assert (page.width, page.height) == pytest.approx(made.paper, abs=1e-4)
    table = ts.cross_sections(site, LINE, stations=[40], left=20, right=30)
    for number, name in enumerate(site, 1):
        (drawn,) = page.paths[f"surface{number}"]
        assert np.ptp(drawn[:, 0]) == pytest.approx(50 * 1000 / 250, abs=1e-3)
        heights = (drawn[:, 1] - drawn[0, 1]) * 250 / 1000 / 2
        expected = table[f"elevation_{name}"]
        assert heights == pytest.approx(expected - expected[0], abs=1e-4)


def test_labels_stand_where_they_say(site, tmp_path):
    made = ts.section_sheets(site, LINE, stations=[40], left=20, right=30, scale=250)
    page = read_svg(made.save(tmp_path / "one.svg")[0])
    labels = page.named("elevation-label")
    levels = np.array([float(one.text) for one in labels])
    heights = np.array([one.place[1] for one in labels])
    slope, _ = np.polyfit(levels, heights, 1)
    assert slope == pytest.approx(1000 / 250, rel=1e-3)
    (drawn,) = page.paths["surface1"]
    table = ts.cross_sections(site, LINE, stations=[40], left=20, right=30)
    told = levels[0] + (drawn[:, 1] - page.paths["datum"][0][0, 1]) * 250 / 1000
    assert told == pytest.approx(table["elevation_ground"], abs=1e-3)
    figures = {one.text for one in page.named("figure")}
    for offset in range(-20, 31, 10):
        at = [EAST + 40, NORTH - offset]
        assert str(offset) in figures
        for tin in site.values():
            assert f"{tin.interpolate([at])[0]:.2f}" in figures


def test_areas_are_those_of_section_volumes(site, tmp_path):
    (file,) = ts.section_sheets(site, LINE, **WHERE).save(tmp_path / "road.pdf")
    text = subprocess.run(["pdftotext", file, "-"], capture_output=True, text=True, check=True)
    found = re.findall(r"Cut ([\d.,]+) m²\s+Fill ([\d.,]+) m²", text.stdout)
    table = ts.section_volumes(*site.values(), LINE, **WHERE)
    areas = zip(table["cut_area"], table["fill_area"], strict=True)
    assert sorted(found) == sorted((f"{cut:,.2f}", f"{fill:,.2f}") for cut, fill in areas)


def test_hatched_areas_are_the_areas(tmp_path):
    level, wedge = plane(lambda _x, _y: 0.0), plane(lambda _x, y: y / 10)
    made = ts.section_sheets([level, wedge], LINE, stations=[40], left=20, right=30, scale=250)
    page = read_svg(made.save(tmp_path / "one.svg")[0])
    for kind, area in (("fill", 20 * 2 / 2), ("cut", 30 * 3 / 2)):
        (ring,) = page.paths[kind]
        x, y = ring.T
        drawn = abs(np.sum(x * np.roll(y, 1) - np.roll(x, 1) * y)) / 2
        assert drawn * (250 / 1000) ** 2 == pytest.approx(area, rel=1e-4)
        assert page.paths[f"{kind}-hatch"]


def read_dxf(path):
    document = ezdxf.readfile(path)
    assert not document.audit().errors
    return document


def test_a_drawing_is_sound_and_measures_like_the_table(site, tmp_path):
    made = ts.section_sheets(site, LINE, **WHERE, scale=200)
    (file,) = made.save(tmp_path / "road.dxf")
    document = read_dxf(file)
    assert document.header["$INSUNITS"] == 6
    layers = {layer.dxf.name for layer in document.layers}
    assert {"ground", "design", "GRID", "CUT", "FILL", "LABELS", "CENTRELINE", "SHEET"} <= layers
    table = ts.cross_sections(site, LINE, **WHERE)
    for name in site:
        lines = [
            np.array(one.get_points("xy"))
            for one in document.modelspace().query(f'LWPOLYLINE[layer=="{name}"]')
        ]
        assert len(lines) == made.sections
        for number, line in enumerate(lines):
            own = table["section"] == number
            offsets, heights = table["offset"][own], table[f"elevation_{name}"][own]
            assert np.diff(line[:, 0]) == pytest.approx(np.diff(offsets), abs=1e-6)
            assert np.diff(line[:, 1]) == pytest.approx(np.diff(heights), abs=1e-6)
    texts = [one.dxf.text for one in document.modelspace().query("TEXT")]
    stations = [text for text in texts if text.startswith("Station")]
    assert len(stations) == len(set(stations)) == made.sections


def test_sheets_of_a_drawing_lie_side_by_side(site, tmp_path):
    made = ts.section_sheets(site, LINE, **WHERE, scale=200)
    document = read_dxf(made.save(tmp_path / "road.dxf")[0])
    wide = made.paper[0] * 200 / 1000
    rings = [np.array(one.get_points("xy")) for one in document.modelspace().query("LWPOLYLINE")]
    borders = [ring for ring in rings if np.ptp(ring[:, 0]) == pytest.approx(wide - 3.2)]
    boxes = sorted(
        {
            (float(ring[:, 0].min()), float(ring[:, 0].max()))
            for ring in borders
            if np.ptp(ring[:, 1]) > 0
        }
    )
    assert len(boxes) == len(made)
    assert all(one[1] < other[0] for one, other in pairwise(boxes))
    low, high = np.concatenate(rings).min(axis=0), np.concatenate(rings).max(axis=0)
    assert (low[0], high[0]) == pytest.approx((boxes[0][0], boxes[-1][1]))


def test_odd_names_become_layers_of_their_own(tmp_path):
    names = ["a/b", "A/B", "GRID", "x" * 300]
    surfaces = {name: plane(lambda x, y, z=z: z + x / 90) for z, name in enumerate(names)}
    (file,) = ts.section_sheets(surfaces, LINE, stations=[40], width=20).save(tmp_path / "a.dxf")
    found = {layer.dxf.name for layer in read_dxf(file).layers}
    assert {"a_b", "A_B_2", "GRID_2", "x" * 100} <= found


@pytest.mark.parametrize(("crs", "unit"), [("EPSG:2274", "m"), (None, "ft"), (UTM, "ft")])
def test_elevations_in_another_unit_are_drawn_in_the_unit_of_eastings(crs, unit, tmp_path):
    is_feet = crs == "EPSG:2274"
    origin = (2e6, 5e5) if is_feet else (EAST, NORTH)
    tin = plane(lambda _x, y: y / 10, origin=origin, crs=crs, elevation_unit=unit)
    line = np.array(LINE) - [EAST, NORTH] + origin
    along = 1200 / 3937 if is_feet else 1.0
    ground = {"ground_unit": "m"} if crs is None else {}
    made = ts.section_sheets([tin, tin], line, stations=[40], width=40, scale=250, **ground)
    page = read_svg(made.save(tmp_path / "one.svg")[0])
    (drawn,) = page.paths["surface1"]
    up = 1.0 if unit == "m" else 0.3048
    assert np.ptp(drawn[:, 0]) == pytest.approx(40 * along * 1000 / 250, rel=1e-4)
    assert np.ptp(drawn[:, 1]) == pytest.approx(4 * up * 1000 / 250, rel=1e-4)


def test_stations_are_written_with_station_equations(site, tmp_path):
    road = ts.Alignment.from_points(
        LINE, equations=[ts.StationEquation(50.0, ahead=200.0)], crs=UTM
    )
    (file,) = ts.section_sheets(site, road, interval=25, width=30).save(tmp_path / "road.svg")
    texts = [one.text for one in read_svg(file).named("station-label")]
    assert texts == [
        "Station 0.00 m  (length 0.00)",
        "Station 25.00 m  (length 25.00)",
        "Station 200.00 m  (length 50.00)",
        "Station 225.00 m  (length 75.00)",
        "Station 245.00 m  (length 95.00)",
    ]


def test_stations_near_each_other_are_told_apart(site, tmp_path):
    stations = [40, 40.001, 40.002]
    (file,) = ts.section_sheets(site, LINE, stations=stations, width=9).save(tmp_path / "a.svg")
    texts = [one.text for one in read_svg(file).named("station-label")]
    assert texts == ["Station 40.000 m", "Station 40.001 m", "Station 40.002 m"]


def test_a_section_without_a_surface_says_so(site, tmp_path):
    small = plane(lambda _x, _y: 322.0, CORNERS * 0.3)
    made = ts.section_sheets({"ground": site["ground"], "pad": small}, LINE, **WHERE)
    text = "".join(file.read_text() for file in made.save(tmp_path / "a.svg"))
    assert text.count(">No pad here<") == 6  # the pad ends 48 m along
    assert any("no surface 'pad'" in note for note in made.notes)


def test_what_is_too_large_is_refused_with_the_scale_that_fits(site):
    with pytest.raises(ts.OptionError, match=r"1:200 or smaller, .* on A4 landscape") as caught:
        ts.section_sheets(site, LINE, **WHERE, scale=50, paper="A4", orientation="landscape")
    assert caught.value.option == "scale"
    made = ts.section_sheets(site, LINE, **WHERE, scale=200, paper="A4", orientation="landscape")
    assert made.sections == 11


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("exaggeration", 0), ("exaggeration", float("nan")), ("exaggeration", 101), ("scale", 0),
        ("paper", "B9"), ("title", 7), ("ground_unit", "ft"), ("orientation", "flat"),
        ("interval", 0.01),
    ],
)  # fmt: skip
def test_options_that_cannot_be_are_refused(site, option, value):
    with pytest.raises(ts.OptionError):
        ts.section_sheets(site, LINE, **(WHERE | {option: value}))


def test_a_scale_finer_than_elevations_is_refused():
    high = plane(lambda _x, y: 1e14 + y)
    with pytest.raises(ts.OptionError, match="not known so finely"):
        ts.section_sheets(high, LINE, **WHERE, scale=200)


@pytest.mark.parametrize("kind", ["pdf", "svg", "dxf"])
def test_the_same_sections_make_the_same_bytes(site, kind, tmp_path):
    made = [ts.section_sheets(site, LINE, **WHERE, paper="A1") for _ in range(2)]
    files = [one.save(tmp_path / f"{number}.{kind}") for number, one in enumerate(made)]
    first, second = ([file.read_bytes() for file in each] for each in files)
    assert first == second


def test_other_suffixes_are_refused_before_anything_is_drawn(site, tmp_path):
    made = ts.section_sheets(site, LINE, **WHERE)
    with pytest.raises(ts.RenderError, match=r"section sheets to .*\.pdf, \.svg, \.dxf"):
        made.save(tmp_path / "road.png")
    assert not list(tmp_path.iterdir())


def test_notes_of_surfaces_and_lines_reach_the_sheets(site):
    tin = site["ground"].with_notes(["One shot was left out."])
    line = ts.Features.of_lines(LINE, [0, 2], crs=UTM).with_notes(["A line was closed."])
    notes = ts.section_sheets(tin, line, **WHERE).notes
    assert any("One shot was left out." in note for note in notes)
    assert any("A line was closed." in note for note in notes)


def test_texts_that_had_no_room_are_told(site, tmp_path):
    made = ts.section_sheets(site, LINE, **WHERE, title="long " * 60)
    assert not any("cut" in note for note in made.notes)
    made.save(tmp_path / "road.pdf")
    assert any(note.startswith("Texts were cut") for note in made.notes)


def test_ink_of_the_drawing_is_seen_on_windows_of_any_colour(site, tmp_path):
    """Number 7 is black on white windows; true colours are those of surfaces and areas."""
    import ezdxf

    (path,) = ts.section_sheets(site, LINE, **WHERE).save(tmp_path / "a.dxf")
    drawn = list(ezdxf.readfile(path).modelspace())
    texts = [one for one in drawn if one.dxftype() == "TEXT" and one.dxf.layer == "SHEET"]
    assert texts
    assert {one.dxf.color for one in texts} == {7}
    grey = [one.rgb for one in drawn if one.rgb is not None and len({*one.rgb}) == 1]
    assert grey == []
    assert len({one.rgb for one in drawn if one.rgb is not None}) >= 4
