"""Selafin files record by record, written and read without the package."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np

__all__ = ["make_selafin", "parse_selafin"]


def _record(content: bytes, order: str) -> bytes:
    mark = struct.pack(f"{order}i", len(content))
    return mark + content + mark


def make_selafin(
    xy: Any,
    elements: Any,
    names: Any,
    frames: Any,
    *,
    size: int = 8,
    order: str = ">",
    origin: tuple[int, int] = (0, 0),
    date: bool = False,
    planes: int = 0,
    ipobo: Any = None,
) -> bytes:
    """Return a file of nodes from 1, of names and units, and of times with a row a variable."""
    real = f"{order}f{size}"
    elements, count = np.asarray(elements), len(xy)

    def integers(*values: int) -> bytes:
        return struct.pack(f"{order}{len(values)}i", *values)

    title = f"{'of a test':<72}" + ("SERAFIND" if size == 8 else "SERAFIN ")
    parameters = [1, 0, *origin, 0, 0, planes, 0, 0, int(date)]
    parts = [title.encode(), integers(len(names), 0)]
    parts += [f"{name:<16}{unit:<16}".encode() for name, unit in names]
    parts += [integers(*parameters), *([integers(2026, 1, 2, 3, 4, 5)] if date else [])]
    parts += [integers(len(elements), count, elements.shape[1], 1)]
    parts += [integers(*elements.ravel().tolist())]
    parts += [integers(*([0] * count if ipobo is None else ipobo))]
    parts += [np.asarray(column, real).tobytes() for column in np.asarray(xy, float).T]
    for time, values in frames:
        parts += [np.array([time], real).tobytes()]
        parts += [np.asarray(row, real).tobytes() for row in values]
    return b"".join(_record(part, order) for part in parts)


def parse_selafin(path: Path) -> dict[str, Any]:
    """Return what a file of doubles without a date holds."""
    content, at = path.read_bytes(), 0
    parts = []
    while at < len(content):
        (length,) = struct.unpack_from(">i", content, at)
        parts.append(content[at + 4 : at + 4 + length])
        assert struct.unpack_from(">i", content, at + 4 + length) == (length,)
        at += 8 + length
    n_variables = sum(struct.unpack(">2i", parts[1]))
    names, rest = parts[2 : 2 + n_variables], parts[2 + n_variables :]
    n_elements, n_nodes, n_corners, one = struct.unpack(">4i", rest[1])
    assert (len(rest[0]), one, len(rest[6])) == (40, 1, 8)
    return {
        "title": parts[0].decode(),
        "names": [name.decode() for name in names],
        "elements": np.frombuffer(rest[2], ">i4").reshape(n_elements, n_corners),
        "ipobo": np.frombuffer(rest[3], ">i4"),
        "xy": np.column_stack([np.frombuffer(one, ">f8", n_nodes) for one in rest[4:6]]),
        "values": [np.frombuffer(one, ">f8", n_nodes) for one in rest[7:]],
    }
