"""PLY, OBJ, STL and VTK files: what other readers see, foreign files, damaged files."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.base.errors import CrsError, FormatError, ReadError
from tinsmith.cli import main
from tinsmith.io.mesh import obj, stl, vtk
from tinsmith.io.mesh.ply import file as ply
from tinsmith.tin.checking.overlaps import describe_oddities, find_overlap

ORIGIN = np.array([745_000.0, 4_033_000.0, 200.0])
SQUARE = np.array([[0, 0, 1], [1, 0, 2], [1, 1, 3], [0, 1, 4]], float)
HALVES = [[0, 1, 2], [0, 2, 3]]


def hills(n=200, seed=3, flagged=False):
    rng = np.random.default_rng(seed)
    tin = ts.triangulate(rng.uniform(0, 300, (n, 3)) + ORIGIN, crs="EPSG:32616")
    if not flagged:
        return tin
    flags = rng.random(tin.constrained.shape) < 0.2
    return ts.TIN.from_triangles(tin.points, tin.triangles, constrained=flags, crs=tin.crs)


def same_mesh(tin, points, triangles):
    assert np.array_equal(tin.points, points)
    assert [sorted(t) for t in tin.triangles.tolist()] == [sorted(t) for t in triangles]


def require_refusal(form, path, words):
    """Require that a file is refused in one line that has such words; return the error."""
    with pytest.raises(ReadError, match=words) as caught:
        ts.read(path, format=form)
    assert caught.value.file == path
    assert "\n" not in str(caught.value)
    return caught.value


# ------------------------------------------------------------------ what others read


@pytest.mark.parametrize("flagged", [False, True])
def test_pyvista_reads_our_ply(tmp_path, flagged):
    pyvista = pytest.importorskip("pyvista")
    tin = hills(flagged=flagged)
    ply.write(tin, tmp_path / "a.ply")
    mesh = pyvista.read(tmp_path / "a.ply")
    assert np.array_equal(mesh.regular_faces, tin.triangles)
    assert np.abs(mesh.points - tin.points).max() < 0.5  # its reader keeps single precision


@pytest.mark.parametrize("flagged", [False, True])
def test_trimesh_reads_our_ply(tmp_path, flagged):
    trimesh = pytest.importorskip("trimesh")
    tin = hills(flagged=flagged)
    ply.write(tin, tmp_path / "a.ply")
    mesh = trimesh.load(tmp_path / "a.ply", process=False)
    assert np.array_equal(mesh.vertices, tin.points)
    assert np.array_equal(mesh.faces, tin.triangles)


def test_meshio_reads_our_ply_and_obj(tmp_path):
    meshio = pytest.importorskip("meshio")
    tin = hills()
    for module, name in ((ply, "a.ply"), (obj, "a.obj")):
        module.write(tin, tmp_path / name)
        mesh = meshio.read(tmp_path / name)
        assert np.array_equal(mesh.points, tin.points)
        assert np.array_equal(mesh.cells_dict["triangle"], tin.triangles)


def test_pyvista_reads_our_obj(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    tin = hills()
    obj.write(tin, tmp_path / "a.obj")
    mesh = pyvista.read(tmp_path / "a.obj")
    assert np.array_equal(mesh.regular_faces, tin.triangles)


def test_pyvista_reads_our_stl_and_its_normals_point_up(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    tin = hills()
    path = tmp_path / "a.stl"
    stl.write(tin, path)
    mesh = pyvista.read(path)
    assert mesh.n_cells == len(tin.triangles)
    assert mesh.area == pytest.approx(tin.surface_area, rel=1e-6)
    facets = np.frombuffer(path.read_bytes()[84:], np.dtype("12<f4, <u2"))["f0"]
    computed = mesh.compute_normals(point_normals=False, auto_orient_normals=False)
    assert np.abs(facets[:, :3] - computed.cell_data["Normals"]).max() < 1e-3
    assert (facets[:, 2] > 0).all()


def test_stl_records_the_origin_that_it_subtracts(tmp_path):
    tin = hills()
    path = tmp_path / "a.stl"
    stl.write(tin, path)
    header = path.read_bytes()[:80].decode().strip()
    words = header.split()
    assert words[0] == "origin"
    assert words[4:] == ["crs", "EPSG:32616"]
    facets = np.frombuffer(path.read_bytes()[84:], np.dtype("12<f4, <u2"))["f0"]
    corners = facets[:, 3:].reshape(-1, 3, 3) + np.array(words[1:4], float)
    assert np.abs(corners - tin.points[tin.triangles]).max() < 300 / 2**23
    assert np.float32(tin.points[:, 1]).astype(float) != pytest.approx(tin.points[:, 1], abs=0.01)


@pytest.mark.parametrize("suffix", [".vtp", ".vtu"])
def test_pyvista_reads_our_vtk_files(tmp_path, suffix):
    pyvista = pytest.importorskip("pyvista")
    tin = hills(flagged=True)
    vtk.write(tin, tmp_path / f"a{suffix}")
    mesh = pyvista.read(tmp_path / f"a{suffix}")
    assert mesh.points.dtype == np.float64
    assert np.array_equal(mesh.points, tin.points)
    faces = mesh.regular_faces if suffix == ".vtp" else mesh.cells_dict[pyvista.CellType.TRIANGLE]
    assert np.array_equal(faces, tin.triangles)
    assert np.array_equal(mesh.cell_data["slope"], ts.terrain.slope(tin))
    assert np.array_equal(mesh.cell_data["aspect"], ts.terrain.aspect(tin), equal_nan=True)
    assert np.array_equal(mesh.cell_data["constrained"], tin.constrained)
    assert mesh.field_data["crs"][0] == "EPSG:32616"
    assert mesh.field_data["origin"].tolist() == [0, 0, 0]


# ----------------------------------------------------------------------- foreign PLY


def ply_text(body, *, vertex="property double x\nproperty double y\nproperty double z", **counts):
    count, faces = counts.get("vertices", 4), counts.get("faces", 2)
    name = counts.get("name", "vertex_indices")
    return (
        f"ply\nformat ascii 1.0\ncomment made elsewhere\nelement vertex {count}\n{vertex}\n"
        f"element face {faces}\nproperty list uchar int {name}\nend_header\n{body}"
    )


CORNERS = "0 0 1\n1 0 2\n1 1 3\n0 1 4\n"


def test_text_ply_of_triangles(tmp_path):
    path = tmp_path / "a.ply"
    path.write_text(ply_text(CORNERS + "3 0 1 2\n3 0 2 3\n"))
    tin = ply.read(path)
    same_mesh(tin, SQUARE, HALVES)
    assert tin.crs is None
    assert not tin.constrained.any()


@pytest.mark.parametrize("name", ["vertex_index", "vertex_indices"])
@pytest.mark.parametrize("line_end", [b"\n", b"\r\n"])
def test_both_names_of_the_face_list_and_both_line_ends(tmp_path, name, line_end):
    path = tmp_path / "a.ply"
    text = ply_text(CORNERS + "3 0 1 2\n3 0 2 3\n", name=name)
    path.write_bytes(text.encode().replace(b"\n", line_end))
    same_mesh(ply.read(path), SQUARE, HALVES)


def test_quads_and_triangles_mixed(tmp_path):
    path = tmp_path / "a.ply"
    corners = CORNERS + "2 0 5\n"
    path.write_text(ply_text(corners + "4 0 1 2 3\n3 1 4 2\n", vertices=5))
    tin = ply.read(path)
    same_mesh(tin, np.vstack([SQUARE, [2, 0, 5]]), [*HALVES, [1, 4, 2]])


def test_a_concave_quad_is_cut_along_its_inner_diagonal(tmp_path):
    # An arrowhead: the diagonal 0-2 runs outside, 1-3 inside.
    arrow = "0 0 0\n4 0 0\n1 1 0\n0 4 0\n"
    path = tmp_path / "a.ply"
    for turn in range(4):
        quad = " ".join(str((k + turn) % 4) for k in range(4))
        path.write_text(ply_text(arrow + f"4 {quad}\n", faces=1))
        tin = ply.read(path)
        assert tin.area == 4.0  # by the shoelace formula
        assert sorted(map(sorted, tin.triangles.tolist())) == [[0, 1, 2], [0, 2, 3]]


def binary_ply(order, *, coordinate="f4", index="u4", count="u1", extra=()):
    names = {
        "f4": "float",
        "f8": "double",
        "u4": "uint",
        "i4": "int32",
        "u1": "uint8",
        "u2": "ushort",
    }
    vertex = np.zeros(4, [(n, order + coordinate) for n in "xyz"] + [("red", "u1")])
    for k, n in enumerate("xyz"):
        vertex[n] = SQUARE[:, k]
    face = np.zeros(2, [("n", order + count), ("v", order + index, 3), *[(n, "u1") for n in extra]])
    face["n"], face["v"] = 3, HALVES
    kind = "binary_little_endian" if order == "<" else "binary_big_endian"
    lines = [
        *("ply", f"format {kind} 1.0", "obj_info from a scanner", "element sensor 2"),
        *("property short gain", "property list uchar float response", "element vertex 4"),
        *(f"property {names[coordinate]} {n}" for n in "xyz"),
        *("property uchar red", "element face 2"),
        f"property list {names[count]} {names[index]} vertex_index",
        *(f"property uchar {n}" for n in extra),
        "end_header",
    ]
    sensors = b"".join(
        struct.pack(f"{order}hB{n}f", 5, n, *range(n)) for n in (1, 3)
    )  # an element before the vertices, its rows not of one length
    return ("\n".join(lines) + "\n").encode() + sensors + vertex.tobytes() + face.tobytes()


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(("coordinate", "index", "count"), [("f4", "u4", "u1"), ("f8", "i4", "u2")])
def test_binary_ply_of_both_byte_orders(tmp_path, order, coordinate, index, count):
    path = tmp_path / "a.ply"
    path.write_bytes(
        binary_ply(order, coordinate=coordinate, index=index, count=count, extra=("flag", "red"))
    )
    same_mesh(ply.read(path), SQUARE, HALVES)


def test_ply_written_by_trimesh(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    tin = hills()
    mesh = trimesh.Trimesh(tin.points - ORIGIN, tin.triangles, process=False)
    mesh.visual.vertex_colors = np.full((len(tin.points), 4), 200, np.uint8)
    for encoding in ("ascii", "binary"):
        mesh.export(tmp_path / "a.ply", encoding=encoding)
        again = ply.read(tmp_path / "a.ply")
        assert np.abs(again.points - (tin.points - ORIGIN)).max() < 1e-4
        assert np.array_equal(again.triangles, tin.triangles)


def test_ply_without_faces_is_a_survey(tmp_path):
    path = tmp_path / "a.ply"
    path.write_text(
        ply_text(
            "0 0 1 17\n1 0 2 18\n",
            vertex="property float x\nproperty float y\nproperty float z\nproperty int class",
            vertices=2,
            faces=0,
        )
    )
    survey = ply.read(path, crs="EPSG:32616")
    assert isinstance(survey, ts.Survey)
    assert survey.points.tolist() == [[0, 0, 1], [1, 0, 2]]
    assert survey.attributes["class"].tolist() == [17, 18]
    assert (survey.crs, survey.source) == ("EPSG:32616", "a.ply")


def test_clockwise_faces_are_turned_round(tmp_path):
    path = tmp_path / "a.ply"
    path.write_text(ply_text(CORNERS + "3 2 1 0\n3 0 2 3\n"))
    assert (ply.read(path).triangle_areas > 0).all()


GOOD_TEXT = ply_text(CORNERS + "3 0 1 2\n3 0 2 3\n")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (" ", "no PLY file"),
        ("plywood\n", "no PLY file"),
        (GOOD_TEXT.replace("end_header", "end"), "does not end with 'end_header'"),
        (GOOD_TEXT.replace("format ascii 1.0\n", ""), "no line 'format'"),
        (GOOD_TEXT.replace("ascii", "ebcdic"), "line 2: 'format ebcdic 1.0'"),
        (GOOD_TEXT.replace("vertex 4", "vertex -4"), "line 4: 'element vertex -4'"),
        (GOOD_TEXT.replace("double y", "quad y"), "line 6: 'property quad y'"),
        (GOOD_TEXT.replace("uchar int", "float int"), "line 9"),
        (GOOD_TEXT.replace("double z", "double depth"), "no element 'vertex' with x, y and z"),
        (GOOD_TEXT.replace("vertex 4", "vertex 400"), "promises 400 rows of 'vertex'"),
        (GOOD_TEXT.replace("vertex 4", f"vertex {10**18}"), f"promises {10**18} rows"),
        (GOOD_TEXT.replace("face 2", f"face {10**30}"), f"promises {10**30} rows of 'face'"),
        (GOOD_TEXT[:-4], "promises 2 rows of 'face'"),
        (GOOD_TEXT.replace("3 0 2 3", "3 0 2 9"), "face 1 names vertex 9.*vertices 0 to 3"),
        (GOOD_TEXT.replace("3 0 2 3", "3 0 2 -1"), "face 1 names vertex -1"),
        (GOOD_TEXT.replace("3 0 2 3", "3 0 2 2.5"), "no whole number"),
        (GOOD_TEXT.replace("3 0 2 3", "3 0 2 nan"), "no number"),
        (GOOD_TEXT.replace("3 0 2 3", "2 0 2"), "face 1 has 2 corners"),
        (GOOD_TEXT.replace("3 0 2 3", "nan 0 2 3"), "length nan"),
        (GOOD_TEXT.replace("3 0 2 3", "-3 0 2 3"), "length -3"),
        (GOOD_TEXT.replace("3 0 2 3", "3 0 1 2"), "lie on the same side"),
        (GOOD_TEXT.replace("3 0 2 3", "3 0 2 2"), "no area"),
        (GOOD_TEXT.replace("1 1 3", "1 one 3"), "no number"),
        (GOOD_TEXT.replace("1 1 3", "1 nan 3"), "not finite"),
    ],
)
def test_damaged_text_ply(tmp_path, text, words):
    path = tmp_path / "a.ply"
    path.write_text(text)
    require_refusal("ply", path, words)


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_ply_cut_anywhere_is_a_read_error(tmp_path, order):
    whole = binary_ply(order)
    path = tmp_path / "a.ply"
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        with pytest.raises(ReadError):
            ply.read(path)


def test_binary_ply_with_any_byte_changed_is_read_or_refused(tmp_path):
    whole = binary_ply("<")
    path = tmp_path / "a.ply"
    outcomes = set()
    for at in range(len(whole)):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 0xFF]) + whole[at + 1 :])
        try:
            outcomes.add(type(ply.read(path)))
        except (ReadError, CrsError) as error:
            outcomes.add(type(error))
    assert {ts.TIN, ReadError} <= outcomes


def test_lying_counts_cost_no_memory(tmp_path):
    path = tmp_path / "a.ply"
    whole = binary_ply("<")
    for old, new in ((b"vertex 4", b"vertex 4000000000"), (b"face 2", b"face 99999999999999999")):
        path.write_bytes(whole.replace(old, new))
        with pytest.raises(ReadError, match="ends too early"):
            ply.read(path)


def test_ply_with_an_unknown_crs(tmp_path):
    path = tmp_path / "a.ply"
    path.write_text(GOOD_TEXT.replace("made elsewhere", "crs: EPSG:999999"))
    with pytest.raises(CrsError, match="EPSG:999999"):
        ply.read(path)
    assert ply.read(path, crs="EPSG:32616").crs == "EPSG:32616"


# ----------------------------------------------------------------------- foreign OBJ

OBJ_VERTICES = "v 0 0 1\nv 1 0 2\nv 1 1 3\nv 0 1 4\n"


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f 1/5 2/6 3/7\nf 1/5 3/7 4/8\n",
        "f 1//1 2//1 3//1\nf 1//1 3//1 4//1\n",
        "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\n",
        "f -4 -3 -2\nf -4 -2 -1\n",
        "f 1 2 3 4\n",
        "f 1 2 3 \\\n 4\n",
        "\tf  1\t2  3\r\n  f 1 3 4\r\n",
        "o part\ng group\nusemtl grass\ns off\nf 1 2 3\nvn 0 0 1\nvt 0 0\nl 1 2\nf 1 3 4\n# end\n",
    ],
)
def test_obj_forms_of_faces(tmp_path, faces):
    path = tmp_path / "a.obj"
    path.write_bytes(("# made elsewhere\nmtllib a.mtl\n" + OBJ_VERTICES + faces).encode())
    same_mesh(obj.read(path), SQUARE, HALVES)


def test_obj_with_negative_numbers_amid_the_vertices(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 1\nv 1 0 2\nv 1 1 3\nf -3 -2 -1\nv 0 1 4\nf -4 -2 -1\n")
    same_mesh(obj.read(path), SQUARE, HALVES)


def test_obj_with_vertex_colours(tmp_path):
    path = tmp_path / "a.obj"
    text = "v 0 0 1 .5 .5 .5\nv 1 0 2 1 1 1\nv 1 1 3\nv 0 1 4 1.0\nf 1 2 3\nf 1 3 4\n"
    path.write_text(text)
    same_mesh(obj.read(path), SQUARE, HALVES)


def test_obj_without_faces_is_a_survey(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text(OBJ_VERTICES)
    survey = obj.read(path)
    assert isinstance(survey, ts.Survey)
    assert np.array_equal(survey.points, SQUARE)


@pytest.mark.parametrize(
    ("text", "words", "line"),
    [
        ("# nothing\n", "holds no points", None),
        ("v 0 0 1\nv 1 0\nv 1 1 3\nf 1 2 3\n", "line 2: a vertex needs x, y and z", 2),
        ("v 0 0 1\nv 1 0 2\nv 1 one 3\nf 1 2 3\n", "line 3: a coordinate is no number", 3),
        ("v 0 0 1\nv 1 0 2\nv 1 nan 3\nf 1 2 3\n", "not finite", None),
        (OBJ_VERTICES + "f 1 2 5\n", "face 0 names vertex 4", None),
        (OBJ_VERTICES + "f 1 2 0\n", "line 5: '0' names no vertex", 5),
        (OBJ_VERTICES + "f 1 2 -5\n", "line 5: '-5' names no vertex", 5),
        (OBJ_VERTICES + "f 1 2 x\n", "line 5: 'x' names no vertex", 5),
        (OBJ_VERTICES + "f 1 2\n", "face 0 has 2 corners", None),
        (OBJ_VERTICES + "f 1 1 2\n", "no area", None),
    ],
)
def test_damaged_obj(tmp_path, text, words, line):
    path = tmp_path / "a.obj"
    path.write_text(text)
    assert require_refusal("obj", path, words).line == line


# ----------------------------------------------------------------------- foreign STL


def binary_stl(corners, header=b"exported by something"):
    facets = b"".join(struct.pack("<12fH", 0, 0, 1, *np.ravel(c), 0) for c in corners)
    return header.ljust(80, b"\0") + struct.pack("<I", len(corners)) + facets


def test_foreign_stl_merges_corners_exactly(tmp_path):
    path = tmp_path / "a.stl"
    near = SQUARE.copy()
    near[0] += 1e-6  # a float32 of its own
    second = [near[0], near[2], near[3]]
    path.write_bytes(binary_stl([SQUARE[HALVES[0]], SQUARE[HALVES[1]]]))
    tin = stl.read(path)
    same_mesh(tin, SQUARE, HALVES)
    assert tin.crs is None
    path.write_bytes(binary_stl([SQUARE[HALVES[0]], second]))
    assert len(stl.read(path).points) == 5


def test_foreign_stl_with_negative_zero_and_a_header_that_says_solid(tmp_path):
    path = tmp_path / "a.stl"
    other = SQUARE.copy()
    other[other == 0] = -0.0
    path.write_bytes(binary_stl([SQUARE[HALVES[0]], other[HALVES[1]]], b"solid but binary"))
    assert len(stl.read(path).points) == 4


def test_trimesh_stl(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    tin = hills()
    trimesh.Trimesh(tin.points - ORIGIN, tin.triangles, process=False).export(tmp_path / "a.stl")
    again = stl.read(tmp_path / "a.stl")
    assert len(again.points) == len(tin.points)
    assert len(again.triangles) == len(tin.triangles)


GOOD_STL = binary_stl([SQUARE[HALVES[0]], SQUARE[HALVES[1]]])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"too short", "shorter than a header"),
        (GOOD_STL[:-1], "promises 2 facets, and there is room for 1"),
        (GOOD_STL[:80] + b"\xff\xff\xff\xff" + GOOD_STL[84:], "promises 4294967295 facets"),
        (GOOD_STL[:84].replace(b"\x02", b"\x00"), "holds no facets"),
        (b"solid a\n facet normal 0 0 1\n  outer loop\n" * 3, "text STL"),
        (binary_stl([[[0, 0, 0], [0, 0, 1], [1, 0, 0]]]), "no area"),
        (binary_stl([[[0, 0, 0], [1, 0, np.nan], [1, 1, 0]]]), "not finite"),
    ],
)
def test_damaged_stl(tmp_path, content, words):
    path = tmp_path / "a.stl"
    path.write_bytes(content)
    require_refusal("stl", path, words)


# ----------------------------------------------------------------------- foreign VTK


def test_vtk_files_of_quads_lines_and_mixed_cells(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.PolyData(SQUARE, lines=[2, 0, 1], faces=[4, 0, 1, 2, 3])
    mesh.save(tmp_path / "a.vtp")
    same_mesh(vtk.read(tmp_path / "a.vtp"), SQUARE, HALVES)
    mesh.cast_to_unstructured_grid().save(tmp_path / "a.vtu")
    same_mesh(vtk.read(tmp_path / "a.vtu"), SQUARE, HALVES)


def test_flags_of_faces_behind_lines(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.PolyData(SQUARE, lines=[2, 0, 1], faces=[3, 0, 1, 2, 3, 0, 2, 3])
    flags = np.array([[1, 1, 1], [0, 1, 0], [0, 0, 1]], np.uint8)
    mesh.cell_data["constrained"] = flags
    for name, saved in (("a.vtp", mesh), ("a.vtu", mesh.cast_to_unstructured_grid())):
        saved.save(tmp_path / name)
        assert np.array_equal(vtk.read(tmp_path / name).constrained, flags[1:])


def test_a_lifted_tin_that_was_saved_comes_back(tmp_path):
    pytest.importorskip("pyvista")
    tin = hills()
    ts.terrain.lift(tin, exaggeration=2.5).save(tmp_path / "a.vtp")
    again = vtk.read(tmp_path / "a.vtp")
    assert np.abs(again.points - tin.points).max() < 1e-8
    assert np.array_equal(again.triangles, tin.triangles)
    assert again.crs == tin.crs


@pytest.mark.parametrize("name", ["exaggeration", "elevation_scale"])
@pytest.mark.parametrize("factor", [0.0, -1.0])
def test_a_factor_that_is_no_scale_leaves_elevations_as_they_are(tmp_path, name, factor):
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.PolyData(SQUARE, faces=[3, 0, 1, 2, 3, 0, 2, 3])
    mesh.field_data[name] = [factor]
    mesh.save(tmp_path / "a.vtp")
    assert np.array_equal(vtk.read(tmp_path / "a.vtp").points, SQUARE)


def test_vtk_points_without_faces_are_a_survey(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    cloud = pyvista.PolyData(SQUARE)
    cloud.point_data["class"] = [2, 2, 5, 6]
    cloud.save(tmp_path / "a.vtp")
    survey = vtk.read(tmp_path / "a.vtp")
    assert isinstance(survey, ts.Survey)
    assert np.array_equal(survey.points, SQUARE)
    assert survey.attributes["class"].tolist() == [2, 2, 5, 6]


def test_vtk_solids_and_strips_are_refused(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    pyvista.ImageData(dimensions=(2, 2, 2)).cast_to_unstructured_grid().save(tmp_path / "a.vtu")
    with pytest.raises(ReadError, match="1 cell that is no face "):
        vtk.read(tmp_path / "a.vtu")
    pyvista.PolyData(SQUARE, faces=[3, 0, 1, 2, 3, 0, 2, 3]).strip().save(tmp_path / "a.vtp")
    with pytest.raises(ReadError, match="strips"):
        vtk.read(tmp_path / "a.vtp")
    pyvista.ImageData(dimensions=(2, 2, 2)).save(tmp_path / "a.vti")
    with pytest.raises(ReadError, match="of type ImageData"):
        vtk.read(tmp_path / "a.vti")


def test_damaged_vtk_files_are_refused_quietly(tmp_path, capfd):
    pytest.importorskip("pyvista")
    path = tmp_path / "a.vtp"
    vtk.write(hills(20), path)
    whole = path.read_bytes()
    damaged = [
        b"nothing of the kind",
        whole[: len(whole) // 2],
        whole[:500] + b"</VTKFile>\n",
        whole.replace(b'NumberOfPoints="20"', b'NumberOfPoints="99999999999999"'),
        whole.replace(b'NumberOfPoints="20"', b'NumberOfPoints="2000"'),
        whole.replace(b"eA", b"eB"),
        whole.replace(b"<Points>", b"<Pints>"),
    ]
    for content in damaged:
        assert content != whole
        path.write_bytes(content)
        with pytest.raises(ReadError):
            vtk.read(path)
    assert capfd.readouterr() == ("", "")


# ------------------------------------------------------------------------ all of them


@pytest.mark.parametrize("module", [ply, obj, stl, vtk])
def test_a_file_that_is_not_there(tmp_path, module):
    with pytest.raises(ReadError, match="No such file"):
        module.read(tmp_path / "missing")


@pytest.mark.parametrize("module", [obj, stl, vtk])
def test_a_survey_has_no_faces(tmp_path, module):
    survey = ts.Survey(points=SQUARE)
    with pytest.raises(FormatError, match="triangulate it first"):
        module.write(survey, tmp_path / "a")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("module", [ply, obj, stl, vtk])
def test_something_that_is_no_surface(tmp_path, module):
    with pytest.raises(FormatError, match="a dict is neither"):
        module.write({}, tmp_path / "a")
    assert not list(tmp_path.iterdir())


# ------------------------------------------------------------------ what a file's mesh is, is told

TWO_OVER_EACH_OTHER = """v 0 0 1
v 4 0 1
v 0 4 1
v 1 1 5
v 5 1 5
v 1 5 5
f 1 2 3
f 4 5 6
"""


def notes_of(tmp_path, text, name="a.obj"):
    path = tmp_path / name
    path.write_text(text)
    return list(ts.read(path).report.notes)


def test_triangles_of_a_file_that_overlap_are_told(tmp_path):
    assert notes_of(tmp_path, TWO_OVER_EACH_OTHER) == [
        "Triangles overlap (westernmost place: near vertex 3). `faces='surface'` leaves out 1 of 2 "
        "triangles (1 that overlaps others, 50 % of the area)."
    ]


def test_a_fan_that_winds_twice_is_told(tmp_path):
    angles = np.arange(8) * (4 * np.pi / 8) + 0.1 * (np.arange(8) >= 4)
    rows = [f"v {math.cos(a)!r} {math.sin(a)!r} 1" for a in angles.tolist()]
    faces = [f"f 1 {k + 2} {(k + 1) % 8 + 2}" for k in range(8)]
    text = "\n".join(["v 0 0 1", *rows, *faces, ""])
    assert any("overlap" in note for note in notes_of(tmp_path, text))


def test_vertices_of_no_triangle_are_told(tmp_path):
    text = "v 0 0 1\nv 9 9 9\nv 4 0 1\nv 0 4 1\nf 1 3 4\n"
    assert notes_of(tmp_path, text) == ["1 vertex belongs to no triangle (first: vertex 1)."]


@pytest.mark.parametrize("name", ["a.ply", "a.obj", "a.vtu", "a.msh"])
def test_a_concave_mesh_in_two_pieces_has_no_notes(tmp_path, name):
    points = [[0, 0, 1], [4, 0, 1], [1, 1, 1], [0, 4, 1], [9, 9, 1], [9, 12, 2], [7, 12, 2]]
    tin = ts.TIN.from_triangles(points, [[0, 1, 2], [0, 2, 3], [4, 5, 6]])
    again = ts.read(ts.write(tin, tmp_path / name))
    assert list(again.report.notes) == []
    assert len(again.triangles) == 3


def test_an_edge_that_is_constrained_on_one_side_is_told():
    points = [[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]]
    flags = [[False, True, False], [False, False, False]]
    tin = ts.TIN.from_triangles(points, [[0, 1, 2], [0, 2, 3]], constrained=flags)
    assert describe_oddities(tin) == ["1 edge is constrained on one side only."]


def test_a_boundary_too_long_to_be_swept_is_told(monkeypatch):
    monkeypatch.setattr("tinsmith.tin.checking.overlaps._MOST_EDGES", 5)
    points = [[0, 0, 1], [4, 0, 1], [0, 4, 1], [1, 1, 5], [5, 1, 5], [1, 5, 5]]
    tin = ts.TIN.from_triangles(points, [[0, 1, 2], [3, 4, 5]])
    overlap = find_overlap(tin)
    assert not overlap.is_found
    assert "whether triangles overlap was not looked at" in overlap.sentence


@pytest.mark.parametrize("command", ["info", "convert"])
def test_the_command_line_shows_what_is_odd_in_a_mesh(tmp_path, command):
    path = tmp_path / "a.obj"
    path.write_text(TWO_OVER_EACH_OTHER)
    arguments = [
        command,
        str(path),
        *(["-o", str(tmp_path / "b.ply")] if command != "info" else []),
    ]
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 0
    assert "Triangles overlap" in done.output


def test_a_tin_too_large_for_float32_is_no_stl(tmp_path):
    far = [[0, 0, 0], [1e39, 0, 0], [0, 1e39, 0]]
    with pytest.raises(ts.WriteError, match="the TIN is too large for float32"):
        ts.io.write(ts.triangulate(far), tmp_path / "a.stl")
    assert not list(tmp_path.iterdir())
