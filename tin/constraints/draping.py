"""Draping: lines without elevations are laid on a surface, and get a vertex at every edge of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel, topology
from ..topology import find_offsets
from .clipping import in_rings
from .constraint_set import BELOW_ALL, LineSet
from .constraint_table import ConstraintTable
from .noding import node
from .polylines import Polylines

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..triangulation import Triangulation


class CutBoundary(NamedTuple):
    """The boundary of a surface that fills its convex hull, through the vertices of lines."""

    lines: LineSet
    """The parts that got vertices."""
    corners: Float64Array
    """(c, 2), along it the places that are vertices of the surface. One that an edge is bent onto
    occurs again."""
    is_met: BoolArray
    """(c,), whether a line has a vertex on it, its ends included."""


class CutLines(NamedTuple):
    """Lines without elevations, cut at the boundary of a surface that fills its convex hull."""

    points: Float64Array
    """(v, 2), places, of which some may be on no line."""
    elevations: Float64Array
    """(v,), of those on the boundary; NaN elsewhere."""
    polylines: Polylines
    """Each line with its parts outside."""
    is_inside: BoolArray
    """(s,), whether each segment is on the surface."""
    boundary: CutBoundary

    @property
    def inner(self) -> Polylines:
        """The parts on the surface, in the order of the lines and along each."""
        return self.polylines if self.is_inside.all() else self.polylines.keep(self.is_inside)

    @property
    def n_cut(self) -> int:
        """Lines of which a part lies outside."""
        return len(np.unique(self.polylines.segment_lines()[~self.is_inside]))


class Draped(NamedTuple):
    """Lines with elevations."""

    lines: LineSet
    """The given lines, cut where they leave the surface; kind, source and name are kept."""
    cut: CutLines
    """How they were cut, and the boundary with them."""


def drape(surface: Triangulation, lines: LineSet, *, threads: int) -> Draped:
    """Lay lines on a surface that fills its convex hull.

    Between its own vertices a line gets one at every edge of the surface that it crosses, so that
    it follows the ground. Parts outside the surface are left out.
    """
    hull = topology.boundary_rings(surface.triangles, surface.neighbors)[0]
    cut = cut_at_boundary(surface.points[hull], lines, threads=threads)
    polylines = cut.inner
    xy, owner = _follow_surface(surface, cut.points, polylines)
    z = _kernel.Locator(surface.points, surface.triangles, surface.neighbors).interpolate(xy)
    known = _look_elevations_up(xy, cut.points, cut.elevations)
    z = np.where(np.isnan(known), z, known)
    keep = ~np.isnan(z)
    xy, z, owner = xy[keep], z[keep], owner[keep]
    counts = np.bincount(owner, minlength=len(polylines))
    table = lines.table.take(polylines.lines)
    table = table._replace(priorities=np.full(len(polylines), BELOW_ALL))
    return Draped(LineSet(xy, z, find_offsets(counts), table), cut)


def cut_at_boundary(ring: Float64Array, lines: LineSet, *, threads: int) -> CutLines:
    """Cut lines at the boundary of a surface that fills its convex hull.

    ``ring`` has all vertices on the boundary, counter-clockwise, (k, 3).
    """
    if (in_rings(lines.xy, [ring[:, :2]]) >= 0).all():
        # the places of the lines' vertices, and the lines through these
        xy, inverse = np.unique(lines.xy, axis=0, return_inverse=True)
        polylines = Polylines.whole(inverse.reshape(-1).astype(np.int32), lines.offsets)
        return CutLines(
            xy,
            np.full(len(xy), np.nan),
            polylines,
            np.ones(len(polylines.starts()), np.bool_),
            CutBoundary(
                lines.choose(np.zeros(len(lines.kinds), np.bool_)),
                ring[:, :2],
                np.zeros(len(ring), np.bool_),
            ),
        )
    boundary = np.concatenate([ring, ring[:1]])
    both = np.concatenate([lines.xy, boundary[:, :2]])
    xy, inverse = np.unique(both, axis=0, return_inverse=True)
    vertex_of: Int32Array = inverse.reshape(-1).astype(np.int32)
    noded = node(
        xy,
        Polylines.whole(vertex_of, np.append(lines.offsets, len(both))),
        np.concatenate([lines.elevations, boundary[:, 2]]),
        np.append(lines.priorities, 0.0),
        threads=threads,
    )
    vertices, offsets = noded.polylines.vertices, noded.polylines.offsets
    boundary_chain = vertices[offsets[-2] :]
    boundary_elevations = noded.elevations[offsets[-2] :]
    points = np.concatenate([xy, noded.new_points[:, :2]])
    cut = Polylines.whole(vertices[: offsets[-2]], offsets[:-1])
    is_outside = np.zeros(len(points), np.bool_)
    is_outside[: len(xy)] = in_rings(xy, [boundary[:-1, :2]]) < 0
    elevations = np.full(len(points), np.nan)
    elevations[boundary_chain] = boundary_elevations
    return CutLines(
        points,
        elevations,
        cut,
        ~_run_outside(cut, is_outside, boundary_chain),
        _split_boundary(
            points,
            boundary_chain,
            boundary_elevations,
            own=np.isin(boundary_chain, vertex_of[len(lines.xy) :]),
            met=np.isin(boundary_chain, cut.vertices),
        ),
    )


def _run_outside(cut: Polylines, is_outside: BoolArray, boundary_chain: Int32Array) -> BoolArray:
    """Tell which segments of noded lines lie outside a convex boundary.

    From one vertex on the boundary to the next a line stays on one side, which its given vertices
    tell. A crossing tells nothing: where another line crosses near the boundary, rounding may put
    it beyond::

        ----.x.---- boundary     the line from below gets a vertex at x, where it crosses a line
             |                   along the boundary, and then one on it: up to there it is inside

    A run without a given vertex is a part of one segment between two points of the boundary:
    inside.
    """
    segments = cut.segments()
    is_on_boundary = np.zeros(len(is_outside), np.bool_)
    is_on_boundary[boundary_chain] = True
    begins = np.diff(cut.segment_lines(), prepend=-1) != 0
    run_of = np.cumsum(begins | is_on_boundary[segments[:, 0]]) - 1
    shows = (is_outside & ~is_on_boundary)[segments].any(axis=1)
    found: BoolArray = np.isin(run_of, run_of[shows])
    return found


def _split_boundary(
    points: Float64Array,
    chain: Int32Array,
    elevations: Float64Array,
    *,
    own: BoolArray,
    met: BoolArray,
) -> CutBoundary:
    """Return a closed boundary, whose edges with vertices between their ends are lines.

    Edges that such a vertex hides belong to them: where rounding put it beyond the boundary, a
    sliver that is no surface lies between it and the next edges in line::

        --------- v ----.         v is above the boundary by a rounding; the edge from a to b
        ______.--' `--. a ___ b   tells the sliver v, a, b apart from the surface below
    """
    corner = np.flatnonzero(own)
    is_split = np.diff(corner) > 1
    # which edges of a closed boundary, corner to corner, a vertex on another one hides
    xy = points[chain]
    is_hidden = np.zeros(len(is_split), np.bool_)
    n = len(is_split)
    for edge in np.flatnonzero(is_split).tolist():
        between = xy[corner[edge] + 1 : corner[edge + 1]]
        for turn in (1, -1):
            for step in range(1, n):
                other = (edge + turn * step) % n
                if not _are_beyond(between, xy[corner[[other, other + 1]]]).any():
                    break
                is_hidden[other] = True
    is_split |= is_hidden
    begins, ends = corner[:-1][is_split], corner[1:][is_split] + 1
    counts = ends - begins
    offsets = find_offsets(counts)
    rows = np.arange(offsets[-1]) + np.repeat(begins - offsets[:-1], counts)
    sources = np.full(len(counts), -1, np.int32)
    table = ConstraintTable.of_kind("boundary", sources, np.full(len(counts), BELOW_ALL))
    before = find_offsets(met)
    return CutBoundary(
        LineSet(points[chain[rows]], elevations[rows], offsets, table),
        points[chain[corner[:-1]]],
        before[corner[1:] + 1] > before[corner[:-1]],
    )


def _are_beyond(xy: Float64Array, edge: Float64Array) -> BoolArray:
    """Tell which places lie to the right of an edge from its first end to its second."""
    start, end = (np.ascontiguousarray(np.broadcast_to(point, xy.shape)) for point in edge)
    beyond: BoolArray = _kernel.orientation(start, end, np.ascontiguousarray(xy)) < 0
    return beyond


def _look_elevations_up(
    xy: Float64Array, points: Float64Array, elevations: Float64Array
) -> Float64Array:
    """Look up the elevations of places that have one already; NaN elsewhere."""
    known = np.flatnonzero(~np.isnan(elevations))
    found = np.full(len(xy), np.nan)
    if len(known):
        both = np.concatenate([points[known], xy])
        _, number = np.unique(both, axis=0, return_inverse=True)
        number = number.reshape(-1)
        table = np.full(int(number.max()) + 1, np.nan)
        table[number[: len(known)]] = elevations[known]
        found = table[number[len(known) :]]
    return found


def _follow_surface(
    surface: Triangulation, points: Float64Array, polylines: Polylines
) -> tuple[Float64Array, Int64Array]:
    """Return the places along every polyline, with those where it crosses edges, and its number.

    ::

                  /          .
        a ------ x ---------- x ---- b      a segment, and two edges of the surface in its way:
                /              .            along it lie a, x, x and b, a place in a row once
    """
    mesh = _kernel.Mesh(
        surface.points,
        surface.triangles,
        surface.neighbors,
        np.ones(surface.triangles.shape, np.bool_),  # so that every edge is there to be crossed
    )
    slots = np.full(len(points), -1, np.int32)
    used = np.unique(polylines.vertices)
    slots[used] = mesh.insert(np.ascontiguousarray(points[used]))
    own = polylines.segments()
    n_own = len(surface.points)
    crossed = mesh.crossed(np.ascontiguousarray(slots[own]), True).reshape(-1, 3)
    # Slots that no line uses are checked with all others, and so must hold numbers.
    xy = np.concatenate([surface.points[:, :2], np.zeros((mesh.slots - n_own, 2))])
    xy[slots[used]] = points[used]
    pairs = np.stack([crossed[:, 0], len(own) + np.arange(len(crossed))], axis=1)
    segments = np.concatenate([slots[own], crossed[:, 1:]]).astype(np.int32)
    meets = _kernel.intersections(
        np.ascontiguousarray(xy), np.ascontiguousarray(segments), pairs.astype(np.int32)
    )
    at = polylines.starts()[crossed[:, 0]]
    along = np.insert(points[polylines.vertices], at + 1, meets, axis=0)
    owner = np.insert(polylines.owners, at + 1, polylines.owners[at])
    is_new = np.ones(len(along), np.bool_)
    is_new[1:] = (np.diff(along, axis=0) != 0).any(axis=1) | (np.diff(owner) != 0)
    return along[is_new], owner[is_new]
