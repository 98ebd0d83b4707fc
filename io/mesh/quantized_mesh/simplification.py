"""A surface from fewer of its vertices, within a tolerance of elevation.

Vertices are inserted greedily (Garland and Heckbert, "Fast polygonal approximation of terrains and
height fields", 1995), in rounds: in every triangle the one farthest from the surface so far. All
vertices of the boundary are kept, and its edges.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....tin import TIN, Breakline, Survey, triangulate
from ....tin.topology import mark_corners

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ....base.arrays import BoolArray, Int64Array

__all__ = ["simplify"]


def simplify(surface: TIN, tolerances: Sequence[float]) -> Iterator[Int64Array]:
    """Yield triangles of ever more vertices of a surface.

    Parameters
    ----------
    surface : TIN
    tolerances : sequence of float
        Falling: the largest difference of elevation at any vertex.

    Yields
    ------
    (m, 3) int64 array
        Vertices of the surface, counter-clockwise, for each tolerance.
    """
    chosen = np.zeros(len(surface.points), np.bool_)
    rings = [ring for ring in surface.boundary if len(ring) > 2]
    chosen[np.concatenate(rings)] = True
    lines = [Breakline(surface.points[np.append(ring, ring[0])]) for ring in rings]
    wanted = mark_corners(surface.triangles, len(surface.points))
    for tolerance in tolerances:
        while True:
            triangles = _connect(surface, np.flatnonzero(chosen), lines)
            worst = _find_worst(surface, triangles, wanted & ~chosen, tolerance)
            if len(worst) == 0:
                break
            chosen[worst] = True
        yield triangles


def _connect(surface: TIN, rows: Int64Array, lines: list[Breakline]) -> Int64Array:
    """Triangulate some vertices within the boundary."""
    built = triangulate(Survey(points=surface.points[rows], breaklines=lines), duplicates="first")
    row_of = np.full(len(built.points), -1, np.int64)
    row_of[built.vertex_of[: len(rows)]] = rows
    triangles = row_of[built.triangles]
    triangles = triangles[(triangles >= 0).all(axis=1)]
    middles = surface.points[triangles, :2].mean(axis=1)
    return triangles[surface.locate(middles) >= 0]


def _find_worst(
    surface: TIN, triangles: Int64Array, left: BoolArray, tolerance: float
) -> Int64Array:
    """Return the vertex of each triangle that lies farthest from it, beyond the tolerance."""
    rows = np.flatnonzero(left)
    if len(rows) == 0:
        return rows
    rough = TIN.from_triangles(surface.points, triangles)
    xy = surface.points[rows, :2]
    error = np.abs(rough.interpolate(xy) - surface.points[rows, 2])
    far = np.flatnonzero(error > tolerance)
    home = rough.locate(xy[far])
    order = np.lexsort((-error[far], home))
    _, first = np.unique(home[order], return_index=True)
    return rows[far[order[first]]]
