"""Which part of a triangulated hull is the surface: boundary, holes, trimming at long edges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import LinesError
from .. import _kernel, topology
from ..topology import edge_keys, find_offsets
from ..triangulation import Triangulation
from .ring_cover import find_crossings

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, Int64Array


def in_rings(xy: Float64Array, rings: Sequence[Float64Array]) -> Int8Array:
    """Tell where places lie: +1 inside an odd number of rings, 0 on one, -1 outside."""
    offsets = find_offsets(map(len, rings)).astype(np.int32)
    corners = np.ascontiguousarray(np.concatenate([ring[:, :2] for ring in rings]))
    return _kernel.places_in_rings(np.ascontiguousarray(xy), corners, offsets)


OWN_BOUNDARY = -1
"""Group of the segments of a boundary that is there: the surface is on their left only."""

BOUNDARY = 0
"""Group of the segments of all boundary rings together."""

EXTENT = 1
"""Group of the segments of all rings together within which there is data."""

HOLES = 2
"""Group of the segments of the first hole, its islands included; hole ``k`` has ``HOLES + k``."""


class RingSegments(NamedTuple):
    """Edges along rings, (k, 2) vertex pairs, and the group of each."""

    pairs: Int32Array
    groups: Int64Array


def is_inside(
    surface: Triangulation,
    segments: RingSegments,
    boundary: Sequence[Float64Array],
    extent: Sequence[Float64Array],
    holes: Sequence[Sequence[Float64Array]],
) -> BoolArray:
    """Tell which triangles lie inside the boundary, where there is data, and in no hole.

    Inside is what an odd number of rings of a group holds, so the islands of a hole stay.

    The triangles between the rings are regions. Where the largest triangle of all lies is found by
    comparing its middle with the rings, which leaves no doubt. From there on every ring that is
    crossed changes sides, so slivers between rings that nearly coincide are told exactly::

        +---------------- boundary ----+      bits: 1 for the boundary, 4, 8 ... for the holes
        |        +--- hole ----+       |
        |   1    |  5   +---+  |   1   |   0  across an edge the bits of its rings flip: the island
        |        |      | 1 |  |       |      is a second ring of the hole, so inside it 4 is off
        |        |      +---+  |       |
        |        +-------------+       |      kept: all that is needed is on, no hole is
        +------------------------------+

    Raises
    ------
    LinesError
        If a hole cuts nothing away.
    """
    half = _gather_half_edges(surface, segments)
    barrier = np.zeros(surface.constrained.shape, np.bool_)
    barrier[half.triangle, half.corner] = True
    region, largest = surface.find_regions(barrier)
    is_out = np.zeros(len(largest), np.bool_)
    is_out[region[half.triangle[half.is_behind_own_boundary]]] = True
    # for each edge along rings the groups that lie on other sides of it, as bits
    toggles: dict[int, int] = {}
    keys = edge_keys(segments.pairs, len(surface.points)).tolist()
    for key, group in zip(keys, segments.groups.tolist(), strict=True):
        toggles[key] = toggles.get(key, 0) ^ (0 if group == OWN_BOUNDARY else 1 << group)
    a, b, c = (surface.points[surface.triangles[largest, k], :2] for k in range(3))
    point: Float64Array = a + ((b - a) + (c - a)) / 3.0
    (x, y), (u, v) = (b - a).T, (c - a).T
    side = _Sides(boundary, extent, holes)
    across = surface.neighbors[half.triangle, half.corner]
    is_inner = across != topology.NO_NEIGHBOR
    here, there = region[half.triangle[is_inner]], region[across[is_inner]]
    beside = find_crossings(here, there, half.key[is_inner])
    known: dict[int, int] = {}  # bits of regions, from the largest one across the rings
    for start in np.argsort(-(x * v - y * u), kind="stable").tolist():
        if start in known:
            continue
        known[start] = side.at(point[start])
        pending = [start] if not is_out[start] else []
        while pending:
            inside = pending.pop()
            for beyond, key in beside.get(inside, ()):
                if beyond not in known and not is_out[beyond]:
                    known[beyond] = known[inside] ^ toggles[key]
                    pending.append(beyond)
    bits = [known[number] for number in range(len(largest))]
    keep = ~is_out & np.array([side.is_kept(own) for own in bits])
    _require_all_cut(bits, is_out, side)
    chosen: BoolArray = keep[region]
    return chosen


class _HalfEdges(NamedTuple):
    """Constrained half-edges along rings."""

    triangle: Int64Array
    corner: Int64Array
    key: Int64Array
    is_behind_own_boundary: BoolArray


def _gather_half_edges(surface: Triangulation, segments: RingSegments) -> _HalfEdges:
    n = len(surface.points)
    triangle, corner = np.nonzero(surface.constrained)
    start, end = topology.ends(surface.triangles, triangle, corner)
    key = edge_keys(np.stack([start, end], axis=1), n)
    is_ring = np.isin(key, edge_keys(segments.pairs, n))
    triangle, corner, key = triangle[is_ring], corner[is_ring], key[is_ring]
    boundary = segments.pairs[segments.groups == OWN_BOUNDARY].astype(np.int64)
    backwards = boundary[:, 1] * n + boundary[:, 0]
    is_behind = np.isin(start[is_ring] * n + end[is_ring], backwards)
    return _HalfEdges(triangle, corner, key, is_behind)


class _Sides:
    """Which rings hold a place, as bits by group."""

    def __init__(
        self,
        boundary: Sequence[Float64Array],
        extent: Sequence[Float64Array],
        holes: Sequence[Sequence[Float64Array]],
    ) -> None:
        self._groups = {BOUNDARY: boundary, EXTENT: extent, **dict(enumerate(holes, HOLES))}
        self._needed = sum(1 << group for group in (BOUNDARY, EXTENT) if self._groups[group])
        self.n_holes = len(holes)

    def at(self, point: Float64Array) -> int:
        bits = 0
        for group, rings in self._groups.items():
            if len(rings) and in_rings(point[None], rings)[0] > 0:
                bits |= 1 << group
        return bits

    def is_within(self, bits: int) -> bool:
        return bits & self._needed == self._needed

    def is_kept(self, bits: int) -> bool:
        return self.is_within(bits) and bits >> HOLES == 0


def _require_all_cut(bits: list[int], is_out: BoolArray, side: _Sides) -> None:
    cut = 0
    for own, out in zip(bits, is_out.tolist(), strict=True):
        if not out and side.is_within(own):
            cut |= own
    require_cut(np.array([cut >> (number + HOLES) & 1 for number in range(side.n_holes)], bool))


def require_cut(is_cutting: BoolArray) -> None:
    """Refuse holes, (h,), of which one cuts nothing away.

    Raises
    ------
    LinesError
    """
    for number in np.flatnonzero(~is_cutting)[:1].tolist():
        raise LinesError(
            f"Hole {number} lies outside the surface: it must cut away a part of it.",
            lines=[number],
        )


def require_triangles(are_left: bool) -> None:
    """Refuse rings that leave nothing.

    Raises
    ------
    LinesError
    """
    if not are_left:
        raise LinesError(
            "The boundary and the holes leave no triangle of the surface: a TIN needs one at least."
        )


def trim(
    surface: Triangulation, keep: BoolArray, max_edge: float, *, everywhere: bool
) -> BoolArray:
    """Drop triangles at edges longer than ``max_edge`` that are no lines.

    From the boundary only the triangles go that lie at a long outer edge, as long as there are
    any; everywhere all that have a long edge::

        a ------------------ b       a-b is outer and long: the triangle a-b-c goes. Then a-c is
          `.   `.          .'        outer, and long too: a-c-d goes. c-d is short: what lies
            `.    `.     .'          beyond it stays.
              `.     `..'
                d ---- c
    """
    if everywhere:
        return keep & ~_find_long_edges(surface, slice(None), max_edge).any(axis=1)
    keep = keep.copy()
    candidates = np.flatnonzero(keep & _find_outer_edges(surface, slice(None), keep).any(axis=1))
    while len(candidates):
        is_outer = _find_outer_edges(surface, candidates, keep)
        is_long = _find_long_edges(surface, candidates, max_edge)
        gone = candidates[(is_long & is_outer).any(axis=1)]
        keep[gone] = False
        near = surface.neighbors[gone].ravel()
        near = near[near != topology.NO_NEIGHBOR]
        candidates = np.unique(near[keep[near]])
    return keep


def _find_outer_edges(surface: Triangulation, chosen: Any, keep: BoolArray) -> BoolArray:
    """Tell which edges of some triangles have no kept triangle beyond them."""
    beside = surface.neighbors[chosen]
    is_outer: BoolArray = (beside == topology.NO_NEIGHBOR) | ~keep[beside]
    return is_outer


def _find_long_edges(surface: Triangulation, chosen: Any, max_edge: float) -> BoolArray:
    """Tell which edges of some triangles are longer, and no lines."""
    a, b, c = (surface.points[surface.triangles[chosen, k], :2] for k in range(3))
    sides = np.stack([np.hypot(*(c - b).T), np.hypot(*(a - c).T), np.hypot(*(b - a).T)], axis=1)
    is_long: BoolArray = (sides > max_edge) & ~surface.constrained[chosen]
    return is_long


def clip(surface: Triangulation, keep: BoolArray) -> tuple[Triangulation, Int32Array]:
    """Return the kept triangles with the vertices that they use, and the new number of each vertex.

    Vertices without a triangle have number -1. The new boundary is constrained::

        triangle   0  1  2  3  4
        keep       x     x  x         what is beside a kept triangle gets its number of now,
        number     0  -  1  2  -      or none, and then the edge between them is constrained
    """
    number = np.cumsum(keep, dtype=np.int32) - np.int32(1)
    beside = surface.neighbors[keep]
    is_outer = (beside == topology.NO_NEIGHBOR) | ~keep[beside]
    corners = surface.triangles[keep]
    is_used = np.zeros(len(surface.points), np.bool_)
    is_used[corners] = True
    vertex = np.where(is_used, np.cumsum(is_used, dtype=np.int32) - np.int32(1), np.int32(-1))
    return (
        Triangulation(
            surface.points[is_used],
            vertex[corners],
            np.where(is_outer, np.int32(topology.NO_NEIGHBOR), number[beside]),
            surface.constrained[keep] | is_outer,
        ),
        vertex,
    )
