"""What the first bytes of a file, or the names in a folder, say about its mesh format."""

from __future__ import annotations

import math
import re
import struct
import zlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

TIN_FILES = ("tnxy.adf", "tnz.adf", "tnod.adf", "tedg.adf", "tmsk.adf", "tmsx.adf", "thul.adf",
             "tdenv.adf", "tdenv9.adf", "tnodinfo.adf", "teval.adf")  # fmt: skip
"""Names of the files in the folder of an Esri TIN; grids of Esri have others."""

_TILE_HEADER = struct.Struct("<3d2f3dd3d")
_LEAST_RADIUS, _MOST_RADIUS, _MOST_HEIGHT = 6.2e6, 6.6e6, 1e5
"""Metres: how far from its centre the surface of the Earth is, and how high above the ellipsoid."""

_HALF_WORLD = 20_037_508.35
"""Metres, half the width of the world in web Mercator."""

_GZIP = b"\x1f\x8b"

_OFF = re.compile(rb"\s*(?:ST)?C?N?4?n?OFF\s")
_2DM = re.compile(rb"(?:[ \t]*(?:#[^\n]*)?\r?\n)*\s*MESH2D")
"""Comments may stand before the keyword."""
_NUMBER = rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"
_COUNTS = re.compile(rb"\s*[1-9]\d{0,17}\s+[1-9]\d{0,17}(?:\s+[^-+.\d\s].*)?\s*")
_NODE = re.compile(rb"\s*\d+(?:\s+" + _NUMBER + rb"){3}\s*")
_ELEMENT = re.compile(rb"\s*\d+\s+(?:3(?:\s+\d+){3}|4(?:\s+\d+){4})\s*")
_CITYJSON = re.compile(rb'"type"\s*:\s*"CityJSON"')


def is_glb(head: bytes) -> bool:
    """Whether the file is binary glTF."""
    return head.startswith(b"glTF")


def is_2dm(head: bytes) -> bool:
    """Whether the file is a 2DM mesh."""
    return _2DM.match(head.removeprefix(b"\xef\xbb\xbf")) is not None


def is_adcirc(head: bytes) -> bool:
    r"""Whether the file is a mesh of ADCIRC or SCHISM: its counts, and rows of nodes and elements.

    Examples
    --------
    >>> is_adcirc(b"title\n1 3\n1 0 0 5\n2 4 0 6\n3 0 3 7\n1 3 1 2 3\n")
    True
    """
    rows = head.split(b"\n", 12)[1:12]
    if len(rows) < 5 or not _COUNTS.fullmatch(rows[0]):
        return False
    n_elements, n_nodes = (int(word) for word in rows[0].split()[:2])
    nodes, elements = rows[1 : n_nodes + 1], rows[n_nodes + 1 : n_nodes + n_elements + 1]
    return all(map(_NODE.fullmatch, nodes)) and all(map(_ELEMENT.fullmatch, elements))


def is_selafin(head: bytes) -> bool:
    """Whether the file is Selafin: a record of 80 bytes, then one of 8, in any order of bytes."""
    mark, behind = head[:4], head[84:92]
    big, little = (80).to_bytes(4, "big"), (80).to_bytes(4, "little")
    if mark not in (big, little):
        return False
    return behind == mark + (8).to_bytes(4, "big" if mark == big else "little")


def is_off(head: bytes) -> bool:
    """Whether the file is an OFF mesh: its keyword."""
    return _OFF.match(head) is not None


def is_cityjson(head: bytes) -> bool:
    """Whether the file is CityJSON, or a sequence that begins with it."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n\x1e").startswith(b"{") and (
        _CITYJSON.search(head) is not None
    )


def is_tile_folder(folder: Path) -> bool:
    """Whether the folder has tiles of quantized-mesh: it has their description."""
    return (folder / "layer.json").is_file()


def is_esri_tin(folder: Path) -> bool:
    """Whether a folder is an Esri TIN."""
    return all((folder / name).is_file() for name in TIN_FILES[:3])


def is_quantized_mesh(head: bytes) -> bool:
    """Whether the file is a quantized-mesh tile, gzipped or not: its places are those of a globe.

    The header tells the centre of the tile, its heights, and a sphere about it; in a pyramid of web
    Mercator, in its coordinates.
    """
    if head.startswith(_GZIP):
        try:
            head = zlib.decompressobj(wbits=31).decompress(head, _TILE_HEADER.size)
        except zlib.error:
            return False
    if len(head) < _TILE_HEADER.size:
        return False
    found = _TILE_HEADER.unpack_from(head)
    if not all(math.isfinite(value) for value in found):
        return False
    lowest, highest, radius = found[3], found[4], found[8]
    if not -_MOST_HEIGHT < lowest <= highest < _MOST_HEIGHT:
        return False
    center, middle = found[:3], found[5:8]
    if _LEAST_RADIUS < math.hypot(*center) < _MOST_RADIUS:
        return math.hypot(*middle) < _MOST_RADIUS and 0.0 < radius < 2 * _MOST_RADIUS
    return bool(
        1.0 < max(map(abs, center[:2])) < _HALF_WORLD
        and max(abs(center[2]), abs(middle[2])) < _MOST_HEIGHT
        and math.dist(center[:2], middle[:2]) < radius < 2 * _HALF_WORLD
    )


def is_gzipped_tile(path: Path) -> bool:
    """Whether a file is named as a quantized-mesh tile and gzipped, as servers keep them."""
    if path.suffix.lower() != ".terrain" or not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(_GZIP)) == _GZIP
