"""Planar straight-line graph (PSLG): vertices, segments of lines, what of the hull is the surface.

It is what a TIN is a function of once rows are merged and lines cut where they meet. The
triangulation of its vertices with its segments is unique, so any way to it gives the same TIN.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import LinesError
from .. import _kernel
from ..topology import edge_keys, edges_at
from .breaklines import Lines
from .clipping import (
    BOUNDARY,
    OWN_BOUNDARY,
    RingSegments,
    clip,
    is_inside,
    require_triangles,
    trim,
)

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..triangulation import Triangulation
    from .constraint_table import ConstraintTable
    from .polylines import Polylines


@dataclass(frozen=True, eq=False, kw_only=True)
class Clip:
    """Which triangles of the hull are the surface."""

    boundary: list[Float64Array] = field(default_factory=list)
    extent: list[Float64Array] = field(default_factory=list)
    """Rings, (k, 2) each."""
    holes: list[list[Float64Array]] = field(default_factory=list)
    """The rings of each, (k, 2), the outer one and its islands."""
    has_own_boundary: bool = False
    """Whether there are lines of a boundary that is there, beyond which is no surface."""
    max_edge: float | None = None
    is_trimmed_everywhere: bool = False

    @property
    def is_none(self) -> bool:
        """Whether all of the hull is the surface."""
        return not self.has_rings and self.max_edge is None

    @property
    def has_rings(self) -> bool:
        """Whether rings tell what the surface is."""
        return bool(self.boundary or self.extent or self.holes or self.has_own_boundary)

    def keeps(self, surface: Triangulation, ring_segments: RingSegments) -> BoolArray:
        """Tell which triangles are kept.

        Raises
        ------
        LinesError
            If there are none, or if a hole cuts nothing away.
        """
        keep = np.ones(len(surface.triangles), np.bool_)
        if self.has_rings:
            keep = is_inside(surface, ring_segments, self.boundary, self.extent, self.holes)
            require_triangles(bool(keep.any()))
        if self.max_edge is not None:
            everywhere = self.is_trimmed_everywhere
            keep = trim(surface, keep, self.max_edge, everywhere=everywhere)
            if not keep.any():
                raise LinesError(
                    f"No triangle is left with `max_edge` {self.max_edge:g}: a TIN needs one at "
                    "least."
                )
        return keep


@dataclass(frozen=True, eq=False, kw_only=True)
class Pslg:
    """Planar straight-line graph: vertices and segments of lines of the whole hull."""

    points: Float64Array
    """(v, 3), distinct places."""
    polylines: Polylines
    constraints: ConstraintTable
    """What their lines are; source -1 is an edge of the boundary that was cut."""
    groups: Int64Array
    """(l,), of each line whose side it changes, if it is a ring, as in :mod:`.clipping`."""
    clip: Clip
    vertex_of: Int32Array
    """(n,), the vertex of each row of the caller's points, -1 for none."""

    def surface(self, hull: Triangulation) -> tuple[Triangulation, Int32Array]:
        """Cut the triangulated hull; return the surface and the new number of each vertex."""
        if self.clip.is_none:
            return hull, np.arange(len(hull.points), dtype=np.int32)
        group = self._find_ring_groups()[self.polylines.segment_lines()]
        is_ring = group >= (OWN_BOUNDARY if self.clip.has_own_boundary else BOUNDARY)
        rings = RingSegments(self.polylines.segments()[is_ring], group[is_ring])
        keep = self.clip.keeps(hull, rings)
        if keep.all():
            return hull, np.arange(len(hull.points), dtype=np.int32)
        return clip(hull, keep)

    def _find_ring_groups(self) -> Int64Array:
        """Return the group of each line, that of the boundary too; below all if it is no ring."""
        table = self.constraints
        groups = np.where(table.sources < 0, OWN_BOUNDARY, self.groups)
        return np.where(table.is_kind("boundary", "hole"), groups, OWN_BOUNDARY - 1)

    def loses_vertices_at_own_boundary(self, hull: Triangulation) -> bool:
        """Tell whether vertices lie beyond a boundary that is there: only if a rounding bent it.

        Rings that end at the boundary need it none the less, to have an inside.
        """
        if not self.clip.has_own_boundary:
            return False
        without = replace(self, clip=replace(self.clip, has_own_boundary=False))
        try:
            (_, within), (_, everywhere) = self.surface(hull), without.surface(hull)
        except LinesError:  # nothing is left: the same without the boundary, or it was its fault
            return True
        return bool(((within < 0) & (everywhere >= 0)).any())


def build_mesh(points: Float64Array, polylines: Polylines, *, threads: int) -> _kernel.Mesh:
    """Triangulate distinct points, and fix the segments of lines that are cut where they meet."""
    mesh, _ = _kernel.triangulate_mesh(points, threads=threads)
    force(mesh, polylines)
    return mesh


def force(mesh: _kernel.Mesh, polylines: Polylines) -> None:
    """Fix all segments."""
    passed, blocked = mesh.force(polylines.segments())
    if len(passed) or len(blocked):
        raise AssertionError("lines were not cut at all places where they meet")


def find_lines_in(
    polylines: Polylines,
    constraints: ConstraintTable,
    number_of: Int32Array,
    surface: Triangulation,
    *,
    is_whole: bool,
) -> Lines:
    """Return the lines as far as they are edges of the surface, by its numbers of vertices."""
    is_edge = (constraints.sources >= 0)[polylines.segment_lines()]
    if not is_whole:
        is_edge &= _are_edges(number_of[polylines.segments()], surface)
    left = polylines.keep(is_edge).renumber(number_of)
    table = constraints.take(left.lines)
    told: dict[str, Any] = {"kinds": table.kinds, "sources": table.sources, "names": table.names}
    return Lines(vertices=left.vertices, offsets=left.offsets, **told)


def _are_edges(segments: Int32Array, surface: Triangulation) -> BoolArray:
    n = len(surface.points)
    edges = edges_at(surface.triangles, surface.constrained)
    is_edge = np.asarray((segments >= 0).all(axis=1), np.bool_)
    is_edge[is_edge] = np.isin(edge_keys(segments[is_edge], n), edge_keys(edges, n))
    return is_edge
