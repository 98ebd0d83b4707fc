"""Where the points and lines of a part of a surface come from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.types import Bounds
    from .circles import Discs
    from .rings import Rings


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
    def none(cls) -> NumberedPoints:
        """Return no points."""
        return cls(np.empty((0, 3)), np.empty(0, np.int64))

    @classmethod
    def join(cls, parts: Iterable[NumberedPoints]) -> NumberedPoints:
        """Return the points of several parts once each, in order of their numbers."""
        points, numbers = map(np.concatenate, zip(*parts, strict=True))
        numbers, first = np.unique(numbers, return_index=True)
        return cls(points[first], numbers)

    def sort(self) -> NumberedPoints:
        """Return the points once each, in order of their numbers: themselves if they are so."""
        is_sorted = bool((self.numbers[1:] > self.numbers[:-1]).all())
        return self if is_sorted else NumberedPoints.join([self])

    def add(self, other: NumberedPoints) -> NumberedPoints:
        """Return these points and some more; both are in order of their numbers."""
        at = np.searchsorted(self.numbers, other.numbers)
        is_new = np.append(self.numbers, -1)[at] != other.numbers
        if not is_new.any():
            return self
        at, other = at[is_new], other.choose(is_new)
        return NumberedPoints(
            np.insert(self.points, at, other.points, axis=0),
            np.insert(self.numbers, at, other.numbers),
        )

    def append(self, other: NumberedPoints) -> NumberedPoints:
        """Return these points and others behind them, as they come."""
        return NumberedPoints(
            np.concatenate([self.points, other.points]),
            np.concatenate([self.numbers, other.numbers]),
        )

    def choose(self, which: BoolArray | Int64Array) -> NumberedPoints:
        """Return some of them."""
        return NumberedPoints(self.points[which], self.numbers[which])


class NumberedSegments(NamedTuple):
    """Segments of lines that are cut where they meet, by their ends.

    Attributes
    ----------
    starts, ends : NumberedPoints
        The vertices of the lines, with the elevations that they have in the whole. One that lies
        where points do has the number of the first of them; one of its own has a number that is
        no row of a point. A segment whose ends are one vertex stands for this vertex alone.
    are_rings : (k,) bool array
        Whether the sides of a segment may differ in being inside the surface.
    """

    starts: NumberedPoints
    ends: NumberedPoints
    are_rings: BoolArray

    @classmethod
    def none(cls) -> NumberedSegments:
        """Return no segments."""
        return cls(NumberedPoints.none(), NumberedPoints.none(), np.empty(0, np.bool_))

    def choose(self, which: BoolArray | Int64Array) -> NumberedSegments:
        """Return some of them."""
        return NumberedSegments(
            self.starts.choose(which), self.ends.choose(which), self.are_rings[which]
        )

    def add(self, other: NumberedSegments) -> NumberedSegments:
        """Return these segments and some more."""
        return NumberedSegments(
            self.starts.append(other.starts),
            self.ends.append(other.ends),
            np.concatenate([self.are_rings, other.are_rings]),
        )

    def are_among(self, others: NumberedSegments) -> BoolArray:
        """Tell which of them, in either direction, are among others."""
        own, seen = self.names, others.names
        together = np.unique(np.concatenate([seen, own]), axis=0, return_inverse=True)[1].ravel()
        return np.isin(together[len(seen) :], together[: len(seen)])

    @property
    def ends_in_plane(self) -> Float64Array:
        """The places of both ends, (k, 2, 2)."""
        return np.stack([self.starts.points[:, :2], self.ends.points[:, :2]], axis=1)

    @property
    def names(self) -> Int64Array:
        """The numbers of the ends, the smaller one first, (k, 2)."""
        return np.sort(np.stack([self.starts.numbers, self.ends.numbers], axis=1), axis=1)

    @property
    def vertices(self) -> NumberedPoints:
        """The ends, once each, in order of their numbers."""
        return NumberedPoints.join([self.starts, self.ends])


class PointSource(Protocol):
    """All points of a surface, of which only some are in memory at a time."""

    @property
    def skeleton(self) -> NumberedPoints:
        """Some of the points, with all vertices of the convex hull among them."""

    def read_box(self, box: Bounds) -> NumberedPoints:
        """Return all points in a closed box; what is in order of numbers costs less."""

    def read_some(self, discs: Discs) -> NumberedPoints:
        """Return points in those of some discs that hold very many, maybe none.

        They are taken before whole discs are read, which is spared for those that hold one.
        """

    def read_discs(self, discs: Discs) -> NumberedPoints:
        """Return all points in any of some closed discs, and maybe others."""


class SegmentSource(Protocol):
    """All segments of a surface's lines: none passes a point of the surface but its ends."""

    @property
    def skeleton(self) -> NumberedPoints:
        """Some of the vertices, with all vertices of the convex hull of the lines among them."""

    @property
    def rings(self) -> Rings | None:
        """Which part of the hull is the surface; None if all of it is."""

    def read_box(self, box: Bounds) -> NumberedSegments:
        """Return all segments that meet a closed box, and maybe others."""

    def read_discs(self, discs: Discs) -> NumberedSegments:
        """Return all segments that meet any of some closed discs, and maybe others."""
