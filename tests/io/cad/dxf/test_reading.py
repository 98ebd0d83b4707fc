"""Drawings as ezdxf and others write them: entities, blocks, layers, units, and what is refused."""

import math
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from support.refusals import refuse

import tinsmith as ts
from tinsmith.io import read_lines, read_rings

DATA = Path(__file__).parents[3] / "data" / "dxf"
CORNERS = [(0, 0, 1), (4, 0, 2), (4, 4, 3), (0, 4, 4)]
FACES = [[CORNERS[k] for k in one] for one in ((0, 1, 2), (0, 2, 3))]


@pytest.fixture
def drawing():
    document = ezdxf.new("R2010")
    document.units = 6
    return document


@pytest.fixture
def save(tmp_path):
    def place(document, name="a.dxf", **how):
        path = tmp_path / name
        document.saveas(path, **how)
        return path

    return place


def refused(words, path, error=ts.ReadError, **options):
    return refuse(words, ts.read, path, error=error, **options)


def notes_of(found):
    return " ".join(found.report.notes if isinstance(found, ts.TIN) else found.notes)


def add_faces(space, layer="TOPO"):
    for face in FACES:
        space.add_3dface(face, dxfattribs={"layer": layer})


# ------------------------------------------------------------------ surfaces


def test_faces_become_a_tin_with_their_own_triangles(drawing, save):
    add_faces(drawing.modelspace())
    tin = ts.read(save(drawing))
    assert tin.points.tolist() == [list(map(float, row)) for row in CORNERS]
    assert tin.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert tin.elevation_unit.name == "metre"
    assert "Lengths are in metre, by $INSUNITS." in notes_of(tin)


@pytest.mark.parametrize("version", ["R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"])
@pytest.mark.parametrize("form", ["asc", "bin"])
def test_versions_text_and_binary(save, version, form):
    document = ezdxf.new(version)
    add_faces(document.modelspace())
    assert ts.read(save(document, fmt=form)).area == 16


def test_polyface_mesh_and_polygon_mesh(drawing, save):
    space = drawing.modelspace()
    space.add_polyface(dxfattribs={"layer": "FACES"}).append_faces(FACES)
    with space.add_mesh(dxfattribs={"layer": "MESH"}).edit_data() as data:
        data.vertices = CORNERS
        data.faces = [(0, 1, 2), (0, 2, 3)]
    grid = space.add_polymesh((3, 3), dxfattribs={"layer": "GRID"})
    for i in range(3):
        for j in range(3):
            grid.set_mesh_vertex((i, j), (i * 2, j * 2, 1))
    path = save(drawing)
    for layer, count in (("FACES", 2), ("MESH", 2), ("GRID", 8)):
        tin = ts.read(path, layer=layer)
        assert (len(tin.triangles), tin.area) == (count, 16), layer
    assert "4 faces of four corners cut in two" in notes_of(ts.read(path, layer="grid"))


def test_faces_of_four_corners_are_cut_and_bent_ones_told(drawing, save):
    bent = [(0, 0, 0), (4, 0, 0), (4, 4, 3), (0, 4, 0)]
    drawing.modelspace().add_3dface(bent)
    drawing.modelspace().add_3dface([(x + 4, y, 0) for x, y, _ in bent])
    tin = ts.read(save(drawing))
    assert len(tin.triangles) == 4
    assert "2 faces of four corners cut in two along an inner diagonal: 1 face of them not" in (
        notes_of(tin)
    )


def test_faces_that_are_lines_are_left_out_and_vertical_ones_refused(drawing, save):
    space = drawing.modelspace()
    add_faces(space)
    space.add_3dface([(0, 0, 1), (4, 0, 2), (4, 0, 2), (0, 0, 1)])
    tin = ts.read(save(drawing))
    assert len(tin.triangles) == 2
    assert "1 face with fewer than three" in notes_of(tin)
    space.add_3dface([(0, 0, 1), (4, 0, 2), (4, 0, 9)])
    refused("no area in the plane", save(drawing))
    refused("8 triangles have no area", DATA / "three_3dfaces_layers.dxf")


def test_lines_along_edges_are_lines_of_the_surface(drawing, save):
    space = drawing.modelspace()
    add_faces(space)
    space.add_polyline3d([CORNERS[0], CORNERS[2]], dxfattribs={"layer": "RIDGE"})
    tin = ts.read(save(drawing))
    assert (tin.lines.kinds, tin.lines.names) == (("hard",), ("RIDGE",))
    assert int(tin.constrained.sum()) == 2


def test_faces_and_other_points_are_a_choice(drawing, save):
    space = drawing.modelspace()
    add_faces(space)
    space.add_point(CORNERS[1])
    assert len(ts.read(save(drawing)).triangles) == 2
    space.add_point((2, 2, 9))
    path = save(drawing)
    refused("`content='surface'` or `content='source'`", path)
    assert len(ts.read(path, content="surface").triangles) == 2
    assert ts.read(path, content="points").points.tolist() == [[4, 0, 2], [2, 2, 9]]


# ------------------------------------------------------------------ points and lines


def test_points_and_lines_become_a_survey(drawing, save):
    space = drawing.modelspace()
    for k, row in enumerate(CORNERS):
        space.add_point(row, dxfattribs={"layer": f"P{k % 2}"})
    space.add_line((1, 1, 5), (2, 1, 6))
    space.add_polyline3d([(1, 2, 5), (2, 2, 6), (3, 2, 7)], dxfattribs={"layer": "KERB"})
    space.add_lwpolyline([(1, 3), (2, 3)], dxfattribs={"elevation": 7.5})
    space.add_lwpolyline([(1, 3.5), (2, 3.5)])
    space.add_polyline2d([(1, 0.5), (2, 0.5), (2, 0.7)], close=True,
                         dxfattribs={"elevation": (0, 0, 2.5)})  # fmt: skip
    survey = ts.read(save(drawing))
    assert survey.points.tolist() == [list(map(float, row)) for row in CORNERS]
    assert survey.attributes["layer"].tolist() == ["P0", "P1", "P0", "P1"]
    assert [line.coords.tolist() for line in survey.breaklines] == [
        [[1, 1, 5], [2, 1, 6]],
        [[1, 2, 5], [2, 2, 6], [3, 2, 7]],
        [[1, 3, 7.5], [2, 3, 7.5]],
        [[1, 3.5], [2, 3.5]],
        [[1, 0.5, 2.5], [2, 0.5, 2.5], [2, 0.7, 2.5], [1, 0.5, 2.5]],
    ]
    assert survey.breaklines[1].name == "KERB"
    assert "1 line of plane entities without elevation will be draped" in notes_of(survey)


@pytest.mark.parametrize("tolerance", [None, 0.5, 1e-4])
def test_curves_are_followed_within_the_tolerance(drawing, save, tolerance):
    space = drawing.modelspace()
    space.add_circle((0, 0, 3), 10)
    space.add_arc((0, 0, 3), 10, 0, 90)
    space.add_ellipse((0, 0, 3), (10, 0, 0), 1.0)
    space.add_lwpolyline([(10, 0, 1), (-10, 0, 1)], format="xyb", close=True,
                         dxfattribs={"elevation": 3})  # fmt: skip
    survey = ts.read(save(drawing), tolerance=tolerance)
    allowed = tolerance or 0.01
    for line in survey.breaklines:
        middles = (line.coords[1:, :2] + line.coords[:-1, :2]) / 2
        assert np.hypot(*line.coords[:, :2].T) == pytest.approx(10, abs=1e-9)
        assert np.hypot(*middles.T).min() >= 10 - allowed - 1e-9
        assert (line.coords[:, 2] == 3).all()
    assert "4 curves became polylines" in notes_of(survey)


def test_splines_are_followed(drawing, save):
    drawing.modelspace().add_spline([(0, 0, 1), (5, 5, 2), (9, 0, 3)])
    (line,) = ts.read(save(drawing)).breaklines
    assert line.coords[0] == pytest.approx([0, 0, 1])
    assert line.coords[-1] == pytest.approx([9, 0, 3])
    assert np.hypot(*(line.coords[:, :2] - [5, 5]).T).min() < 0.02


def test_blocks_are_taken_apart_with_scale_rotation_arrays_and_nesting(drawing, save):
    inner = drawing.blocks.new("INNER")
    inner.add_point((1, 0, 0))  # on layer 0: that of the insert counts
    inner.add_point((2, 0, 0), dxfattribs={"layer": "OWN"})
    outer = drawing.blocks.new("OUTER", base_point=(10, 10, 0))
    outer.add_blockref("INNER", (10, 10, 5), dxfattribs={"layer": "0"})
    drawing.modelspace().add_blockref(
        "OUTER",
        (100, 200, 1),
        dxfattribs={"layer": "SHOTS", "rotation": 90, "xscale": 2, "yscale": 2, "zscale": 3,
                    "column_count": 2, "column_spacing": 50},
    )  # fmt: skip
    survey = ts.read(save(drawing))
    expected = [(100, 202, 16), (100, 204, 16), (100, 252, 16), (100, 254, 16)]
    assert survey.points == pytest.approx(np.array(expected, float))
    assert survey.attributes["layer"].tolist() == ["SHOTS", "OWN"] * 2
    assert len(ts.read(save(drawing), layer="OWN")) == 2


def test_texts_are_points_only_when_asked_for(drawing, save):
    space = drawing.modelspace()
    space.add_point((0, 0, 1))
    space.add_text("318.25", dxfattribs={"insert": (5, 6)})
    space.add_mtext("319.5", dxfattribs={"insert": (7, 8, 0)})
    space.add_text("MH 12", dxfattribs={"insert": (9, 9)})
    path = save(drawing)
    survey = ts.read(path)
    assert len(survey) == 1
    assert "2 TEXT, 1 MTEXT" in notes_of(survey)
    survey = ts.read(path, texts=True)
    assert survey.points.tolist() == [[0, 0, 1], [5, 6, 318.25], [7, 8, 319.5]]
    assert "Points that come from texts: 2; texts that are no numbers: 1." in notes_of(survey)


# ------------------------------------------------------------------ layers


def test_layers_are_chosen_by_name_and_pattern(drawing, save):
    space = drawing.modelspace()
    for k, layer in enumerate(("TOPO-1", "TOPO-2", "BREAK", "Other")):
        space.add_point((k, 0, k), dxfattribs={"layer": layer})
    path = save(drawing)
    for pattern, count in (
        ("TOPO*", 2), ("topo-1", 1), ("TOPO-?, BREAK", 3), ("*", 4), (" other ", 1),
    ):  # fmt: skip
        assert len(ts.read(path, layer=pattern)) == count, pattern
    text = refused("Invalid layer 'ROAD'", path, error=ts.OptionError, layer="ROAD")
    assert "has 'TOPO-1', 'TOPO-2', 'BREAK', 'Other'." in text
    refused("Invalid layer", path, error=ts.OptionError, layer=" , ")


def test_frozen_and_off_layers_are_left_out_and_told_unless_named(drawing, save):
    space = drawing.modelspace()
    for k, layer in enumerate(("SHOWN", "ICE", "DARK")):
        drawing.layers.add(layer)
        space.add_point((k, 0, k), dxfattribs={"layer": layer})
    space.add_point((9, 9, 9), dxfattribs={"layer": "SHOWN", "invisible": 1})
    drawing.layers.get("ICE").freeze()
    drawing.layers.get("DARK").off()
    path = save(drawing)
    survey = ts.read(path)
    assert len(survey) == 1
    for words in ("'ICE', which is off or frozen", "'DARK', which", "1 entity that are invisible"):
        assert words in notes_of(survey)
    assert len(ts.read(path, layer="ICE,DARK")) == 2


# ------------------------------------------------------------------ units and CRS


def test_units_of_the_header_are_honoured(drawing, save):
    add_faces(drawing.modelspace())
    drawing.units = 4
    path = save(drawing)
    assert ts.read(path).elevation_unit.name == "millimetre"
    refused("`unit='millimetre'` or `unit='metre'`", path, crs=32616)
    tin = ts.read(path, crs=32616, unit="mm")
    assert tin.bounds.xmax == pytest.approx(0.004)
    tin = ts.read(path, crs=32616, unit="m")
    assert (tin.bounds.xmax, tin.elevation_unit.name) == (4, "metre")
    drawing.units = 0
    tin = ts.read(save(drawing))
    assert tin.elevation_unit is None
    assert "names no unit of lengths" in notes_of(tin)
    assert ts.read(save(drawing), elevation_unit="ft").elevation_unit.name == "foot"


# ------------------------------------------------------------------ lines for other points


def test_breaklines_of_drawings_have_elevations_blocks_and_arcs(drawing, save):
    space = drawing.modelspace()
    block = drawing.blocks.new("WALL")
    block.add_polyline3d([(0, 0, 1), (4, 0, 2)])
    space.add_blockref("WALL", (10, 0, 5), dxfattribs={"layer": "WALLS"})
    space.add_lwpolyline([(0, 0, 1), (10, 0, 0)], format="xyb", dxfattribs={"elevation": 2})
    space.add_lwpolyline([(0, 0), (1, 0)], dxfattribs={"layer": "PLAN"})
    space.add_point((5, 5, 5))
    path = save(drawing)
    notes = []
    wall, arc, plan = read_lines(path, notes=notes)
    assert wall.coords.tolist() == [[10, 0, 6], [14, 0, 7]]
    assert len(arc.coords) > 8
    assert np.hypot(*(arc.coords[:, :2] - [5, 0]).T) == pytest.approx(5)
    assert plan.is_draped
    assert "not read: 1 point" in " ".join(notes)
    (only,) = read_lines(path, layer="WALL*")
    assert np.array_equal(only.coords, wall.coords)
    assert len(read_lines(path, layer="entities")) == 3
    assert len(read_lines(path, where="Layer = 'PLAN' OR layer like 'WALL%'")) == 2
    for wrong in ("nothing = 1", "1; drop table drawing", "layer = 'XX'"):
        with pytest.raises(ts.ReadError, match=r"condition|no features"):
            read_lines(path, where=wrong)
    with pytest.raises(ts.ReadError, match="no layer 'ROAD'"):
        read_lines(path, layer="ROAD")


def test_rings_of_drawings(drawing, save):
    drawing.modelspace().add_lwpolyline([(0, 0), (4, 0), (4, 4)], close=True)
    (ring,) = read_rings(save(drawing))
    assert ring.tolist() == [[0, 0], [4, 0], [4, 4]]
    drawing.modelspace().add_line((0, 0), (1, 1))
    with pytest.raises(ts.ReadError, match="open line"):
        read_rings(save(drawing))


# ------------------------------------------------------------------ hostile drawings


@pytest.mark.parametrize(
    "content",
    [
        b"0\rSECTION\r",
        b"0\nSECTION\n2\nENTITIES\n0\n",
        b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE",
        b"0\nSECTION\n2\nENTITIES\n0\n3DFACE\n10\nx\n0\nENDSEC\n0\nEOF\n",
        b"AutoCAD Binary DXF\r\n\x1a\x00",
        b"AutoCAD Binary DXF\r\n\x1a\x00\x00SECTION\x00\x02HEADER\x00",
        b"0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n",
    ],
)
def test_damaged_drawings_are_refused_in_a_sentence(tmp_path, content):
    path = tmp_path / "a.dxf"
    path.write_bytes(content)
    refused("a.dxf", path)


def test_a_drawing_cut_short_is_refused(drawing, save):
    add_faces(drawing.modelspace())
    path = save(drawing)
    whole = path.read_bytes()
    at = whole.index(b"3DFACE", whole.index(b"ENTITIES"))
    for end in (at + 100, whole.index(b"EOF", at) - 200, len(whole) // 2):
        path.write_bytes(whole[:end])
        refused("damaged", path)


@pytest.mark.parametrize("value", ["nan", "inf", "1e999"])
def test_numbers_that_are_none_are_refused(drawing, save, value):
    drawing.modelspace().add_point((1.25, 2, 3))
    path = save(drawing)
    path.write_text(path.read_text().replace("\n1.25\n", f"\n{value}\n"))
    refused("not finite|damaged", path)


@pytest.mark.parametrize("value", ["1e308", "-1.7e308"])
def test_corners_beyond_any_coordinate_are_refused(drawing, save, value):
    space = drawing.modelspace()
    space.add_3dface([(1.25, 0, 0), (9, 0, 1), (9, 9, 2.5), (0, 9, 0)])
    space.add_3dface([(20, 0, 0), (29, 0, 1), (29, 9, 2.5)])
    path = save(drawing)
    text = path.read_text()
    path.write_text(text.replace("\n1.25\n", f"\n{value}\n"))
    refused("holds no TIN", path)
    path.write_text(text.replace("\n2.5\n", f"\n{value}\n"))
    refused("elevation out of range", path)


def test_a_block_that_inserts_itself_is_refused(drawing, save):
    a, b = drawing.blocks.new("A"), drawing.blocks.new("B")
    a.add_point((0, 0, 1))
    a.add_blockref("B", (1, 1, 1))
    b.add_blockref("A", (1, 1, 1))
    drawing.modelspace().add_blockref("A", (0, 0, 0))
    refused("more than 32 deep", save(drawing))


@pytest.mark.slow
def test_a_million_copies_of_a_million_points_are_given_up(drawing, save, monkeypatch):
    monkeypatch.setattr("tinsmith.io.isolated.limits.LEAST_SECONDS", 1.0)
    drawing.blocks.new("A").add_point((0, 0, 1))
    b = drawing.blocks.new("B")
    array = {"column_count": 30_000, "row_count": 30_000, "column_spacing": 1, "row_spacing": 1}
    for space, name in ((b, "A"), (drawing.modelspace(), "B")):
        space.add_blockref(name, (0, 0, 0), dxfattribs=array)
    refused("limit for a file of this size", save(drawing))


def test_other_files_are_not_followed(drawing, save, tmp_path):
    other = ezdxf.new()
    other.modelspace().add_point((7, 7, 7))
    other.saveas(tmp_path / "other.dxf")
    drawing.add_xref_def(str(tmp_path / "other.dxf"), "OTHER")
    drawing.modelspace().add_blockref("OTHER", (0, 0, 0))
    drawing.modelspace().add_point((1, 1, 1))
    survey = ts.read(save(drawing))
    assert survey.points.tolist() == [[1, 1, 1]]
    assert "not followed: 'OTHER'" in notes_of(survey)


def test_options_that_are_none(drawing, save):
    drawing.modelspace().add_point((1, 1, 1))
    path = save(drawing)
    for options in ({"tolerance": 0}, {"tolerance": math.nan}, {"content": "all"}, {"layer": 3}):
        refused("Invalid", path, error=ts.OptionError, **options)
    refused("no faces", path, content="surface")
