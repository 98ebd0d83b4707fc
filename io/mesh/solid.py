"""A closed solid below a surface: base and walls, for 3D printing."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import WriteError
from ...base.sentences import FILE, counted
from ...tin.topology import NO_NEIGHBOR, ends

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...tin import TIN

__all__ = ["Solid", "build_solid"]


class Solid(NamedTuple):
    """A mesh without holes, its triangles counter-clockwise seen from outside."""

    points: Float64Array
    """(n, 3)."""
    triangles: Int64Array
    """(m, 3)."""

    @property
    def volume(self) -> float:
        """Volume within, units of the points cubed."""
        a, b, c = (self.points[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def build_solid(tin: TIN, points: Float64Array, thickness: float) -> Solid:
    """Close a surface with a flat base and upright walls.

    Parameters
    ----------
    tin : TIN
    points : (n, 3) float64 array
        Its vertices as they are to be printed.
    thickness : float
        From the base to the lowest vertex, units of ``points``.

    Returns
    -------
    Solid
        The base has the triangles of the surface, turned over, so that every wall stands on edges.
        Where parts of the surface touch in one vertex, the solid is cut apart there.

    Raises
    ------
    WriteError
        If the surface has no triangle.
    """
    triangles, neighbors = tin.triangles.astype(np.int64), tin.neighbors
    if len(triangles) == 0:
        raise WriteError(f"Cannot write {FILE}: {counted(0, 'triangle')} make no solid.")
    corners, number = _split_touching(triangles, neighbors)
    tops = points[corners]
    base = np.array(tops)
    base[:, 2] = tops[:, 2].min() - thickness
    count = len(corners)
    triangle, corner = np.nonzero(neighbors == NO_NEIGHBOR)
    first, last = ends(number.astype(np.int32), triangle, corner)
    walls = [np.column_stack([last, first, first + count]),
             np.column_stack([last, first + count, last + count])]  # fmt: skip
    return Solid(
        np.concatenate([tops, base]),
        np.concatenate([number, number[:, ::-1] + count, *walls]).astype(np.int64),
    )


def _split_touching(triangles: Int64Array, neighbors: Int32Array) -> tuple[Int64Array, Int64Array]:
    """Give each fan of triangles about a vertex a corner of its own.

    Returns
    -------
    corners : (k,) int64 array
        The vertex that each corner stands for.
    number : (m, 3) int64 array
        Corners of the triangles.
    """
    used, number = np.unique(triangles, return_inverse=True)
    number = number.reshape(-1, 3).astype(np.int64)
    corners = used.astype(np.int64).tolist()
    triangle, corner = np.nonzero(neighbors == NO_NEIGHBOR)
    starts = triangles[triangle, (corner + 1) % 3]
    _, first = np.unique(starts, return_index=True)
    further = np.setdiff1d(np.arange(len(starts)), first)  # parts of the surface touch in these
    for at in further.tolist():
        for slot in _walk_fan(triangles, neighbors, int(triangle[at]), int(starts[at])):
            number[slot] = len(corners)
        corners.append(int(starts[at]))
    return np.array(corners, np.int64), number


def _walk_fan(
    triangles: Int64Array, neighbors: Int32Array, triangle: int, vertex: int
) -> list[tuple[int, int]]:
    """Return the corners at a vertex, from a triangle whose edge from there is of the boundary."""
    slots = []
    while triangle != NO_NEIGHBOR:
        corner = int(np.argmax(triangles[triangle] == vertex))
        slots.append((triangle, corner))
        triangle = int(neighbors[triangle, (corner + 1) % 3])  # across the edge that ends there
    return slots
