"""Binary STL: a facet for each triangle, for machine control, CAD and 3D printing.

STL stores float32, which at UTM size is good for half a metre only. So an origin is subtracted (the
south-west bottom corner of the TIN, rounded down to whole units) and recorded in the 80 bytes of
the header, with the CRS and the unit of elevations if they are known and short enough:
``origin 745000.0 4033000.0 198.0 crs EPSG:32616 z foot``.
Add the origin to get coordinates in the CRS. What float32 rounds off then is about a sixteen
millionth of the extent. Which edges are constrained is lost.

A model is written for 3D printing instead where a size, a scale, an exaggeration or a solid is
asked for: in millimetres or CRS units from its own corner, elevations in the same unit, and closed
by a base and walls.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.atomic import replacing
from ...base.checks import as_flag, as_number
from ...base.crs import scale_elevations
from ...base.errors import CrsError, OptionError, ReadError, WriteError
from ...base.sentences import FILE, counted
from ...tin.topology import NO_NEIGHBOR, ends
from .common import (
    Mesh,
    describe_single_precision,
    format_unit,
    measure_rounding,
    mesh_reader,
    read_content,
    require_tin,
)

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import Float32Array, Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from ...tin import TIN

_HEADER_BYTES = 80
_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEAD = 1000
_BATCH = 131_072
_MILLIMETRES = 1000.0
_BASE_SHARE = 20.0
"""The longer side of a model through the thickness of its base, where none is given."""
_RECORD = re.compile(r"origin (\S+) (\S+) (\S+)(?: crs (\S+))?(?: z (\S+))?")


@mesh_reader
def read(path: Path) -> Mesh:
    """Read a binary STL file; corners at the same place become one vertex.

    CRS and unit default to those recorded in the header, whose origin is added back, if there is
    one; a text STL is refused.
    """
    content = read_content(path)
    body = _HEADER_BYTES + 4
    count = int.from_bytes(content[_HEADER_BYTES:body], "little")
    room = (len(content) - body) // _FACET.itemsize
    if room == count > 0:
        facets = np.frombuffer(content, _FACET, count, body)
    else:
        if content.lstrip()[:5].lower() == b"solid" and b"facet" in content[:_HEAD].lower():
            raise ReadError(f"{FILE} is a text STL, and only binary STL is read: save it as that.")
        if len(content) < body:
            raise ReadError(f"{FILE} is no STL file: it is shorter than a header.")
        if count == 0:
            raise ReadError(f"{FILE} holds no facets.")
        fault = "ends too early" if room < count else "goes on behind its last facet"
        raise ReadError(
            f"{FILE} {fault}: its header promises {count} "
            f"facet{'' if count == 1 else 's'}, and there is room for {room}."
        )
    origin, found_crs, found_unit = _read_record(content[:_HEADER_BYTES])
    if not np.isfinite(origin).all():
        raise ReadError(
            f"{FILE} records the origin {origin.tolist()}: three finite numbers are needed."
        )
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused
        points, triangles = _merge_corners(facets["corners"].reshape(-1, 3))
        places = points + origin
    notes = describe_single_precision(points, np.float32)
    own = measure_rounding(points, np.float32) if content.startswith(b"origin ") else 0.0
    offsets = np.arange(0, triangles.size + 1, 3)
    return Mesh(
        places,
        triangles.ravel(),
        offsets,
        crs=found_crs,
        elevation_unit=found_unit,
        notes=notes,
        rounding=own,
    )


def _read_record(header: bytes) -> tuple[Float64Array, str | None, str | None]:
    """Return origin, CRS and unit that our own header records; a foreign one records none."""
    found = _RECORD.fullmatch(header.rstrip(b"\0 ").decode("ascii", errors="replace"))
    if found is None:
        return np.zeros(3), None, None
    try:
        origin = np.array(found.groups()[:3], np.float64)
    except ValueError:
        return np.zeros(3), None, None
    return origin, found[4], found[5]


def _merge_corners(corners: Float32Array) -> tuple[Float64Array, Int64Array]:
    """Return the distinct places in the order in which they first occur, and their numbers."""
    corners = corners + np.float32(0.0)  # turns -0.0 into 0.0, so that equal places are equal bits
    bits = np.ascontiguousarray(corners).view(np.uint32).astype(np.uint64)
    _, plane = np.unique((bits[:, 0] << np.uint64(32)) | bits[:, 1], return_inverse=True)
    keys = (plane.astype(np.uint64) << np.uint64(32)) | bits[:, 2]
    _, first, places = np.unique(keys, return_index=True, return_inverse=True)
    in_order = np.argsort(first)  # by the first corner at each place
    numbers = np.empty(len(first), np.int64)
    numbers[in_order] = np.arange(len(first))
    return corners[first[in_order]].astype(np.float64), numbers[places].reshape(-1, 3)


def write(
    surface: TIN,
    path: Path,
    *,
    solid: bool = False,
    thickness: float | None = None,
    scale: float | None = None,
    size: float | None = None,
    exaggeration: float = 1.0,
    progress: Tell | None = None,
) -> None:
    """Write a TIN as binary STL, relative to an origin that the header records.

    Parameters
    ----------
    solid : bool
        Close it with a flat base and walls, for 3D printing.
    thickness : float, optional
        Of the base below the lowest vertex, millimetres with ``scale`` or ``size``, else CRS units;
        default a twentieth of the longer side of the model.
    scale : float, optional
        Make a model of 1 : scale in millimetres, such as 500.
    size : float, optional
        Make a model whose longer side has so many millimetres.
    exaggeration : float
        Factor on the elevations of a model.

    Raises
    ------
    OptionError
        If a factor is not positive, scale and size are both given, or a thickness without a solid.
    CrsError
        If a model is asked for and coordinates are longitude and latitude; if ``scale`` is given
        and the unit of the eastings is not known.
    WriteError
        Also if the extent is beyond float32.

    Notes
    -----
    Vertices closer together than the rounding of float32 fall together, and :func:`read` then
    finds a facet without area; PLY keeps every digit. A model does not record where it comes from.
    """
    tin = require_tin(surface, format_name="STL")
    is_solid = as_flag("solid", solid)
    for name, value in (("thickness", thickness), ("scale", scale), ("size", size)):
        if value is not None:
            as_number(name, value, above=0, or_none=True)
    as_number("exaggeration", exaggeration, above=0)
    if scale is not None and size is not None:
        raise OptionError("size", size, "left out where a scale is given, which sets the size")
    if thickness is not None and not is_solid:
        raise OptionError("thickness", thickness, "left out where no solid is asked for")
    if is_solid or scale is not None or size is not None or exaggeration != 1.0:
        points, record = _make_model(tin, scale, size, exaggeration)
        triangles = tin.triangles.astype(np.int64)
        if is_solid:
            side = float(np.ptp(points[:, :2], axis=0).max())
            closed = build_solid(tin, points, thickness or side / _BASE_SHARE)
            points, triangles = closed
    else:
        origin = np.floor(tin.points.min(axis=0))
        points, record = tin.points - origin, _format_record(origin, tin)
        triangles = tin.triangles.astype(np.int64)
    if np.ptp(points, axis=0).max() > np.finfo(np.float32).max / 4:
        raise WriteError(f"Cannot write {FILE}: the TIN is too large for float32.")
    with replacing(path) as file:
        file.write(record)
        file.write(len(triangles).to_bytes(4, "little"))
        for start in range(0, len(triangles), _BATCH):
            part = triangles[start : start + _BATCH]
            corners = points[part]
            rows = np.zeros(len(corners), _FACET)
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            lengths = np.linalg.norm(normals, axis=1, keepdims=True)
            rows["normal"] = np.divide(
                normals, lengths, out=np.zeros_like(normals), where=lengths > 0
            )
            rows["corners"] = corners
            file.write(rows.data)
            if progress is not None:
                progress(min(1.0, (start + len(part)) / len(triangles)))


def _make_model(
    tin: TIN, scale: float | None, size: float | None, exaggeration: float
) -> tuple[Float64Array, bytes]:
    """Return the vertices of a model, from its own corner, and what the header tells of it."""
    used = tin.points[np.unique(tin.triangles)]
    points = (tin.points - used.min(axis=0)) * (1.0, 1.0, exaggeration * scale_elevations(
        tin.crs, tin.elevation_unit))  # fmt: skip
    unit = "CRS units"
    if size is not None:
        points *= size / float(np.ptp(used[:, :2], axis=0).max())
        unit = "millimetres"
    if scale is not None:
        metres = None if tin.crs is None else tin.crs.horizontal_unit.metres
        if metres is None:
            raise CrsError(
                "A scale needs the unit of the eastings, and the CRS of the TIN is not known: give "
                "the size of the model instead.",
                crs=tin.crs,
            )
        points *= _MILLIMETRES * metres / scale
        unit = f"millimetres, 1:{scale:g}"
    record = f"Model of a TIN, {unit}, exaggeration {exaggeration:g}"
    return points, record.encode()[:_HEADER_BYTES].ljust(_HEADER_BYTES, b" ")


def _format_record(origin: Float64Array, tin: TIN) -> bytes:
    """Record the origin, and CRS and unit of elevations as far as there is room for them."""
    record = "origin {!r} {!r} {!r}".format(*(origin + 0.0).tolist())
    for name, text in (("crs", str(tin.crs or "")), ("z", "".join(format_unit(tin).split()))):
        longer = f"{record} {name} {text}"
        if text and not set(text) & set(" \n\t") and len(longer.encode()) <= _HEADER_BYTES:
            record = longer
    return record.encode().ljust(_HEADER_BYTES, b" ")


class Solid(NamedTuple):
    """A mesh without holes, its triangles counter-clockwise seen from outside."""

    points: Float64Array
    """(n, 3)."""
    triangles: Int64Array
    """(m, 3)."""

    @property
    def volume(self) -> float:
        """Volume within, units of the points cubed."""
        a, b, c = (self.points[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def build_solid(tin: TIN, points: Float64Array, thickness: float) -> Solid:
    """Close a surface with a flat base and upright walls.

    Parameters
    ----------
    tin : TIN
    points : (n, 3) float64 array
        Its vertices as they are to be printed.
    thickness : float
        From the base to the lowest vertex, units of ``points``.

    Returns
    -------
    Solid
        The base has the triangles of the surface, turned over, so that every wall stands on edges.
        Where parts of the surface touch in one vertex, the solid is cut apart there.
    """
    triangles, neighbors = tin.triangles.astype(np.int64), tin.neighbors
    if len(triangles) == 0:
        raise WriteError(f"Cannot write {FILE}: {counted(0, 'triangle')} make no solid.")
    corners, number = _split_touching(triangles, neighbors)
    tops = points[corners]
    base = np.array(tops)
    base[:, 2] = tops[:, 2].min() - thickness
    count = len(corners)
    triangle, corner = np.nonzero(neighbors == NO_NEIGHBOR)
    first, last = ends(number.astype(np.int32), triangle, corner)
    walls = [np.column_stack([last, first, first + count]),
             np.column_stack([last, first + count, last + count])]  # fmt: skip
    return Solid(
        np.concatenate([tops, base]),
        np.concatenate([number, number[:, ::-1] + count, *walls]).astype(np.int64),
    )


def _split_touching(triangles: Int64Array, neighbors: Int32Array) -> tuple[Int64Array, Int64Array]:
    """Give each fan of triangles about a vertex a corner of its own.

    Returns
    -------
    corners : (k,) int64 array
        The vertex that each corner stands for.
    number : (m, 3) int64 array
        Corners of the triangles.
    """
    used, number = np.unique(triangles, return_inverse=True)
    number = number.reshape(-1, 3).astype(np.int64)
    corners = used.astype(np.int64).tolist()
    triangle, corner = np.nonzero(neighbors == NO_NEIGHBOR)
    starts = triangles[triangle, (corner + 1) % 3]
    _, first = np.unique(starts, return_index=True)
    further = np.setdiff1d(np.arange(len(starts)), first)  # parts of the surface touch in these
    for at in further.tolist():
        for slot in _walk_fan(triangles, neighbors, int(triangle[at]), int(starts[at])):
            number[slot] = len(corners)
        corners.append(int(starts[at]))
    return np.array(corners, np.int64), number


def _walk_fan(
    triangles: Int64Array, neighbors: Int32Array, triangle: int, vertex: int
) -> list[tuple[int, int]]:
    """Return the corners at a vertex, from a triangle whose edge from there is of the boundary."""
    slots = []
    while triangle != NO_NEIGHBOR:
        corner = int(np.argmax(triangles[triangle] == vertex))
        slots.append((triangle, corner))
        triangle = int(neighbors[triangle, (corner + 1) % 3])  # across the edge that ends there
    return slots
