"""Bytes of mesh files against the documents of their formats, and files that others write."""

import struct

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io import ReadError, read
from tinsmith.io.mesh import obj, stl
from tinsmith.io.mesh.ply import file as ply

# Corner 0 is the right angle, so that the edge opposite to it is the slanted one.
KITE = np.array([[0.0, 0.0, 1.0], [4.0, 0.0, 2.0], [0.0, 3.0, 3.0], [5.0, 5.0, 4.0]])


def kite(flags):
    return ts.TIN.from_triangles(KITE, [[0, 1, 2], [1, 3, 2]], constrained=flags)


def refused(path, content):
    path.write_bytes(content)
    with pytest.raises(ReadError) as caught:
        read(path)
    text = str(caught.value)
    assert text.isprintable()
    assert text.endswith(".")
    assert path.name in text
    return text


# -------------------------------------------------------------------------------- PLY


def test_flags_of_a_ply_file_stand_at_the_corner_opposite_the_edge(tmp_path):
    tin = kite([[True, False, False], [False, False, False]])  # on one side only
    ply.write(tin, tmp_path / "a.ply")
    content = (tmp_path / "a.ply").read_bytes()
    head, body = content.split(b"end_header\n", 1)
    names = [line.split()[-1] for line in head.decode().splitlines() if "uchar c" in line]
    assert names == ["constrained_0", "constrained_1", "constrained_2"]
    rows = [struct.unpack_from("<B3i3B", body, 4 * 24 + k * 16) for k in range(2)]
    assert rows == [(3, 0, 1, 2, 1, 0, 0), (3, 1, 3, 2, 0, 0, 0)]


def test_edges_of_a_ply_file_are_the_constrained_ones(tmp_path):
    tin = kite([[True, False, False], [False, True, False]])
    ply.write(tin, tmp_path / "a.ply")
    head, body = (tmp_path / "a.ply").read_bytes().split(b"end_header\n", 1)
    assert b"\ncomment edges: constrained\n" in head
    assert b"element edge 1\nproperty int vertex1\nproperty int vertex2\n" in head
    assert b"constrained_0" not in head
    assert struct.unpack_from("<2i", body, 4 * 24 + 2 * 13) == (1, 2)
    assert (read(tmp_path / "a.ply").constrained == tin.constrained).all()


def test_flags_of_a_foreign_ply_file_mean_the_opposite_edge(tmp_path):
    (tmp_path / "a.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property uchar constrained_0\nproperty uchar constrained_1\nproperty uchar constrained_2\n"
        "end_header\n0 0 1\n4 0 2\n0 3 3\n5 5 4\n3 0 1 2 1 0 0\n3 1 3 2 0 1 0\n"
    )
    tin = read(tmp_path / "a.ply")
    triangle, corner = np.nonzero(tin.constrained)
    edges = {
        frozenset(np.delete(tin.triangles[t], c).tolist())
        for t, c in zip(triangle, corner, strict=True)
    }
    assert edges == {frozenset({1, 2})}


def test_truth_values_of_a_survey_are_bytes_in_a_ply_file(tmp_path):
    survey = ts.Survey(points=KITE, attributes={"checked": np.array([True, False, True, True])})
    ply.write(survey, tmp_path / "a.ply")
    assert b"property uchar checked\n" in (tmp_path / "a.ply").read_bytes()
    again = read(tmp_path / "a.ply")
    assert again.attributes["checked"].dtype == np.uint8
    assert again.attributes["checked"].tolist() == [1, 0, 1, 1]


@pytest.mark.parametrize("first", [b"ply\n", b"ply \n", b"ply\t \n", b"ply\r\n", b"ply  \r\n"])
@pytest.mark.parametrize("name", ["a.ply", "a.txt"])
def test_blanks_behind_the_first_word_of_a_ply_file(tmp_path, first, name):
    ply.write(kite(None), tmp_path / "b.ply")
    content = (tmp_path / "b.ply").read_bytes()
    (tmp_path / name).write_bytes(content.replace(b"ply\n", first, 1))
    assert np.array_equal(read(tmp_path / name).points, KITE)


def test_a_ply_file_that_holds_more_than_it_tells(tmp_path):
    ply.write(ts.Survey(points=KITE), tmp_path / "b.ply")
    content = (tmp_path / "b.ply").read_bytes()
    fewer = content.replace(b"vertex 4", b"vertex 3")
    assert "promises 3 rows of 'vertex'" in refused(tmp_path / "a.ply", fewer)
    assert "promises 1 row of 'vertex'" in refused(
        tmp_path / "a.ply", content.replace(b"vertex 4", b"vertex 1")
    )
    (tmp_path / "a.ply").write_bytes(content + b"\r\n")
    assert len(read(tmp_path / "a.ply")) == 4


HEAD = "ply\nformat ascii 1.0\nelement vertex 3\nproperty {0} x\nproperty {0} y\nproperty {0} z\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEAD.format("double") + "property double x\nend_header\n", "'x' twice"),
        (HEAD.format("double") + "element vertex 3\nend_header\n", "no line of a PLY header"),
        (HEAD.format("double") + "format ascii 1.0\nend_header\n", "no line of a PLY header"),
        (HEAD.format("double").replace("vertex 3", "vertex -3") + "end_header\n", "'element"),
        (HEAD.format("double").replace("vertex 3", "vertex 3.0") + "end_header\n", "'element"),
        (HEAD.format("double") + "comment " + "x" * 20_000_000 + "\nend_header\n", "end_header"),
        (HEAD.format("double") + "end_header\n1 2 3\n4 5 6\n7 8 1e400\n", "not finite"),
        (HEAD.format("double") + "end_header\n1 2 3\n4 5 6\n7 8 nan\n", "1 point is not finite"),
        (
            HEAD.format("double")
            + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n2.5 0 1\n",
            "length 2.5",
        ),
        (
            HEAD.format("double")
            + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n2 0 1\n",
            "face 0 has 2 corners",
        ),
        (
            HEAD.format("double")
            + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n",
            "1 triangle has no area",
        ),
    ],
)
def test_ply_files_that_cannot_be(tmp_path, text, words):
    assert words in refused(tmp_path / "a.ply", text.encode())


def test_a_ply_file_with_control_letters_does_not_reach_the_terminal(tmp_path):
    text = HEAD.format("double") + "element \x1b[31mface\x07 one\nend_header\n"
    assert "\x1b" not in refused(tmp_path / "a.ply", text.encode())


def test_a_face_of_a_hundred_thousand_corners(tmp_path):
    angle = np.linspace(0, 2 * np.pi, 100_000, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle), angle])
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(circle)}\n"
        "property double x\nproperty double y\nproperty double z\nelement face 1\n"
        "property list uint int vertex_indices\nend_header\n"
    )
    face = struct.pack("<I", len(circle)) + np.arange(len(circle), dtype="<i4").tobytes()
    (tmp_path / "a.ply").write_bytes(head.encode() + circle.astype("<f8").tobytes() + face)
    tin = read(tmp_path / "a.ply")
    assert len(tin.triangles) == len(circle) - 2
    assert tin.area == pytest.approx(np.pi, rel=1e-6)


# -------------------------------------------------------------------------------- OBJ


@pytest.mark.parametrize(
    ("face", "words"),
    [
        ("1 2 99999999999999999999", "fewer"),
        ("1 2 18446744073709551617", "fewer"),
        ("1 2 1_0", "'1_0' names no vertex"),
        ("1 2 \u0663", "names no vertex"),
        ("1 2 -4", "count from 1"),
        ("1 2 0", "count from 1"),
        ("1 2 3.0", "'3.0' names no vertex"),
        ("1 2 " + "9" * 6000, "fewer"),
    ],
)
def test_obj_faces_that_name_no_vertex(tmp_path, face, words):
    text = f"v 0 0 1\nv 1 0 1\nv 0 1 1\nf {face}\n"
    message = refused(tmp_path / "a.obj", text.encode())
    assert words in message
    assert "line 4" in message
    assert len(message) < 500


# -------------------------------------------------------------------------------- STL


@pytest.mark.parametrize(
    "corner", [(0.0, 0.0, 0.0), (-0.5, 0.5, -1234.75), (745_000.25, -3.5, 0.999), (-7.0, 8.0, 9.0)]
)
def test_the_origin_of_an_stl_file_is_the_whole_number_below(tmp_path, corner):
    tin = ts.TIN.from_triangles(KITE + np.array(corner), [[0, 1, 2], [1, 3, 2]])
    stl.write(tin, tmp_path / "a.stl")
    words = (tmp_path / "a.stl").read_bytes()[:80].decode().split()
    lowest = (KITE + np.array(corner)).min(axis=0)
    assert [float(word) for word in words[1:4]] == np.floor(lowest).tolist()
    assert np.allclose(stl.read(tmp_path / "a.stl").points, tin.points, rtol=0, atol=1e-6)


def test_the_origin_that_a_foreign_stl_file_records_is_added_whole(tmp_path):
    header = b"origin 0.5 -1000.25 0.125".ljust(80)
    facet = np.zeros(1, np.dtype("12<f4, <u2"))
    facet["f0"][0, 3:] = [0, 0, 1, 4, 0, 2, 0, 3, 3]
    (tmp_path / "a.stl").write_bytes(header + b"\1\0\0\0" + facet.tobytes())
    assert read(tmp_path / "a.stl").points.tolist() == [
        [0.5, -1000.25, 1.125],
        [4.5, -1000.25, 2.125],
        [0.5, -997.25, 3.125],
    ]


def test_an_stl_file_whose_count_is_wrong(tmp_path):
    stl.write(kite(None), tmp_path / "b.stl")
    content = (tmp_path / "b.stl").read_bytes()
    for count, words in ((1, "promises 1 facet, and there is room for 2"), (3, "too early")):
        wrong = content[:80] + count.to_bytes(4, "little") + content[84:]
        assert words in refused(tmp_path / "a.stl", wrong)


def test_an_stl_file_whose_origin_is_no_place(tmp_path):
    stl.write(kite(None), tmp_path / "b.stl")
    content = (tmp_path / "b.stl").read_bytes()
    assert "inf" in refused(tmp_path / "a.stl", b"origin 0 1e400 0".ljust(80) + content[80:])


# ------------------------------------------------------------------- cut at every byte


@pytest.mark.parametrize("module", [ply, obj, stl])
def test_a_file_cut_anywhere_is_a_part_of_the_surface_or_a_sentence(tmp_path, module):
    name = f"a.{module.__name__.rpartition('.')[2]}"
    module.write(kite([[True, False, False], [False, True, False]]), tmp_path / name)
    content = (tmp_path / name).read_bytes()
    for end in range(1, len(content)):
        (tmp_path / name).write_bytes(content[:end])
        try:
            found = module.read(tmp_path / name)
        except ts.TinsmithError as error:
            text = str(error)
        else:
            # A text that ends behind a whole line, or within its last number, is a whole file.
            assert module is obj, end
            assert np.isfinite(found.points).all()
            continue
        assert text.isprintable()
        assert text.endswith(".")
