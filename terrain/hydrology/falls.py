"""Falls: across which of its edges each triangle drains, and what meets at an edge; exact."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...tin.predicates import falls_across
from ...tin.topology import NO_NEIGHBOR
from ...tin.validation import require_exact_range

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, Int64Array
    from ...tin import TIN

FINEST = 2.0**-53
"""Shares of an edge are multiples of this, so that they are exact from either end."""


_AFTER, _BEFORE = np.array([1, 2, 0]), np.array([2, 0, 1])
_POOR = 1e-10
"""Relative error beyond which a value is computed anew in fractions."""


class Falls(NamedTuple):
    r"""How the triangles of a TIN fall; edge k of a triangle lies opposite corner k.

    The fall line through a corner meets the edge opposite::

          corner k
          /      \          at the share -values[k + 2] / values[k] of the way from a to b
         /    |   \
        a ----|---- b
           edge k
    """

    points: Float64Array
    triangles: Int32Array
    neighbors: Int32Array
    signs: Int8Array
    """(m, 3), +1 where water leaves the triangle across the edge, -1 where it enters, 0 where it
    runs along the edge; all 0 if the triangle is level.
    """
    values: Float64Array
    """(m, 3), how much leaves, in proportion; the three of a triangle add up to 0."""

    @property
    def is_level(self) -> BoolArray:
        """Whether each triangle is level."""
        one, other, last = self.signs.T
        is_level: BoolArray = (one | other | last) == 0
        return is_level

    def ends(self, triangle: Any, edge: Any) -> tuple[Int64Array, Int64Array]:
        """Return start and end vertex of edges."""
        corners, first = self.triangles.reshape(-1), 3 * np.asarray(triangle, np.int64)
        return (
            corners.take(first + _AFTER.take(edge), mode="wrap").astype(np.int64),
            corners.take(first + _BEFORE.take(edge), mode="wrap").astype(np.int64),
        )

    def cross(self, triangle: Any, edge: Any) -> tuple[Int64Array, Int64Array]:
        """Return the triangle across each edge, and which of its edges it is; -1 outside."""
        _, end = self.ends(triangle, edge)
        other = self.neighbors[triangle, edge].astype(np.int64)
        return other, _BEFORE.take(find_corners(self.triangles, other, end))

    def sign_beyond(self, triangle: Any, edge: Any) -> Int8Array:
        """Return the sign of the other triangle at each edge; 0 outside."""
        other, its_edge = self.cross(triangle, edge)
        return np.where(other == NO_NEIGHBOR, np.int8(0), self.signs[other, its_edge])

    def shares(self, triangle: Any, edge: Any) -> Float64Array:
        """Return where the fall line through the corner opposite meets each edge, from 0 to 1."""
        part = -self.values[triangle, (edge + 2) % 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.clip(part / self.values[triangle, edge], 0.0, 1.0)
        shares: Float64Array = round_share(found)
        return shares


def find_corners(triangles: Int32Array, chosen: Int64Array, vertices: Int64Array) -> Int64Array:
    """Return which corner of each chosen triangle a vertex of it is."""
    found = triangles.take(chosen, axis=0, mode="wrap")
    is_one, is_two = found[:, 1] == vertices, found[:, 2] == vertices
    corners: Int64Array = is_one + 2 * is_two.astype(np.int64)
    return corners


def round_share(share: Any) -> Any:
    """Return shares of edges, from 0 to 1, as multiples of ``FINEST``."""
    return 1.0 - (1.0 - share)


def find_falls(tin: TIN) -> Falls:
    """Find how the triangles of a TIN fall: signs are exact, values good to ten digits at least.

    Raises PointsError if elevations are of a magnitude at which signs are not exact.
    """
    surface = tin.triangulation
    require_exact_range(surface.points[:, 2:], "Elevations", ["elevation"])
    signs, values, bounds = falls_across(surface.points, surface.triangles)
    poor = (bounds > _POOR * np.abs(values)) & (signs != 0)
    for row, k in np.argwhere(poor).tolist():
        a, b, c = np.roll(surface.triangles[row], 2 - k).tolist()
        values[row, k] = measure_fall(surface.points, a, b, c)
    values[signs == 0] = 0.0
    return Falls(surface.points, surface.triangles, surface.neighbors, signs, values)


def measure_fall(points: Float64Array, a: int, b: int, c: int) -> Fraction:
    """Return the value of :func:`falls_across` without any rounding."""
    p, q, r = ([Fraction(value) for value in points[vertex].tolist()] for vertex in (a, b, c))
    ux, uy, uz = (end - start for start, end in zip(p, q, strict=True))
    vx, vy, vz = (end - start for start, end in zip(p, r, strict=True))
    return vz * (ux * ux + uy * uy) - uz * (ux * vx + uy * vy)
