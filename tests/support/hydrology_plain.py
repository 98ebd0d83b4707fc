"""The network of a surface in numpy, as the compiled core makes it; decided by fractions alone.

All strips and all vertices at a time: the cuts from triangle to triangle, sorted; drops from the
middles of strips and from vertices.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tinsmith.terrain.hydrology.descent import BOUNDARY, MOVING, Drops, Walker, make_drops
from tinsmith.terrain.hydrology.falls import Falls
from tinsmith.terrain.hydrology.strips import SAME, follow, settle
from tinsmith.terrain.hydrology.vertices import NOWHERE
from tinsmith.tin.topology import NO_NEIGHBOR, find_offsets


class Bases(NamedTuple):
    """As the core names them."""

    edges: np.ndarray
    splits: np.ndarray
    drains: np.ndarray


class Strips(NamedTuple):
    """Parts of triangles between neighbouring cuts: shares of the base, parts of the area."""

    triangles: np.ndarray
    starts: np.ndarray
    ends: np.ndarray
    parts: np.ndarray


def find_bases(falls: Falls) -> Bases:
    drains = (falls.signs > 0).sum(axis=1) < 2
    edges = np.where(drains, falls.signs.argmax(axis=1), falls.signs.argmin(axis=1))
    return Bases(edges, falls.shares(np.arange(len(edges)), edges), drains)


def choose(bases: Bases, triangles: np.ndarray) -> Bases:
    return Bases._make(column[triangles] for column in bases)


def cut_strips(falls: Falls, bases: Bases) -> Strips:
    """Follow all fall lines that part triangles upwards, a triangle at a time."""
    triangles = np.flatnonzero(~bases.drains & ~falls.is_level)
    edges, shares = bases.edges[triangles], bases.splits[triangles]
    found = [(triangles, shares)]
    while len(triangles):
        above, edge = falls.cross(triangles, edges)
        runs = (above != NO_NEIGHBOR) & (falls.signs[above, edge] > 0)
        triangles, edges, shares = above[runs], edge[runs], 1.0 - shares[runs]
        own = choose(bases, triangles)
        to_edges, to_shares = follow(own, edges, shares)
        at_base = np.where(edges == own.edges, shares, to_shares)
        inner = (np.abs(at_base - own.splits) > SAME) & is_inside(at_base)
        found.append((triangles, at_base))
        triangles, edges, shares = triangles[inner], to_edges[inner], to_shares[inner]
    return part(falls, bases, *(np.concatenate(arrays) for arrays in zip(*found, strict=True)))


def is_inside(shares: np.ndarray) -> np.ndarray:
    return (shares > SAME) & (shares < 1.0 - SAME)


def part(falls: Falls, bases: Bases, triangles: np.ndarray, shares: np.ndarray) -> Strips:
    """Return the strips between cuts, from the start of each base to its end."""
    inside = is_inside(shares)
    triangles, shares = triangles[inside], shares[inside]
    order = np.lexsort((shares, triangles))
    triangles, shares = triangles[order], shares[order]
    same = (np.diff(triangles) == 0) & (np.diff(shares) <= SAME)
    kept = np.append(True, ~same)[: len(order)]
    triangles, shares = triangles[kept], shares[kept]
    sloping = np.flatnonzero(~falls.is_level)
    counts = np.bincount(triangles, minlength=len(bases.edges))[sloping] + 1
    offsets = find_offsets(counts)
    owners, starts, ends = np.repeat(sloping, counts), np.zeros(offsets[-1]), np.ones(offsets[-1])
    is_first = np.zeros(len(owners), np.bool_)
    is_first[offsets[:-1]] = True
    starts[~is_first] = shares
    ends[np.flatnonzero(~is_first) - 1] = shares
    splits = bases.splits[owners]
    parts = measure_parts(ends, splits) - measure_parts(starts, splits)
    return Strips(owners, starts, ends, parts)


def measure_parts(shares: np.ndarray, splits: np.ndarray) -> np.ndarray:
    """Return which part of a triangle lies before a share of its base."""
    with np.errstate(divide="ignore", invalid="ignore"):
        before, beyond = shares * shares / splits, 1.0 - (1.0 - shares) ** 2 / (1.0 - splits)
    parts = np.where(shares < splits, before, beyond)
    return np.where(shares >= 1.0, 1.0, np.where(shares <= 0.0, 0.0, np.nan_to_num(parts)))


def leave_strips(walker: Walker, bases: Bases, strips: Strips) -> Drops:
    """Return drops where the water from the middle of each strip leaves its triangle."""
    own, middles = choose(bases, strips.triangles), (strips.starts + strips.ends) / 2
    edges, shares = follow(own, own.edges, middles)
    edges, shares = np.where(own.drains, own.edges, edges), np.where(own.drains, middles, shares)
    return walker.arrive(strips.triangles, edges, shares)


def enter_strips(bases: Bases, strips: Strips, drops: Drops) -> np.ndarray:
    """Return the strips that drops enter, which come to an edge of a triangle."""
    own = choose(bases, drops.triangles)
    _, at_base = follow(own, drops.edges, drops.shares)
    shares = np.where(drops.edges == own.edges, drops.shares, at_base)
    offsets = find_offsets(np.bincount(strips.triangles, minlength=len(bases.edges)))
    pairs = zip(drops.triangles.tolist(), shares.tolist(), strict=True)
    return np.array(
        [
            offsets[t] + strips.starts[offsets[t] : offsets[t + 1]].searchsorted(share, "right") - 1
            for t, share in pairs
        ],
        np.int64,
    )


class Links(NamedTuple):
    """The nodes below strips and vertices, and upper ends of channels, -1 for none."""

    nexts: np.ndarray
    uppers: np.ndarray


def link(walker: Walker, bases: Bases, strips: Strips, grounds: np.ndarray) -> Links:
    """Link strips and vertices: those nodes first, then the ends."""
    first, count = len(strips.triangles), len(grounds)
    found = Links(np.arange(first + 2 * count + 1), np.full(first + count, NOWHERE))
    start = make_drops(count)
    start.vertices[:] = np.arange(count)
    drops, uppers = settle(walker, start)
    _link(walker, found, (first, grounds), first + np.arange(count), drops)
    along = np.flatnonzero(uppers != NOWHERE)
    found.uppers[first + along] = uppers[along]
    left = leave_strips(walker, bases, strips)
    _link(walker, found, (first, grounds), np.arange(first), left)
    on = (left.vertices == NOWHERE) & (left.targets == NOWHERE) & (left.ends == MOVING)
    found.nexts[:first][on] = enter_strips(bases, strips, left.choose(np.flatnonzero(on)))
    return found


def _link(
    walker: Walker, found: Links, given: tuple[int, np.ndarray], nodes: np.ndarray, drops: Drops
) -> None:
    first, grounds = given
    start, end = walker.falls.ends(drops.triangles, drops.edges)
    at_vertex = np.where(drops.vertices != NOWHERE, drops.vertices, drops.targets)
    goes = (drops.ends == MOVING) & (at_vertex != NOWHERE)
    found.nexts[nodes[goes]] = first + at_vertex[goes]
    along = goes & (drops.targets != NOWHERE)
    found.uppers[nodes[along]] = np.where(start == drops.targets, end, start)[along]
    ended = drops.ends != MOVING
    ground = grounds[np.where(drops.vertices != NOWHERE, drops.vertices, start)]
    ends = np.where(drops.ends == BOUNDARY, len(found.nexts) - 1, first + len(grounds) + ground)
    found.nexts[nodes[ended]] = ends[ended]


def find_ends(nexts: np.ndarray) -> np.ndarray:
    """Return the node at which the water of each ends, -1 where it runs in a circle."""
    ends = nexts
    for _ in range(len(nexts).bit_length()):
        ends = ends[ends]
    return np.where(nexts[ends] == ends, ends, NOWHERE)


def accumulate(nexts: np.ndarray, totals: np.ndarray) -> np.ndarray:
    """Take away nodes that nothing comes to, then those that this leaves so, and so on."""
    total = totals.copy()
    moving = np.flatnonzero(nexts != np.arange(len(nexts)))
    waits = np.bincount(nexts[moving], minlength=len(total))
    ready = moving[waits[moving] == 0]
    latest = np.empty(len(total), np.int64)
    while len(ready):
        below = nexts[ready]
        np.add.at(total, below, total[ready])
        np.subtract.at(waits, below, 1)
        below = below[(waits[below] == 0) & (nexts[below] != below)]
        latest[below] = np.arange(len(below))
        ready = below[latest[below] == np.arange(len(below))]  # each once
    return total


def sum_channels(
    uppers: np.ndarray, nexts: np.ndarray, totals: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return upper and lower ends of channels, and the sums of what comes to them."""
    nodes = np.flatnonzero(uppers != NOWHERE)
    ends = nexts[nodes].astype(np.int64) - (len(uppers) - count)
    keys, row = np.unique(uppers[nodes].astype(np.int64) * count + ends, return_inverse=True)
    areas = np.bincount(row, totals[nodes], minlength=len(keys))
    return np.column_stack(np.divmod(keys, count)), areas


def cut_cells(
    corners: np.ndarray,
    ranges: np.ndarray,
    first_place: int,
    offsets: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
) -> tuple[list[int], list[list[int]]]:
    """Return the numbers and the vertices of the cells of triangles that have three at least."""
    cells: list[Any] = []
    for row, (a, b, apex) in enumerate(corners.tolist()):
        edges = zip(((a, b), (a, apex), (apex, b)), ranges[row].reshape(3, 2).tolist(), strict=True)
        chains = []
        for (start, end), (begin, stop) in edges:
            places = list(range(first_place + begin, first_place + stop))
            chains.append([start, *(places if start < end else places[::-1])])
        cuts = slice(*offsets[row : row + 2].tolist())
        pairs = list(zip(lower[cuts].tolist(), upper[cuts].tolist(), strict=True))
        cells += cut_ring([*chains[0], b], [*chains[1], *chains[2], b], pairs)
    numbers = [number for number, cell in enumerate(cells) if len(cell) > 2]
    return numbers, [cells[number] for number in numbers]


def cut_ring(below: list[int], above: list[int], cuts: list[tuple[int, int]]) -> list[list[int]]:
    """Cut a ring of two chains, from the same vertex to the same, into cells."""
    cells = []
    i = j = 0
    for lower, upper in [*cuts, (below[-1], above[-1])]:
        to_i, to_j = max(i, below.index(lower)), max(j, above.index(upper))
        cells.append(list(dict.fromkeys(below[i : to_i + 1] + above[j : to_j + 1][::-1])))
        i, j = to_i, to_j
    return cells
