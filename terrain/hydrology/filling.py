"""Filling: the surface with its depressions full of water, and the way on across level ground."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...tin.topology import find_boundary_vertices, find_offsets, gather
from .hierarchy import build_hierarchy, rank_vertices
from .vertices import NOWHERE

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...tin import TIN
    from .hierarchy import Hierarchy


class Filling(NamedTuple):
    """A surface whose depressions are full, so that all water leaves it over the boundary."""

    hierarchy: Hierarchy
    """Its outermost depressions spill at the vertex where water leaves them here."""
    levels: Float64Array
    """(n,), of the water at each vertex, of the ground where there is none."""
    ponds: Int64Array
    """(n,), the outermost depression under whose water each vertex is, ``NOWHERE`` for none."""
    nexts: Int64Array
    """(n,), the next vertex on the way across water or level ground, ``NOWHERE`` where water
    descends or leaves the surface.
    """
    steps: Int64Array
    """(n,), how many edges that way has, under water to where the pond spills."""
    ranks: Int64Array
    """(n,), place of each vertex by elevation, easting, northing."""

    def choose_way(self, *vertices: Int64Array) -> Int64Array:
        """Return of vertices of one level that with the shortest way; under water if any is."""
        found = vertices[0]
        for other in vertices[1:]:
            keys = [
                (self.ponds[one] == NOWHERE, self.steps[one], self.ranks[one])
                for one in (found, other)
            ]
            found = np.where(_is_less(keys[1], keys[0]), other, found)
        return found


def _is_less(one: tuple[Any, ...], other: tuple[Any, ...]) -> BoolArray:
    """Compare keys, column after column."""
    found = np.zeros(len(one[0]), np.bool_)
    for left, right in zip(one[::-1], other[::-1], strict=True):
        found = (left < right) | ((left == right) & found)
    return found


def fill(tin: TIN) -> Filling:
    """Fill the depressions of a surface from which water runs off freely at the boundary.

    Notes
    -----
    1. Levels are those of a priority flood [1]_: of the outermost depressions of the hierarchy.
    2. At one level water goes on by the fewest edges to a vertex from which it descends or leaves
       the surface (breadth first); of as many, by the vertex that is first by easting and northing.
       A pond counts as one step, and spills at one vertex.
    3. In a pond it goes by the fewest edges to that vertex.

    So the level falls along every way, or else the number of edges that are left. Each connected
    part of a surface has a boundary, so there is a way from everywhere.

    References
    ----------
    .. [1] R. Barnes, C. Lehman, D. Mulla, Priority-flood, Computers & Geosciences 62 (2014),
       doi:10.1016/j.cageo.2013.04.024.
    """
    ranks = rank_vertices(tin.points)
    hierarchy = build_hierarchy(tin, ranks)
    z, count = tin.points[:, 2], len(tin.points)
    roots = np.append(hierarchy.find_roots(), NOWHERE)[hierarchy.basins]
    levels = z.copy()
    inside = np.flatnonzero(roots != NOWHERE)
    levels[inside] = np.maximum(z[inside], z[hierarchy.spill_vertices[roots[inside]]])
    ponds = np.where(levels > z, roots, NOWHERE)
    filling = Filling(
        hierarchy,
        levels,
        ponds,
        np.full(count, NOWHERE),
        np.zeros(count, np.int64),
        ranks,
    )
    edges = tin.edges.astype(np.int64)
    edges = edges[filling.levels[edges[:, 0]] == filling.levels[edges[:, 1]]]
    ways = _Ways(np.append(edges[:, 0], edges[:, 1]), np.append(edges[:, 1], edges[:, 0]))
    exits = _cross_level_ground(tin, filling, ways)
    _cross_ponds(filling, ways, exits)
    spills = np.where(exits == NOWHERE, hierarchy.spill_vertices, exits)
    return filling._replace(hierarchy=hierarchy._replace(spill_vertices=spills))


class _Ways(NamedTuple):
    """Edges between vertices of one level, in both directions."""

    starts: Int64Array
    ends: Int64Array

    def choose(self, rows: BoolArray) -> _Ways:
        """Return some of them."""
        return _Ways(self.starts[rows], self.ends[rows])


def _cross_level_ground(tin: TIN, filling: Filling, ways: _Ways) -> Int64Array:
    """Find the way on from dry vertices; return where each depression spills, if it is outermost.

    Nodes are vertices, and behind them ponds.
    """
    count = len(filling.levels)
    is_dry = filling.ponds == NOWHERE
    descends = find_boundary_vertices(tin.triangles, tin.neighbors, count)
    for near, far in (tin.edges.T, tin.edges.T[::-1]):
        descends[near[filling.levels[far] < filling.levels[near]]] = True
    ways = ways.choose(is_dry[ways.starts] | is_dry[ways.ends])
    nodes = np.where(is_dry, np.arange(count), count + filling.ponds)
    n_nodes = count + len(filling.hierarchy.pits)
    chosen, steps = _spread(
        np.flatnonzero(descends & is_dry),
        _Ways(nodes[ways.starts], nodes[ways.ends]),
        filling.ranks[ways.ends],
        n_nodes,
    )
    found = np.where(chosen == NOWHERE, NOWHERE, np.append(ways.ends, NOWHERE)[chosen])
    filling.nexts[is_dry], filling.steps[is_dry] = found[:count][is_dry], steps[:count][is_dry]
    return found[count:]


def _cross_ponds(filling: Filling, ways: _Ways, exits: Int64Array) -> None:
    """Find the way from vertices under water to where their pond spills."""
    is_wet = filling.ponds != NOWHERE
    spills = np.append(exits, NOWHERE)[filling.ponds]
    arrives = is_wet[ways.ends] | (spills[ways.starts] == ways.ends)
    ways = ways.choose(is_wet[ways.starts] & arrives)
    sources = np.unique(exits[exits != NOWHERE])
    chosen, steps = _spread(sources, ways, filling.ranks[ways.ends], len(spills))
    filling.nexts[is_wet], filling.steps[is_wet] = ways.ends[chosen[is_wet]], steps[is_wet]


def _spread(
    sources: Int64Array, ways: _Ways, ranks: Int64Array, count: int
) -> tuple[Int64Array, Int64Array]:
    """Search breadth first from sources, against the direction of ways.

    Returns, (count,) each, the way to take from each node, of several the one of least rank,
    ``NOWHERE`` for none; and how many there are to a source.
    """
    order = np.argsort(ways.ends, kind="stable")
    starts, ranks = ways.starts[order], ranks[order]
    offsets = find_offsets(np.bincount(ways.ends, minlength=count))
    chosen, steps = np.full(count, NOWHERE), np.zeros(count, np.int64)
    is_new = np.ones(count, np.bool_)
    is_new[sources] = False
    depth = 0
    while len(sources):
        depth += 1
        slots, _ = gather(offsets, sources)
        slots = slots[is_new[starts[slots]]]
        slots = slots[np.lexsort((ranks[slots], starts[slots]))]
        slots = slots[np.append(True, np.diff(starts[slots]) != 0)[: len(slots)]]
        sources = starts[slots]
        chosen[sources], steps[sources] = order[slots], depth
        is_new[sources] = False
    return chosen, steps
