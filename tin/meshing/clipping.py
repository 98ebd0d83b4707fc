"""Clip: the part of a TIN within rings, or beyond them, with its lines and its rows."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import LinesError
from ...base.progress import Progress
from .. import topology
from ..building import Version
from ..constraints import (
    BOUNDARY,
    OWN_BOUNDARY,
    Clip,
    ConstraintTable,
    Polylines,
    RingSegments,
    clip,
    find_lines_in,
)
from ..editing import account_for_fewer_vertices
from ..triangulation import mark_illegal_edges
from .cutting import CutSurface, are_among, cut_along

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import LineKind
    from ...base.progress import Tell
    from ..constraints import Lines
    from ..surface import TIN
    from ..triangulation import Triangulation

_JOINT = "joint"
"""Name of soft breaklines along edges that are not Delaunay, in whose place others would be."""


class Clipped(NamedTuple):
    """A part of a TIN."""

    tin: TIN
    made: int
    """Number of vertices that the TIN does not have."""
    joints: int
    """Number of edges that are soft breaklines now, as they are not Delaunay."""


def clip_tin(
    tin: TIN, rings: Sequence[Float64Array], *, outside: bool, progress: Tell | None = None
) -> Clipped:
    """Return the part of a TIN that an odd number of rings holds, or with ``outside`` the rest.

    ``rings`` are corners, (k, 2) each, the first not repeated; they touch one another at most.

    Raises
    ------
    LinesError
        If nothing is left, or if nothing is cut away with ``outside``.
    PointsError
        If triangles overlap, or vertices share a place.
    """
    done = Progress(progress)
    part = _Part.of(tin, rings, outside=outside)
    done(0.1)
    cut = cut_along(part.surface, part.chains, rings, done.stage(0.1, 0.8) or _ignore)
    done(0.8)
    return _Result(tin, part, cut, rings, outside=outside).make()


def _ignore(_: float) -> None:
    pass


class _Part(NamedTuple):
    """The triangles of a TIN that rings may cut or keep: those in their bounds, or all."""

    surface: Triangulation
    number_of: Int32Array
    """(n,), the vertex here for each of the TIN, -1 for none."""
    chains: list[Int32Array]
    """Its lines."""
    table: ConstraintTable

    @classmethod
    def of(cls, tin: TIN, rings: Sequence[Float64Array], *, outside: bool) -> _Part:
        mesh, lines = tin.triangulation, tin.lines
        keep = np.ones(len(mesh.triangles), np.bool_)
        if not outside:
            corners, every = mesh.points[mesh.triangles, :2], np.concatenate(rings)
            keep &= (corners.max(axis=1) >= every.min(axis=0)).all(axis=1)
            keep &= (corners.min(axis=1) <= every.max(axis=0)).all(axis=1)
            if not keep.any():
                raise _explain_miss(outside=False)
        surface, number_of = clip(mesh, keep)
        surface = replace(surface, constrained=mesh.constrained[keep])
        polylines = Polylines.whole(lines.vertices, lines.offsets).renumber(number_of)
        pairs = polylines.segments()
        edges = topology.edges_at(surface.triangles, surface.constrained)
        left = polylines.keep(_are_among(pairs, edges, len(surface.points)))
        priorities = np.zeros(len(lines))
        table = ConstraintTable(lines.kinds, lines.sources, priorities, lines.names)
        return cls(
            surface,
            number_of,
            list(left),
            table.take(left.lines),
        )


def _are_among(pairs: Int32Array, edges: Int32Array, n_vertices: int) -> BoolArray:
    """Tell which pairs of vertices, of which some are -1 for none, are among some edges."""
    found = np.asarray((pairs >= 0).all(axis=1), np.bool_)
    known = topology.edge_keys(edges, n_vertices)
    found[found] = are_among(topology.edge_keys(pairs[found], n_vertices), known)
    return found


def _explain_miss(*, outside: bool) -> LinesError:
    what = "they cut nothing off it" if outside else "nothing of it is inside them"
    return LinesError(f"The polygons lie outside the surface: {what}.")


class _Result:
    """The part of a cut surface that is kept; vertices are those of its hull, then of itself."""

    def __init__(
        self,
        tin: TIN,
        part: _Part,
        cut: CutSurface,
        rings: Sequence[Float64Array],
        *,
        outside: bool,
    ) -> None:
        self._tin, self._part, self._cut, self._outside = tin, part, cut, outside
        kind: LineKind = "hole" if outside else "boundary"
        same = part.table.sources[part.table.is_kind(kind)]
        sources = int(same.max(initial=-1)) + 1 + np.arange(len(rings))
        self._lines = ConstraintTable.join([part.table, _make_table(kind, sources)])
        self._polylines = Polylines.of_chains([*cut.chains, *cut.rings])
        self._is_ring = self._polylines.segment_owners() >= len(cut.chains)
        self._surface, self._number_of = clip(cut.hull, self._find_kept(rings))

    def _find_kept(self, rings: Sequence[Float64Array]) -> BoolArray:
        """Tell which triangles of the hull are kept: within the boundary, and the right side."""
        cut, hull = self._cut, self._cut.hull
        own, ring = (Polylines.of_chains(one).segments() for one in (cut.boundary, cut.rings))
        around = RingSegments(own, np.full(len(own), OWN_BOUNDARY))
        is_own = Clip(has_own_boundary=True).keeps(hull, around)
        is_inside = Clip(boundary=list(rings)).keeps(
            hull, RingSegments(ring, np.full(len(ring), BOUNDARY))
        )
        keep = is_own & (is_inside ^ self._outside)
        if self._outside and not keep.any():
            raise LinesError("The polygons cover the whole surface: nothing of it is outside them.")
        if not keep.any() or (self._outside and keep.sum() == is_own.sum()):
            raise _explain_miss(outside=self._outside)
        return keep

    def make(self) -> Clipped:
        """Return the TIN."""
        is_fixed = self._find_fixed()
        joints = self._find_joints(is_fixed)
        part, tin = self._part, self._tin
        points = self._surface.points.copy()
        is_open = np.isnan(points[:, 2])  # beside the boundary by a rounding
        points[is_open, 2] = tin.interpolate(points[is_open, :2], extrapolate="nearest")
        surface = replace(self._surface, points=points, constrained=is_fixed | self._flag(joints))
        number_of = np.append(part.number_of, np.int32(-1))
        there = number_of >= 0
        number_of[there] = self._number_of[number_of[there]]
        vertex_of = number_of[tin.vertex_of]
        made = len(surface.points) - int((number_of >= 0).sum())
        why = "in a hole" if self._outside else "outside the boundary"
        version = Version(
            triangulation=surface,
            vertex_of=vertex_of,
            report=account_for_fewer_vertices(tin.report, surface, number_of, vertex_of, why),
            lines=self._find_lines(joints, surface),
        )
        return Clipped(tin._with_version(version), made, len(joints))

    def _find_fixed(self) -> BoolArray:
        """Tell which edges are constrained: those that were, and all around if rings cut."""
        flagged, rings = (
            self._flag(self._number_of[Polylines.of_chains(chains).segments()])
            for chains in (self._cut.flagged, self._cut.rings)
        )
        is_outer = self._surface.neighbors == topology.NO_NEIGHBOR
        return flagged | rings | is_outer if rings.any() else flagged

    def _flag(self, pairs: Int32Array | Int64Array) -> BoolArray:
        """Return flags of edges, (m, 3), of pairs of the result's vertices, some of them -1."""
        n = len(self._surface.points)
        pairs = pairs[(pairs >= 0).all(axis=1)]
        start, end = topology.directed_edges(self._surface.triangles)
        keys = topology.edge_keys(np.stack([start, end], axis=-1), n)
        return are_among(keys, topology.edge_keys(pairs, n))

    def _find_joints(self, is_fixed: BoolArray) -> Int32Array:
        """Return the edges that are not Delaunay, (k, 2) vertices."""
        surface = replace(self._surface, constrained=is_fixed)
        return topology.edges_at(surface.triangles, mark_illegal_edges(surface))

    def _find_lines(self, joints: Int32Array, surface: Triangulation) -> Lines:
        """Return the lines that are left, the rings along the boundary, and the joints."""
        pairs = self._number_of[self._polylines.segments()]
        outer = topology.edges_at(surface.triangles, surface.neighbors == topology.NO_NEIGHBOR)
        is_outer = _are_among(pairs, outer, len(surface.points))
        left = self._polylines.keep(~self._is_ring | is_outer)
        number = np.flatnonzero(self._number_of >= 0).astype(np.int32)
        more = Polylines.of_chains(number[joints].tolist())
        soft = self._lines.sources[self._lines.is_kind("hard", "soft")]
        sources = int(soft.max(initial=-1)) + 1 + np.arange(len(joints))
        table = ConstraintTable.join([self._lines, _make_table("soft", sources, _JOINT)])
        together = Polylines(
            np.append(left.vertices, more.vertices),
            np.append(left.offsets, len(left.vertices) + more.offsets[1:]).astype(np.int32),
            np.append(left.lines, len(self._lines.kinds) + more.lines).astype(np.int32),
        )
        return find_lines_in(together, table, self._number_of, surface, is_whole=False)


def _make_table(kind: LineKind, sources: Int64Array, name: str = "") -> ConstraintTable:
    """Return lines that are all of one kind and name."""
    table = ConstraintTable.of_kind(kind, sources.astype(np.int32), np.zeros(len(sources)))
    return table._replace(names=(name,) * len(sources))
