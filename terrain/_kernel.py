"""The only module that imports the compiled core of terrain."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ..base.interrupts import hold_interrupts

with hold_interrupts():
    from . import _core

if TYPE_CHECKING:
    from ..base.arrays import Float64Array, Int32Array, Int64Array

__all__ = [
    "SUMS",
    "TILE_SIDE",
    "FallingSurface",
    "GriddedSurface",
    "OverlayMesh",
    "accumulate",
    "cut_cells",
    "densify",
    "fill_bands",
    "find_ends",
    "find_seen_parts",
    "find_seen_vertices",
    "fit_quadratics",
    "measure_cells",
    "overlay",
    "shade_planes",
    "simplify_cells",
    "smooth_contours",
    "stage_sums",
    "sum_areas",
    "sum_between",
    "sum_channels",
    "sum_heights",
    "trace_contours",
    "triangle_normals",
    "vertex_normals",
]

GriddedSurface = _core.GriddedSurface
TILE_SIDE = _core.TILE_SIDE
"""Cells of a raster that are computed together lie in squares of so many rows and columns."""

triangle_normals = _core.triangle_normals
vertex_normals = _core.vertex_normals
shade_planes = _core.shade_planes
fit_quadratics = _core.fit_quadratics

densify = _core.densify
simplify_cells = _core.simplify_cells
measure_cells = _core.measure_cells
find_seen_parts = _core.find_seen_parts
find_seen_vertices = _core.find_seen_vertices

FallingSurface = _core.FallingSurface
find_ends = _core.find_ends
accumulate = _core.accumulate
sum_channels = _core.sum_channels
cut_cells = _core.cut_cells

trace_contours = _core.trace_contours
smooth_contours = _core.smooth_contours
fill_bands = _core.fill_bands

SUMS = (
    "area",
    "cut_area",
    "fill_area",
    "cut",
    "fill",
    "squares",
    "surface_area",
    "other_surface_area",
    "lowest",
    "highest",
)
"""Columns of what :func:`sum_between` and :func:`sum_heights` return, a row for each group."""

sum_areas = _core.sum_areas
sum_between = _core.sum_between
sum_heights = _core.sum_heights
stage_sums = _core.stage_sums


class OverlayMesh(NamedTuple):
    """The overlay of two surfaces: convex cells that share their vertices."""

    vertices: Float64Array
    """(n, 3), easting, northing, elevation of the second surface above the first."""
    origins: Int32Array
    """(n, 2), the vertex of the first surface, and of the second, that it is; -1 for none."""
    offsets: Int64Array
    """(k + 1,)."""
    corners: Int32Array
    """(c,), cell i has the vertices ``corners[offsets[i]:offsets[i + 1]]``, counter-clockwise."""
    triangles: Int32Array
    """(k, 2), of the first and of the second surface, that the cell is part of."""


def overlay(
    points: Float64Array,
    triangles: Int32Array,
    other_points: Float64Array,
    other_triangles: Int32Array,
    *,
    is_other_apart: bool = False,
) -> OverlayMesh:
    """Cut two surfaces along the edges of each other, where both are.

    Faster where both have many triangles in common, if it is known that those of the other one do
    not overlap.
    """
    return OverlayMesh(
        *_core.overlay(points, triangles, other_points, other_triangles, is_other_apart)
    )
