"""Where the points of a part of a surface come from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.types import Bounds
    from .circles import Discs

__all__ = ["NumberedPoints", "PointSource"]


class NumberedPoints(NamedTuple):
    """Points with their numbers among all points.

    Attributes
    ----------
    points : (n, 3) float64 array
    numbers : (n,) int64 array
        Of their rows, in the order in which a file with all of them would have them.
    """

    points: Float64Array
    numbers: Int64Array

    @classmethod
    def join(cls, parts: Iterable[NumberedPoints]) -> NumberedPoints:
        """Return the points of several parts once each, in order of their numbers."""
        points, numbers = map(np.concatenate, zip(*parts, strict=True))
        numbers, first = np.unique(numbers, return_index=True)
        return cls(points[first], numbers)

    def choose(self, which: BoolArray | Int64Array) -> NumberedPoints:
        """Return some of them."""
        return NumberedPoints(self.points[which], self.numbers[which])


class PointSource(Protocol):
    """All points of a surface, of which only some are in memory at a time."""

    @property
    def skeleton(self) -> NumberedPoints:
        """Some of the points, with all vertices of the convex hull among them."""

    def read_box(self, box: Bounds) -> NumberedPoints:
        """Return all points in a closed box."""

    def read_discs(self, discs: Discs) -> NumberedPoints:
        """Return all points in any of some closed discs, and maybe others."""
