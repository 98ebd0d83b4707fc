"""Selafin files of TELEMAC: an independent reader and writer of records, QGIS, damaged files."""

from __future__ import annotations

import re
import struct

import numpy as np
import pytest
from support.mesh_files import assert_same_mesh, write_and_read
from support.qgis_meshes import open_all_in_qgis
from support.selafin_files import make_selafin, parse_selafin
from support.surfaces import hills

import tinsmith as ts
from tinsmith.io.mesh.signatures import is_selafin

XY = [[0, 0], [4, 0], [4, 3], [0, 3]]
Z = [5.0, 6.0, 7.0, 8.0]
TRIANGLES = [[1, 2, 3], [1, 3, 4]]
BOTTOM = [("BOTTOM", "M")]
FRAMES = [(0.0, [Z])]
METRIC = {"crs": "EPSG:32616", "elevation_unit": "m"}


def make_metric(lines=True):
    tin = hills(lines=lines)
    return tin.replace(**METRIC)


def read(tmp_path, content, **options):
    path = tmp_path / "a.slf"
    path.write_bytes(content)
    return ts.read(path, **options)


@pytest.mark.parametrize("name", ["a.slf", "a.ser"])
def test_a_tin_comes_back_to_the_last_bit_with_its_unit(tmp_path, name):
    tin = make_metric()
    back = write_and_read(tin, tmp_path / name)
    assert (back.crs, back.elevation_unit) == (None, tin.elevation_unit)
    assert ts.check(back, level=2).problems == ()


def test_what_an_independent_reader_finds_in_our_file(tmp_path):
    tin = make_metric()
    found = parse_selafin(ts.write(tin, tmp_path / "a.slf"))
    assert found["title"].endswith("SERAFIND")
    assert found["names"] == [f"{'BOTTOM':<16}{'M':<16}"]
    assert np.array_equal(found["elements"] - 1, tin.triangles)
    assert np.array_equal(found["xy"], tin.points[:, :2])
    assert np.array_equal(found["values"], [tin.points[:, 2]])


def test_the_boundary_is_numbered_as_telemac_wants_it(tmp_path):
    """From the south-west, the outer ring counter-clockwise, then holes clockwise."""
    points = [(x, y, x + y) for x in range(4) for y in range(4)]
    tin = ts.triangulate(points, holes=[[[1, 1], [2, 1], [2, 2], [1, 2]]], elevation_unit="m")
    found = parse_selafin(ts.write(tin, tmp_path / "a.slf"))
    ipobo = found["ipobo"]
    assert sorted(ipobo[ipobo > 0]) == list(range(1, 17))
    walk = found["xy"][np.argsort(ipobo)][np.count_nonzero(ipobo == 0) :]
    outer = [(x, 0) for x in range(3)] + [(3, y) for y in range(3)]
    outer += [(x, 3) for x in range(3, 0, -1)] + [(0, y) for y in range(3, 0, -1)]
    assert walk.tolist() == [list(map(float, one)) for one in outer] + [
        [1, 1], [1, 2], [2, 2], [2, 1]]  # fmt: skip
    assert not any("IPOBO" in note for note in ts.read(tmp_path / "a.slf").notes)


def test_another_boundary_than_that_of_the_mesh_is_told(tmp_path):
    content = make_selafin(XY, TRIANGLES, BOTTOM, FRAMES, ipobo=[1, 2, 0, 0])
    found = read(tmp_path, content)
    assert any("numbers 2 nodes as those of the boundary (IPOBO), and 4" in note
               for note in found.notes)  # fmt: skip


@pytest.mark.parametrize("size", [4, 8])
@pytest.mark.parametrize("order", [">", "<"])
def test_both_precisions_and_orders_of_bytes(tmp_path, size, order):
    names = [("VELOCITY U", "M/S"), ("FOND", "M")]
    frames = [(0.0, [Z[::-1], Z]), (60.0, [Z, Z])]
    how = {"size": size, "order": order, "date": True, "origin": (752_000, 4_024_000)}
    found = read(tmp_path, make_selafin(XY, TRIANGLES, names, frames, **how))
    assert found.points.tolist() == [[x + 752_000, y + 4_024_000, z]
                                     for (x, y), z in zip(XY, Z, strict=True)]  # fmt: skip
    assert found.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert found.elevation_unit.name == "metre"
    told = " ".join(found.notes)
    assert "The origin 752,000, 4,024,000 was added" in told
    assert "Variables of the file other than FOND are left out: VELOCITY U." in told


def test_a_bottom_that_changes_is_asked_for(tmp_path):
    frames = [(0.0, [Z]), (60.0, [[1, 2, 3, 4]])]
    content = make_selafin(XY, TRIANGLES, BOTTOM, frames)
    with pytest.raises(ts.ReadError, match="2 frames, between which BOTTOM changes: name one"):
        read(tmp_path, content)
    assert read(tmp_path, content, frame=1).points[:, 2].tolist() == Z
    assert read(tmp_path, content, frame=2).points[:, 2].tolist() == [1, 2, 3, 4]
    for wrong in (0, 3, 1.5):
        with pytest.raises(ts.OptionError, match="frame"):
            read(tmp_path, content, frame=wrong)


def test_another_variable_by_its_name(tmp_path):
    names = [("FREE SURFACE", "M"), ("ERROR", "")]
    content = make_selafin(XY, TRIANGLES, names, [(0.0, [Z, [0, 0, 0, 1]])])
    with pytest.raises(ts.ReadError, match=r"no variable BOTTOM or FOND.* \(FREE SURFACE, ERROR\)"):
        read(tmp_path, content)
    assert read(tmp_path, content, variable="free surface").points[:, 2].tolist() == Z
    with pytest.raises(ts.OptionError, match="one of FREE SURFACE, ERROR"):
        read(tmp_path, content, variable="BOTTOM")


@pytest.mark.parametrize(
    ("unit", "name"), [("M", "metre"), ("FT", "foot"), ("", None), ("KG", None)]
)
def test_units_of_elevations(tmp_path, unit, name):
    found = read(tmp_path, make_selafin(XY, TRIANGLES, [("BOTTOM", unit)], FRAMES))
    assert getattr(found.elevation_unit, "name", None) == name


def test_feet_come_back_and_are_told(tmp_path):
    tin = hills().replace(crs="EPSG:32616", elevation_unit="US survey foot")
    with pytest.warns(ts.LossWarning, match="lengths in US survey foot, and TELEMAC computes in m"):
        path = ts.write(tin, tmp_path / "a.slf")
    assert ts.read(path).elevation_unit == tin.elevation_unit
    unknown = ts.triangulate([[0, 0, 1], [1, 0, 2], [0, 1, 3]])
    assert ts.read(ts.write(unknown, tmp_path / "b.slf")).elevation_unit is None


def test_single_precision_where_it_is_asked_for(tmp_path):
    tin = make_metric()
    with pytest.warns(ts.LossWarning, match="rounded to numbers of 32 bits, by up to 0"):
        path = ts.write(tin, tmp_path / "a.slf", dtype="float32")
    assert path.read_bytes()[4:84].endswith(b"SERAFIN ")
    back = ts.read(path)
    assert np.array_equal(back.points, tin.points.astype(np.float32))
    assert any("numbers of 32 bits" in note for note in back.notes)
    with pytest.raises(ts.OptionError, match="one of float32, float64"):
        ts.write(tin, tmp_path / "b.slf", dtype="int8")


def test_a_boundary_that_comes_to_a_vertex_twice_is_told(tmp_path):
    points = [[0, 0, 1], [1, 0, 1], [0, 1, 1], [-1, 0, 2], [0, -1, 2]]
    tin = ts.TIN.from_triangles(points, [[0, 1, 2], [0, 3, 4]])
    with pytest.warns(ts.LossWarning, match="the boundary comes to 1 vertex twice"):
        ts.write(tin, tmp_path / "a.slf")


def test_quadrilaterals_are_cut_and_told(tmp_path):
    found = read(tmp_path, make_selafin(XY, [[1, 2, 3, 4]], BOTTOM, FRAMES))
    assert found.area == 12
    assert any("1 polygon of the file was cut" in note for note in found.notes)


SOUND = make_selafin(XY, TRIANGLES, BOTTOM, FRAMES)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (SOUND[:-1], "ends within frame 1: 55 of its 56 bytes are there"),
        (SOUND[:-56], "without values: no elevations of its nodes are there"),
        (SOUND + SOUND[-20:], "ends within frame 2: 20 of its 56 bytes"),
        (SOUND[:120], "ends within the name of a variable: the record has 32 bytes, and 12 bytes"),
        (SOUND[:104], "ends before the name of a variable"),
        (SOUND[:-44] + struct.pack(">i", 9) + SOUND[-40:], "a record of frame 1 has 9 bytes, not"),
        (make_selafin(XY, [[1, 2, 3], [1, 3, 9]], BOTTOM, FRAMES),
         "element 2 names node 9, and there are nodes 1 to 4"),
        (make_selafin(XY, [[1, 2, 3, 1, 2, 3]], BOTTOM, FRAMES, planes=2),
         "a mesh of 6 nodes an element in 2 planes"),
        (make_selafin(XY, TRIANGLES, BOTTOM, [(0.0, [[1, 2, 3, np.nan]])]), "not finite"),
        (make_selafin(XY, TRIANGLES, [], [(0.0, [])]), "elevations of its nodes: it has none"),
        (SOUND.replace(struct.pack(">i", 24) + struct.pack(">6i", 1, 2, 3, 1, 3, 4),
                       struct.pack(">i", 20) + struct.pack(">6i", 1, 2, 3, 1, 3, 4)),
         "the nodes of the elements has 20 bytes by the number before it, and 4 by the one"),
        (SOUND.replace(struct.pack(">4i", 2, 4, 3, 1), struct.pack(">4i", 3, 4, 3, 1)),
         "the record of the nodes of the elements has 24 bytes, not 36"),
        (SOUND.replace(struct.pack(">4i", 2, 4, 3, 1), struct.pack(">4i", 0, 4, 3, 1)),
         "0 elements and 4 nodes, which are no mesh"),
    ],
)  # fmt: skip
def test_damaged_files(tmp_path, content, sentence):
    with pytest.raises(ts.ReadError, match=re.escape(sentence)) as caught:
        read(tmp_path, content, format="selafin")
    assert str(caught.value).endswith(".")


@pytest.mark.parametrize(
    "content", [b"", b"\0\0\0P", SOUND[:90], b"P\0\0\0" + SOUND[4:], b"x" * 200]
)
def test_other_files_are_not_taken_for_it(content):
    assert not is_selafin(content)


def test_content_decides_whatever_the_suffix(tmp_path):
    path = tmp_path / "result.dat"
    path.write_bytes(SOUND)
    assert isinstance(ts.read(path), ts.TIN)


@pytest.mark.slow
def test_qgis_opens_both_precisions(tmp_path):
    tin = make_metric()
    double = ts.write(tin, tmp_path / "double.slf")
    with pytest.warns(ts.LossWarning):
        single = ts.write(tin, tmp_path / "single.slf", dtype="float32")
    z = tin.points[:, 2]
    for seen in open_all_in_qgis([double, single], tmp_path):
        assert seen["valid"]
        assert (seen["vertices"], seen["faces"]) == (len(tin.points), len(tin.triangles))
        ((name, limits),) = seen["groups"].items()
        assert name.split() == ["bottom", "m"]
        assert limits == pytest.approx([z.min(), z.max()], rel=1e-6)


@pytest.mark.slow
def test_a_file_of_another_writer_is_the_same_to_qgis_and_to_us(tmp_path):
    path = tmp_path / "other.slf"
    path.write_bytes(make_selafin(XY, TRIANGLES, BOTTOM, FRAMES, size=4, date=True))
    (seen,) = open_all_in_qgis([path], tmp_path)
    found = ts.read(path)
    assert_same_mesh(
        found, ts.TIN.from_triangles(np.column_stack([XY, Z]), np.array(TRIANGLES) - 1)
    )
    assert (seen["vertices"], seen["faces"]) == (4, 2)
    assert list(seen["groups"].values()) == [[5, 8]]
