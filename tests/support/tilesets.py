"""Tilesets written by the specification of 3D Tiles and glTF, with nothing of the product."""

from __future__ import annotations

import itertools
import json
import struct

import numpy as np


def pack_glb(document, binary=b""):
    """Return a GLB file of its JSON and its numbers."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def make_glb(points, triangles, *, node=None, mode=4, index="u2", stride=0, more=None):
    """Return triangles as GLB; ``points`` are (n, 3) with Z up, in the frame of the node.

    ``stride`` puts further bytes between positions, ``index`` None leaves indices out.
    """
    x, y, z = np.asarray(points, float).T
    rows = np.column_stack([x, z, -y]).astype("<f4")
    if index is None:
        rows = rows[np.asarray(triangles).ravel()]
    padded = [row.tobytes() + bytes(stride) for row in rows]
    binary = b"".join(padded)
    views = [{"buffer": 0, "byteLength": len(binary)}]
    if stride:
        views[0]["byteStride"] = 12 + stride
    accessors = [
        {
            "bufferView": 0,
            "componentType": 5126,
            "count": len(rows),
            "type": "VEC3",
            "min": rows.min(axis=0).tolist() if len(rows) else [0, 0, 0],
            "max": rows.max(axis=0).tolist() if len(rows) else [0, 0, 0],
        }
    ]
    primitive = {"attributes": {"POSITION": 0}, "mode": mode}
    if index is not None:
        corners = np.asarray(triangles, dtype=f"<{index}").ravel()
        start = len(binary)
        binary += corners.tobytes()
        views.append({"buffer": 0, "byteOffset": start, "byteLength": corners.nbytes})
        kind = {"u1": 5121, "u2": 5123, "u4": 5125}[index]
        accessors.append(
            {"bufferView": 1, "componentType": kind, "count": corners.size, "type": "SCALAR"}
        )
        primitive["indices"] = 1
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, **(node or {})}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
        **(more or {}),
    }
    return pack_glb(document, binary)


def make_square_glb(low, high, height=0.0, *, cells=2, origin=(0.0, 0.0, 0.0), **how):
    """Return a level square with some relief as GLB, of places less an origin."""
    ticks = [np.linspace(low[k], high[k], cells + 1) for k in range(2)]
    x, y = (one.ravel() for one in np.meshgrid(*ticks))
    z = height + 0.02 * (high[0] - low[0]) * np.sin(x / 7.0) * np.cos(y / 5.0)
    width = cells + 1
    triangles = [
        corner
        for row, column in itertools.product(range(cells), repeat=2)
        for a in [row * width + column]
        for corner in ([a, a + 1, a + width], [a + 1, a + width + 1, a + width])
    ]
    return make_glb(np.column_stack([x, y, z]) - origin, triangles, **how)


def make_tile(low, high, error, *, uri=None, children=(), relief=5.0, **more):
    """Return a tile of a square, of -relief to relief, as JSON."""
    half = [(b - a) / 2 for a, b in zip(low, high, strict=True)]
    middle = [(b + a) / 2 for a, b in zip(low, high, strict=True)]
    box = [*middle, 0.0, half[0], 0, 0, 0, half[1], 0, 0, 0, relief]
    tile = {"boundingVolume": {"box": box}, "geometricError": error, **more}
    if uri is not None:
        tile["content"] = {"uri": uri}
    if children:
        tile["children"] = list(children)
    return tile


def write_tileset(folder, root, contents, *, name="tileset.json", version="1.1", **more):
    """Write a tileset and its contents, by their paths."""
    document = {"asset": {"version": version}, "geometricError": 1e3, "root": root, **more}
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(json.dumps(document))
    for path, content in contents.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)
    return folder


def write_quadtree(folder, *, levels=3, side=256.0, refine="REPLACE", **more):
    """Write a whole quadtree of squares; errors halve from level to level."""
    contents = {}

    def make(level, column, row):
        width = side / 2**level
        low = (column * width - side / 2, row * width - side / 2)
        high = (low[0] + width, low[1] + width)
        uri = f"{level}/{column}/{row}.glb"
        contents[uri] = make_square_glb(low, high)
        below = [(0, 0), (1, 0), (0, 1), (1, 1)] if level + 1 < levels else []
        children = [make(level + 1, 2 * column + i, 2 * row + j) for i, j in below]
        error = 0.0 if not children else side / 16 / 2**level
        return make_tile(low, high, error, uri=uri, children=children)

    root = make(0, 0, 0) | {"refine": refine}
    return write_tileset(folder, root, contents, **more)
