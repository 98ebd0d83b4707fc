"""Archives of 12d Model: forms of its manual, our files read plainly, damaged blocks."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.mesh_files import assert_same_mesh
from support.plain_readers import parse_12da
from support.surfaces import hills

import tinsmith as ts
from tinsmith.io.cad.signatures import is_12da

CRS = "EPSG:32616"
FULL = """\
//  12da archive
// output_tin_hex_floats true
project_attributes { text "job" "a // b" }
null -999
model "design"
full_tin {
  name "GROUND"  // the name
  colour green
  attributes { integer "a" 1 group { name "g" attributes { text "b" "}" } } }
  points { -100 -100 0  -100 100 0  100 100 0  100 -100 0
    0 0 5   0x1.4p+3 0 6   0 10 7   10 10 8   20 20 9 }
  triangles { 5 7 6   6 7 8   1 5 6   8 9 6 }
  neighbours { 0 2 3   1 0 0   0 1 0   0 0 0 }
  nulling { 2 2 1 1 }
  input { preserve_strings true models { "survey" } }
}
"""
STRINGS = """\
model "survey"
string super { name "kerb" colour red breakline line
  data_3d { 0 0 5  10 0 6  10 10 8 } }
string super {
  name "pad"
  closed true
  data_2d { 0 0  10 0  10 10 }
  z 4.5
}
string 3d { name "spots" breakline point data { 1 1 5  2 2 6  3 3 null  4 4 -999 } }
string 4d { name "texts" data { 7 7 8 "tree" } }
string 2d { name "contour" z 12.5 data { 0 0  5 5 } }
string polyline { name "curve" closed 0 data { 0 0 1 12 0  20 0 1 0 0 } }
string super { name "arc" data_3d { 0 0 1  9 0 1 }
  geometry_data { straight { } arc { radius -50 major 0 } } }
string super { name "plan" data_2d { 30 30  40 40 } }
string text { x 1 y 2 z 3 text "string super {" }
string super_alignment { horizontal_parts { ip { id 100 x 0 y 0 } } }
super_tin { name "all" tins { "GROUND" } }
"""


def read(tmp_path, text, name="a.12da", **options):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return ts.read(path, **options)


def test_a_tin_comes_back_with_its_lines(tmp_path):
    tin = hills().replace(elevation_unit="m", crs=CRS)
    back = ts.read(ts.write(tin, tmp_path / "a.12da"), crs=CRS, unit="m")
    assert_same_mesh(back, tin)
    assert (back.lines.names, back.lines.kinds) == (tin.lines.names, tin.lines.kinds)
    assert np.array_equal(back.lines.vertices, tin.lines.vertices)
    assert np.array_equal(back.lines.offsets, tin.lines.offsets)
    assert np.array_equal(back.constrained, tin.constrained)
    assert back.elevation_unit == tin.elevation_unit
    assert ts.check(back, level=2).problems == ()


def test_constrained_edges_of_no_line_come_back(tmp_path):
    tin = hills().replace(elevation_unit="m", crs=CRS)
    flags = tin.constrained.copy()
    flags[tin.neighbors < 0] = True
    given = ts.TIN.from_triangles(tin.points, tin.triangles, constrained=flags, crs=CRS)
    back = ts.read(ts.write(given, tmp_path / "a.12da"), crs=CRS, unit="m")
    assert np.array_equal(back.constrained, given.constrained)
    assert len(back.lines) == 0


def test_our_tin_has_clockwise_triangles_and_its_lines_as_strings(tmp_path):
    tin = hills().replace(elevation_unit="m", crs=CRS)
    text = ts.write(tin, tmp_path / "a.12da", name='the "new" one').read_text()
    points, triangles, strings = parse_12da(text)
    assert np.array_equal(points, tin.points)
    assert np.array_equal(triangles[:, [0, 2, 1]], tin.triangles)
    a, b, c = (points[triangles[:, k], :2] for k in range(3))
    assert ((b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]).all()
    assert [name for name, _ in strings] == list(tin.lines.names)
    for (_, rows), chain in zip(strings, tin.lines.chains(), strict=True):
        assert np.array_equal(np.array(rows.split(), float).reshape(-1, 3), tin.points[chain])
    assert text.startswith('model "the \\"new\\" one"\ntin {\n  name "the \\"new\\" one"\n')
    assert ts.read(tmp_path / "a.12da").name == 'the "new" one'


def test_a_survey_comes_back_with_lines_and_polygons(tmp_path):
    ring = [[0.0, 0, 5], [9, 0, 6], [9, 9, 7], [0, 9, 8]]
    inner = [[2.0, 2, 5], [3, 2, 6], [3, 3, 7]]
    given = ts.Survey(
        points=[[1.5, 1, 5], [2, 1, 6], [1, 2, 0.1]],
        breaklines=[
            ts.Breakline([[0, 0, 1], [5, 5, 2]], name="a", kind="soft", priority=3),
            ts.Breakline([[0, 1], [5, 6]], name="b"),
        ],
        boundary=[[ring, inner]],
        holes=[inner],
        erase=[inner],
        water=[ts.Water(np.array(inner)[:, :2], 4.0, name="pond")],
    )
    found = ts.read(ts.write(given, tmp_path / "a.12da"))
    assert found.points.tobytes() == given.points.tobytes()
    for one, other in zip(found.breaklines, given.breaklines, strict=True):
        assert (one.kind, one.name, one.priority) == (other.kind, other.name, other.priority)
        assert one.coords.tolist() == other.coords.tolist()
    assert [np.asarray(one).tolist() for one in found.boundary[0]] == [ring, inner]
    assert np.asarray(found.holes[0]).tolist() == inner
    assert np.asarray(found.erase[0]).tolist() == inner
    ((pond,),) = ([*found.water],)
    assert (pond.name, pond.z, pond.ring.tolist()) == ("pond", 4.0, [row[:2] for row in inner])


def test_a_full_tin_without_what_is_nulled_or_construction(tmp_path):
    tin = read(tmp_path, FULL)
    assert tin.name == "GROUND"
    assert tin.points.tolist() == [[0, 0, 5], [10, 0, 6], [0, 10, 7], [10, 10, 8]]
    assert tin.area == 100
    told = " ".join(tin.notes)
    assert "Skipped: 2 triangles that are nulled or outside." in told
    assert "5 points of no visible triangle left out." in told
    assert "The archive names no unit of lengths." in told


def test_strings_along_edges_are_lines_of_the_tin(tmp_path):
    text = FULL + 'string super { name "kerb" data_3d { 0 0 5  10 0 6 } }\n'
    tin = read(tmp_path, text)
    assert tin.lines.names == ("kerb",)
    survey = read(tmp_path, text, content="source")
    assert [one.name for one in survey.breaklines] == ["kerb"]
    assert "Not read: 1 tin." in survey.notes


def test_strings_are_a_survey(tmp_path):
    found = read(tmp_path, STRINGS, crs=None, unit="ft")
    assert found.points.tolist() == [[1, 1, 5], [2, 2, 6], [7, 7, 8]]
    assert found.elevation_unit.name == "foot"
    lines = {one.name: one.coords.tolist() for one in found.breaklines}
    assert lines == {
        "kerb": [[0, 0, 5], [10, 0, 6], [10, 10, 8]],
        "pad": [[0, 0, 4.5], [10, 0, 4.5], [10, 10, 4.5], [0, 0, 4.5]],
        "contour": [[0, 0, 12.5], [5, 5, 12.5]],
        "curve": [[0, 0, 1], [20, 0, 1]],
        "arc": [[0, 0, 1], [9, 0, 1]],
        "plan": [[30, 30], [40, 40]],
    }
    told = " ".join(found.notes)
    assert (
        "Left out of the archive: 1 'string text', 1 'string super_alignment', 1 'super_tin'"
        in told
    )
    assert "2 strings have curves between vertices, which were read as straight lines." in told
    assert "2 points without elevation left out." in told
    assert "1 string without elevations: will be draped on the surface." in told
    assert read(tmp_path, STRINGS, content="points").breaklines == []


def test_commands_count_for_all_that_follows(tmp_path):
    text = "null 0\nbreakline point\nstring super { data_3d { 1 1 0  2 2 5 } }\n"
    found = read(tmp_path, text)
    assert found.points.tolist() == [[2, 2, 5]]
    assert not found.breaklines


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_encodings_and_ends_of_lines(tmp_path, encoding):
    text = 'model "Straße"\nstring super { name "Böschung" data_3d { 0 0 1 1 0 2 } }\n'
    found = read(tmp_path, text.replace("\n", "\r\n").encode(encoding), name="a.txt")
    assert found.breaklines[0].name == "Böschung"


def test_several_tins_are_chosen_by_name_or_number(tmp_path):
    second = FULL[FULL.index("full_tin") :].replace("GROUND", "ROCK")
    with pytest.raises(ts.ReadError, match=r"has 2 tins: name one.*\('GROUND', 'ROCK'\)"):
        read(tmp_path, FULL + second)
    assert read(tmp_path, FULL + second, surface="ROCK").name == "ROCK"
    found = read(tmp_path, FULL + second, surface=1)
    assert found.name == "GROUND"
    assert "Not read: 1 other tin." in found.notes
    for wrong in ("SAND", 3, 0):
        with pytest.raises(ts.ReadError, match=r"has 0 tins .*: there are 'GROUND', 'ROCK'"):
            read(tmp_path, FULL + second, surface=wrong)
    with pytest.raises(ts.OptionError, match="surface"):
        read(tmp_path, FULL, surface="")


def test_feet_become_the_unit_of_the_crs(tmp_path):
    tin = hills(lines=False).replace(crs=CRS, elevation_unit="ft")
    with pytest.warns(ts.LossWarning, match="converted from foot to metre, as 12d Model has one"):
        path = ts.write(tin, tmp_path / "a.12da")
    assert ts.read(path).points[:, 2] == pytest.approx(tin.points[:, 2] * 0.3048, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (FULL[:-3], "line 6: the block of a tin does not end"),
        (FULL.replace("0 10 7 ", "0 ten 7 "), "line 11: 'ten' is no number"),
        (FULL.replace("0 10 7 ", "0 nan 7 "), "line 11: 'nan' is no number"),
        (FULL.replace("0 10 7 ", "0 1_0 7 "), "line 11: '1_0' is no number"),
        (FULL.replace("0 10 7 ", "0 10 "), "points of a tin has 26 numbers, which are no rows"),
        (FULL.replace("5 7 6 ", "5 7 60 "), "triangle 1 of a tin names point 60 of 9"),
        (FULL.replace("5 7 6 ", "5 7 6.5 "), "triangle 1 of a tin names point 6.5"),
        (FULL.replace("2 2 1 1", "2 2 1"), "nulling of a tin has 3 numbers for 4 triangles"),
        (FULL.replace("0 0 5 ", "0 0 null "), "not finite"),
        ('string super { data_3d { 1 2 } }', "line 1: data_3d of a string has 2 numbers"),
        (FULL.replace("0 10 7 ", f"0 {'9' * 400} 7 "), "999' is no number that 64 bits hold"),
        (FULL.replace("0x1.4p+3", "0x1.4p+9999"), "'0x1.4p+9999' is no number that 64 bits"),
        ('string super { data_3d { 1 2 3', "the block of data_3d of a string does not end"),
        ('string super { name "a', "line 1: a text in quotes does not end"),
        ('string super { z low data_2d { 0 0 } }', "line 1: 'low' behind z is no number"),
        ('string text { x 1 }', "neither points nor lines in its strings"),
        ('string super { attributes { text "a" "b" ', "the block of attributes does not end"),
        ('string super { geometry_data { arc { } ', "the block of geometry_data does not end"),
        ('string super { other { { } ', "the block of other does not end"),
    ],
)  # fmt: skip
def test_damaged_blocks(tmp_path, text, sentence):
    with pytest.raises(ts.ReadError, match=re.escape(sentence)) as caught:
        read(tmp_path, text, format="12da")
    assert str(caught.value).endswith(".")


def test_what_is_not_there_is_refused(tmp_path):
    with pytest.raises(ts.ReadError, match="has no tin with triangles"):
        read(tmp_path, STRINGS, content="surface")
    with pytest.raises(ts.ReadError, match="has no points in its strings"):
        read(tmp_path, "string super { data_3d { 0 0 1 1 1 1 } }", content="points")
    nulled = FULL.replace("2 2 1 1", "1 1 1 1")
    with pytest.raises(ts.ReadError, match="the tin 'GROUND' has no visible triangles"):
        read(tmp_path, nulled, surface="GROUND")
    with pytest.raises(ts.OptionError, match="name"):
        ts.write(hills(), tmp_path / "b.12da", name=" ")
    degrees = ts.triangulate([[9, 50, 1], [9.1, 50, 2], [9, 50.1, 3]], crs=4326)
    with pytest.raises(ts.CrsError, match="12d Model holds lengths"):
        ts.write(degrees, tmp_path / "b.12da")


@pytest.mark.parametrize(
    "text", ["", "model,x,y,z\na,1,2,3\n", 'model "a"\n', "string theory\n", "x\nstring super {\n"]
)
def test_other_texts_are_not_taken_for_it(text):
    assert not is_12da(text.encode())
