"""Alignments of LandXML, DXF and vector files: those of other programs, written and read again."""

import math
import re
from pathlib import Path

import ezdxf
import numpy as np
import pytest

import tinsmith as ts

DATA = Path(__file__).parents[2] / "data/landxml"
INFRAMODEL = sorted(DATA.glob("inframodel_*_alignment.xml"))
LAND_DESKTOP = DATA / "land_desktop_2005_alignments.xml"
KINDS = ("clothoid", "bloss", "cosine", "sinusoid", "biquadratic", "cubic parabola")
CORNERS = [[0, 0], [300, 20], [400, 300], [800, 250]]


def stated_lengths(path):
    return [
        float(one) for one in re.findall(r'<Alignment [^>]*length="([\d.]+)"', path.read_text())
    ]


def require_same(road, other, tolerance=1e-8):
    at = np.linspace(road.start, road.end, 301)
    assert other.end == pytest.approx(road.end, abs=tolerance)
    there = other.points_at(np.clip(at, other.start, other.end))
    np.testing.assert_allclose(there, road.points_at(at), atol=tolerance)


@pytest.mark.parametrize("path", INFRAMODEL, ids=lambda path: path.stem)
def test_axes_of_3d_win_have_the_lengths_that_it_states(path):
    road = ts.read_alignment(path)
    assert str(road.crs) == str(ts.CRS("EPSG:3875"))
    assert road.length == pytest.approx(stated_lengths(path)[0], abs=2e-6)
    # Every element states the station at which it begins.
    stations = [
        float(one)
        for one in re.findall(r'<(?:Line|Curve) [^>]*staStart="([\d.]+)"', path.read_text())
    ]
    np.testing.assert_allclose(road.tabulate()["station"], stations, atol=2e-6)
    assert not road.notes


def test_vertical_arcs_of_3d_win_meet_its_points():
    road = ts.read_alignment(INFRAMODEL[0])
    vertical = road.find_vertical()
    lengths = [
        float(one) for one in re.findall(r'<CircCurve length="([\d.]+)"', INFRAMODEL[0].read_text())
    ]
    known = [one for one in vertical.curve_lengths if one]
    np.testing.assert_allclose(known, lengths, atol=2e-5)
    steps = np.linspace(vertical.start, vertical.end, 20_001)
    grades = np.diff(vertical.elevations_at(steps)) / np.diff(steps)
    off = np.abs(grades - vertical.grades_at((steps[1:] + steps[:-1]) / 2)) > 1e-4
    bare = [one.station for one in vertical.points[1:-1] if one.kind is None]
    # Only where tangents meet without a curve the grade breaks within a step.
    assert np.flatnonzero(off).tolist() == (np.searchsorted(steps, bare) - 1).tolist()


def test_all_alignments_of_land_desktop_are_read_by_name_and_number():
    with pytest.raises(ts.ReadError, match="6 alignments"):
        ts.read_alignment(LAND_DESKTOP)
    for number, length in enumerate(stated_lengths(LAND_DESKTOP), 1):
        road = ts.read_alignment(LAND_DESKTOP, number)
        assert road.length == pytest.approx(length, abs=1e-6)
        named = ts.read_alignment(LAND_DESKTOP, road.name)
        require_same(road, named, 0.0)
        assert any("Not read: 5 alignments" in note for note in road.notes)
    with pytest.raises(ts.OptionError, match="'1stave'"):
        ts.read_alignment(LAND_DESKTOP, "9thave")


def test_a_file_of_alignments_alone_says_what_reads_them():
    with pytest.raises(ts.ReadError, match="6 alignments: see read_alignment"):
        ts.read(LAND_DESKTOP)


def test_a_vertical_alignment_whose_curves_overlap_is_left_out_and_told():
    road = ts.read_alignment(LAND_DESKTOP, "loop")
    assert not road.verticals
    assert any("'FGCenter'" in note and "645.423" in note for note in road.notes)


# ---------------------------------------------------------------- written and read again


def make_road(kind, **more):
    """A line, a transition, an arc, a transition back, and a line, to either side."""
    elements, start, direction = [], (1000.0, 2000.0), 0.3
    parts = [("line", 50, 0, 0), (kind, 60, 0, 0.01), ("arc", 40, 0.01, 0.01), (kind, 60, 0.01, 0)]
    parts += [(kind, 45, 0, -1 / 70), ("arc", 30, -1 / 70, -1 / 70), (kind, 45, -1 / 70, 0)]
    for name, length, first, last in [*parts, ("line", 20, 0, 0)]:
        elements.append(ts.Element(name, start, direction, length, first, last))
        start, direction = elements[-1].end, elements[-1].end_direction
    return ts.Alignment(elements, **more)


@pytest.mark.parametrize("kind", [*KINDS, "sine half-wave"])
def test_every_kind_of_element_comes_back(kind, tmp_path):
    road = make_road(kind, name="A & B", start=1200.0, crs="EPSG:32616")
    back = ts.read_alignment(ts.write(road, tmp_path / "road.xml"))
    require_same(road, back)
    assert [one.kind for one in back.elements] == [one.kind for one in road.elements]
    assert (back.name, back.start, back.crs) == ("A & B", 1200.0, road.crs)
    assert not back.notes
    for before, after in zip(back.elements, back.elements[1:], strict=False):
        assert math.cos(before.end_direction - after.direction) > 1 - 1e-14


def test_equations_and_vertical_alignments_come_back(tmp_path):
    points = [
        ts.VerticalPoint(1200, 10),
        ts.VerticalPoint(1290, 15, "parabola", 20, 20),
        ts.VerticalPoint(1400, 12, "parabola", 20, 40),
        ts.VerticalPoint(1480, 16, "arc", radius=300),
        ts.VerticalPoint(1540, 14),
    ]
    verticals = [ts.VerticalAlignment(points, "design"), ts.VerticalAlignment(points[::4], "old")]
    jumps = [ts.StationEquation(1300, 5000), ts.StationEquation(1400, 60, False)]
    how = {"start": 1200.0, "crs": "EPSG:32616", "elevation_unit": "m"}
    road = make_road("clothoid", equations=jumps, verticals=verticals, **how)
    back = ts.read_alignment(ts.write(road, tmp_path / "road.xml"))
    assert back.equations == road.equations
    at = np.linspace(1200, 1540, 77)
    for one in verticals:
        np.testing.assert_array_equal(back.elevations_at(at, one.name), one.elevations_at(at))


def test_the_same_alignment_in_feet_and_in_mirrored_axes(tmp_path):
    for crs in ("EPSG:2264", "EPSG:2048", "EPSG:2180"):
        road = make_road("clothoid", crs=crs)
        require_same(road, ts.read_alignment(ts.write(road, tmp_path / "road.xml")))


def test_vertical_arcs_need_elevations_in_the_unit_of_stations(tmp_path):
    points = [ts.VerticalPoint(0, 10), ts.VerticalPoint(150, 15, "arc", radius=900)]
    rise = ts.VerticalAlignment([*points, ts.VerticalPoint(340, 12)], "design")
    how = {"verticals": [rise], "crs": "EPSG:32616"}
    with pytest.raises(ts.OptionError, match="where vertical curves are arcs"):
        make_road("clothoid", elevation_unit="ft", **how)
    path = ts.write(make_road("clothoid", elevation_unit="m", **how), tmp_path / "road.xml")
    text = path.read_text().replace('elevationUnit="meter" ', "")
    path.write_text(text.replace('linearUnit="meter"', 'linearUnit="meter" elevationUnit="feet"'))
    road = ts.read_alignment(path, elevation_unit="ft")
    assert not road.verticals
    assert any("another unit than stations" in note for note in road.notes)


def test_another_crs_is_refused_and_an_unknown_one_declared(tmp_path):
    path = ts.write(make_road("bloss", crs="EPSG:32616"), tmp_path / "road.xml")
    with pytest.raises(ts.CrsError, match="no arcs there"):
        ts.read_alignment(path, crs="EPSG:32617")
    with pytest.warns(ts.LossWarning, match="no units"):
        path = ts.write(make_road("bloss"), tmp_path / "plain.xml")
    assert ts.read_alignment(path, crs="EPSG:32616").crs.label == "EPSG:32616"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('rot="cw"', 'rot="left"', "cw or ccw"),
        ('spiType="clothoid"', 'spiType="weinerBogen"', "whose form is not known here"),
        (r'radius="[\d.]+"', 'radius="93.0"', "does not fit together"),
        (r'<Spiral length="60', '<Spiral length="61', "does not fit together"),
        (r"<Line length=\"50[\d.]*\"", '<Line length="51"', "does not fit together"),
        (r"<End>.*?</End>", "", "no End"),
        (r"<Start>\S+", "<Start>abc", "abc"),
        ('radiusStart="INF"', 'radiusStart="100.0"', "same radius at both ends"),
        (r"<CoordGeom>.*</CoordGeom>", "", "without a CoordGeom"),
        (r"<PI>\S+ \S+</PI>", "<PI>2000.0 1300.0</PI>", "by its PI"),
    ],
)
def test_files_that_contradict_themselves_are_refused_with_their_line(old, new, words, tmp_path):
    path = ts.write(make_road("clothoid", crs="EPSG:32616"), tmp_path / "road.xml")
    text, count = re.subn(old, new, path.read_text(), count=1, flags=re.S)
    assert count
    path.write_text(text)
    with pytest.raises(ts.ReadError, match=words):
        ts.read_alignment(path)


def test_an_arc_without_a_centre_has_its_radius(tmp_path):
    road = make_road("clothoid", crs="EPSG:32616")
    path = ts.write(road, tmp_path / "road.xml")
    path.write_text(re.sub(r"<Center>.*?</Center>", "", path.read_text()))
    require_same(road, ts.read_alignment(path))


# ---------------------------------------------------------------- drawings and vector files


def bulges(road):
    rows = [(*one.start, math.tan(one.start_curvature * one.length / 4)) for one in road.elements]
    return [*rows, (*road.elements[-1].end, 0.0)]


@pytest.mark.parametrize("extrusion", [(0, 0, 1), (0, 0, -1)])
def test_a_polyline_with_bulges_is_an_alignment_of_arcs(extrusion, tmp_path):
    road = ts.Alignment.from_points(CORNERS, radii=[90, 60])
    document = ezdxf.new()
    rows = bulges(road)
    if extrusion[2] < 0:
        rows = [(-x, y, -bulge) for x, y, bulge in rows]
    how = {"format": "xyb", "dxfattribs": {"extrusion": extrusion}}
    document.modelspace().add_lwpolyline(rows, **how)
    document.saveas(tmp_path / "axis.dxf")
    back = ts.read_alignment(tmp_path / "axis.dxf")
    require_same(road, back)
    assert [one.kind for one in back.elements] == ["line", "arc", "line", "arc", "line"]


def test_lines_and_arcs_are_joined_end_to_end(tmp_path):
    road = ts.Alignment.from_points(CORNERS, radii=[90, 60])
    document = ezdxf.new()
    space = document.modelspace()
    for k in (0, 3, 1, 4, 2):
        one = road.elements[k]
        if one.kind == "line":
            ends = (one.start, one.end) if k != 4 else (one.end, one.start)
            space.add_line(*ends)
            continue
        radius = 1 / one.start_curvature
        x = one.start[0] - radius * math.sin(one.direction)
        y = one.start[1] + radius * math.cos(one.direction)
        angles = [math.degrees(math.atan2(v - y, u - x)) for u, v in (one.start, one.end)]
        space.add_arc((x, y), abs(radius), *(angles if radius > 0 else angles[::-1]))
    document.saveas(tmp_path / "axis.dxf")
    back = ts.read_alignment(tmp_path / "axis.dxf")
    require_same(road, back)
    assert any("joined end to end" in note for note in back.notes)
    space.add_line((0, 500), (10, 500))
    document.saveas(tmp_path / "two.dxf")
    with pytest.raises(ts.ReadError, match="do not make one axis"):
        ts.read_alignment(tmp_path / "two.dxf")
    space.add_line(road.elements[2].start, (500, -500))
    document.saveas(tmp_path / "fork.dxf")
    with pytest.raises(ts.ReadError, match="axis"):
        ts.read_alignment(tmp_path / "fork.dxf")


def test_a_layer_chooses_the_axis(tmp_path):
    document = ezdxf.new()
    space = document.modelspace()
    space.add_line((0, 0), (10, 0), dxfattribs={"layer": "AXIS"})
    space.add_line((0, 5), (10, 5), dxfattribs={"layer": "OTHER"})
    document.saveas(tmp_path / "axis.dxf")
    assert ts.read_alignment(tmp_path / "axis.dxf", layer="AXIS").length == 10.0


def test_the_one_line_of_a_vector_file_is_an_alignment(tmp_path):
    line = ts.Features.of_lines([[0, 0], [10, 0], [10, 10]], [0, 3], crs="EPSG:32616")
    road = ts.read_alignment(ts.write(line, tmp_path / "line.gpkg"))
    assert (road.length, road.crs.label) == (20.0, "EPSG:32616")
    both = ts.Features.of_lines([[0, 0], [10, 0], [10, 10], [0, 9]], [0, 2, 4], crs="EPSG:32616")
    path = ts.write(both, tmp_path / "lines.gpkg")
    with pytest.raises(ts.ReadError, match="2 lines"):
        ts.read_alignment(path)
    for how, words in (({"name": "a"}, "only LandXML"), ({"unit": "m"}, "unit of its CRS")):
        with pytest.raises(ts.OptionError, match=words):
            ts.read_alignment(path, **how)


def test_missing_files_are_refused(tmp_path):
    with pytest.raises(ts.ReadError, match="There is no file"):
        ts.read_alignment(tmp_path / "none.xml")
