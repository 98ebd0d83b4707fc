"""Divides: triangles cut where the water on both sides of a fall line goes different ways."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin import topology
from .. import _kernel
from ..surface import DividedMesh, fan_out, sort_by
from .descent import interpolate_edges
from .strips import SAME, follow
from .vertices import NOWHERE

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from .falls import Falls
    from .networks import Network

_NEAR = 1e-10
"""Places on an edge whose shares of it differ by less are one."""


class _Cuts(NamedTuple):
    """Fall lines across triangles, by triangle and share of the base."""

    triangles: Int64Array
    """(k,)."""
    lower: Int64Array
    upper: Int64Array
    """Both (k,), their ends, at the base and on other edges: vertices, or places from n on."""
    before: Int32Array
    beyond: Int32Array
    """Both (k,), the labels on both sides."""
    places: Float64Array
    """(p, 2)."""
    edges: Int64Array
    """(p,), the edge of each place, ascending, and in an edge from its smaller vertex on."""
    touched: Int32Array
    """(t,), triangles with a place on an edge of theirs, beyond the cut ones."""


class Divides(NamedTuple):
    """Where triangles are to be cut, and their labels."""

    falls: Falls
    surface: _kernel.FallingSurface
    """Of the compiled core."""
    cuts: _Cuts
    whole: Int32Array
    """(m,), the label of each triangle that is not cut."""


def find_divides(network: Network, labels: Int32Array, level: Int32Array) -> Divides:
    """Find where water parts within triangles.

    ``labels`` are those of the strips, (s,); ``level`` those of level triangles, (m,).
    """
    offsets = network.strips.offsets
    whole = level.copy()
    sloping = np.flatnonzero(np.diff(offsets))
    whole[sloping] = labels[offsets[sloping + 1] - 1]
    differs = np.ones(len(labels), np.bool_)
    np.not_equal(labels[1:], labels[:-1], out=differs[1:])
    differs[offsets[sloping]] = False  # from one triangle to the next
    rows = np.flatnonzero(differs)
    cuts = _place_cuts(network, rows, network.strips.find_triangles(rows), labels)
    return Divides(network.walker.falls, network.surface, cuts, whole)


def cut_at_divides(divides: Divides) -> DividedMesh:
    """Return triangles that share their vertices, each of one label."""
    falls, _, cuts, whole = divides
    is_cut = np.zeros(len(falls.triangles), np.bool_)
    is_cut[cuts.triangles] = is_cut[cuts.touched] = True
    made, regions = _cut_triangles(divides, np.flatnonzero(is_cut))
    points = np.concatenate([falls.points[:, :2], cuts.places])
    triangles = np.concatenate([falls.triangles[~is_cut], made])
    patch_regions = np.append(whole[~is_cut], regions).astype(np.int64)
    return DividedMesh.of(points, triangles, patch_regions)


def _place_cuts(
    network: Network,
    rows: Int64Array,
    triangles: Int64Array,
    labels: Int32Array,
) -> _Cuts:
    """Place the ends of cuts, once for both triangles of an edge."""
    falls, shares = network.walker.falls, network.strips.starts[rows]
    bases, count = network.surface.bases_of(triangles), len(falls.points)
    sides, at_side = follow(bases, bases.edges, shares)
    is_apex = np.abs(shares - bases.splits) <= SAME
    owners, edges = np.tile(triangles, 2), np.append(bases.edges, sides)
    start, end = falls.ends(owners, edges)
    share = np.append(shares, at_side)
    nodes = np.where(share <= _NEAR, start, np.where(share >= 1.0 - _NEAR, end, -1))
    nodes[len(rows) :][is_apex] = falls.triangles[triangles, bases.edges][is_apex]
    # A cut from a corner along an edge of it is none: both ends are the corner.
    corner = np.roll(nodes, len(rows))
    at_corner = (nodes < 0) & ((corner == start) | (corner == end))
    nodes[at_corner] = corner[at_corner]
    share = np.where(start < end, share, 1.0 - share)
    low, high = np.minimum(start, end), np.maximum(start, end)
    free = np.flatnonzero(nodes < 0)
    free = free[sort_by((low * count + high)[free], share[free])]
    keys = (low * count + high)[free]
    is_new = np.append(True, (np.diff(keys) != 0) | (np.diff(share[free]) > _NEAR))[: len(free)]
    nodes[free] = count - 1 + np.cumsum(is_new)
    first = free[is_new]
    places = interpolate_edges(
        falls.points[low[first], :2], falls.points[high[first], :2], share[first, None]
    )
    touched = falls.neighbors[owners[first], edges[first]]
    return _Cuts(
        triangles,
        nodes[: len(rows)],
        nodes[len(rows) :],
        labels[rows - 1],
        labels[rows],
        places,
        keys[is_new],
        touched[touched != topology.NO_NEIGHBOR],
    )


def _cut_triangles(divides: Divides, triangles: Int64Array) -> tuple[Int32Array, Int32Array]:
    """Cut triangles into cells, and these into triangles; return them, and their labels."""
    falls, surface, cuts, whole = divides
    count = len(falls.points)
    turns = np.array([1, 2, 0]) + surface.bases_of(triangles).edges[:, None]
    corners = falls.triangles[triangles[:, None], turns % 3]  # start, end, apex
    keys = topology.edge_keys(corners[:, [[1, 2], [2, 0], [0, 1]]], count)[:, [2, 1, 0]]
    begin = cuts.edges.searchsorted(keys)
    end, has_places = begin.copy(), np.append(cuts.edges, NOWHERE)[begin] == keys
    end[has_places] = cuts.edges.searchsorted(keys[has_places], "right")
    ranges = np.stack([begin, end], axis=2)
    offsets = np.append(cuts.triangles.searchsorted(triangles), len(cuts.triangles))
    numbers, cells, vertices = _kernel.cut_cells(
        corners,
        ranges.reshape(-1, 6),
        count,
        offsets,
        cuts.lower.astype(np.int32),
        cuts.upper.astype(np.int32),
    )
    made, cell = fan_out(cells, vertices)
    labels = np.insert(cuts.beyond, offsets[:-1], _label_first(cuts, offsets, whole[triangles]))
    return np.ascontiguousarray(made, np.int32), labels[numbers][cell]


def _label_first(cuts: _Cuts, offsets: Int64Array, whole: Int32Array) -> Int32Array:
    """Return the label before the first cut of triangles."""
    labels = whole.copy()
    has_cuts = np.flatnonzero(np.diff(offsets))
    labels[has_cuts] = cuts.before[offsets[has_cuts]]
    return labels
