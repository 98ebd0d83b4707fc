"""TINs in PLY files as tinsmith writes them: binary, lines as edges. Needs no Blender."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from .reference import Reference, Refused, Unit

if TYPE_CHECKING:
    from pathlib import Path

_SCALARS = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_LONGEST_HEADER = 1 << 24
_LINE = re.compile(r'comment line: (\w+) -?\d+ (\d+) (".*")')
_LIST = ("count", "corners")
_OTHER = (
    "is not laid out as tinsmith writes PLY ({}): convert it by 'tinsmith convert', or take "
    "Blender's own import, which knows no CRS and no shift."
)


@dataclass
class Line:
    """A line in space, of a kind and with a name."""

    kind: str
    name: str
    points: Any
    """(n, 3) float64."""


@dataclass
class Content:
    """What a file holds."""

    reference: Reference
    points: Any = None
    """(n, 3) float64; None if it has no surface."""
    triangles: Any = None
    """(m, 3) int32."""
    lines: list[Line] = field(default_factory=list)


def read(path: Path) -> Content:
    """Read a TIN.

    Raises
    ------
    Refused
        If the file is damaged, or of another layout.
    """
    try:
        return _parse(path.read_bytes(), path)
    except (ValueError, LookupError) as error:
        raise Refused(f"'{path.name}' is damaged, or no PLY of tinsmith ({error}).") from error


def _parse(content: bytes, path: Path) -> Content:
    header, size = _split_header(content, path.name)
    elements = _list_elements(header, path.name)
    tables, at = {}, size
    for name, (dtype, count) in elements.items():
        if at + dtype.itemsize * count > len(content):
            raise Refused(f"'{path.name}' ends too early: its header promises {count} of '{name}'.")
        tables[name] = np.frombuffer(content, dtype, count, at)
        at += dtype.itemsize * count
    vertices = tables["vertex"]
    points = np.stack([vertices[axis].astype(np.float64) for axis in "xyz"], axis=1)
    if not len(points) or not np.isfinite(points).all():
        raise Refused(f"'{path.name}' has no vertices, or coordinates that are no numbers.")
    made = Content(_read_reference(header), points, np.empty((0, 3), np.int32))
    if "face" in tables:
        faces = tables["face"]
        if (faces[_LIST[0]] != 3).any():
            raise Refused(f"'{path.name}' " + _OTHER.format("faces of more than three vertices"))
        made.triangles = np.ascontiguousarray(faces[_LIST[1]], np.int32)
        _require_numbers(made.triangles, len(points), path.name)
    if "edge" in tables:
        edges = np.stack([tables["edge"][one] for one in ("vertex1", "vertex2")], axis=1)
        _require_numbers(edges, len(points), path.name)
        made.lines = _take_lines(header, edges, points, path.name)
    return made


def _split_header(content: bytes, name: str) -> tuple[list[str], int]:
    """Return the lines of the header, and its bytes."""
    end = content.find(b"\nend_header\n", 0, _LONGEST_HEADER)
    if not content.startswith(b"ply\n") or end < 0:
        raise Refused(f"'{name}' is no PLY file, or its header has no end.")
    return content[:end].decode("utf-8", "replace").split("\n"), end + len(b"\nend_header\n")


def _list_elements(header: list[str], name: str) -> dict[str, tuple[Any, int]]:
    """Return of each element its type and the count of its rows."""
    if "format binary_little_endian 1.0" not in header:
        raise Refused(f"'{name}' " + _OTHER.format("not binary little-endian"))
    counts: dict[str, int] = {}
    fields: dict[str, list[Any]] = {}
    element = ""
    for line in header:
        words = line.split()
        if words[:1] == ["element"] and len(words) == 3 and words[2].isdecimal():
            element = words[1]
            counts[element], fields[element] = int(words[2]), []
        elif words[:1] == ["property"] and element:
            fields[element] += _take_property(words[1:], element, name)
    if not {"x", "y", "z"} <= {one[0] for one in fields.get("vertex", [])}:
        raise Refused(f"'{name}' " + _OTHER.format("no vertices with x, y and z"))
    return {one: (np.dtype(fields[one]), counts[one]) for one in counts}


def _take_property(words: list[str], element: str, name: str) -> list[Any]:
    """Return the fields of a row that a property takes."""
    if len(words) == 2 and words[0] in _SCALARS:
        return [(words[1], "<" + _SCALARS[words[0]])]
    is_list = len(words) == 4 and words[0] == "list" and element == "face"
    if is_list and words[3] in ("vertex_indices", "vertex_index"):
        length, item = ("<" + _SCALARS[one] for one in words[1:3])
        return [(_LIST[0], length), (_LIST[1], item, (3,))]
    raise Refused(f"'{name}' " + _OTHER.format(f"property {' '.join(words)[:60]}"))


def _read_reference(header: list[str]) -> Reference:
    told: dict[str, str] = {}
    for line in header:
        key, _, value = line.removeprefix("comment ").partition(": ")
        told.setdefault(key, value.strip())
    return Reference(
        told.get("crs", ""),
        Unit.find(told.get("horizontal unit", "")),
        Unit.find(told.get("elevation unit", "")),
    )


def _require_numbers(vertices: Any, count: int, name: str) -> None:
    if len(vertices) and (vertices.min() < 0 or vertices.max() >= count):
        raise Refused(f"'{name}' is damaged: it names vertices beyond its {count}.")


def _take_lines(header: list[str], edges: Any, points: Any, name: str) -> list[Line]:
    """Return the lines that the header tells of; their edges lie one after the other."""
    lines, at = [], 0
    for stated in filter(None, map(_LINE.fullmatch, header)):
        own = edges[at : at + int(stated[2])]
        at += int(stated[2])
        if len(own) != int(stated[2]) or (own[1:, 0] != own[:-1, 1]).any() or not len(own):
            raise Refused(f"'{name}' is damaged: the edges of a line are not those it tells of.")
        chain = np.append(own[:, 0], own[-1, 1])
        lines.append(Line(stated[1], str(json.loads(stated[3])), points[chain]))
    return lines
