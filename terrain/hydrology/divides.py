"""Divides: triangles cut where the water on both sides of a fall line goes different ways."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin import topology
from ..earthwork.cells import fan_out
from .descent import interpolate_edges
from .strips import SAME, follow
from .water import Patches

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from .networks import Network

__all__ = ["cut_at_divides"]

_NEAR = 1e-10
"""Places on an edge whose shares of it differ by less are one."""


class _Cuts(NamedTuple):
    """Fall lines across triangles, by triangle and share of the base.

    Attributes
    ----------
    triangles : (k,) int64 array
    lower, upper : (k,) int64 arrays
        Their ends, at the base and on the other two edges: vertices, or places from n on.
    before, beyond : (k,) int64 arrays
        The labels on both sides.
    places : (p, 2) float64 array
    edges : dict
        The places on each edge, from its smaller vertex on; named by both.
    """

    triangles: NDArray[np.int64]
    lower: NDArray[np.int64]
    upper: NDArray[np.int64]
    before: NDArray[np.int64]
    beyond: NDArray[np.int64]
    places: NDArray[np.float64]
    edges: dict[int, list[int]]


def cut_at_divides(
    network: Network, labels: NDArray[np.int64], level: NDArray[np.int64]
) -> Patches:
    """Return triangles that share their vertices, each of one label.

    Parameters
    ----------
    network : Network
    labels : (s,) int64 array
        Of the strips.
    level : (m,) int64 array
        Of the triangles, for those that are level.
    """
    falls, strips = network.walker.falls, network.strips
    whole = level.copy()
    whole[strips.triangles] = labels
    inner = strips.triangles[1:] == strips.triangles[:-1]
    rows = np.flatnonzero(inner & (labels[1:] != labels[:-1])) + 1
    cuts = _place_cuts(network, rows, labels)
    keys = _name_edges(falls.triangles, len(falls.points))
    is_cut = np.any(np.isin(keys, np.array(list(cuts.edges), np.int64)), axis=1)
    is_cut |= np.bincount(cuts.triangles, minlength=len(keys)) > 0
    cells, owners = _list_cells(network, cuts, np.flatnonzero(is_cut), whole)
    offsets = topology.find_offsets(np.array([len(one) for one in cells], np.int64))
    slots = np.array([vertex for one in cells for vertex in one], np.int32)
    made, cell = fan_out(offsets, slots)
    triangles = np.ascontiguousarray(np.concatenate([falls.triangles[~is_cut], made]), np.int32)
    points = np.concatenate([falls.points[:, :2], cuts.places])
    regions = np.append(whole[~is_cut], np.array(owners, np.int64)[cell])
    return Patches(points, triangles, topology.neighbors_of(triangles, len(points)), regions)


def _name_edges(triangles: NDArray[np.int32], count: int) -> NDArray[np.int64]:
    """Return a number for each edge, the same in both of its triangles."""
    start, end = (np.roll(triangles, -turn, axis=1).astype(np.int64) for turn in (1, 2))
    return np.minimum(start, end) * count + np.maximum(start, end)


def _place_cuts(network: Network, rows: NDArray[np.int64], labels: NDArray[np.int64]) -> _Cuts:
    """Place the ends of cuts, once for both triangles of an edge."""
    falls, bases = network.walker.falls, network.bases
    triangles, shares = network.strips.triangles[rows], network.strips.starts[rows]
    base, count = bases.edges[triangles], len(falls.points)
    sides, at_side = follow(bases, triangles, base, shares)
    is_apex = np.abs(shares - bases.splits[triangles]) <= SAME
    start, end = falls.ends(np.tile(triangles, 2), np.append(base, sides))
    share = np.append(shares, at_side)
    nodes = np.where(share <= _NEAR, start, np.where(share >= 1.0 - _NEAR, end, -1))
    nodes[len(rows) :][is_apex] = falls.triangles[triangles, base][is_apex]
    # A cut from a corner along an edge of it is none: both ends are the corner.
    corner = np.roll(nodes, len(rows))
    at_corner = (nodes < 0) & ((corner == start) | (corner == end))
    nodes[at_corner] = corner[at_corner]
    share = np.where(start < end, share, 1.0 - share)
    low, high = np.minimum(start, end), np.maximum(start, end)
    free = np.flatnonzero(nodes < 0)
    free = free[np.lexsort((share[free], (low * count + high)[free]))]
    keys = (low * count + high)[free]
    is_new = np.append(True, (np.diff(keys) != 0) | (np.diff(share[free]) > _NEAR))[: len(free)]
    nodes[free] = count - 1 + np.cumsum(is_new)
    first = free[is_new]
    places = interpolate_edges(
        falls.points[low[first], :2], falls.points[high[first], :2], share[first, None]
    )
    edges: dict[int, list[int]] = {}
    for key, node in zip(keys[is_new].tolist(), nodes[first].tolist(), strict=True):
        edges.setdefault(key, []).append(node)
    lower, upper = nodes[: len(rows)], nodes[len(rows) :]
    return _Cuts(triangles, lower, upper, labels[rows - 1], labels[rows], places, edges)


def _list_cells(
    network: Network, cuts: _Cuts, triangles: NDArray[np.int64], whole: NDArray[np.int64]
) -> tuple[list[list[int]], list[int]]:
    """Return the cells of triangles, and the label of each."""
    cells: list[list[int]] = []
    owners: list[int] = []
    begins, ends = (cuts.triangles.searchsorted(triangles, side) for side in ("left", "right"))
    for triangle, i, j in zip(triangles.tolist(), begins.tolist(), ends.tolist(), strict=True):
        below, above = _walk_around(network, cuts, triangle)
        labels = [int(whole[triangle])]
        if i < j:
            labels = [int(cuts.before[i]), *cuts.beyond[i:j].tolist()]
        pairs = zip(cuts.lower[i:j].tolist(), cuts.upper[i:j].tolist(), strict=True)
        for label, cell in zip(labels, _cut_ring(below, above, list(pairs)), strict=True):
            if len(cell) > 2:
                cells.append(cell)
                owners.append(label)
    return cells, owners


def _walk_around(network: Network, cuts: _Cuts, triangle: int) -> tuple[list[int], list[int]]:
    """Return the vertices of the base, and those of the other edges, both from its start on."""
    falls = network.walker.falls
    base, count = int(network.bases.edges[triangle]), len(falls.points)
    a, b, apex = (int(falls.triangles[triangle, (base + turn) % 3]) for turn in (1, 2, 0))
    below, first, second = (
        _walk_edge(cuts, count, *edge) for edge in ((a, b), (a, apex), (apex, b))
    )
    return [*below, b], [*first, *second, b]


def _walk_edge(cuts: _Cuts, count: int, start: int, end: int) -> list[int]:
    places = cuts.edges.get(min(start, end) * count + max(start, end), [])
    return [start, *(places if start < end else places[::-1])]


def _cut_ring(
    below: list[int], above: list[int], cuts: list[tuple[int, int]]
) -> Iterator[list[int]]:
    """Cut a ring of two chains, from the same vertex to the same, into cells."""
    i = j = 0
    for lower, upper in [*cuts, (below[-1], above[-1])]:
        to_i, to_j = max(i, below.index(lower)), max(j, above.index(upper))
        yield list(dict.fromkeys(below[i : to_i + 1] + above[j : to_j + 1][::-1]))
        i, j = to_i, to_j
