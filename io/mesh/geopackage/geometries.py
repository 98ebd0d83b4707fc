"""Geometries as GeoPackage stores them: a header, then little-endian well-known binary with z."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import AnyArray, Float64Array

__all__ = ["POINT", "make_chain_blobs", "make_point_blobs", "make_triangle_blobs"]

_HEADER = [("magic", "S2"), ("version", "u1"), ("flags", "u1"), ("srs", "<i4")]
_ENVELOPE = [("bounds", "<f8", (4,))]  # min x, max x, min y, max y
_KIND = [("order", "u1"), ("kind", "<u4")]
_WITH_ENVELOPE, _WITHOUT = 0b011, 0b001  # the last bit: little-endian

POINT = np.dtype([*_HEADER, *_KIND, ("xyz", "<f8", (3,))])
"""A point, as it lies in the file."""

_TRIANGLE = np.dtype(
    [*_HEADER, *_ENVELOPE, *_KIND, ("rings", "<u4"), ("count", "<u4"), ("xyz", "<f8", (4, 3))]
)
_POINT_Z, _LINE_Z, _POLYGON_Z = 1001, 1002, 1003


def make_point_blobs(points: Float64Array, srs: int) -> Iterator[memoryview]:
    """Yield a point for each row of an (n, 3) array."""
    rows = _begin(np.zeros(len(points), POINT), _WITHOUT, srs, _POINT_Z)
    rows["xyz"] = points
    return _cut(rows)


def make_triangle_blobs(corners: Float64Array, srs: int) -> Iterator[memoryview]:
    """Yield a closed ring of four vertices for each of the (m, 3, 3) corners."""
    rows = _begin(np.zeros(len(corners), _TRIANGLE), _WITH_ENVELOPE, srs, _POLYGON_Z)
    rows["rings"], rows["count"] = 1, 4
    rows["xyz"][:, :3] = corners
    rows["xyz"][:, 3] = corners[:, 0]
    for axis in (0, 1):
        rows["bounds"][:, 2 * axis] = corners[:, :, axis].min(axis=1)
        rows["bounds"][:, 2 * axis + 1] = corners[:, :, axis].max(axis=1)
    return _cut(rows)


def make_chain_blobs(chains: list[Float64Array], srs: int, *, as_rings: bool) -> list[bytes]:
    """Return a line, or a polygon of one ring, for each (k, 3) array of vertices."""
    rings = [("rings", "<u4")] if as_rings else []
    kind = _POLYGON_Z if as_rings else _LINE_Z
    blobs = []
    for chain in chains:
        fields: list[Any] = [*_HEADER, *_ENVELOPE, *_KIND, *rings, ("count", "<u4")]
        row = _begin(np.zeros(1, np.dtype(fields)), _WITH_ENVELOPE, srs, kind)
        if as_rings:
            row["rings"] = 1
        row["count"] = len(chain)
        (low_x, low_y), (high_x, high_y) = chain[:, :2].min(axis=0), chain[:, :2].max(axis=0)
        row["bounds"] = (low_x, high_x, low_y, high_y)
        blobs.append(row.tobytes() + np.ascontiguousarray(chain, "<f8").tobytes())
    return blobs


def _begin(rows: AnyArray, flags: int, srs: int, kind: int) -> AnyArray:
    rows["magic"], rows["flags"], rows["srs"] = b"GP", flags, srs
    rows["order"], rows["kind"] = 1, kind
    return rows


def _cut(rows: AnyArray) -> Iterator[memoryview]:
    content, size = memoryview(rows.tobytes()), rows.dtype.itemsize
    return (content[start : start + size] for start in range(0, len(content), size))
