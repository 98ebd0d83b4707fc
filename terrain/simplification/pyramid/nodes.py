"""The meshes of nodes: cut from the surface, or joined of four children, and simplified."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import PointsError
from ....tin import TIN
from ....tin.meshing import simplify_convex
from ..seams import halve_at_farthest
from .cutting import Mesh, cut, explain_narrow, settle

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ....base.types import Bounds

_SHARE_OF_A_SIDE = 2.0**-8
"""Of the finest square: the tolerance of the level above it, which doubles with each."""
_SHARE_ALONG_SIDES = 0.5
"""Of the tolerance, within which the vertices on the sides of a square are chosen: so no other one
there is ever beyond the tolerance."""


def find_tolerance(height: int, side: float, tolerance: float) -> float:
    """Return within what a node is simplified from its children.

    Parameters
    ----------
    height : int
        Levels above the finest.
    side : float
        Of a finest square, in the unit of elevations.
    tolerance : float
        Of the finest level, from the surface.
    """
    if height == 0:
        return tolerance
    return float(2.0 ** (height - 1) * max(tolerance, side * _SHARE_OF_A_SIDE))


def make_finest(
    points: Float64Array, triangles: Int32Array, box: Bounds, tolerance: float
) -> Mesh | None:
    """Return the part of a surface in a square, within a tolerance; None if there is none.

    Parameters
    ----------
    points : (n, 3) float64 array
    triangles : (m, 3) int32 array
        All triangles that meet the square, and maybe others.
    box : Bounds
    tolerance : float
        0 for the surface itself.
    """
    corners = points[triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    is_near = (low[:, 0] < box.xmax) & (high[:, 0] > box.xmin)
    is_near &= (low[:, 1] < box.ymax) & (high[:, 1] > box.ymin)
    found = cut(points, triangles[is_near], box)
    if not len(found.triangles):
        return None
    return simplify(found, box, tolerance) if tolerance > 0 else found


def join_nodes(children: Sequence[Mesh]) -> Mesh:
    """Return the meshes of children as one: what lies on sides between them is in both."""
    firsts = np.cumsum([0, *(len(one.points) for one in children)])
    triangles = [
        one.triangles.astype(np.int64) + first for one, first in zip(children, firsts, strict=False)
    ]
    return settle(
        np.concatenate([one.points for one in children]),
        np.concatenate(triangles),
        max(one.error for one in children),
    )


def simplify(mesh: Mesh, box: Bounds, tolerance: float) -> Mesh:
    """Return few vertices of a mesh; its own error is added to what the mesh has.

    Raises
    ------
    PointsError
        If rounding left a vertex on a side of the square that was not chosen there, or triangles
        that lie over each other.
    """
    on_sides, chosen = _choose_on_sides(mesh.points, box, tolerance * _SHARE_ALONG_SIDES)
    try:
        tin = TIN.from_triangles(mesh.points, mesh.triangles)
        kept, triangles, error = simplify_convex(tin, chosen, on_sides, tolerance)
    except PointsError as fault:
        raise explain_narrow(box) from fault
    if not np.array_equal(kept[on_sides[kept]], chosen):
        raise PointsError(
            f"The sides of the square from {box.xmin:g}, {box.ymin:g} to {box.xmax:g}, "
            f"{box.ymax:g} cannot be simplified: vertices lie nearer to each other than "
            "coordinates are rounded."
        )
    return settle(mesh.points[kept], triangles.astype(np.int64), mesh.error + error)


def _choose_on_sides(
    points: Float64Array, box: Bounds, limit: float
) -> tuple[BoolArray, Int64Array]:
    """Tell which vertices lie on the sides of a square, and return those to be kept there."""
    on_sides = np.zeros(len(points), np.bool_)
    chosen = [np.empty(0, np.int64)]
    for axis, value in ((0, box.xmin), (0, box.xmax), (1, box.ymin), (1, box.ymax)):
        rows = np.flatnonzero(points[:, axis] == value)
        if not len(rows):
            continue
        rows = rows[np.argsort(points[rows, 1 - axis], kind="stable")]
        on_sides[rows] = True
        chosen.append(rows[choose_on_line(points[rows, 1 - axis], points[rows, 2], limit)])
    return on_sides, np.unique(np.concatenate(chosen))


def choose_on_line(along: Float64Array, z: Float64Array, limit: float) -> Int64Array:
    """Return the places of a profile, its ends among them, that keep all within a limit.

    By halving at the farthest (D. H. Douglas, T. K. Peucker, "Algorithms for the reduction of the
    number of points required to represent a digitized line or its caricature", 1973), in elevation.

    Parameters
    ----------
    along : (n,) float64 array
        Ascending.
    z : (n,) float64 array
    limit : float

    Examples
    --------
    >>> z = np.array([0.0, 0.1, 2.0, 1.0, 0.0])
    >>> choose_on_line(np.arange(5.0), z, 0.5)
    array([0, 1, 2, 4])
    """

    def measure(start: int, end: int) -> Float64Array:
        inner = slice(start + 1, end)
        share = (along[inner] - along[start]) / (along[end] - along[start])
        return np.asarray(np.abs(z[start] + share * (z[end] - z[start]) - z[inner]), np.float64)

    return np.unique([0, *halve_at_farthest(len(z), measure, limit), len(z) - 1])
