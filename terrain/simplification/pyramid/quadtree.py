"""Squares over a surface, each divided into four: a function of bounds and numbers alone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from ....base.types import Bounds

if TYPE_CHECKING:
    pass


class Node(NamedTuple):
    """A square: its level from the root, 0, and its column and row from the south-west.

    Examples
    --------
    >>> Node(1, 0, 1).key
    '1.0.1'
    """

    level: int
    x: int
    y: int

    @property
    def key(self) -> str:
        """Its name."""
        return f"{self.level}.{self.x}.{self.y}"

    @property
    def parent(self) -> Node:
        """The square that it is a quarter of."""
        return Node(self.level - 1, self.x // 2, self.y // 2)

    @property
    def children(self) -> tuple[Node, ...]:
        """Its quarters."""
        west, south = 2 * self.x, 2 * self.y
        return tuple(Node(self.level + 1, west + x, south + y) for y in range(2) for x in range(2))


@dataclass(frozen=True)
class Quadtree:
    """Squares whose sides are powers of two, and lie on multiples of them.

    Lines between squares are whole multiples of the finest side: no coordinate of a line is
    rounded.
    """

    side: float
    """Of a square of the finest level, CRS units."""
    column: int
    row: int
    """Both, of the south-westernmost square, in sides from the origin of the CRS."""
    levels: int
    """Of the finest; the root is level 0."""

    @classmethod
    def over(cls, bounds: Bounds, count: int, node_points: int) -> Quadtree:
        """Return squares over some points, of which one of the finest has so many, about.

        Examples
        --------
        >>> Quadtree.over(Bounds(10.0, 10.0, 110.0, 60.0), 5_000, 500)
        Quadtree(side=16.0, column=0, row=0, levels=3)
        """
        width, height = bounds.width, bounds.height
        longest = max(width, height)
        even = math.sqrt(node_points / count) * math.sqrt(width) * math.sqrt(height)
        side = 2.0 ** math.floor(math.log2(max(even, longest * (node_points / count))))
        column, row = math.floor(bounds.xmin / side), math.floor(bounds.ymin / side)
        most = max(math.ceil(bounds.xmax / side) - column, math.ceil(bounds.ymax / side) - row, 1)
        return cls(side, column, row, (most - 1).bit_length())

    def find_side(self, level: int) -> float:
        """Return the side of the squares of a level."""
        return math.ldexp(self.side, self.levels - level)

    def find_box(self, node: Node) -> Bounds:
        """Return the sides of a square, exactly."""
        count = 1 << (self.levels - node.level)
        west, south = self.column + node.x * count, self.row + node.y * count
        return Bounds(
            west * self.side,
            south * self.side,
            (west + count) * self.side,
            (south + count) * self.side,
        )
