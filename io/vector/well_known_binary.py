"""Well-known binary: geometries of equal shape written by arrays, surfaces read as polygons.

References
----------
OGC Simple Feature Access - Part 1 (06-103r4), section 8: TINs, triangles and polyhedral surfaces
have numbers of their own there, and GEOS knows none of them.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...base.arrays import Float64Array
    from ...base.results import Features

_POINT, _LINE, _POLYGON, _MULTIPOLYGON = 1, 2, 3, 6
_TIN_Z, _TRIANGLE_Z = 1016, 1017
_PLAIN_KIND = {15: _MULTIPOLYGON, 16: _MULTIPOLYGON, 17: _POLYGON}
"""Polyhedral surface, TIN and triangle, whose bytes are those of polygons."""

_COLLECTIONS = frozenset((4, 5, 6, 7, 15, 16))
_RINGS = frozenset((_POLYGON, 17))
_HAS_Z, _HAS_M, _HAS_SRID = 0x8000_0000, 0x4000_0000, 0x2000_0000
"""Flags of the kinds that older programs write."""


def encode_equal_shapes(features: Features) -> NDArray[np.void] | None:
    """Return points, lines of equally many vertices, or polygons of one such ring each.

    Returns
    -------
    (n,) array of void or None
        ISO well-known binary, little endian, as GEOS writes it; None if shapes differ, or features
        have several parts.
    """
    shape = _find_shape(features)
    if shape is None:
        return None
    kind, numbers, n_vertices = shape
    width = features.coordinates.shape[1]
    return _fill_records(
        kind + 1000 * (width == 3), numbers, features.coordinates.reshape(-1, n_vertices, width)
    )


def encode_tin(rings: Float64Array) -> bytes:
    """Return triangles as one TIN.

    Parameters
    ----------
    rings : (m, 4, 3) float64 array
        Corners of each triangle, the first repeated at the end.
    """
    head = struct.pack("<BII", 1, _TIN_Z, len(rings))
    return head + _fill_records(_TRIANGLE_Z, (1, 4), rings).tobytes()


def _fill_records(
    kind: int, numbers: tuple[int, ...], coordinates: Float64Array
) -> NDArray[np.void]:
    """Return a record for each row of coordinates, (n, vertices, 2 or 3)."""
    record = np.dtype(
        [("order", "u1"), ("kind", "<u4"), ("numbers", "<u4", (len(numbers),)),
         ("coordinates", "<f8", coordinates.shape[1:])]
    )  # fmt: skip
    made = np.empty(len(coordinates), record)
    made["order"], made["kind"], made["numbers"] = 1, kind, numbers
    made["coordinates"] = coordinates
    return made.view(np.dtype((np.void, record.itemsize)))


def _find_shape(features: Features) -> tuple[int, tuple[int, ...], int] | None:
    """Return kind, the numbers of parts and vertices, and the latter, of all features alike."""
    kinds = {"Point": (_POINT, 0), "LineString": (_LINE, 1), "Polygon": (_POLYGON, 2)}
    kind, n_levels = kinds.get(features.geometry_type, (0, -1))
    if len(features.offsets) != n_levels or len(features) == 0:
        return None
    if kind == _POINT:
        return None if np.isnan(features.coordinates).any() else (kind, (), 1)
    lengths = np.diff(features.offsets[0])
    if (lengths != lengths[0]).any():
        return None
    if kind == _LINE:
        return kind, (int(lengths[0]),), int(lengths[0])
    is_single = len(lengths) == len(features)
    return (kind, (1, int(lengths[0])), int(lengths[0])) if is_single else None


def replace_surfaces(wkb: bytes) -> bytes:
    """Return a geometry with its TINs, triangles and polyhedral surfaces as polygons.

    Bytes that are no geometry are given back as they are.
    """
    changed = bytearray(wkb)
    try:
        # Renumber geometry after geometry, those in a collection behind it; return their end.
        end, left = 0, 1
        while left:
            left -= 1
            form = "<I" if changed[end] == 1 else ">I"
            (number,) = struct.unpack_from(form, changed, end + 1)
            thousands, kind = divmod(number & 0xFFFF, 1000)
            has_z = bool(number & _HAS_Z) or thousands in (1, 3)
            has_m = bool(number & _HAS_M) or thousands in (2, 3)
            kind, width = kind, 8 * (2 + has_z + has_m)
            struct.pack_into(form, changed, end + 1, number - kind + _PLAIN_KIND.get(kind, kind))
            end += 9 if number & _HAS_SRID else 5
            if kind in _COLLECTIONS:
                left += struct.unpack_from(form, changed, end)[0]
                end += 4
            else:
                end = _skip_coordinates(changed, end, form, kind, width)
    except (struct.error, IndexError):
        return wkb
    return bytes(changed) if end == len(wkb) else wkb


def _skip_coordinates(wkb: bytearray, place: int, form: str, kind: int, width: int) -> int:
    """Return where the vertices of a single geometry end."""
    if kind == _POINT:
        return place + width
    rings = 1
    if kind in _RINGS:
        (rings,) = struct.unpack_from(form, wkb, place)
        place += 4
    while rings:
        place += 4 + width * struct.unpack_from(form, wkb, place)[0]
        rings -= 1
    return place
