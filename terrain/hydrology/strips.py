"""Strips: triangles cut along the fall lines that pass through vertices.

All water of a strip leaves it across one edge, and enters one strip of the next triangle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import PointsError
from ...tin.topology import NO_NEIGHBOR, find_offsets
from .descent import MOVING, Drops, make_drops

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .descent import Walker
    from .falls import Falls

__all__ = [
    "SAME",
    "Bases",
    "Strips",
    "cut_strips",
    "enter_strips",
    "find_bases",
    "follow",
    "leave_strips",
    "settle",
]

SAME = 1e-12
"""Fall lines whose shares of the base differ by no more are one."""
_MOST_CUTS = 30_000_000


class Bases(NamedTuple):
    r"""The edge of each triangle that all its fall lines meet, so that shares of it name them.

    It is the only edge that water leaves across, or else the only one that it enters across::

                  apex
                 /  | \          share 0 at the start of the base, 1 at its end; the fall line
                /   |  \         through the apex meets it at ``splits``
          start ----|--- end

    Attributes
    ----------
    edges : (m,) int64 array
    splits : (m,) float64 array
    drains : (m,) bool array
        Whether water leaves across the base.
    """

    edges: NDArray[np.int64]
    splits: NDArray[np.float64]
    drains: NDArray[np.bool_]


class Strips(NamedTuple):
    """Parts of triangles between neighbouring cuts, by triangle and share of the base.

    Attributes
    ----------
    triangles : (s,) int64 array
    starts, ends : (s,) float64 arrays
        Shares of the base.
    parts : (s,) float64 array
        Of the area of the triangle.
    """

    triangles: NDArray[np.int64]
    starts: NDArray[np.float64]
    ends: NDArray[np.float64]
    parts: NDArray[np.float64]


def find_bases(falls: Falls) -> Bases:
    """Return the base of each triangle; that of a level one means nothing."""
    drains = (falls.signs > 0).sum(axis=1) < 2
    edges = np.where(drains, falls.signs.argmax(axis=1), falls.signs.argmin(axis=1))
    return Bases(edges, falls.shares(np.arange(len(edges)), edges), drains)


def follow(
    bases: Bases,
    triangles: NDArray[np.int64],
    edges: NDArray[np.int64],
    shares: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return where the fall line through a place on an edge meets the base, or from it the side."""
    base, split = bases.edges[triangles], bases.splits[triangles]
    on_base, before = edges == base, shares < split
    with np.errstate(divide="ignore", invalid="ignore"):
        from_base = np.where(before, 1.0 - shares / split, (1.0 - shares) / (1.0 - split))
    first = edges == (base + 2) % 3
    to_base = np.where(first, split * (1.0 - shares), 1.0 - shares * (1.0 - split))
    side = np.where(before, (base + 2) % 3, (base + 1) % 3)
    found = np.clip(np.where(on_base, np.nan_to_num(from_base), to_base), 0.0, 1.0)
    return np.where(on_base, side, base), found


def cut_strips(falls: Falls, bases: Bases) -> Strips:
    """Cut triangles along the fall lines that come down to vertices.

    Raises
    ------
    PointsError
        If there are too many cuts.

    Notes
    -----
    A triangle whose water leaves across two edges is parted by the fall line through the vertex
    between them. That line is followed upwards, triangle by triangle, to where nothing comes from
    above, or a vertex, which has such lines of its own.
    """
    triangles = np.flatnonzero(~bases.drains & ~falls.is_level)
    edges, shares = bases.edges[triangles], bases.splits[triangles]
    found, count = [(triangles, shares)], len(triangles)
    while len(triangles):
        above, edge = falls.cross(triangles, edges)
        runs = (above != NO_NEIGHBOR) & (falls.signs[above, edge] > 0)
        triangles, edges, shares = above[runs], edge[runs], 1.0 - shares[runs]
        is_base = edges == bases.edges[triangles]
        to_edges, to_shares = follow(bases, triangles, edges, shares)
        at_base = np.where(is_base, shares, to_shares)
        inner = (np.abs(at_base - bases.splits[triangles]) > SAME) & _is_inside(at_base)
        found.append((triangles, at_base))
        count += len(triangles)
        _require_few(count)
        triangles, edges, shares = triangles[inner], to_edges[inner], to_shares[inner]
    return _part(falls, bases, *(np.concatenate(arrays) for arrays in zip(*found, strict=True)))


def _is_inside(shares: NDArray[np.float64]) -> NDArray[np.bool_]:
    inside: NDArray[np.bool_] = (shares > SAME) & (shares < 1.0 - SAME)
    return inside


def _require_few(count: int) -> None:
    if count > _MOST_CUTS:
        raise PointsError(
            f"The fall lines of this surface cross more than {_MOST_CUTS:,} triangles: "
            "simplify it first, or clip it."
        )


def _part(
    falls: Falls, bases: Bases, triangles: NDArray[np.int64], shares: NDArray[np.float64]
) -> Strips:
    """Return the strips between cuts, from the start of each base to its end."""
    inside = _is_inside(shares)
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
    parts = _measure_parts(ends, splits) - _measure_parts(starts, splits)
    return Strips(owners, starts, ends, parts)


def _measure_parts(shares: NDArray[np.float64], splits: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return which part of a triangle lies before a share of its base."""
    with np.errstate(divide="ignore", invalid="ignore"):
        before, beyond = shares * shares / splits, 1.0 - (1.0 - shares) ** 2 / (1.0 - splits)
    parts: NDArray[np.float64] = np.where(shares < splits, before, beyond)
    return np.where(shares >= 1.0, 1.0, np.where(shares <= 0.0, 0.0, np.nan_to_num(parts)))


def leave_strips(walker: Walker, bases: Bases, strips: Strips) -> Drops:
    """Return drops where the water from the middle of each strip leaves its triangle."""
    triangles, middles = strips.triangles, (strips.starts + strips.ends) / 2
    edges, shares = bases.edges[triangles].copy(), middles.copy()
    both = np.flatnonzero(~bases.drains[triangles])
    edges[both], shares[both] = follow(bases, triangles[both], edges[both], middles[both])
    return walker.arrive(triangles, edges, shares)


def enter_strips(bases: Bases, strips: Strips, drops: Drops) -> NDArray[np.int64]:
    """Return the strips that drops enter, which come to an edge of a triangle."""
    triangles, shares = drops.triangles, drops.shares.copy()
    sides = np.flatnonzero(drops.edges != bases.edges[triangles])
    _, shares[sides] = follow(bases, triangles[sides], drops.edges[sides], shares[sides])
    return _find_strips(bases, strips, triangles, shares)


def _find_strips(
    bases: Bases, strips: Strips, triangles: NDArray[np.int64], shares: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Return the last strip of each triangle that begins at a share or before: by bisection."""
    offsets = find_offsets(np.bincount(strips.triangles, minlength=len(bases.edges)))
    found, beyond = offsets[triangles], offsets[triangles + 1]
    rows = np.flatnonzero(beyond - found > 1)
    while len(rows):
        middle = (found[rows] + beyond[rows]) // 2
        begins = strips.starts[middle] <= shares[rows]
        found[rows[begins]] = middle[begins]
        beyond[rows[~begins]] = middle[~begins]
        rows = rows[beyond[rows] - found[rows] > 1]
    return found


def settle(walker: Walker, drops: Drops) -> tuple[Drops, NDArray[np.int64]]:
    """Follow drops until each has come to a vertex or to an edge that is a channel, or has ended.

    Returns
    -------
    Drops, and (k,) int64 array
        The upper end of the edge along which each has left a vertex, -1 for others.
    """
    found = make_drops(len(drops.vertices))
    upper = np.full(len(drops.vertices), -1)
    rows = np.arange(len(drops.vertices))
    while len(rows):
        moved = walker.step(drops)
        left = (drops.vertices >= 0) & (moved.vertices >= 0) & (moved.ends == MOVING)
        upper[rows[left]] = drops.vertices[left]
        on = (moved.vertices < 0) & (moved.targets < 0) & (moved.ends == MOVING)
        found.put(rows[~on], moved.choose(np.flatnonzero(~on)))
        rows, drops = rows[on], moved.choose(np.flatnonzero(on))
    return found, upper
