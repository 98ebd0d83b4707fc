"""OFF meshes: round trips, other readers, forms of the header, damaged rows."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.mesh_files import read_text, write_and_read
from support.surfaces import hills

import tinsmith as ts

BODY = "4 2 0\n0 0 5\n4 0 6\n4 3 7\n0 3 8\n3 0 1 2\n3 0 2 3\n"


def test_a_tin_comes_back(tmp_path):
    tin = hills()
    back = write_and_read(tin, tmp_path / "a.off")
    assert (back.crs, back.elevation_unit) == (tin.crs, tin.elevation_unit)


def test_trimesh_reads_our_off(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    tin = hills()
    mesh = trimesh.load(ts.write(tin, tmp_path / "a.off"), process=False)
    assert np.array_equal(mesh.vertices, tin.points)
    assert np.array_equal(mesh.faces, tin.triangles)


@pytest.mark.parametrize(
    "text",
    [
        f"OFF\n{BODY}",
        f"OFF {BODY}",
        f"OFF\n# a comment\n{BODY}",
        "COFF\n4 1 0\n0 0 5 255 0 0\n4 0 6 1 1 1\n4 3 7 1 1 1\n0 3 8 1 1 1\n4 0 1 2 3 9 9 9\n",
        f"OFF\r\n{BODY}".replace("\n", "\r\n").replace("\r\r", "\r"),
    ],
)
def test_forms_of_the_file(tmp_path, text):
    tin = read_text(tmp_path / "a.off", text)
    assert tin.area == 12
    assert float(tin.interpolate([4, 0])) == 6


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("OFF\n4 2 0\n0 0 5\n", "ends too early: it promises 4 vertices and 2 faces"),
        ("OFF\n", "ends before the numbers"),
        ("OFF\n4\n0 0 0\n", "the numbers of vertices and of faces are needed"),
        ("OFF\n-1 2 0\n0 0 0\n", "a count is negative"),
        ("4OFF\n" + BODY, "more than three dimensions"),
        (f"OFF BINARY\n{BODY}", "is a binary OFF file, and only those in text"),
        ("OFF\n" + BODY.replace("3 0 2 3", "3 0 2"), "fewer corners than it promises"),
        ("OFF\n" + BODY.replace("3 0 2 3", "3 0 2 4"), "names vertex 4"),
        ("OFF\n" + BODY.replace("0 3 8", "0 3 inf"), "not finite"),
        ("OFF\n" + BODY.replace("0 3 8", "0 3"), "line 6: a vertex needs x, y and z"),
    ],
)
def test_damaged_files(tmp_path, text, sentence):
    with pytest.raises(ts.ReadError, match=re.escape(sentence)):
        read_text(tmp_path / "a.off", text)
