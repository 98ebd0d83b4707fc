"""Meshes of ADCIRC and SCHISM: rows by the published description, boundaries, damaged rows."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.mesh_files import read_text, write_and_read
from support.plain_readers import parse_adcirc
from support.surfaces import hills

import tinsmith as ts
from tinsmith.io.mesh.signatures import is_adcirc

SQUARE = [[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]]
NODES = "".join(f"{k} {x} {y} {-z}\n" for k, (x, y, z) in enumerate(SQUARE, 1))
ELEMENTS = "1 3 1 2 3\n2 3 1 3 4\n"
MESH = f"a square\n2 4\n{NODES}{ELEMENTS}"
TURNED = "Depths of the nodes grow downwards: their sign was changed."


def read(tmp_path, text, name="fort.14"):
    return read_text(tmp_path / name, text)


@pytest.mark.parametrize("name", ["fort.14", "hgrid.gr3"])
def test_a_tin_comes_back_to_the_last_bit(tmp_path, name):
    tin = hills()
    back = write_and_read(tin, tmp_path / name)
    assert TURNED in back.report.notes
    assert ts.check(back, level=2).problems == ()


def test_what_another_program_reads_of_our_file(tmp_path):
    tin = hills(60, lines=False)
    nodes, elements, (opened, land) = parse_adcirc(ts.write(tin, tmp_path / "a.14").read_text())
    assert nodes[:, 0].tolist() == list(range(1, len(tin.points) + 1))
    assert np.array_equal(nodes[:, 1:], tin.points * [1, 1, -1])
    assert (elements[:, 1] == 3).all()
    assert np.array_equal(elements[:, 2:] - 1, tin.triangles)
    assert opened == []
    ((kind, ring),) = land
    assert kind == 0
    assert ring[0] == ring[-1]
    assert [node - 1 for node in ring[:-1]] == tin.boundary[0].tolist()


def test_a_hole_is_an_island_whose_ring_is_not_closed(tmp_path):
    points = [(x, y, x + y) for x in range(4) for y in range(4)]
    hole = [[1, 1], [2, 1], [2, 2], [1, 2]]
    tin = ts.triangulate(points, holes=[hole])
    path = ts.write(tin, tmp_path / "a.14")
    _, _, (_, land) = parse_adcirc(path.read_text())
    assert [(kind, len(ring)) for kind, ring in land] == [(0, 13), (1, 4)]
    back = ts.read(path)
    assert back.lines.names == ("land 0", "land 1")
    assert [len(line) for line in back.lines.chains()] == [13, 5]
    assert ts.write(back, tmp_path / "b.14").read_bytes() == path.read_bytes()


def test_open_and_land_boundaries_are_lines_and_come_back(tmp_path):
    text = MESH + "1 = open\n2\n2 0 = first\n1\n2\n1 = land\n3\n3 20\n3\n4\n1\n"
    tin = read(tmp_path, text)
    assert tin.lines.names == ("open", "land 20")
    assert tin.lines.kinds == ("boundary", "boundary")
    assert [chain.tolist() for chain in tin.lines.chains()] == [[0, 1], [2, 3, 0]]
    path = ts.write(tin, tmp_path / "again.14")
    _, _, (opened, land) = parse_adcirc(path.read_text())
    assert opened == [(0, [1, 2])]
    assert land == [(20, [3, 4, 1]), (0, [2, 3])]  # what no line covers is land
    again = ts.read(path)
    assert again.lines.names == ("open", "land 20", "land 0")


def test_boundaries_run_with_the_surface_on_their_left(tmp_path):
    tin = read(tmp_path, MESH + "1\n3\n3\n1\n4\n3\n0\n0\n")
    _, _, (opened, land) = parse_adcirc(ts.write(tin, tmp_path / "again.14").read_text())
    assert opened == [(0, [3, 4, 1])]
    assert land == [(0, [1, 2, 3])]


def test_boundaries_by_name_reach_the_file_from_any_tin(tmp_path):
    sea = ts.Breakline([[0, 0, 5], [4, 0, 6]], name="open")
    tin = ts.triangulate(ts.Survey(points=SQUARE, breaklines=[sea]))
    _, _, (opened, land) = parse_adcirc(ts.write(tin, tmp_path / "a.14").read_text())
    assert opened == [(0, [1, 2])]
    assert land == [(0, [2, 3, 4, 1])]


def test_barriers_keep_both_sides_and_tell_that_heights_are_left_out(tmp_path):
    text = MESH + "0\n0\n1\n4\n2 24\n1 4 2.5 1 1 ! crest\n2 3 2.5 1 1\n"
    tin = read(tmp_path, text)
    assert tin.lines.names == ("barrier 24", "barrier 24")
    assert [chain.tolist() for chain in tin.lines.chains()] == [[0, 1], [3, 2]]
    assert any("Heights and coefficients of 1 barrier" in note for note in tin.notes)


def test_rows_behind_the_boundaries_are_told(tmp_path):
    assert any("1 row behind" in note for note in read(tmp_path, f"{MESH}0\n0\n0\n0\nx\n").notes)


def test_numbers_with_gaps_are_told_and_fortran_exponents_read(tmp_path):
    rows = "10 0 0 -5\n30 4.0D+00 0 -6d0\n20 4 3 -7\n"
    tin = read(tmp_path, f"title # D\\\n1 3\n{rows}7 3 10 30 20\n", "hgrid.gr3")
    assert tin.points.tolist() == [[0, 0, 5], [4, 0, 6], [4, 3, 7]]
    assert tin.triangles.tolist() == [[0, 1, 2]]
    assert any("numbered 10 to 30, not 1 to 3" in note for note in tin.notes)


def test_quadrilaterals_are_cut_in_their_place_and_told(tmp_path):
    nodes = NODES + "5 8 0 -1\n6 8 3 -2\n"
    tin = read(tmp_path, f"\n3 6\n{nodes}1 3 1 2 3\n2 4 2 5 6 3\n3 3 1 3 4\n")
    assert len(tin.triangles) == 4
    assert tin.area == 24
    assert any("1 polygon of the file was cut" in note for note in tin.notes)


def test_elevations_where_the_caller_says_so(tmp_path):
    path = tmp_path / "a.gr3"
    path.write_text(MESH)
    tin = ts.read(path, positive="up")
    assert tin.points[:, 2].tolist() == [-5, -6, -7, -8]
    assert TURNED not in tin.notes
    again = ts.read(ts.write(tin, tmp_path / "b.gr3", positive="up"), positive="up")
    assert np.array_equal(again.points, tin.points)
    assert (tmp_path / "b.gr3").read_text().startswith("elevations positive up\n")
    with pytest.raises(ts.OptionError, match="one of down, up"):
        ts.read(path, positive="north")
    with pytest.raises(ts.OptionError, match="one of down, up"):
        ts.write(tin, tmp_path / "c.gr3", positive="north")


def test_no_minus_zero_is_written(tmp_path):
    tin = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 2]])
    assert "-0.0" not in ts.write(tin, tmp_path / "a.14").read_text()


def test_nodes_alone_are_a_survey(tmp_path):
    path = tmp_path / "a.14"
    path.write_text(f"title\n0 4\n{NODES}")
    found = ts.read(path, format="adcirc")
    assert isinstance(found, ts.Survey)
    assert found.points.tolist() == SQUARE
    assert TURNED in found.notes


def test_content_decides_whatever_the_suffix(tmp_path):
    assert isinstance(read(tmp_path, MESH, "mesh.grd"), ts.TIN)
    assert isinstance(read(tmp_path, MESH.replace("\n", "\r\n"), "mesh.txt"), ts.TIN)


@pytest.mark.parametrize(
    "text",
    ["", "a\n2 4\n", "x,y,z\n1 2 3\n", "title\n12 20\n1 2 3\n4 5 6\n7 8 9\n1 1 1\n",
     f"title\n2 4 7\n{NODES}{ELEMENTS}", f"title\n0 4\n{NODES}",
     f"t\n2 4J\n{NODES}{ELEMENTS}", f"t\n2 4{'4' * 9999}\n{NODES}{ELEMENTS}",
     f"t\n2 4\n{NODES}1 2 1 2\n1 3 1 2 3\n"],
)  # fmt: skip
def test_other_texts_are_not_taken_for_it(text):
    assert not is_adcirc(text.encode())


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("title", "ends before the numbers of its elements and nodes"),
        ("title\n2\n", "line 2: the numbers of elements and of nodes are needed ('2')"),
        ("title\n-1 4\n", "line 2: a count is negative"),
        (f"title\n9 4\n{NODES}", "it promises 4 nodes and 9 elements, and has 4 rows for them"),
        (MESH.replace("4 0 3 -8", "4 0 3"), "line 6: a node needs its number, x, y and depth"),
        (MESH.replace("4 0 3 -8", "4 0 3 x"), "line 6: a coordinate is no number"),
        (MESH.replace("4 0 3 -8", "4 0 3 nan"), "not finite"),
        (MESH.replace("4 0 3 -8", "2 0 3 -8"), "line 6: there is a node 2 already"),
        (MESH.replace("3 1 3 4", "3 1 3 9"), "line 8: there is no node 9"),
        (MESH.replace("3 1 3 4", "3 1 3"), "line 8: an element of 3 corners needs 3 nodes"),
        (MESH.replace("3 1 3 4", "5 1 3 4"), "line 8: an element needs 3 or 4 nodes"),
        (MESH + "1\n", "the number of nodes of a boundary is missing"),
        (MESH + "1\n2\n2\n1\n", "a boundary of 2 nodes is missing"),
        (MESH + "1\n2\n2\n1\n7\n0\n0\n", "line 13: there is no node 7"),
        (MESH + "0\n0\n1\n2\n2\n1\n2\n", "line 13: a land boundary needs its number of nodes"),
        (MESH + "0\n0\n1\n2\n2 24\n1\n2\n", "line 14: the node on the other side is missing"),
        (MESH + "-1\n", "line 9: the number of boundaries is negative"),
        (MESH + "0\n0\n", "the number of boundaries is missing"),
    ],
)
def test_damaged_rows(tmp_path, text, sentence):
    path = tmp_path / "fort.14"
    path.write_text(text)
    with pytest.raises(ts.ReadError, match=re.escape(sentence)) as caught:
        ts.read(path, format="adcirc")
    assert str(caught.value).endswith(".")


def test_surveys_are_refused(tmp_path):
    with pytest.raises(ts.FormatError, match="triangulate it first"):
        ts.write(ts.Survey(points=SQUARE), tmp_path / "a.14")
