"""Parts of a triangulation: the same vertices with fewer triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..topology import NO_NEIGHBOR
from ..triangulation import Triangulation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...arrays import BoolArray, Int32Array

__all__ = ["find_clustered", "keep_triangles", "leave_out"]


def find_clustered(surface: Triangulation, vertices: Int32Array) -> Int32Array:
    """Return those of some vertices that have another one of them as a neighbour."""
    if len(vertices) < 2:
        return vertices[:0]
    is_one = np.zeros(len(surface.points), np.bool_)
    is_one[vertices] = True
    count = is_one[surface.triangles].sum(axis=1)
    together = surface.triangles[count > 1]
    return np.unique(together[is_one[together]])


def leave_out(surface: Triangulation, vertices: Sequence[int] | Int32Array) -> Triangulation:
    """Return a surface without the triangles at some vertices; these have none any more."""
    if len(vertices) == 0:
        return surface
    is_gone = np.zeros(len(surface.points), np.bool_)
    is_gone[vertices] = True
    first, second, third = (is_gone[corner] for corner in surface.triangles.T)
    return keep_triangles(surface, ~(first | second | third))


def keep_triangles(surface: Triangulation, stays: BoolArray) -> Triangulation:
    """Return some triangles of a surface, in their order, and all of its vertices.

    Edges where others were are the boundary, and no lines for that.
    """
    number = np.full(len(stays) + 1, NO_NEIGHBOR, np.int32)  # the last is that of no triangle
    number[:-1][stays] = np.arange(stays.sum(), dtype=np.int32)
    return Triangulation(
        points=surface.points,
        triangles=np.ascontiguousarray(surface.triangles[stays]),
        neighbors=np.ascontiguousarray(number[surface.neighbors[stays]]),
        constrained=np.ascontiguousarray(surface.constrained[stays]),
    )
