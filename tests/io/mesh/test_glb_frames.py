"""GLB is read back where it was, wherever the file puts it; foreign and damaged files."""

from __future__ import annotations

import json
import struct

import numpy as np
import pyproj
import pytest
from support.surfaces import hills

import tinsmith as ts

pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")


def look(path):
    """Return the document and the rest of a file."""
    content = path.read_bytes()
    size = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20 : 20 + size]), content[20 + size :]


def store(path, document, rest):
    text = json.dumps(document).encode() if isinstance(document, dict) else document
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
    path.write_bytes(head + text + rest)
    return path


@pytest.mark.parametrize("frame", ["map", "local", "globe"])
@pytest.mark.parametrize("exaggeration", [1.0, 2.5])
@pytest.mark.parametrize(
    ("crs", "unit"), [("EPSG:32616", "US survey foot"), ("EPSG:2274", None), ("EPSG:32616", "m")]
)
def test_what_is_written_is_read_back(tmp_path, frame, exaggeration, crs, unit):
    tin = hills(crs=crs, unit=unit)
    path = ts.write(tin, tmp_path / "a.glb", frame=frame, exaggeration=exaggeration)
    back = ts.read(path)
    assert back.crs == tin.crs
    assert back.elevation_unit == tin.elevation_unit
    assert len(back.triangles) == len(tin.triangles)
    step = np.ptp(tin.points, axis=0).max() / 2**23
    found, wanted = (one.points[one.triangles] for one in (back, tin))
    away = np.abs(found - wanted).max(axis=(0, 1))
    assert (away <= max(step, 1e-4 if frame == "globe" else 0.0)).all(), away


def test_the_globe_is_that_of_proj(tmp_path):
    """Nodes and vertices lie where PROJ has them in EPSG:4978, as 3D Tiles turn glTF up."""
    tin = hills(crs="EPSG:32616", unit="m")
    path = ts.write(tin, tmp_path / "a.glb", frame="globe")
    trimesh = pytest.importorskip("trimesh")
    (mesh,) = trimesh.load_scene(path).dump()
    found = np.column_stack([mesh.vertices[:, 0], -mesh.vertices[:, 2], mesh.vertices[:, 1]])
    x, y, z = tin.points.T
    to_globe = pyproj.Transformer.from_crs("EPSG:32616", "EPSG:4979", always_xy=True)
    longitude, latitude, _ = to_globe.transform(x, y, z)
    geocentric = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    wanted = np.column_stack(geocentric.transform(longitude, latitude, z))
    assert np.abs(found[mesh.faces] - wanted[tin.triangles]).max() < 1e-3
    node = look(path)[0]["nodes"][0]
    turn = np.array(node["matrix"]).reshape(4, 4)[:3, :3]
    assert np.abs(turn @ turn.T - np.eye(3)).max() < 1e-12
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_degrees_are_written_on_the_globe(tmp_path):
    points = np.array([[8, 50, 100.0], [8.01, 50, 200], [8, 50.01, 300], [8.01, 50.012, 50]])
    tin = ts.triangulate(points, crs="EPSG:4326")
    with pytest.raises(ts.CrsError, match="frame='globe'"):
        ts.write(tin, tmp_path / "a.glb")
    back = ts.read(ts.write(tin, tmp_path / "a.glb", frame="globe"))
    assert np.abs(back.points - tin.points).max(axis=0) == pytest.approx([0, 0, 0], abs=1e-3)
    with pytest.raises(ts.CrsError, match="declare it"):
        ts.write(hills(crs=None), tmp_path / "b.glb", frame="globe")
    with pytest.raises(ts.OptionError, match="frame"):
        ts.write(tin, tmp_path / "b.glb", frame="moon")


def test_extras_tell_the_datum_and_local_scenes_are_about_zero(tmp_path):
    tin = hills(crs="EPSG:32616+5703", unit="m")
    path = ts.write(tin, tmp_path / "a.glb", frame="local")
    document, _ = look(path)
    (node,) = document["nodes"]
    assert "translation" not in node
    assert node["extras"]["verticalDatum"] == "NAVD88 height"
    assert node["extras"]["frame"] == "local"
    low, high = (np.array(document["accessors"][0][name]) for name in ("min", "max"))
    assert np.abs(low + high).max() <= 2.0
    assert node["extras"]["origin"] == np.rint(tin.points.min(axis=0) / 2 + tin.points.max(axis=0)
                                               / 2).tolist()  # fmt: skip
    assert ts.read(path).crs == tin.crs


def test_scenes_of_other_programs(tmp_path):
    """Nodes below nodes, turned and scaled, several meshes, strips and no indices, by trimesh."""
    trimesh = pytest.importorskip("trimesh")
    rng = np.random.default_rng(2)
    scene = trimesh.Scene()
    tin = ts.triangulate(rng.uniform(0, 10, (30, 3)))
    up = tin.points[:, [0, 2, 1]] * (1, 1, -1)
    for k in range(2):
        place = trimesh.transformations.compose_matrix(
            scale=(2, 1, 2), angles=(0, 0.3, 0), translate=(30 * k, 5, 0)
        )
        mesh = trimesh.Trimesh(up, tin.triangles, process=False)
        scene.add_geometry(mesh, f"m{k}", f"n{k}", transform=place)
    path = tmp_path / "a.glb"
    path.write_bytes(scene.export(file_type="glb"))
    found = ts.read(path, crs="EPSG:32616", elevation_unit="m")
    whole = trimesh.load_scene(path).to_geometry()
    assert len(found.triangles) == 2 * len(tin.triangles)
    wanted = np.column_stack([whole.vertices[:, 0], -whole.vertices[:, 2], whole.vertices[:, 1]])
    assert found.bounds.xmin == pytest.approx(wanted[:, 0].min(), abs=1e-5)
    assert found.bounds.ymax == pytest.approx(wanted[:, 1].max(), abs=1e-5)
    assert found.surface_area == pytest.approx(whole.area, rel=1e-5)
    assert str(found.crs) == "EPSG:32616"
    assert any("does not tell where north is" in note for note in found.report.notes)


@pytest.mark.parametrize("mode", [5, 6])
def test_strips_and_fans(tmp_path, mode):
    rim = [[0, 0, 0], [4, 1, 0], [4, 2, -4], [0, 3, -4]]
    corners = rim if mode == 6 else [rim[0], rim[1], rim[3], rim[2]]
    rows = np.array(corners, "<f4").tobytes()
    document = {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0, "scale": [2, 1, 1]}, {"mesh": 1}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "mode": mode}]},
            {"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]},
        ],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(rows)}],
        "buffers": [{"byteLength": len(rows)}],
    }
    rest = struct.pack("<II", len(rows), 0x004E4942) + rows
    tin = ts.read(store(tmp_path / "a.glb", document, rest))
    assert tin.area == pytest.approx(32.0)
    assert sorted(tin.points[:, 2].tolist()) == [0, 1, 2, 3]
    assert any("1 part of points or lines" in note for note in tin.report.notes)


def damage(document, **changes):
    return {**document, **changes}


@pytest.mark.parametrize(
    ("words", "change"),
    [
        ("is no JSON", lambda d: b"{"),
        ("holds no triangles", lambda d: damage(d, scenes=[{"nodes": []}])),
        ("nodes has no entry 7", lambda d: damage(d, scenes=[{"nodes": [7]}])),
        ("node 0 is there twice", lambda d: damage(d, scenes=[{"nodes": [0, 0]}])),
        ("the extension KHR_x", lambda d: damage(d, extensionsRequired=["KHR_x"])),
        ("transformation of node 0", lambda d: damage(d, nodes=[{"mesh": 0, "matrix": [1, 2]}])),
        ("transformation of node 0", lambda d: damage(d, nodes=[{"mesh": 0, "scale": ["a"] * 3}])),
        ("extras do not tell", lambda d: damage(d, nodes=[{"mesh": 0, "extras": {"origin": 3}}])),
        ("reaches beyond its end", lambda d: damage(d, bufferViews=[
            {**one, "byteOffset": 10**9} for one in d["bufferViews"]])),
        ("form that is not read", lambda d: damage(d, accessors=[
            {**one, "componentType": 5120} for one in d["accessors"]])),
        ("form that is not read", lambda d: damage(d, accessors=[
            {**one, "componentType": []} for one in d["accessors"]])),
        ("holds no triangles", lambda d: damage(d, meshes=[{"primitives": 3}])),
        ("extras do not tell", lambda d: damage(d, nodes=[
            {"mesh": 0, "extras": {"origin": [10**400, 0, 0]}}])),
        ("in another file", lambda d: damage(d, buffers=[{"uri": "a.bin", "byteLength": 4}])),
        ("names no part", lambda d: damage(d, accessors=[
            {**one, "count": -1} for one in d["accessors"]])),
    ],
)  # fmt: skip
def test_damaged_files_are_refused(tmp_path, words, change):
    path = ts.write(hills(), tmp_path / "a.glb")
    document, rest = look(path)
    with pytest.raises(ts.ReadError, match=words):
        ts.read(store(tmp_path / "b.glb", change(document), rest))


def test_files_that_end_too_early(tmp_path):
    content = ts.write(hills(), tmp_path / "a.glb").read_bytes()
    for size in (0, 4, 11, 19, 40, len(content) - 1):
        (tmp_path / "b.glb").write_bytes(content[:size])
        with pytest.raises(ts.ReadError):
            ts.read(tmp_path / "b.glb", format="glb")
    (tmp_path / "b.glb").write_bytes(content[:4] + b"\x01" + content[5:])
    with pytest.raises(ts.ReadError, match="version 1"):
        ts.read(tmp_path / "b.glb")
