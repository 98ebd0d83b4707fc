"""The header of a PLY file: which elements follow, with which properties, in which encoding."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from typing import Any, NamedTuple, get_args

from ....base.errors import ReadError
from ....base.policies import LineKind
from ....base.sentences import FILE
from ...registry import is_ply

SCALARS = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}
"""NumPy types of the names of the format, old and new."""

LONGEST_HEADER = 1 << 24
"""Bytes searched for the end of the header; a WKT takes some thousand, a line of a TIN some 40."""

_COUNT = re.compile(r"[0-9]{1,100}")  # all that a disk holds, and a sentence about more
_LONGEST_FIRST_LINE = 200

_INT32 = 2**31
_COMMENT = re.compile(r'(hard|soft|boundary|hole|water) (-?[0-9]{1,10}) ([0-9]{1,10}) (".*")')
_BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True, slots=True)
class Property:
    """One property of an element."""

    name: str
    type: str
    """NumPy type without byte order."""
    count_type: str | None = None
    """NumPy type of the length of a list; None for a single value."""


@dataclass(frozen=True, slots=True)
class Element:
    """A table of the file, for example ``vertex`` or ``face``."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)


class LineComment(NamedTuple):
    """What the header says of a line."""

    kind: LineKind
    source: int
    n_edges: int
    name: str


@dataclass(frozen=True, slots=True)
class Header:
    """What the header says."""

    byte_order: str
    """One of "<", ">", and "" for text."""
    elements: list[Element]
    """In the order in which they follow."""
    crs: str | None
    """From the comment ``crs: ...``."""
    size: int
    """Bytes of the header."""
    elevation_unit: str | None = None
    """From the comment ``elevation unit: ...``."""
    lines: list[LineComment] | None = None
    """What the first edges are, where all are constrained ones; None where that is not said."""


def parse_header(content: bytes) -> Header:
    """Read the header of a PLY file."""
    if not is_ply(content[:_LONGEST_FIRST_LINE]):
        raise ReadError(f"{FILE} is no PLY file: it does not begin with 'ply'.")
    mark = content.find(b"\nend_header", 0, LONGEST_HEADER)
    line_end = content.find(b"\n", mark + 1) if mark >= 0 else -1
    if line_end < 0:
        raise ReadError("the PLY header does not end with 'end_header'.")
    text = content[:line_end].decode("utf-8", errors="replace")
    lines, size = [line.rstrip() for line in text.split("\n")], line_end + 1
    byte_order: str | None = None
    elements: list[Element] = []
    for number, line in enumerate(lines, start=1):
        words = line.split()
        match words:
            case ["format", encoding, _] if encoding in _BYTE_ORDERS and byte_order is None:
                byte_order = _BYTE_ORDERS[encoding]
            case ["element", name, count] if (
                name not in [element.name for element in elements]
            ) and _COUNT.fullmatch(count):
                elements.append(Element(name, int(count)))
            case ["property", *rest] if elements and (found := _parse_property(rest)) is not None:
                _require_new(found, elements[-1], number)
                elements[-1].properties.append(found)
            case [] | ["ply" | "comment" | "obj_info" | "end_header", *_]:
                pass
            case _:
                raise ReadError(
                    f"{FILE}, line {number}: '{line[:60]}' is no line of a PLY header.",
                    lines=[number],
                )
    if byte_order is None:
        raise ReadError("the PLY header has no line 'format'.")
    crs, unit, stated = _read_comments(lines)
    return Header(byte_order, elements, crs, size, unit, stated)


def _read_comments(lines: list[str]) -> tuple[str | None, str | None, list[LineComment] | None]:
    crs: str | None = None
    unit: str | None = None
    stated: list[LineComment] | None = None
    for number, line in enumerate(lines, start=1):
        match line.split():
            case ["comment", "crs:", _, *_]:
                crs = line.split("crs:", 1)[1].strip()
            case ["comment", "elevation", "unit:", _, *_]:
                unit = line.split("unit:", 1)[1].strip()
            case ["comment", "edges:", "constrained"]:
                stated = []
            case ["comment", "line:", *_] if stated is not None:
                found = _parse_line_comment(line.split("line:", 1)[1].strip())
                if found is None:
                    raise ReadError(
                        f"{FILE}, line {number}: '{line[:60]}' tells no line of a TIN.",
                        lines=[number],
                    )
                stated.append(found)
    return crs, unit, stated


def _parse_line_comment(text: str) -> LineComment | None:
    """Return what a comment says of a line; None if it says nothing that can be understood."""
    found = _COMMENT.fullmatch(text)
    if found is None or found[1] not in get_args(LineKind):
        return None
    try:
        name = json.loads(found[4])
    except ValueError:
        return None
    kind: Any = found[1]
    source, n_edges = int(found[2]), int(found[3])
    if not 0 <= source < _INT32:
        return None
    return LineComment(kind, source, n_edges, name)


def _require_new(added: Property, element: Element, number: int) -> None:
    if added.name in [one.name for one in element.properties]:
        raise ReadError(
            f"{FILE}, line {number}: '{element.name}' has the property '{added.name}' twice.",
            lines=[number],
        )


def _parse_property(words: list[str]) -> Property | None:
    match words:
        case ["list", count_type, item_type, name] if {count_type, item_type} <= SCALARS.keys():
            if SCALARS[count_type][0] == "f":
                return None
            return Property(name, SCALARS[item_type], SCALARS[count_type])
        case [value_type, name] if value_type in SCALARS:
            return Property(name, SCALARS[value_type])
    return None
