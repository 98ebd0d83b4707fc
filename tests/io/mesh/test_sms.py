"""2DM meshes: files of other programs, what others read of ours, damaged rows."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from support.mesh_files import read_text, write_and_read
from support.qgis_meshes import open_in_qgis
from support.surfaces import hills

import tinsmith as ts

DATA = Path(__file__).parents[2] / "data" / "meshes"
NODES = "MESH2D\nND 1 0 0 5\nND 2 4 0 6\nND 3 4 3 7\nND 4 0 3 8\n"


def read(tmp_path, text):
    return read_text(tmp_path / "a.2dm", text)


def test_a_tin_comes_back_with_its_constrained_edges(tmp_path):
    tin = hills()
    back = write_and_read(tin, tmp_path / "a.2dm")
    assert np.array_equal(back.constrained, tin.constrained)
    assert [chain.tolist() for chain in back.lines.chains()] == [
        chain.tolist() for chain in tin.lines.chains()
    ]
    assert back.crs is None
    assert ts.check(back, level=2).problems == ()


def test_meshio_free_reading_of_our_rows(tmp_path):
    """Numbers ascend from 1, and every digit is there."""
    tin = hills(40, lines=False)
    text = ts.write(tin, tmp_path / "a.2dm").read_text()
    nodes = re.findall(r"^ND (\d+) (\S+) (\S+) (\S+)$", text, re.M)
    assert [int(row[0]) for row in nodes] == list(range(1, len(tin.points) + 1))
    assert np.array_equal(np.array([row[1:] for row in nodes], float), tin.points)
    faces = np.array(re.findall(r"^E3T (\d+) (\d+) (\d+) (\d+) 1$", text, re.M), int)
    assert np.array_equal(faces[:, 0], np.arange(1, len(faces) + 1))
    assert np.array_equal(faces[:, 1:] - 1, tin.triangles)


@pytest.mark.slow
def test_qgis_opens_our_2dm(tmp_path):
    tin = hills()
    seen = open_in_qgis(ts.write(tin, tmp_path / "a.2dm"), tmp_path)
    assert seen["valid"]
    assert (seen["vertices"], seen["faces"]) == (len(tin.points), len(tin.triangles))
    z = tin.points[:, 2]
    assert seen["groups"]["Bed Elevation"] == pytest.approx([z.min(), z.max()])


@pytest.mark.parametrize(
    "text",
    [
        f"# from the survey of May\n{NODES}E3T 1 1 2 3 1\n",
        f"\n#\n  # two\r\n\n{NODES}E3T 1 1 2 3 1\n",
        f"MESH2D # units: m\n# nodes\n{NODES.partition(chr(10))[2]}E3T 1 1 2 3 1 # the only one\n",
    ],
)
def test_comments_stand_anywhere(tmp_path, text):
    path = tmp_path / "comment.2dm"
    path.write_text(text)
    tin = ts.read(path)
    assert tin.points.tolist() == [[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]]
    assert tin.triangles.tolist() == [[0, 1, 2]]


def test_numbers_with_gaps():
    tin = ts.read(DATA / "mesh_with_numbering_gaps.2dm")
    assert len(tin.points) == 5
    assert tin.area == pytest.approx(1.5e6)
    told = " ".join(tin.report.notes)
    assert "1 polygon of the file was cut" in told
    assert "1 element of the file that is a line (E2L) is left out" in told


def test_scientific_numbers():
    tin = ts.read(DATA / "quad_and_triangle_scientific.2dm")
    assert tin.points[:, 2].tolist() == [20, 30, 40, 50, 10]
    assert tin.area == pytest.approx(1.5e6)


def test_midside_nodes_are_vertices_of_four_triangles():
    tin = ts.read(DATA / "triangleE6T.2dm")
    assert len(tin.triangles) == 6 * 4


def test_elements_that_overlap_are_refused():
    with pytest.raises(ts.ReadError, match="must not overlap"):
        ts.read(DATA / "unordered_ids.2dm")


def test_nodes_in_any_order(tmp_path):
    rows = NODES.splitlines()
    shuffled = "\n".join([rows[0], "E3T 9 4 1 2", *rows[:0:-1], "E3T 2 2 3 4 7"]) + "\n"
    tin = read(tmp_path, shuffled)
    assert tin.area == 12
    assert float(tin.interpolate([4, 3])) == 7


@pytest.mark.parametrize(
    ("element", "triangles"),
    [("E3T 1 1 2 3", 1), ("E4Q 1 1 2 3 4", 2), ("E3T 1 3 2 1 4 5.5", 1)],
)
def test_elements(tmp_path, element, triangles):
    assert len(read(tmp_path, f"{NODES}{element}\n").triangles) == triangles


@pytest.mark.parametrize(("material", "is_stated"), [("1", False), ("2", True)])
def test_several_materials_are_told(tmp_path, material, is_stated):
    tin = read(tmp_path, f"{NODES}E3T 1 1 2 3 1\nE3T 2 1 3 4 {material}\n")
    assert any("materials" in note for note in tin.report.notes) is is_stated


def test_eight_and_nine_nodes_are_cut_at_their_sides(tmp_path):
    xy = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1), (1, 1)]
    nodes = "".join(f"ND {k} {x} {y} {x * y}\n" for k, (x, y) in enumerate(xy, 1))
    eight = read(tmp_path, f"MESH2D\n{nodes}E8Q 1 1 2 3 4 5 6 7 8 1\n")
    nine = read(tmp_path, f"MESH2D\n{nodes}E9Q 1 1 2 3 4 5 6 7 8 9 1\n")
    assert (len(eight.triangles), len(nine.triangles)) == (6, 8)
    assert eight.area == nine.area == 4
    assert float(nine.interpolate([1, 1])) == 1


def test_node_strings_are_lines_over_several_rows(tmp_path):
    tin = read(tmp_path, f"{NODES}E4Q 1 1 2 3 4\nNS 1 2\nNS -3 5\nNS 4 -1\n")
    assert [chain.tolist() for chain in tin.lines.chains()] == [[0, 1, 2], [3, 0]]
    assert tin.lines.names == ("5", "")
    assert tin.lines.kinds == ("boundary", "boundary")


def test_a_node_string_across_triangles_is_told(tmp_path):
    tin = read(tmp_path, f"{NODES}E4Q 1 1 2 3 4\nNS 2 4 -1\nNS 1 -3\n")
    lost = [note for note in tin.report.notes if "along no edge" in note]
    assert len(lost) == 1
    assert lost[0].startswith("1 segment")


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        ("E3T 1 1 2 9", "line 6: there is no node 9"),
        ("E3T 1 1 2", "line 6: an element E3T needs its number and 3 nodes"),
        ("E3T 1 1 2 x", "line 6: a number must be whole"),
        ("ND 3 1 1 1\nE3T 1 1 2 3", "line 6: there is a node 3 already"),
        ("ND 5 1 1\nE3T 1 1 2 3", "line 6: a node needs its number, x, y and z"),
        ("ND 5 1 1 a\nE3T 1 1 2 3", "line 6: a coordinate is no number"),
        ("ND 5 1 1 nan\nE3T 1 1 2 5", "not finite"),
        ("E3T 1 1 2 " + "9" * 40, "line 6: a number must be whole"),
        ("E3T 1 1 2 3\nNS 1 -8", "line 7: there is no node 8"),
    ],
)
def test_damaged_rows(tmp_path, rows, sentence):
    with pytest.raises(ts.ReadError, match=re.escape(sentence)):
        read(tmp_path, f"{NODES}{rows}\n")


def test_nodes_alone_are_a_survey(tmp_path):
    assert isinstance(read(tmp_path, NODES), ts.Survey)
