"""GLB files against the specification of glTF 2.0, as trimesh sees them, and their textures."""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest
from support.mesh_files import assert_same_mesh
from support.surfaces import hills

import tinsmith as ts

COMPONENTS = {5126: "<f4", 5125: "<u4", 5123: "<u2"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
ARRAY, ELEMENTS = 34962, 34963


def parse(path):
    """Check the container and every view; return the document, and the arrays of accessors."""
    content = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    assert kind == b"JSON"
    assert size % 4 == 0
    document = json.loads(content[20 : 20 + size])
    binary_size, binary_kind = struct.unpack_from("<I4s", content, 20 + size)
    assert binary_kind == b"BIN\x00"
    assert binary_size % 4 == 0
    binary = content[28 + size :]
    assert len(binary) == binary_size == document["buffers"][0]["byteLength"]
    return document, [_load(document, one, binary) for one in document["accessors"]], binary


def _load(document, accessor, binary):
    view = document["bufferViews"][accessor["bufferView"]]
    dtype = np.dtype(COMPONENTS[accessor["componentType"]])
    width = WIDTHS[accessor["type"]]
    assert view["byteOffset"] % dtype.itemsize == 0
    assert view["byteOffset"] % 4 == 0
    assert view["byteLength"] == accessor["count"] * width * dtype.itemsize
    assert view["byteOffset"] + view["byteLength"] <= len(binary)
    array = np.frombuffer(binary, dtype, accessor["count"] * width, view["byteOffset"])
    array = array.reshape(-1, width)
    if "min" in accessor:
        assert array.min(axis=0).astype(float).tolist() == accessor["min"]
        assert array.max(axis=0).astype(float).tolist() == accessor["max"]
    return array


def restore(positions, node):
    """Return coordinates as ``extras`` tells the way back."""
    extras = node["extras"]
    turned = np.column_stack([positions[:, 0], -positions[:, 2], positions[:, 1]]).astype(float)
    metres = np.array(extras["metres"]) * (1, 1, extras["exaggeration"])
    return turned / metres + extras["origin"]


@pytest.mark.parametrize(("crs", "unit"), [("EPSG:32616", "US survey foot"), ("EPSG:2274", None),
                                           (None, None)])  # fmt: skip
@pytest.mark.parametrize("exaggeration", [1.0, 3.0])
def test_the_file_keeps_to_the_specification(tmp_path, crs, unit, exaggeration):
    tin = hills(crs=crs, unit=unit)
    path = ts.write(tin, tmp_path / "a.glb", exaggeration=exaggeration)
    document, arrays, _ = parse(path)
    assert document["asset"]["version"] == "2.0"
    (node,) = document["nodes"]
    (primitive,) = document["meshes"][0]["primitives"]
    named = primitive["attributes"]
    positions, normals = arrays[named["POSITION"]], arrays[named["NORMAL"]]
    indices = arrays[primitive["indices"]].reshape(-1, 3)
    targets = [document["bufferViews"][one["bufferView"]]["target"]
               for one in document["accessors"]]  # fmt: skip
    assert targets == [ARRAY] * 3 + [ELEMENTS]
    assert "min" in document["accessors"][named["POSITION"]]
    assert np.array_equal(indices, tin.triangles)
    extent = np.ptp(tin.points, axis=0).max()
    assert np.abs(restore(positions, node) - tin.points).max() < extent / 2**22
    assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-6
    assert (normals[:, 1] > 0).all()
    a, b, c = (positions[indices[:, k]].astype(float) for k in range(3))
    assert (np.cross(b - a, c - a)[:, 1] > 0).all()  # front faces look up
    colors = arrays[named["COLOR_0"]]
    assert document["accessors"][named["COLOR_0"]]["normalized"] is True
    low, high = np.argmin(tin.points[:, 2]), np.argmax(tin.points[:, 2])
    assert colors[low, :3].sum() < colors[high, :3].sum()


def test_normals_are_those_of_the_true_surface(tmp_path):
    tin = hills(exact := 200, crs="EPSG:32616", unit="US survey foot")
    assert exact
    _, arrays, _ = parse(ts.write(tin, tmp_path / "a.glb"))
    expected = tin.vertex_normals
    turned = np.column_stack([expected[:, 0], expected[:, 2], -expected[:, 1]])
    assert np.abs(arrays[1] - turned).max() < 1e-6


def test_trimesh_sees_the_surface_in_its_place(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    tin = hills(unit=None)
    scene = trimesh.load(ts.write(tin, tmp_path / "a.glb"))
    low, high = tin.points.min(axis=0), tin.points.max(axis=0)
    assert scene.bounds[0] == pytest.approx([low[0], low[2], -high[1]], abs=1e-3)
    assert scene.bounds[1] == pytest.approx([high[0], high[2], -low[1]], abs=1e-3)
    (mesh,) = scene.geometry.values()
    assert mesh.area == pytest.approx(tin.surface_area, rel=1e-6)


def test_vertices_of_no_triangle_are_left_out(tmp_path):
    points = np.array([[9, 9, 9], [0, 0, 1], [4, 0, 2], [0, 4, 3]], float)
    tin = ts.TIN.from_triangles(points, [[1, 2, 3]])
    document, arrays, _ = parse(ts.write(tin, tmp_path / "a.glb"))
    assert [len(array) for array in arrays] == [3, 3, 3, 3]
    assert document["accessors"][3]["componentType"] == 5123


def test_degrees_are_refused(tmp_path):
    tin = ts.triangulate(np.array([[8, 50, 1], [9, 50, 1], [8, 51, 2]]), crs="EPSG:4326")
    with pytest.raises(ts.CrsError, match="projected CRS"):
        ts.write(tin, tmp_path / "a.glb")
    with pytest.raises(ts.OptionError, match="exaggeration"):
        ts.write(hills(), tmp_path / "a.glb", exaggeration=0)
    assert not list(tmp_path.iterdir())


# ------------------------------------------------------------------------- textures


def make_picture(path, *, crs="EPSG:32616", size=(310, 300), west=744_995.0, driver="GTiff"):
    """Write a picture whose red grows to the east and whose green grows to the south."""
    rasterio = pytest.importorskip("rasterio")
    width, height = size
    colors = np.zeros((3, height, width), np.uint8)
    colors[0] = np.linspace(0, 255, width)
    colors[1] = np.linspace(0, 255, height)[:, None]
    place = rasterio.Affine(310 / width, 0.0, west, 0.0, -300 / height, 4_033_300.0)
    with rasterio.open(path, "w", driver=driver, count=3, width=width, height=height,
                       dtype="uint8", crs=crs, transform=place) as target:  # fmt: skip
        target.write(colors)
    return path


def write_world_file(path):
    """Place a picture of 310 by 300 pixels of a metre by the centre of its first pixel."""
    path.write_text("1.0\n0.0\n0.0\n-1.0\n744995.5\n4033299.5\n")


def make_png(folder):
    """Write a PNG file with a world file, and nothing else beside it."""
    source = make_picture(folder / "o.png", driver="PNG", crs=None)
    for one in folder.glob("o.png.*"):
        one.unlink()
    (folder / "o.wld").unlink(missing_ok=True)
    write_world_file(folder / "o.pgw")
    return source


@pytest.mark.parametrize("kind", ["tif", "png"])
def test_each_vertex_has_the_colour_of_its_place(tmp_path, kind):
    pil = pytest.importorskip("PIL.Image")
    from io import BytesIO

    tin = hills()
    source = make_picture(tmp_path / "o.tif") if kind == "tif" else make_png(tmp_path)
    document, arrays, binary = parse(ts.write(tin, tmp_path / "a.glb", ortho=source))
    (primitive,) = document["meshes"][0]["primitives"]
    assert "COLOR_0" not in primitive["attributes"]
    uv = arrays[primitive["attributes"]["TEXCOORD_0"]].astype(float)
    (image,) = document["images"]
    view = document["bufferViews"][image["bufferView"]]
    content = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    assert image["mimeType"] == ("image/jpeg" if kind == "tif" else "image/png")
    if kind == "png":
        assert content == source.read_bytes()
    picture = np.asarray(pil.open(BytesIO(content)).convert("RGB")).astype(float)
    rows = np.clip((uv[:, 1] * 300).astype(int), 0, 299)
    columns = np.clip((uv[:, 0] * 310).astype(int), 0, 309)
    east = (tin.points[:, 0] - 744_995) / 310 * 255
    south = (4_033_300 - tin.points[:, 1]) / 300 * 255
    assert np.abs(picture[rows, columns, 0] - east).max() < 6
    assert np.abs(picture[rows, columns, 1] - south).max() < 6


def test_an_obj_with_a_texture_has_its_material_beside_it(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    tin = hills()
    source = make_picture(tmp_path / "ortho.tif")
    path = ts.write(tin, tmp_path / "site.obj", ortho=source)
    assert {one.name for one in tmp_path.iterdir()} == {
        "ortho.tif", "site.obj", "site.mtl", "site_texture.jpg"}  # fmt: skip
    mesh = trimesh.load(path, process=False)
    assert mesh.visual.material.image.size == (310, 300)
    u = (tin.points[:, 0] - 744_995) / 310
    v = 1 - (4_033_300 - tin.points[:, 1]) / 300
    assert np.abs(mesh.visual.uv - np.column_stack([u, v])).max() < 1e-6
    back = ts.read(path)
    assert_same_mesh(back, tin)


def test_the_texture_is_never_written_over(tmp_path):
    source = make_picture(tmp_path / "site_texture.jpg", driver="JPEG", crs=None)
    write_world_file(tmp_path / "site_texture.jgw")
    before = source.read_bytes()
    with pytest.raises(ts.WriteError, match="the texture itself"):
        ts.write(hills(), tmp_path / "site.obj", ortho=source)
    assert source.read_bytes() == before
    assert not (tmp_path / "site.obj").exists()


def test_a_large_picture_is_made_smaller_and_it_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("tinsmith.io.mesh.texture.MOST_PIXELS", 100)
    source = make_picture(tmp_path / "o.tif")
    with pytest.warns(ts.LossWarning, match="from 310 x 300 to"):
        ts.write(hills(), tmp_path / "a.glb", ortho=source)


def test_pictures_that_do_not_fit(tmp_path):
    tin = hills()
    elsewhere = make_picture(tmp_path / "far.tif", west=0.0)
    with pytest.raises(ts.ReadError, match="shows nothing of the surface"):
        ts.write(tin, tmp_path / "a.glb", ortho=elsewhere)
    other = make_picture(tmp_path / "other.tif", crs="EPSG:25832")
    with pytest.raises(ts.ReadError, match="shows nothing of the surface"):
        ts.write(tin, tmp_path / "a.glb", ortho=other)
    half = make_picture(tmp_path / "half.tif", west=745_150.0)
    with pytest.warns(ts.LossWarning, match="does not reach over"):
        ts.write(tin, tmp_path / "a.glb", ortho=half)
    bare = make_png(tmp_path)
    (tmp_path / "o.pgw").unlink()
    with pytest.raises(ts.ReadError, match="no world file"):
        ts.write(tin, tmp_path / "a.glb", ortho=bare)
    with pytest.raises(ts.ReadError, match="Cannot read"):
        ts.write(tin, tmp_path / "a.glb", ortho=tmp_path / "nothing.tif")
    with pytest.raises(ts.ReadError, match="only files of this machine"):
        ts.write(tin, tmp_path / "a.glb", ortho="https://example.org/o.tif")
    with pytest.raises(ts.OptionError, match="path of a GeoTIFF"):
        ts.write(tin, tmp_path / "a.glb", ortho=7)


@pytest.mark.parametrize(
    "text", ["", "1\n0\n0\n-1\n0\n", "1 0 0 -1 x 0", "0 0 0 0 1 1", "nan 0 0 1 1 1"]
)
def test_damaged_world_files(tmp_path, text):
    source = make_png(tmp_path)
    (tmp_path / "o.pgw").write_text(text)
    with pytest.raises(ts.ReadError, match=r"world file|no place on the ground"):
        ts.write(hills(), tmp_path / "a.glb", ortho=source)


def slivers(count=12):
    """A surface with pairs of vertices that float32 does not tell apart."""
    rng = np.random.default_rng(count)
    inside = rng.uniform(20, 180, (count, 2))
    square = np.array([[0.0, 0], [200, 0], [200, 200], [0, 200]])
    xy = np.vstack([square, inside, inside + 1e-6]) + np.array([752_600, 4_024_100])
    return ts.triangulate(np.column_stack([xy, np.rint(xy[:, 0]) % 7]))


def test_slivers_are_left_out_and_told(tmp_path):
    tin = slivers()
    with pytest.warns(ts.LossWarning, match=r"does not hold \d+ triangles? without area") as told:
        path = ts.write(tin, tmp_path / "a.glb")
    document, arrays, _ = parse(path)
    (primitive,) = document["meshes"][0]["primitives"]
    triangles = arrays[primitive["indices"]].reshape(-1, 3)
    positions = arrays[primitive["attributes"]["POSITION"]].astype(float)
    corners = positions[triangles]
    areas = np.linalg.norm(np.cross(*(corners[:, k] - corners[:, 0] for k in (1, 2))), axis=1)
    left_out = int(told[0].message.args[0].split()[4])
    assert len(triangles) == len(tin.triangles) - left_out
    assert (areas > 0).all()
    assert np.array_equal(np.unique(triangles), np.arange(len(positions)))
    flat = positions[triangles][..., [0, 2]]
    u, v = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    covered = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2
    assert covered == pytest.approx(tin.area, rel=1e-5)


def test_a_surface_of_nothing_but_slivers_is_refused(tmp_path):
    tin = ts.TIN.from_triangles([[0, 0, 1], [1e6, 1e6, 1], [2e6, 2e6 + 0.01, 1]], [[0, 1, 2]])
    with pytest.raises(ts.WriteError, match="nothing but 1 triangle without area"):
        ts.write(tin, tmp_path / "a.glb")
    assert not (tmp_path / "a.glb").exists()
