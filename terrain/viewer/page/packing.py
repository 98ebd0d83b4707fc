"""Whole numbers packed as text: differences in zigzag coding, planes of bytes, deflate, base64.

Neighbouring vertices differ little if they stand in Morton order, so most bytes of the differences
are zero, and the planes of the high bytes all but vanish when they are deflated. A page of 100,000
triangles takes some 0.5 MB that way. ``src/unpacking.ts`` is the other side.

References
----------
G. M. Morton, A computer oriented geodetic data base and a new technique in file sequencing
(IBM, 1966).
"""

from __future__ import annotations

import base64
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import Int64Array, UInt64Array

_LEVEL = 6
_BITS = 16


def pack_rows(rows: Int64Array) -> dict[str, Any]:
    """Pack a (k, c) array, each row as its difference from the row before, in 32 bits."""
    return _pack(np.diff(rows, axis=0, prepend=np.zeros_like(rows[:1])))


def pack_counts(counts: Int64Array) -> dict[str, Any]:
    """Pack a (k,) array, each number by itself."""
    return _pack(counts[:, None])


def pack_triangles(triangles: Int64Array) -> dict[str, Any]:
    """Pack (m, 3) triangles: their least corners ascend, and the others are told from these."""
    first = triangles.argmin(axis=1)
    turned = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    ordered = turned[np.lexsort((turned[:, 2], turned[:, 1], turned[:, 0]))]
    differences = ordered - ordered[:, :1]
    differences[:, 0] = np.diff(ordered[:, 0], prepend=0)
    return _pack(differences)


def sort_in_morton_order(xy: Int64Array) -> Int64Array:
    """Return the order of (n, 2) places along the Z-shaped curve of Morton."""
    low = xy.min(axis=0)
    span = max(int((xy.max(axis=0) - low).max()), 1)
    cells = ((xy - low) * ((1 << _BITS) - 1) // span).astype(np.uint64)
    order: Int64Array = np.argsort(
        _spread_bits(cells[:, 0]) | (_spread_bits(cells[:, 1]) << np.uint64(1)), kind="stable"
    )
    return order


def _spread_bits(values: UInt64Array) -> UInt64Array:
    """Put a zero before each of the lower 16 bits."""
    spread = values
    for shift, mask in ((8, 0x00FF00FF), (4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        spread = (spread | (spread << np.uint64(shift))) & np.uint64(mask)
    return spread


def _pack(differences: Int64Array) -> dict[str, Any]:
    rows, columns = differences.shape
    flat = differences.ravel()
    zigzag = ((flat << 1) ^ (flat >> 63)).astype(np.uint32)
    planes = (int(zigzag.max(initial=0)).bit_length() + 7) // 8
    split = [(zigzag >> np.uint32(8 * plane)).astype(np.uint8) for plane in range(planes)]
    data = zlib.compress(b"".join(plane.tobytes() for plane in split), _LEVEL) if planes else b""
    text = base64.b64encode(data).decode("ascii")
    return {"rows": rows, "columns": columns, "planes": planes, "data": text}
