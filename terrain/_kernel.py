"""The only module that imports the compiled core of terrain."""

from __future__ import annotations

from ..base.interrupts import hold_interrupts

with hold_interrupts():
    from . import _core

GriddedSurface = _core.GriddedSurface
TILE_SIDE = _core.TILE_SIDE
"""Cells of a raster that are computed together lie in squares of so many rows and columns."""

number_components = _core.number_components
double_areas = _core.double_areas
join_components = _core.join_components
triangle_normals = _core.triangle_normals
vertex_normals = _core.vertex_normals
shade_planes = _core.shade_planes
fit_quadratics = _core.fit_quadratics

densify = _core.densify
simplify_cells = _core.simplify_cells
measure_cells = _core.measure_cells
find_seen_parts = _core.find_seen_parts
complete_sides = _core.complete_sides
find_seen_vertices = _core.find_seen_vertices

FallingSurface = _core.FallingSurface
Filling = _core.Filling
Bases = _core.Bases
find_ends = _core.find_ends
accumulate = _core.accumulate
sum_channels = _core.sum_channels
cut_cells = _core.cut_cells

ContourLines = _core.ContourLines
trace_contours = _core.trace_contours
smooth_contours = _core.smooth_contours
fill_bands = _core.fill_bands

LinePieces = _core.LinePieces
BandBoundaries = _core.BandBoundaries
trace_pieces = _core.trace_pieces
settle_contours = _core.settle_contours
list_band_boundaries = _core.list_band_boundaries
fill_band = _core.fill_band

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
SumTerms = _core.SumTerms
terms_between = _core.terms_between
terms_of_heights = _core.terms_of_heights
terms_of_areas = _core.terms_of_areas
sum_rows = _core.sum_rows
merge_terms = _core.merge_terms
stage_sums = _core.stage_sums
overlay = _core.overlay
OverlayMesh = _core.OverlayMesh
