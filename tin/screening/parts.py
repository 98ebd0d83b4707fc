"""Parts of a triangulation: the same vertices with fewer triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..topology import NO_NEIGHBOR
from ..triangulation import Triangulation

if TYPE_CHECKING:
    from ...arrays import BoolArray, Int32Array

__all__ = ["keep_triangles", "leave_out"]


def leave_out(surface: Triangulation, vertices: Int32Array) -> Triangulation:
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
