"""The lists that the paper's procedure keeps: points searched, use of edges, triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..predicates import orientation

if TYPE_CHECKING:
    from ...base.arrays import Int8Array, Int64Array
    from ..predicates import Columns

Edge = tuple[int, int]
Triangle = tuple[int, int, int]

_MOST_USES = 2
"""Condition 3 of the paper: an edge is used by at most two triangles."""


class Lists:
    """Point set M, the Count of every edge, list N of triangles; and how much was searched.

    With ``removal`` points are deleted from M, which is ``searched`` in the order of the rows, once
    all their edges are used twice. ``triangles`` stand in the order of growth, counter-clockwise.
    Counted are ``searches``, edges extended or tried, ``candidates``, points looked at for them,
    and ``tests``, comparisons of a point with a circle.
    """

    def __init__(self, xy: Columns, *, removal: bool) -> None:
        self.xy = xy
        self.removal = removal
        self.searched: Int64Array = np.arange(len(xy[0]), dtype=np.int64)
        self.triangles: list[Triangle] = []
        self.searches = self.candidates = self.tests = 0
        self._count: dict[Edge, int] = {}
        self._used_twice: list[set[int]] = [set() for _ in self.searched]
        self._used_once: list[set[int]] = [set() for _ in self.searched]

    def count(self, p: int, q: int) -> int:
        """How often the edge between two points is used, 0 to 2."""
        return self._count.get((min(p, q), max(p, q)), 0)

    def open_edges(self) -> list[Edge]:
        """Return the edges used once, smaller vertex first, in ascending order."""
        return sorted(edge for edge, count in self._count.items() if count < _MOST_USES)

    def is_used_up(self, p: int, q: int) -> bool:
        """Second step: tell whether the edge between two points is used twice already."""
        return self.count(p, q) == _MOST_USES

    def qualified(self, p1: int, p2: int) -> Int64Array:
        """Third step: the points that may become a triangle with the edge p1-p2 of a triangle.

        Left out are 1) points collinear with the edge, 2) points on the side of the triangle's
        third point, which is the left, 3) points to which an edge from p1 or p2 is used twice.
        """
        others = self.searched[(self.searched != p1) & (self.searched != p2)]
        self.searches += 1
        self.candidates += len(others)
        across: Int64Array = others[sides(self.xy, p1, p2, others) < 0]
        closed = list(self._used_twice[p1] | self._used_twice[p2])
        return across[~np.isin(across, closed)] if closed else across

    def enter(self, triangle: Triangle) -> None:
        """Fifth and sixth step: record the triangle, count its edges, delete finished points."""
        self.triangles.append(triangle)
        a, b, c = triangle
        for p, q in ((a, b), (b, c), (c, a)):
            uses = self.count(p, q) + 1
            self._count[min(p, q), max(p, q)] = uses
            for v, w in ((p, q), (q, p)):
                if uses == _MOST_USES:
                    self._used_once[v].discard(w)
                    self._used_twice[v].add(w)
                else:
                    self._used_once[v].add(w)
        if self.removal:
            finished = [p for p in triangle if not self._used_once[p]]
            for p in finished:
                self.searched = self.searched[self.searched != p]


def sides(xy: Columns, p1: int, p2: int, points: Int64Array) -> Int8Array:
    """Tell the side of p1-p2 that points lie on: +1 left, -1 right, 0 collinear; exactly."""
    return orientation(xy, np.full(len(points), p1), np.full(len(points), p2), points)
