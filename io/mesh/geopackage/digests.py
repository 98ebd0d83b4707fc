"""Digests: whether layers and record are still those that were written together."""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ....base.arrays import AnyArray

__all__ = ["digest_arrays", "digest_lines"]


def digest_arrays(*arrays: AnyArray, text: str = "") -> str:
    """Return a digest of arrays, their types and shapes, and a text."""
    found = blake2b(text.encode(), digest_size=16)
    for array in arrays:
        found.update(f"{array.dtype.str}{array.shape}".encode())
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()


def digest_lines(rows: Iterable[tuple[bytes, str, str]]) -> str:
    """Return a digest of the geometries, kinds and names of a layer of lines."""
    found = blake2b(digest_size=16)
    for geometry, kind, name in rows:
        found.update(f"{kind}\n{name}\n{len(geometry)}\n".encode())
        found.update(geometry)
    return found.hexdigest()
