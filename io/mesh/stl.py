"""Binary STL: a facet for each triangle, for machine control, CAD and 3D printing.

STL stores float32, which at UTM size is good for half a metre only. So an origin is subtracted (the
south-west bottom corner of the TIN, rounded down to whole units) and recorded in the 80 bytes of
the header, with the CRS and the unit of elevations if they are known and short enough:
``origin 745000.0 4033000.0 198.0 crs EPSG:32616 z foot``.
Add the origin to get coordinates in the CRS. What float32 rounds off then is about a sixteen
millionth of the extent. Which edges are constrained is lost.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._atomic import replacing
from ...errors import ReadError, WriteError
from .common import choose_reference, format_unit, make_tin, read_content, require_tin

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from ...crs import CrsLike, UnitLike
    from ...tin import TIN

__all__ = ["read", "write"]

_HEADER_BYTES = 80
_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_BATCH = 131_072
_RECORD = re.compile(r"origin (\S+) (\S+) (\S+)(?: crs (\S+))?(?: z (\S+))?")


def read(path: Path, *, crs: CrsLike | None = None, z_unit: UnitLike | None = None) -> TIN:
    """Read a binary STL file; corners at the same place become one vertex.

    Parameters
    ----------
    path : Path
    crs : CRS, str, int or pyproj.CRS, optional
        Declares the CRS; default the one recorded in the header.
    z_unit : Unit or str, optional
        Declares the unit of the elevations; default the one recorded there.

    Returns
    -------
    TIN
        The origin recorded in the header, if there is one, is added back.

    Raises
    ------
    ReadError
        If the file is text or damaged, or its facets are no TIN.
    CrsError
        If PROJ does not know the CRS, or the file names another.
    OptionError
        If the unit is unknown, or the file names another.
    """
    content = read_content(path)
    facets = _find_facets(content, path)
    origin, found_crs, found_unit = _read_record(content[:_HEADER_BYTES])
    if not np.isfinite(origin).all():
        raise ReadError(
            f"'{path}' records the origin {origin.tolist()}: three finite numbers are needed.",
            path=path,
        )
    reference = choose_reference(crs, z_unit, path, found_crs=found_crs, found_unit=found_unit)
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused
        points, triangles = _merge_corners(facets["corners"].reshape(-1, 3))
        places = points + origin
    return make_tin(places, triangles, path, reference=reference)


def _find_facets(content: bytes, path: Path) -> NDArray[Any]:
    body = _HEADER_BYTES + 4
    count = int.from_bytes(content[_HEADER_BYTES:body], "little")
    room = (len(content) - body) // _FACET.itemsize
    if room == count > 0:
        return np.frombuffer(content, _FACET, count, body)
    if content.lstrip().startswith(b"solid"):
        raise ReadError(
            f"'{path}' is a text STL, and only binary STL is read: save it as that.",
            path=path,
        )
    if len(content) < body:
        raise ReadError(f"'{path}' is no STL file: it is shorter than a header.", path=path)
    if count == 0:
        raise ReadError(f"'{path}' holds no facets.", path=path)
    fault = "ends too early" if room < count else "goes on behind its last facet"
    raise ReadError(
        f"'{path}' {fault}: its header promises {count} "
        f"facet{'' if count == 1 else 's'}, and there is room for {room}.",
        path=path,
    )


def _read_record(header: bytes) -> tuple[NDArray[np.float64], str | None, str | None]:
    """Return origin, CRS and unit that our own header records; a foreign one records none."""
    found = _RECORD.fullmatch(header.rstrip(b"\0 ").decode("ascii", errors="replace"))
    if found is None:
        return np.zeros(3), None, None
    try:
        origin = np.array(found.groups()[:3], np.float64)
    except ValueError:
        return np.zeros(3), None, None
    return origin, found[4], found[5]


def _merge_corners(corners: NDArray[np.float32]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the distinct places in the order in which they first occur, and their numbers."""
    from pandas import factorize

    corners = corners + np.float32(0.0)  # turns -0.0 into 0.0, so that equal places are equal bits
    bits = np.ascontiguousarray(corners).view(np.uint32).astype(np.uint64)
    plane, _ = factorize((bits[:, 0] << np.uint64(32)) | bits[:, 1])
    numbers, places = factorize((plane.astype(np.uint64) << np.uint64(32)) | bits[:, 2])
    first = np.empty(len(places), np.int64)
    first[numbers[::-1]] = np.arange(len(numbers))[::-1]
    return corners[first].astype(np.float64), numbers.reshape(-1, 3).astype(np.int64)


def write(surface: TIN, path: Path, *, progress: Callable[[float], None] | None = None) -> None:
    """Write a TIN as binary STL, relative to an origin that the header records.

    Parameters are those of every writer, see :class:`.Format`.

    Raises
    ------
    WriteError
        If the file cannot be written, or the extent is beyond float32.

    Notes
    -----
    Vertices closer together than the rounding of float32 fall together, and :func:`read` then
    finds a facet without area; PLY keeps every digit.
    """
    tin = require_tin(surface, path, format_name="STL")
    origin = np.floor(tin.points.min(axis=0))
    if np.ptp(tin.points, axis=0).max() > np.finfo(np.float32).max / 4:
        raise WriteError(f"Cannot write '{path}': the TIN is too large for float32.", path=path)
    with replacing(path) as file:
        file.write(_format_record(origin, tin))
        file.write(len(tin.triangles).to_bytes(4, "little"))
        for start in range(0, len(tin.triangles), _BATCH):
            part = tin.triangles[start : start + _BATCH]
            file.write(_pack_facets(tin.points[part] - origin).data)
            if progress is not None:
                progress(min(1.0, (start + len(part)) / len(tin.triangles)))


def _format_record(origin: NDArray[np.float64], tin: TIN) -> bytes:
    """Record the origin, and CRS and unit of elevations as far as there is room for them."""
    record = "origin {!r} {!r} {!r}".format(*(origin + 0.0).tolist())
    for name, text in (("crs", str(tin.crs or "")), ("z", "".join(format_unit(tin).split()))):
        longer = f"{record} {name} {text}"
        if text and not set(text) & set(" \n\t") and len(longer.encode()) <= _HEADER_BYTES:
            record = longer
    return record.encode().ljust(_HEADER_BYTES, b" ")


def _pack_facets(corners: NDArray[np.float64]) -> NDArray[Any]:
    """Return STL rows for (m, 3 corners, 3) coordinates."""
    rows = np.zeros(len(corners), _FACET)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    rows["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    rows["corners"] = corners
    return rows
