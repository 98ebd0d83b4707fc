"""Triangulation: triangles over vertices, with what is computed from them once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...base.types import Bounds, Frozen, seal
from .. import _kernel, topology
from .nearest import NearestVertex

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array


@dataclass(frozen=True, eq=False)
class Triangulation(Frozen):
    """Triangles over vertices; never changed, all arrays are read-only."""

    points: Float64Array
    triangles: Int32Array
    neighbors: Int32Array
    constrained: BoolArray
    """As those of :class:`.TIN`."""

    @cached_property
    def bounds(self) -> Bounds:
        """Bounds of the vertices."""
        return Bounds.of(self.points)

    @cached_property
    def edges(self) -> Int32Array:
        """Every edge once, (k, 2) vertex pairs."""
        return seal(topology.edges(self.triangles, self.neighbors))

    @cached_property
    def rings(self) -> tuple[Int32Array, ...]:
        """Boundary rings as vertex numbers, the surface on the left; the outer one first."""
        rings = topology.boundary_rings(self.triangles, self.neighbors)
        west = [self.points[ring, 0].min() for ring in rings]
        return tuple(seal(rings[i]) for i in np.argsort(west, kind="stable"))

    @cached_property
    def fills_hull(self) -> bool:
        """Whether the surface is all of its convex hull."""
        if len(self.rings) != 1:
            return False
        ring = self.points[self.rings[0], :2]
        a, b, c = (np.ascontiguousarray(np.roll(ring, -k, axis=0)) for k in range(3))
        return bool((_kernel.orientation(a, b, c) >= 0).all())

    @cached_property
    def hull(self) -> Int32Array:
        """Vertices on the convex hull, counter-clockwise, those within its edges too."""
        if self.fills_hull:
            return self.rings[0]
        rows = np.unique(np.concatenate(self.rings))
        growth = _kernel.grow(np.ascontiguousarray(self.points[rows]), threads=1)
        if growth.kept_row is not None:
            rows = rows[growth.kept_row == np.arange(len(rows))]
        (ring,) = topology.boundary_rings(growth.triangles, growth.neighbors)
        return seal(rows[ring])

    @cached_property
    def triangle_areas(self) -> Float64Array:
        """Area of each triangle in the plane, (m,) array, CRS units squared."""
        (ux, vx), (uy, vy) = self._edge_components(2)
        return seal(0.5 * (ux * vy - uy * vx))

    @property
    def area(self) -> float:
        """Area in the plane, CRS units squared."""
        return float(self.triangle_areas.sum())

    def surface_areas(self, elevation_scale: float = 1.0) -> Float64Array:
        """Measure each triangle in space, (m,) array; elevations times a factor."""
        (ux, vx), (uy, vy), (uz, vz) = self._edge_components(3)
        uz, vz = uz * elevation_scale, vz * elevation_scale
        east, north, up = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        areas: Float64Array = 0.5 * np.sqrt(east * east + north * north + up * up)
        return seal(areas)

    @cached_property
    def locator(self) -> _kernel.Locator:
        """The index of point location; any number of threads may ask it at a time."""
        return _kernel.Locator(self.points, self.triangles, self.neighbors)

    def normals(self, elevation_scale: float = 1.0) -> Float64Array:
        """Return an upward normal of each triangle, (m, 3) array; elevations times a factor.

        Their lengths are in proportion to the triangles' areas in space. Coordinates are scaled
        first, so that no product overflows.
        """
        origin = self.points[self.triangles[:, 0]]
        first, second = (
            self.points[self.triangles[:, 1]] - origin,
            self.points[self.triangles[:, 2]] - origin,
        )
        run = np.abs([first[:, :2], second[:, :2]]).max()
        first[:, :2] /= run
        second[:, :2] /= run
        rise = max(float(np.abs([first[:, 2], second[:, 2]]).max()), np.finfo(float).tiny)
        upward: Float64Array = np.cross(first / [1, 1, rise], second / [1, 1, rise])
        with np.errstate(over="ignore"):  # infinitely steep: the normal is level
            steepness = np.float64(rise) * elevation_scale / run
        upward[:, :2] *= min(steepness, 1.0)
        upward[:, 2] = np.maximum(upward[:, 2], 0.0) / max(steepness, 1.0)
        return upward

    def vertex_normals(self, elevation_scale: float = 1.0) -> Float64Array:
        """Sum the normals of the triangles at each vertex, (n, 3) array."""
        corners = self.triangles.ravel()
        upward = np.repeat(self.normals(elevation_scale), 3, axis=0)
        n_vertices = len(self.points)
        return np.stack([np.bincount(corners, axis, n_vertices) for axis in upward.T], axis=1)

    @cached_property
    def half_edges(self) -> topology.HalfEdges:
        """The edges of the triangles by the vertex where they start."""
        edges = topology.sort_half_edges(self.triangles, len(self.points))
        return topology.HalfEdges(seal(edges.keys), seal(edges.triangles), seal(edges.offsets))

    def turn_about(self, vertex: int) -> tuple[Int32Array, Int32Array]:
        """Return the triangles around a vertex and its neighbours, counter-clockwise."""
        around, neighbors = topology.turn_about(self.triangles, self.half_edges, vertex)
        return seal(around), seal(neighbors)

    def find_edges(self, a: Int64Array, b: Int64Array) -> Int32Array:
        """Return the triangles left and right of the edges from a to b, (..., 2) array."""
        sides = [topology.find_triangles(self.half_edges, *ends) for ends in ((a, b), (b, a))]
        return seal(np.stack(sides, axis=-1))

    def find_regions(self, barrier: BoolArray) -> tuple[Int32Array, Int32Array]:
        """Return the region of each triangle, and the largest triangle of each region.

        ``barrier`` tells which edges no region goes across, (m, 3).
        """
        return _kernel.regions(self.points, self.triangles, self.neighbors, barrier)

    def vertices_at(self, xy: Float64Array) -> Int32Array:
        """Return the vertex at each place, -1 for none."""
        own = np.ascontiguousarray(self.points[:, :2])
        return _kernel.vertices_at(own, np.ascontiguousarray(xy))

    @cached_property
    def nearest(self) -> NearestVertex:
        """The index of nearest vertices; any number of threads may ask it at a time."""
        return NearestVertex(self.points)

    def _edge_components(self, axes: int) -> list[tuple[Float64Array, ...]]:
        """Return for each axis that of both edges from the first corner, contiguous in memory."""
        first, second, third = (corner.astype(np.intp) for corner in self.triangles.T)
        columns = [np.ascontiguousarray(axis) for axis in self.points.T[:axes]]
        return [(axis[second] - axis[first], axis[third] - axis[first]) for axis in columns]
