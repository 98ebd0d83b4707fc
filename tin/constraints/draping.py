"""Draping: lines without heights are laid on a surface, and get a vertex at every edge of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel, topology
from .clipping import Surface, in_rings
from .constraint_set import BELOW_ALL, LineSet
from .constraint_table import ConstraintTable
from .noding import node
from .polylines import Polylines, offsets_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Draped", "drape"]


class Draped(NamedTuple):
    """Lines with heights.

    Attributes
    ----------
    lines : LineSet
        The given lines, cut where they leave the surface; kind, source and name are kept.
    rim : LineSet
        The parts of the surface's rim that got vertices where lines leave it.
    n_cut : int
        Lines of which a part lies outside the surface.
    """

    lines: LineSet
    rim: LineSet
    n_cut: int


def drape(surface: Surface, lines: LineSet, *, threads: int) -> Draped:
    """Lay lines on a surface that fills its convex hull.

    Between its own vertices a line gets one at every edge of the surface that it crosses, so that
    it follows the ground. Parts outside the surface are left out.
    """
    hull = topology.boundary_rings(surface.triangles, surface.neighbors)[0]
    ring = np.ascontiguousarray(surface.points[hull, :2])
    if (in_rings(lines.xy, [ring]) >= 0).all():
        xy, polylines = _vertices_once(lines)
        whole = _with_heights(surface, xy, np.full(len(xy), np.nan), polylines, lines)
        return Draped(whole, _no_lines(lines), 0)
    return _cut_at_rim(surface, hull, lines, threads=threads)


def _no_lines(lines: LineSet) -> LineSet:
    return lines.chosen(np.zeros(len(lines.kinds), np.bool_))


def _vertices_once(lines: LineSet) -> tuple[NDArray[np.float64], Polylines]:
    """Return the places of the lines' vertices, and the lines through these."""
    xy, vertex_of = np.unique(lines.xy, axis=0, return_inverse=True)
    return xy, Polylines.whole(vertex_of.reshape(-1).astype(np.int32), lines.offsets)


def _cut_at_rim(
    surface: Surface, hull: NDArray[np.int32], lines: LineSet, *, threads: int
) -> Draped:
    rim = surface.points[np.append(hull, hull[0])]
    both = np.concatenate([lines.xy, rim[:, :2]])
    xy, inverse = np.unique(both, axis=0, return_inverse=True)
    vertex_of: NDArray[np.int32] = inverse.reshape(-1).astype(np.int32)
    noded = node(
        xy,
        Polylines.whole(vertex_of, np.append(lines.offsets, len(both))),
        np.concatenate([lines.heights, rim[:, 2]]),
        np.append(lines.priorities, 0.0),
        threads=threads,
    )
    vertices, offsets = noded.polylines.vertices, noded.polylines.offsets
    rim_chain = vertices[offsets[-2] :]
    rim_heights = noded.elevations[offsets[-2] :]
    places = np.concatenate([xy, noded.new_points[:, :2]])
    cut = Polylines.whole(vertices[: offsets[-2]], offsets[:-1])
    is_outside = np.zeros(len(places), np.bool_)
    is_outside[: len(xy)] = in_rings(xy, [rim[:-1, :2]]) < 0
    is_inside = ~_runs_outside(cut, is_outside, rim_chain)
    heights = np.full(len(places), np.nan)
    heights[rim_chain] = rim_heights
    return Draped(
        _with_heights(surface, places, heights, cut.keep(is_inside), lines),
        _split_rim(places, rim_chain, rim_heights, vertex_of[len(lines.xy) :]),
        len(np.unique(cut.segment_lines()[~is_inside])),
    )


def _runs_outside(
    cut: Polylines, is_outside: NDArray[np.bool_], rim_chain: NDArray[np.int32]
) -> NDArray[np.bool_]:
    """Tell which segments of noded lines lie outside a convex rim.

    From one vertex on the rim to the next a line stays on one side, which its given vertices tell.
    A crossing tells nothing: where another line crosses near the rim, rounding may put it beyond::

        ----.x.---- rim      the line from below gets a vertex at x, where it crosses a line along
             |               the rim, and then one on the rim: up to there it is inside

    A run without a given vertex is a part of one segment between two points of the rim: inside.
    """
    segments = cut.segments()
    is_on_rim = np.zeros(len(is_outside), np.bool_)
    is_on_rim[rim_chain] = True
    begins = np.diff(cut.segment_lines(), prepend=-1) != 0
    run_of = np.cumsum(begins | is_on_rim[segments[:, 0]]) - 1
    shows = (is_outside & ~is_on_rim)[segments].any(axis=1)
    found: NDArray[np.bool_] = np.isin(run_of, run_of[shows])
    return found


def _split_rim(
    places: NDArray[np.float64],
    chain: NDArray[np.int32],
    heights: NDArray[np.float64],
    own: NDArray[np.int32],
) -> LineSet:
    """Return the edges of the rim that have vertices between their ends, as lines.

    Edges that such a vertex hides belong to them: where rounding put it beyond the rim, a sliver
    that is no surface lies between it and the next edges in line::

        rim  --------- v ----.         v is above the rim by a rounding; the edge from a to b tells
             ______.--' `--. a ___ b   the sliver v, a, b apart from the surface below
    """
    corner = np.flatnonzero(np.isin(chain, own))
    is_split = np.diff(corner) > 1
    is_split |= _hidden_edges(places[chain], corner, is_split)
    begins, ends = corner[:-1][is_split], corner[1:][is_split] + 1
    counts = ends - begins
    offsets = offsets_of(counts)
    rows = np.arange(offsets[-1]) + np.repeat(begins - offsets[:-1], counts)
    sources = np.full(len(counts), -1, np.int32)
    table = ConstraintTable.of_kind("boundary", sources, np.full(len(counts), BELOW_ALL))
    return LineSet(places[chain[rows]], heights[rows], offsets, table)


def _hidden_edges(
    xy: NDArray[np.float64], corner: NDArray[np.int64], is_split: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Tell which edges of a closed rim, from corner to corner, a vertex on another one hides."""
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
    return is_hidden


def _are_beyond(xy: NDArray[np.float64], edge: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which places lie to the right of an edge from its first end to its second."""
    start, end = (np.ascontiguousarray(np.broadcast_to(place, xy.shape)) for place in edge)
    beyond: NDArray[np.bool_] = _kernel.orientation(start, end, np.ascontiguousarray(xy)) < 0
    return beyond


def _with_heights(
    surface: Surface,
    places: NDArray[np.float64],
    heights: NDArray[np.float64],
    polylines: Polylines,
    lines: LineSet,
) -> LineSet:
    """Give polylines a vertex at every edge of the surface, and every vertex its height."""
    xy, owner = _along_surface(surface, places, polylines)
    z = _kernel.Locator(surface.points, surface.triangles, surface.neighbors).interpolate(xy)
    known = _heights_at(xy, places, heights)
    z = np.where(np.isnan(known), z, known)
    keep = ~np.isnan(z)
    xy, z, owner = xy[keep], z[keep], owner[keep]
    counts = np.bincount(owner, minlength=len(polylines))
    table = lines.table.take(polylines.lines)
    table = table._replace(priorities=np.full(len(polylines), BELOW_ALL))
    return LineSet(xy, z, offsets_of(counts), table)


def _heights_at(
    xy: NDArray[np.float64], places: NDArray[np.float64], heights: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Look up the heights of places that have one already; NaN elsewhere."""
    known = np.flatnonzero(~np.isnan(heights))
    found = np.full(len(xy), np.nan)
    if len(known):
        both = np.concatenate([places[known], xy])
        _, number = np.unique(both, axis=0, return_inverse=True)
        number = number.reshape(-1)
        table = np.full(int(number.max()) + 1, np.nan)
        table[number[: len(known)]] = heights[known]
        found = table[number[len(known) :]]
    return found


def _along_surface(
    surface: Surface, places: NDArray[np.float64], polylines: Polylines
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the places along every polyline, with those where it crosses edges, and its number."""
    mesh = _kernel.Mesh(
        surface.points,
        surface.triangles,
        surface.neighbors,
        np.ones(surface.triangles.shape, np.bool_),  # so that every edge is there to be crossed
    )
    slots = np.full(len(places), -1, np.int32)
    used = np.unique(polylines.vertices)
    slots[used] = mesh.insert(np.ascontiguousarray(places[used]))
    steps = polylines.segments()
    n_own = len(surface.points)
    crossed = mesh.crossed(np.ascontiguousarray(slots[steps]), True).reshape(-1, 3)
    xy = np.concatenate([surface.points[:, :2], np.empty((mesh.slots - n_own, 2))])
    xy[slots[used]] = places[used]
    pairs = np.stack([crossed[:, 0], len(steps) + np.arange(len(crossed))], axis=1)
    segments = np.concatenate([slots[steps], crossed[:, 1:]]).astype(np.int32)
    meets = _kernel.intersections(
        np.ascontiguousarray(xy), np.ascontiguousarray(segments), pairs.astype(np.int32)
    )
    at = polylines.starts()[crossed[:, 0]]
    along = np.insert(places[polylines.vertices], at + 1, meets, axis=0)
    owner = np.insert(polylines.owners, at + 1, polylines.owners[at])
    is_new = np.ones(len(along), np.bool_)
    is_new[1:] = (np.diff(along, axis=0) != 0).any(axis=1) | (np.diff(owner) != 0)
    return along[is_new], owner[is_new]
