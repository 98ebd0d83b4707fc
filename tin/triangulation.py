"""Triangulation: triangles over vertices, with what is computed from them once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from . import _kernel, topology
from .types import Bounds, Frozen, seal

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Triangulation"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Triangulation(Frozen):
    """Triangles over vertices; never changed, all arrays are read-only.

    Attributes
    ----------
    points : (n, 3) float64 array
        Easting, northing, elevation of the vertices.
    triangles : (m, 3) int32 array
        Vertices of each triangle, counter-clockwise seen from above.
    neighbors : (m, 3) int32 array
        The triangle across the edge opposite each corner; -1 outside.
    constrained : (m, 3) bool array
        Whether that edge is a breakline, boundary or hole.
    """

    points: NDArray[np.float64]
    triangles: NDArray[np.int32]
    neighbors: NDArray[np.int32]
    constrained: NDArray[np.bool_]

    @cached_property
    def bounds(self) -> Bounds:
        """Bounds of the vertices."""
        return Bounds.of(self.points)

    @cached_property
    def edges(self) -> NDArray[np.int32]:
        """Every edge once, (k, 2) vertex pairs."""
        return seal(topology.edges(self.triangles, self.neighbors))

    @cached_property
    def rings(self) -> tuple[NDArray[np.int32], ...]:
        """Boundary rings as vertex numbers, the surface on the left; the outer one first."""
        rings = topology.boundary_rings(self.triangles, self.neighbors)
        west = [self.points[ring, 0].min() for ring in rings]
        return tuple(seal(rings[i]) for i in np.argsort(west, kind="stable"))

    @cached_property
    def triangle_areas(self) -> NDArray[np.float64]:
        """Area of each triangle in the plane, (m,) array, CRS units squared."""
        first, second = self._edge_vectors()
        return seal(0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]))

    def surface_areas(self, elevation_scale: float = 1.0) -> NDArray[np.float64]:
        """Measure each triangle in space, (m,) array; elevations times a factor."""
        first, second = (edge * (1.0, 1.0, elevation_scale) for edge in self._edge_vectors())
        areas: NDArray[np.float64] = 0.5 * np.linalg.norm(np.cross(first, second), axis=1)
        return seal(areas)

    @cached_property
    def locator(self) -> _kernel.Locator:
        """The index of point location; any number of threads may ask it at a time."""
        return _kernel.Locator(self.points, self.triangles, self.neighbors)

    def _edge_vectors(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        origin = self.points[self.triangles[:, 0]]
        return (
            self.points[self.triangles[:, 1]] - origin,
            self.points[self.triangles[:, 2]] - origin,
        )
