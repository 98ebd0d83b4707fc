"""Edges of a mesh as lines: chains of edges, the lines of a TIN from chains of a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.sentences import counted
from ...tin import TIN
from ...tin.constraints import Lines
from ...tin.topology import NO_NEIGHBOR, edge_keys, ends
from .common import add_notes, flag_edges

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ...base.arrays import BoolArray, Int64Array
    from ...base.policies import LineKind


class Chain(NamedTuple):
    """A line along edges."""

    vertices: Int64Array
    """(k,)."""
    kind: LineKind | None = None
    """None for one that is of the boundary if all its edges are, else a hard breakline."""
    name: str = ""


def add_lines(tin: TIN, chains: Sequence[Chain], what: str) -> TIN:
    """Return a TIN with lines along its edges, which become constrained.

    Chains are cut at segments that are no edges of the TIN: a note tells how many, and ``what``
    they are called.
    """
    pieces = [piece for chain in chains for piece in _cut_at_gaps(tin, chain)]
    lost = sum(len(one.vertices) - 1 for one in chains)
    lost -= sum(len(one.vertices) - 1 for one in pieces)
    if lost:
        note = f"{counted(lost, what)} of the file lie along no edge and are left out."
        tin = add_notes(tin, [note])
    if not pieces:
        return tin
    vertices = np.concatenate([one.vertices for one in pieces]).astype(np.int32)
    lengths = [len(one.vertices) for one in pieces]
    lines = Lines(
        vertices=vertices,
        offsets=np.concatenate([[0], np.cumsum(lengths)]).astype(np.int32),
        kinds=tuple(_choose_kind(tin, one) for one in pieces),
        sources=np.arange(len(pieces), dtype=np.int32),
        names=tuple(one.name for one in pieces),
    )
    flags = tin.constrained | flag_edges(tin.triangles, lines.segments(), len(tin.points))
    return tin.replace(lines=lines, constrained=flags)


def _cut_at_gaps(tin: TIN, chain: Chain) -> list[Chain]:
    nodes = chain.vertices
    if len(nodes) < 2:
        return []
    gaps = np.flatnonzero(~tin.is_edge(nodes[:-1], nodes[1:])) + 1
    return [chain._replace(vertices=part) for part in np.split(nodes, gaps) if len(part) > 1]


def _choose_kind(tin: TIN, chain: Chain) -> LineKind:
    if chain.kind is not None:
        return chain.kind
    sides = tin.edge_triangles(chain.vertices[:-1], chain.vertices[1:])
    return "boundary" if (sides == NO_NEIGHBOR).any(axis=1).all() else "hard"


def list_chains(tin: TIN) -> list[Int64Array]:
    """Return the lines of a TIN as chains of vertices, then its other constrained edges chained."""
    chains = [np.asarray(chain, np.int64) for chain in tin.lines.chains()]
    triangle, corner = np.nonzero(tin.constrained)
    edges = np.stack(ends(tin.triangles, triangle, corner), axis=1)
    count = len(tin.points)
    known = edge_keys(tin.lines.segments().reshape(-1, 2), count)
    left = edges[~np.isin(edge_keys(edges, count), known)]
    return [*chains, *chain_edges(left, count)]


def chain_edges(edges: NDArray[np.integer], n_vertices: int) -> list[Int64Array]:
    """Join edges to chains that end where an end, a fork or a crossing is; a ring is closed.

    Parameters
    ----------
    edges : (k, 2) int array
        Pairs of vertices in any order and direction; one that comes twice counts once.
    n_vertices : int

    Returns
    -------
    list of (l,) int64 arrays

    Examples
    --------
    >>> [chain.tolist() for chain in chain_edges(np.array([[1, 2], [0, 1], [5, 4]]), 6)]
    [[0, 1, 2], [4, 5]]
    """
    _, first = np.unique(edge_keys(np.asarray(edges, np.int64), n_vertices), return_index=True)
    pairs = np.sort(np.asarray(edges, np.int64)[first], axis=1)
    at: dict[int, list[int]] = {}
    for number, pair in enumerate(pairs.tolist()):
        for vertex in pair:
            at.setdefault(vertex, []).append(number)
    used = np.zeros(len(pairs), np.bool_)
    knots = sorted(vertex for vertex, around in at.items() if len(around) != 2)
    chains = [_walk(pairs, at, used, start) for start in [knot for knot in knots for _ in at[knot]]]
    chains += [_walk(pairs, at, used, start) for start in sorted(at)]  # rings are left
    return [np.array(chain, np.int64) for chain in chains if len(chain) > 1]


def _walk(pairs: Int64Array, at: dict[int, list[int]], used: BoolArray, start: int) -> list[int]:
    """Follow unused edges from a vertex to the next knot, or round a ring."""
    chain = [start]
    while len(chain) == 1 or len(at[chain[-1]]) == 2:
        here = chain[-1]
        step = next((one for one in at[here] if not used[one]), None)
        if step is None:
            break
        used[step] = True
        a, b = pairs[step].tolist()
        chain.append(b if a == here else a)
    return chain
