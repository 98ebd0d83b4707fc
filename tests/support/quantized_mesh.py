"""Read quantized-mesh tiles as the specification says, with nothing of what wrote them."""

from __future__ import annotations

import struct

import numpy as np


def decode(content, name):
    """Decode a tile value by value, as the specification tells; a plain second opinion."""
    level, x, y = name
    header = struct.unpack_from("<3d2f3dd3d", content)
    at = 88
    (count,) = struct.unpack_from("<I", content, at)
    at += 4
    axes = [
        _sum_zigzag(struct.unpack_from(f"<{count}H", content, at + 2 * count * k)) for k in range(3)
    ]
    at += 6 * count
    form = "H" if count <= 65536 else "I"
    at += -at % struct.calcsize(form)
    (n_triangles,) = struct.unpack_from("<I", content, at)
    at += 4
    highest, indices = 0, []
    for code in struct.unpack_from(f"<{3 * n_triangles}{form}", content, at):
        indices.append(highest - code)
        highest += code == 0
    at += 3 * n_triangles * struct.calcsize(form)
    edges = []
    for _ in range(4):
        (size,) = struct.unpack_from("<I", content, at)
        edges.append(list(struct.unpack_from(f"<{size}{form}", content, at + 4)))
        at += 4 + size * struct.calcsize(form)
    kind, size = struct.unpack_from("<BI", content, at)
    codes = np.frombuffer(content, np.uint8, size, at + 5).reshape(-1, 2)
    assert (kind, size, len(content)) == (1, 2 * count, at + 5 + size)
    width = 180 / 2**level
    steps = np.array(axes).T
    plane = (x * width - 180 + steps[:, 0] / 32767 * width, y * width - 90
             + steps[:, 1] / 32767 * width)  # fmt: skip
    heights = header[3] + steps[:, 2] / 32767 * (header[4] - header[3])
    return {
        "header": header,
        "steps": steps,
        "places": np.column_stack([*plane, heights]),
        "triangles": np.array(indices).reshape(-1, 3),
        "edges": edges,
        "normals": _unfold(codes),
    }


def _sum_zigzag(codes):
    value, sums = 0, []
    for code in codes:
        value += (code >> 1) ^ -(code & 1)
        sums.append(value)
    return sums


def _unfold(codes):
    plane = codes / 255 * 2 - 1
    up = 1 - np.abs(plane).sum(axis=1)
    sign = np.where(plane < 0, -1.0, 1.0)
    folded = (1 - np.abs(plane[:, ::-1])) * sign
    vectors = np.column_stack([np.where(up[:, None] < 0, folded, plane), up])
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def load_folder(folder):
    """Return all tiles by level, column and row."""
    names = [tuple(int(part) for part in one.relative_to(folder).with_suffix("").parts)
             for one in folder.rglob("*.terrain")]  # fmt: skip
    return {name: decode((folder / f"{name[0]}/{name[1]}/{name[2]}.terrain").read_bytes(), name)
            for name in names}  # fmt: skip
