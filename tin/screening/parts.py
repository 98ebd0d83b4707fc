"""Parts of a triangulation: the same vertices with fewer triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel
from ..topology import NO_NEIGHBOR
from ..triangulation import Triangulation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Int32Array, Int64Array


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


def find_parts(surface: Triangulation, chosen: Int64Array) -> Int32Array:
    """Return for each of some triangles, ascending, the connected part of them that it is of."""
    number = np.full(len(surface.triangles) + 1, NO_NEIGHBOR, np.int32)
    number[chosen] = np.arange(len(chosen), dtype=np.int32)
    corners = np.ascontiguousarray(surface.triangles[chosen])
    beside = np.ascontiguousarray(number[surface.neighbors[chosen]])
    barrier = np.zeros(corners.shape, np.bool_)
    parts: Int32Array = _kernel.regions(surface.points, corners, beside, barrier)[0]
    return parts


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
