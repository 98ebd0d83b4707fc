"""GLB is read as a mesh: triangles of all nodes of its scene, where these put them.

What this package wrote says in ``extras`` where it lies, so that the map's coordinates come back.
Of other files X is east, Y up and -Z north, in metres, as glTF has its axes.
"""

from __future__ import annotations

import json
import struct
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ....base.crs import CRS, METRE, Unit
from ....base.errors import CrsError, ReadError
from ....base.sentences import FILE, counted
from ...reprojection import reproject
from ..common import Mesh, join_places, measure_rounding, mesh_reader, read_content
from ..globe import has_heights

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array, Int64Array

_HEADER, _CHUNK = struct.Struct("<4sII"), struct.Struct("<II")
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_TYPES = {"5121": "<u1", "5123": "<u2", "5125": "<u4", "5126": "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC3": 3}
_TRIANGLES = 4
_SURFACES = (4, 5, 6)
"""Modes of primitives: triangles, strips, fans; others are points and lines."""

_FOREIGN = (
    "X was taken for the easting, -Z for the northing and Y for the elevation, the numbers as they "
    "are: glTF counts metres, and does not tell where north is."
)

_GEOCENTRIC, _ELLIPSOIDAL, _FLAT = "EPSG:4978", "EPSG:4979", "OGC:CRS84"


class _File(NamedTuple):
    """What the two chunks hold."""

    document: dict[str, Any]
    content: bytes

    def get(self, kind: str, number: Any) -> dict[str, Any]:
        """Return an entry of a list of the document."""
        entries = self.document.get(kind)
        if isinstance(entries, list) and type(number) is int and 0 <= number < len(entries):
            found = entries[number]
            if isinstance(found, dict):
                return found
        raise ReadError(f"{FILE} is damaged: {kind} has no entry {number!r}.")

    def read(self, number: Any, width: str) -> AnyArray:
        """Return the rows of an accessor."""
        one = self.get("accessors", number)
        view = self.get("bufferViews", one.get("bufferView"))
        dtype = np.dtype(_TYPES.get(str(one.get("componentType")), "V1"))
        if "sparse" in one or dtype.kind == "V" or one.get("type") != width:
            raise ReadError(
                f"{FILE} holds numbers of accessor {number} in a form that is not read."
            )
        if "uri" in self.get("buffers", view.get("buffer")):
            raise ReadError(
                f"{FILE} keeps numbers in another file, and a file of one piece is needed."
            )
        step = dtype.itemsize * _WIDTHS[width]
        places = [one.get("count"), view.get("byteStride", step)]
        places += [part.get("byteOffset", 0) for part in (one, view)]
        numbers = [place for place in places if type(place) is int and place >= 0]
        if len(numbers) < len(places):
            raise ReadError(f"{FILE} is damaged: accessor {number} names no part of it.")
        count, stride, start, base = numbers
        end = base + start + (count - 1) * stride + step if count else 0
        if stride < step or end > len(self.content):
            raise ReadError(f"{FILE} is damaged: accessor {number} reaches beyond its end.")
        rows = np.ndarray((count, _WIDTHS[width]), dtype, self.content, base + start,
                          (stride, dtype.itemsize))  # fmt: skip
        return rows[:, 0] if width == "SCALAR" else rows


@mesh_reader
def read(path: Path) -> Mesh:
    """Read the triangles of a GLB file, at their places on the map where it tells these.

    CRS and unit default to those in ``extras`` of a file that this package wrote. Of other files
    the coordinates are metres: X is east, Y up and -Z north, which a note tells. Corners at one
    place are one vertex; normals, colours, textures, points and lines are skipped.
    """
    file = _open(read_content(path))
    points: list[Float64Array] = []
    triangles: list[Int64Array] = []
    count, skipped, rounding = 0, 0, 0.0
    notes: list[str] = []
    told: dict[str, Any] = {}
    for node, matrix in _list_nodes(file):
        primitives = file.get("meshes", node["mesh"]).get("primitives")
        for primitive in primitives if isinstance(primitives, list) else []:
            mode = primitive.get("mode", _TRIANGLES) if isinstance(primitive, dict) else None
            if mode not in _SURFACES:
                skipped += 1
                continue
            local, corners = _read_primitive(file, primitive, mode)
            extras = node.get("extras")
            own = extras if isinstance(extras, dict) and "origin" in extras else {}
            told = told or own
            step = measure_rounding(local[:, [0, 2]], np.float32)
            if own:
                placed, unit = _restore(local, matrix, own)
                rounding = max(rounding, step * unit)
            else:
                notes = [_FOREIGN]
                placed = local @ matrix[:3, :3].T + matrix[:3, 3]
                placed = np.column_stack([placed[:, 0], -placed[:, 2], placed[:, 1]])
            points.append(placed)
            triangles.append(corners + count)
            count += len(local)
    if not triangles:
        raise ReadError(f"{FILE} holds no triangles.")
    places, numbers = join_places(np.concatenate(points))
    corners = numbers[np.concatenate(triangles)]
    if skipped:
        parts = counted(skipped, "part of points or lines", "parts of points or lines")
        notes = [*notes, f"Not read: {parts}."]
    return Mesh(
        places,
        corners.ravel(),
        np.arange(0, corners.size + 1, 3),
        crs=_take_text(told, "crs"),
        elevation_unit=_take_text(told, "elevationUnit"),
        notes=notes,
        rounding=rounding,
    )


def _take_text(extras: dict[str, Any], name: str) -> str | None:
    text = extras.get(name)
    return text if isinstance(text, str) and text else None


def _open(content: bytes) -> _File:
    if len(content) < _HEADER.size + _CHUNK.size or not content.startswith(b"glTF"):
        raise ReadError(f"{FILE} is no GLB file.")
    _, version, length = _HEADER.unpack_from(content)
    if version != 2:
        raise ReadError(f"{FILE} is glTF of version {version}, and version 2 is read.")
    if length > len(content):
        raise ReadError(f"{FILE} is cut short: it has {len(content)} of {length} bytes.")
    chunks: dict[int, bytes] = {}
    at = _HEADER.size
    while at + _CHUNK.size <= length:
        size, kind = _CHUNK.unpack_from(content, at)
        at += _CHUNK.size
        if size > length - at:
            raise ReadError(f"{FILE} is damaged: a chunk reaches beyond its end.")
        chunks.setdefault(kind, content[at : at + size])
        at += size
    try:
        document = json.loads(chunks.get(_JSON, b""))
    except (ValueError, RecursionError):
        document = None
    if not isinstance(document, dict):
        raise ReadError(f"{FILE} is damaged: its first chunk is no JSON.")
    needed = document.get("extensionsRequired")
    if needed:
        names = ", ".join(map(str, needed)) if isinstance(needed, list) else str(needed)
        raise ReadError(f"{FILE} needs the extension {names}, which is not read.")
    return _File(document, chunks.get(_BINARY, b""))


def _list_nodes(file: _File) -> list[tuple[dict[str, Any], Float64Array]]:
    """Return the nodes of the scene that have meshes, and where they lie."""
    scenes, nodes = file.document.get("scenes"), file.document.get("nodes")
    if scenes:
        roots = file.get("scenes", file.document.get("scene", 0)).get("nodes", [])
    else:
        roots = list(range(len(nodes))) if isinstance(nodes, list) else []
    waiting = [(number, np.eye(4)) for number in reversed(roots if isinstance(roots, list) else [])]
    found, seen = [], set()
    while waiting:
        number, above = waiting.pop()
        node = file.get("nodes", number)
        if number in seen:
            if not scenes:  # where every node is a root, and may be below another one
                continue
            raise ReadError(f"{FILE} is damaged: node {number} is there twice.")
        seen.add(number)
        matrix = above @ _find_matrix(node, number)
        if "mesh" in node:
            found.append((node, matrix))
        below = node.get("children", [])
        waiting += [(child, matrix) for child in reversed(below if isinstance(below, list) else [])]
    return found


def _find_matrix(node: dict[str, Any], number: int) -> Float64Array:
    """Return the transformation of a node."""
    try:
        if "matrix" in node:
            matrix = np.array(node["matrix"], np.float64).reshape(4, 4).T
        else:
            x, y, z, w = np.array(node.get("rotation", (0, 0, 0, 1)), np.float64).tolist()
            turn = np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
                ]
            )
            matrix = np.eye(4)
            matrix[:3, :3] = turn * np.array(node.get("scale", (1, 1, 1)), np.float64).reshape(3)
            matrix[:3, 3] = np.array(node.get("translation", (0, 0, 0)), np.float64).reshape(3)
    except (ValueError, TypeError, OverflowError):
        matrix = np.full((4, 4), np.nan)
    if not np.isfinite(matrix).all():
        raise ReadError(f"{FILE} is damaged: the transformation of node {number} is none.")
    return matrix


def _read_primitive(
    file: _File, primitive: dict[str, Any], mode: int
) -> tuple[Float64Array, Int64Array]:
    """Return positions in the axes of the file, (n, 3), and triangles, (m, 3)."""
    attributes = primitive.get("attributes")
    position = attributes.get("POSITION") if isinstance(attributes, dict) else None
    rows = file.read(position, "VEC3")
    if rows.dtype.kind != "f":
        raise ReadError(f"{FILE} holds positions in a form that is not read.")
    local = rows.astype(np.float64)
    if "indices" in primitive:
        rows = file.read(primitive["indices"], "SCALAR")
        if rows.dtype.kind == "f" or not (rows < len(local)).all():
            raise ReadError(f"{FILE} is damaged: a triangle has a corner that is not there.")
        numbers: Int64Array = rows.astype(np.int64)
    else:
        numbers = np.arange(len(local), dtype=np.int64)
    if mode == _TRIANGLES:
        return local, numbers[: len(numbers) // 3 * 3].reshape(-1, 3)
    first = np.arange(max(len(numbers) - 2, 0))
    odd = first % 2
    at = (
        np.column_stack([first, first + 1 + odd, first + 2 - odd])
        if mode == _SURFACES[1]
        else np.column_stack([first + 1, first + 2, np.zeros_like(first)])
    )
    return local, np.asarray(numbers[at])


def _restore(
    local: Float64Array, matrix: Float64Array, extras: dict[str, Any]
) -> tuple[Float64Array, float]:
    """Return the coordinates of the map, and how many of its units are in a metre along."""
    try:
        origin = np.array(extras["origin"], np.float64).reshape(3)
        metres = np.array(extras.get("metres", (1, 1, 1)), np.float64).reshape(3)
        factor = float(extras.get("exaggeration", 1.0))
    except (ValueError, TypeError, OverflowError):
        origin = metres = np.full(3, np.nan)
        factor = 1.0
    scale = metres * (1.0, 1.0, factor)
    if not (np.isfinite(origin).all() and np.isfinite(scale).all() and (scale > 0).all()):
        raise ReadError(f"{FILE} is damaged: its extras do not tell where it lies.")
    east = np.column_stack([local[:, 0], -local[:, 2], local[:, 1]])
    if extras.get("frame") != "globe":
        return east / scale + origin, 1.0 / float(metres[0])
    world = local @ matrix[:3, :3].T + matrix[:3, 3]
    found = _leave_globe(np.column_stack([world[:, 0], -world[:, 2], world[:, 1]]), extras)
    found[:, 2] /= factor
    return found, 1.0 / float(metres[0])


def _leave_globe(cartesian: Float64Array, extras: dict[str, Any]) -> Float64Array:
    """Return points of the globe in the CRS that the file names."""
    crs = CRS.of(_take_text(extras, "crs"))
    if crs is None:
        raise CrsError(f"{FILE} lies on the globe, and does not tell its CRS.")
    transformer = optional.load("pyproj").Transformer.from_crs(
        _GEOCENTRIC, _ELLIPSOIDAL, always_xy=True
    )
    places = np.column_stack(transformer.transform(*cartesian.T))
    if has_heights(crs):
        return reproject(places, CRS(_ELLIPSOIDAL), crs, unit=None).points.copy()
    unit = Unit.of(_take_text(extras, "elevationUnit")) or crs.usual_elevation_unit
    return reproject(places, CRS(_FLAT), crs.horizontal, unit=METRE, wanted=unit).points.copy()
