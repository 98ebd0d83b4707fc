"""The vertex nearest to a place: the Voronoi cell that holds it, found without building cells.

Inside the hull it is the nearest of the place's natural neighbours, at which the compiled core
looks. Outside it is reached from any vertex by going on to a nearer Delaunay neighbour as long as
there is one: only the owner of the cell that holds the place has none [1]_.

.. [1] P. Bose and P. Morin, "Online routing in triangulations", SIAM Journal on Computing 33
   (2004), 937-951. https://doi.org/10.1137/S0097539700369387
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel, topology
from ..validation import thread_count

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int8Array, Int32Array, Int64Array

_ROUNDING = 1.0 + 64 * np.finfo(np.float64).eps
"""Two squared distances whose ratio is further from 1 than this are told apart by doubles: each is
rounded by less than 8 eps, coordinates of the exact range never underflow."""

_MOST_PAIRS = 4_000_000
"""Pairs of a place and a neighbour that are looked at in one go, about: a bound on memory."""


class NearestVertex:
    """An index of (n, 3) points; it is never changed.

    Of several at one place the first is found. At least three places, not collinear.
    """

    def __init__(self, points: Float64Array) -> None:
        growth = _kernel.grow(points, threads=thread_count(None, len(points)))
        kept = np.arange(len(points), dtype=np.int32)
        if growth.kept_row is not None:
            kept = np.flatnonzero(growth.kept_row == kept).astype(np.int32)
        distinct = np.ascontiguousarray(points[kept])
        self._number = kept
        self._xy = np.ascontiguousarray(distinct[:, :2])
        self._locator = _kernel.Locator(distinct, growth.triangles, growth.neighbors)
        edges = topology.edges(growth.triangles, growth.neighbors).astype(np.int64)
        start, end = np.concatenate([edges, edges[:, ::-1]]).T
        self._neighbors = end[np.argsort(start)]
        self._offsets = topology.find_offsets(np.bincount(start, minlength=len(kept)))
        self._hull = np.unique(
            topology.edges_at(growth.triangles, growth.neighbors == topology.NO_NEIGHBOR)
        )

    def find(self, xy: Float64Array, *, threads: int = 1, from_west: bool = False) -> Int32Array:
        """Return the nearest vertex of each place; -1 for NaN.

        Of several the smallest number, or ``from_west`` the lexicographically first place.
        """
        found = np.full(len(xy), -1, np.int32)
        nearest = _kernel.nearest_vertices(self._locator, xy, from_west, threads)
        inside = np.flatnonzero(~np.isnan(nearest))
        found[inside] = self._number[nearest[inside].astype(np.int64)]
        outside = np.flatnonzero(np.isnan(nearest) & ~np.isnan(xy).any(axis=1))
        if len(outside):
            places = np.ascontiguousarray(xy[outside])
            found[outside] = self._number[self._find_outside(places, from_west)]
        return found

    def _find_outside(self, xy: Float64Array, from_west: bool) -> Int64Array:
        """Return the nearest vertex of places outside the hull."""
        # a vertex of the hull near each place outside: by one of the two coordinates
        hull = self._xy[self._hull]
        candidates = []
        for axis in (0, 1):
            order = np.argsort(hull[:, axis], kind="stable")
            at = np.searchsorted(hull[order, axis], xy[:, axis])
            candidates += [
                self._hull[order[np.clip(at + k, 0, len(hull) - 1)]] for k in (-2, -1, 0, 1)
            ]
        tried = np.stack(candidates, axis=1)
        best = np.argmin(self._measure_squares(xy[:, None], tried), axis=1)
        nearest = self._descend(xy, np.asarray(tried[np.arange(len(xy)), best], np.int64))
        return self._choose_first_of_tied(xy, nearest, self._ranks if from_west else None)

    @cached_property
    def _ranks(self) -> Int64Array:
        """The place of each vertex in the order of eastings and northings."""
        ranks = np.empty(len(self._xy), np.int64)
        ranks[np.lexsort(self._xy.T[::-1])] = np.arange(len(self._xy))
        return ranks

    def _descend(self, xy: Float64Array, at: Int64Array) -> Int64Array:
        """Go from vertex to nearer vertex until none of the neighbours is nearer."""
        at = at.copy()
        active = np.arange(len(xy))
        while len(active):
            moved = [self._step(xy, at, part) for part in self._cut_into_portions(at, active)]
            active = np.concatenate(moved)
        return at

    def _step(self, xy: Float64Array, at: Int64Array, rows: Int64Array) -> Int64Array:
        """Move some places' vertices to a nearer neighbour; return those that have moved."""
        item, owner = topology.gather(self._offsets, at[rows])
        neighbor, of = self._neighbors[item], rows[owner]
        away = self._measure_squares(xy[of], neighbor)
        here = self._measure_squares(xy[rows], at[rows])
        first = topology.find_offsets(np.bincount(owner, minlength=len(rows)))[:-1]
        least = np.minimum.reduceat(away, first)
        is_least = np.flatnonzero(away == least[owner])
        best = neighbor[is_least[np.searchsorted(owner[is_least], np.arange(len(rows)))]]
        is_nearer = least * _ROUNDING < here
        # What doubles leave open is decided among all the neighbours that may be nearer.
        is_open = (away <= here[owner] * _ROUNDING) & ~is_nearer[owner]
        nearer = np.flatnonzero(is_open)
        nearer = nearer[self._compare(xy[of[nearer]], neighbor[nearer], at[of[nearer]]) < 0]
        best[owner[nearer]] = neighbor[nearer]
        is_nearer[owner[nearer]] = True
        at[rows[is_nearer]] = best[is_nearer]
        return rows[is_nearer]

    def _choose_first_of_tied(
        self, xy: Float64Array, nearest: Int64Array, ranks: Int64Array | None
    ) -> Int64Array:
        """Return the first of the vertices that are as near; they are joined by edges.

        The first by rank, or else by number.

        Places are taken once each: all the vertices tied at places of the plane are no more than
        the corners of all triangles.
        """
        rows, _ = self._find_tied(xy, nearest, np.arange(len(xy)), nearest)
        if len(rows) == 0:
            return nearest
        rows = np.unique(rows)
        pairs = xy[rows].view(np.complex128).ravel()
        _, first, which = np.unique(pairs, return_index=True, return_inverse=True)
        tied = rows[first]
        smallest = nearest.copy()
        smallest[rows] = self._spread_ties(xy[tied], nearest[tied], ranks)[which]
        return smallest

    def _spread_ties(
        self, xy: Float64Array, begin: Int64Array, ranks: Int64Array | None
    ) -> Int64Array:
        """Return the first vertex that is reached from one through vertices as near."""
        first = begin if ranks is None else ranks[begin]
        smallest = first.copy()
        count = len(self._xy)
        rows, reached = np.arange(len(xy)), begin
        known = rows * count + reached
        while len(rows):
            rows, reached = self._find_tied(xy, begin, rows, reached)
            fresh = np.setdiff1d(rows * count + reached, known)
            known = np.union1d(known, fresh)
            rows, reached = fresh // count, fresh % count
            np.minimum.at(smallest, rows, reached if ranks is None else ranks[reached])
        return smallest if ranks is None else np.argsort(ranks)[smallest]

    def _find_tied(
        self,
        xy: Float64Array,
        nearest: Int64Array,
        rows: Int64Array,
        at: Int64Array,
    ) -> tuple[Int64Array, Int64Array]:
        """Return the neighbours of vertices that are as near to a place as its nearest vertex."""
        found = []
        for part in self._cut_into_portions(at, np.arange(len(rows))):
            item, owner = topology.gather(self._offsets, at[part])
            neighbor, of = self._neighbors[item], rows[part][owner]
            away, least = (
                self._measure_squares(xy[of], neighbor),
                self._measure_squares(xy[of], nearest[of]),
            )
            near = np.flatnonzero(away <= least * _ROUNDING)
            near = near[self._compare(xy[of[near]], neighbor[near], nearest[of[near]]) == 0]
            found.append((of[near], neighbor[near]))
        first, second = zip(*found, strict=True)
        return np.concatenate(first), np.concatenate(second)

    def _cut_into_portions(self, at: Int64Array, rows: Int64Array) -> list[Int64Array]:
        """Cut rows into portions whose vertices have not too many neighbours together."""
        degrees = np.diff(self._offsets)[at[rows]]
        portion = np.cumsum(degrees) // _MOST_PAIRS
        return np.split(rows, np.flatnonzero(np.diff(portion)) + 1)

    def _measure_squares(self, xy: Float64Array, vertex: Int64Array | Int32Array) -> Float64Array:
        east, north = np.moveaxis(self._xy[vertex] - xy, -1, 0)
        return np.asarray(east * east + north * north, np.float64)

    def _compare(self, xy: Float64Array, one: Int64Array, other: Int64Array) -> Int8Array:
        return _kernel.compare_distances(np.ascontiguousarray(xy), self._xy[one], self._xy[other])
