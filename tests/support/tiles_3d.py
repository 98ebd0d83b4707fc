"""Read 3D Tiles 1.1 as the specification says, with nothing of what wrote them."""

from __future__ import annotations

import json
import struct
from typing import NamedTuple

import numpy as np


class Tile(NamedTuple):
    """A tile of a tileset, with its content."""

    level: int
    uri: str
    error: float
    low: np.ndarray
    high: np.ndarray
    positions: np.ndarray
    """(n, 3), in the frame of the root: X, Y and Z up."""
    triangles: np.ndarray
    parent: int


def read_glb(path):
    """Return positions in doubles, Z up, and triangles of a GLB file of one mesh."""
    content = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    assert kind == b"JSON"
    document = json.loads(content[20 : 20 + size])
    binary_size, kind = struct.unpack_from("<I4s", content, 20 + size)
    assert kind == b"BIN\0"
    assert 28 + size + binary_size == length
    binary = content[28 + size :]
    (node,) = document["nodes"]
    (primitive,) = document["meshes"][node["mesh"]]["primitives"]

    def read(number):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        dtype = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        count = accessor["count"] * width
        values = np.frombuffer(binary, dtype, count, view["byteOffset"]).reshape(-1, width)
        if "min" in accessor:
            np.testing.assert_array_equal(values.min(axis=0), accessor["min"])
            np.testing.assert_array_equal(values.max(axis=0), accessor["max"])
        return values

    local = read(primitive["attributes"]["POSITION"]).astype(float)
    x, y, z = (local + node["translation"]).T
    triangles = read(primitive["indices"]).reshape(-1, 3).astype(int)
    assert len(read(primitive["attributes"]["COLOR_0"])) == len(local)
    assert sorted(np.unique(triangles)) == list(range(len(local)))
    return np.column_stack([x, -z, y]), triangles


def read_tileset(folder):
    """Return the tileset and its tiles, the root first; everything is checked on the way."""
    tileset = json.loads((folder / "tileset.json").read_text())
    assert tileset["asset"]["version"] == "1.1"
    assert set(tileset) == {"asset", "geometricError", "root"}
    root = tileset["root"]
    assert root["refine"] == "REPLACE"
    assert np.array(root["transform"]).shape == (16,)
    assert tileset["geometricError"] >= root["geometricError"]
    tiles = []
    _walk(folder, root, -1, tiles, is_root=True)
    found = {str(path.relative_to(folder)) for path in folder.rglob("*.glb")}
    assert sorted(found) == sorted(tile.uri for tile in tiles)
    return tileset, tiles


def _walk(folder, entry, parent, tiles, *, is_root=False):
    allowed = {"boundingVolume", "geometricError", "content", "children"}
    assert set(entry) <= allowed | ({"transform", "refine"} if is_root else set())
    box = np.array(entry["boundingVolume"]["box"])
    assert box.shape == (12,)
    half = box[3:].reshape(3, 3)
    assert (half == np.diag(np.diag(half))).all()
    low, high = box[:3] - np.diag(half), box[:3] + np.diag(half)
    positions, triangles = read_glb(folder / entry["content"]["uri"])
    assert (positions >= low).all()
    assert (positions <= high).all()
    level = 0
    if parent >= 0:
        above = tiles[parent]
        level = above.level + 1
        assert (low >= above.low).all()
        assert (high <= above.high).all()
        assert entry["geometricError"] <= above.error
    assert entry["geometricError"] >= 0
    tiles.append(
        Tile(
            *(level, entry["content"]["uri"], entry["geometricError"], low, high),
            *(positions, triangles, parent),
        )
    )
    number = len(tiles) - 1
    assert entry.get("children") != []
    for child in entry.get("children", ()):
        _walk(folder, child, number, tiles)
