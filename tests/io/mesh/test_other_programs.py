"""Meshes as other programs leave them: what is guessed or rounded in them is told."""

import json
import struct

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.errors import ReadError

VERTICES = np.array([[500_000.12, 4e6, 10], [500_010.2, 4e6, 11],
                     [500_010.3, 4_000_010.4, 13], [500_000.3, 4_000_010.1, 12]])  # fmt: skip
TURN = (0, 1, 2, 3)
CUT = "1 polygon of the file was cut into triangles"
ROUNDED = "Coordinates of the file are numbers of 32 bits: those about 4,000,010.5 are rounded to"


def write_ply(path, *, number="double", order="<", faces=(TURN,)):
    form = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\nformat {form} 1.0\nelement vertex 4\n"
    head += "".join(f"property {number} {axis}\n" for axis in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    body = VERTICES.astype(order + {"double": "f8", "float": "f4"}[number]).tobytes()
    body += b"".join(struct.pack(f"{order}B{len(one)}i", len(one), *one) for one in faces)
    path.write_bytes(head.encode() + body)
    return path


def write_obj(path):
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in VERTICES.tolist()]
    path.write_text("\n".join([*rows, "f 1 2 3 4", ""]))
    return path


def write_off(path):
    rows = [f"{x!r} {y!r} {z!r}" for x, y, z in VERTICES.tolist()]
    path.write_text("\n".join(["OFF", "4 1 0", *rows, "4 0 1 2 3", ""]))
    return path


def write_vtp(path, *, dtype=np.float64, faces=(TURN,)):
    pyvista = pytest.importorskip("pyvista")
    cells = np.concatenate([[len(one), *one] for one in faces])
    pyvista.PolyData(VERTICES.astype(dtype), cells).save(path)
    return path


@pytest.mark.parametrize(
    ("write", "name"),
    [(write_ply, "a.ply"), (write_obj, "a.obj"), (write_off, "a.off"), (write_vtp, "a.vtp")],
)
def test_the_diagonal_of_a_quadrilateral_is_told_to_be_a_guess(tmp_path, write, name):
    tin = ts.read(write(tmp_path / name))
    assert len(tin.triangles) == 2
    assert any(CUT in note for note in tin.report.notes)


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize(("number", "is_stated"), [("float", True), ("double", False)])
@pytest.mark.parametrize("faces", [[(0, 1, 2)], []])
def test_ply_of_single_precision_says_how_far_it_is_rounded(
    tmp_path, order, number, is_stated, faces
):
    found = ts.read(write_ply(tmp_path / "a.ply", number=number, order=order, faces=faces))
    notes = found.report.notes if faces else found.notes
    assert any(f"{ROUNDED} multiples of 0.25" in note for note in notes) == is_stated


@pytest.mark.parametrize(("dtype", "is_stated"), [(np.float32, True), (np.float64, False)])
def test_vtk_of_single_precision_says_how_far_it_is_rounded(tmp_path, dtype, is_stated):
    tin = ts.read(write_vtp(tmp_path / "a.vtp", dtype=dtype, faces=[(0, 1, 2)]))
    assert any(ROUNDED in note for note in tin.report.notes) == is_stated


def test_stl_at_map_coordinates_says_how_far_it_is_rounded_and_ours_does_not(tmp_path):
    facet = struct.pack("<12fH", 0, 0, 1, *VERTICES[:3].ravel(), 0)
    (tmp_path / "a.stl").write_bytes(b"made elsewhere".ljust(80) + struct.pack("<I", 1) + facet)
    assert any(ROUNDED in note for note in ts.read(tmp_path / "a.stl").report.notes)
    ours = ts.write(ts.triangulate(VERTICES), tmp_path / "ours.stl")
    assert not any("32 bits" in note for note in ts.read(ours).report.notes)


@pytest.mark.parametrize("word", ["solid a\n facet normal", "SOLID a\n FACET NORMAL"])
def test_stl_in_text_is_called_so_in_any_case(tmp_path, word):
    (tmp_path / "a.stl").write_text(f"{word} 0 0 1\n" + " " * 100)
    with pytest.raises(ReadError, match="is a text STL"):
        ts.read(tmp_path / "a.stl")


def test_a_vertex_of_no_data_is_told(tmp_path):
    text = "MESH2D\nE3T 1 1 2 3 1\nE3T 2 2 4 3 1\n"
    text += "ND 1 0 0 -9999\nND 2 1 0 2\nND 3 0 1 3\nND 4 1 1 3\n"
    (tmp_path / "a.2dm").write_text(text)
    notes = ts.read(tmp_path / "a.2dm").report.notes
    assert any("1 vertex has the elevation -9999, far from the others (2 to 3)" in n for n in notes)


@pytest.mark.parametrize(("version", "is_read"), [("1.0", True), ("1.1", False), ("2.0", False)])
def test_cityjson_without_the_transform_that_its_version_needs_is_refused(
    tmp_path, version, is_read
):
    path = ts.write(ts.triangulate(VERTICES, crs="EPSG:32616"), tmp_path / "a.city.json")
    city = json.loads(path.read_text())
    del city["transform"]
    path.write_text(json.dumps(city | {"version": version}))
    if is_read:
        assert len(ts.read(path).points) == 4
    else:
        with pytest.raises(ReadError, match="needs a transform, and it has none"):
            ts.read(path)


def write_ugrid(path, *, units=("m", "m"), crs="EPSG:32616", dtype=None):
    netcdf = pytest.importorskip("netCDF4")
    ts.write(ts.triangulate(VERTICES, crs=crs), path)
    with netcdf.Dataset(path, "a") as data:
        names = data.variables["mesh2d"].node_coordinates.split()[:2]
        for name, unit in zip(names, units, strict=True):
            data.variables[name].units = unit
            del data.variables[name].standard_name
    return path


@pytest.mark.parametrize(
    ("units", "crs", "name"),
    [
        (("km", "km"), "EPSG:32616", "kilometre"),
        (("m", "m"), "EPSG:2274", "metre"),
        (("degrees_east", "degrees_north"), "EPSG:32616", "degrees"),
    ],
)
def test_units_of_a_ugrid_mesh_that_are_not_those_of_its_crs_are_refused(
    tmp_path, units, crs, name
):
    with pytest.raises(ReadError, match=f"eastings and northings in {name}"):
        ts.read(write_ugrid(tmp_path / "a.nc", units=units, crs=crs))


@pytest.mark.parametrize(
    ("units", "note"),
    [
        (("km", "km"), "are in kilometre, and no CRS is named"),
        (("degrees_east", "degrees_north"), "are in degrees, and no CRS is named"),
        (("m", "m"), None),
    ],
)
def test_units_of_a_ugrid_mesh_without_a_crs_are_told(tmp_path, units, note):
    tin = ts.read(write_ugrid(tmp_path / "a.nc", units=units, crs=None))
    assert any(note in one for one in tin.report.notes) if note else not tin.report.notes
