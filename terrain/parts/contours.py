"""Contours of a surface, traced tile by tile and joined.

A tile traces the lines through the triangles that it owns. A piece that leaves them names the
triangle that it goes on in, by its corners' numbers in the whole surface: the piece that begins in
this triangle is its continuation, so that nothing is compared but whole numbers. Lines that end
within a tile are finished there; of the others only those are kept whose continuation has not come.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _kernel
from ..isolines import as_features
from .surfaces import are_owned_triangles

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.crs import CRS, Unit
    from ...base.results import Features
    from ...base.types import Bounds
    from ...tin.tiling import LocalTriangulation
    from ..isolines import Levels

RINGS = 2
"""Rings of triangles that a part needs around those that meet the tile's box.

Whether a vertex counts as being at a level depends on how steep all triangles around it are, and a
line that comes to a ridge at its level goes on in the triangle beyond it.
"""

_BOUNDARY, _CLOSED = -1, -2

Key = tuple[int, ...]


class ContourOptions(NamedTuple):
    """What contours are traced: levels as :class:`tinsmith.terrain.isolines.Levels`."""

    levels: Levels
    crs: CRS | None = None
    elevation_unit: Unit | None = None


class Lines(NamedTuple):
    """Lines one after the other, with all points that they run through."""

    points: Float64Array
    """(n, 2), the first of a closed line is not repeated."""
    offsets: Int64Array
    """(k + 1,)."""
    level: Int32Array
    """(k,), place in the levels."""
    is_closed: BoolArray
    """(k,)."""


class ContourPart(NamedTuple):
    """The contours in a tile."""

    finished: Lines
    points: Float64Array
    offsets: Int64Array
    level: Int32Array
    """All three, pieces of lines that begin or end in other tiles, as those of :class:`Lines`."""
    first: Int64Array
    next: Int64Array
    """Both (k, 3), the corners of the triangle that a piece begins in, and of the one that it goes
    on in; -1 at the boundary of the surface."""


def compute_part(part: LocalTriangulation, box: Bounds, options: ContourOptions) -> ContourPart:
    """Trace the contours through the triangles that a tile owns.

    Parameters
    ----------
    part : LocalTriangulation
        All triangles that meet the box, with :data:`RINGS` rings around them.
    box : Bounds
        Of the tile; of those that tile the plane each triangle is owned by one.
    options : ContourOptions
    """
    found = _kernel.trace_pieces(
        part.points,
        part.triangles,
        part.neighbors,
        options.levels.values,
        are_owned_triangles(part, box),
        part.numbers,
    )
    first, after = found.first[:, 0], found.next[:, 0]
    is_closed = first == _CLOSED
    is_finished = is_closed | ((first == _BOUNDARY) & (after == _BOUNDARY))
    lines = Lines(*_choose(found, is_finished), is_closed[is_finished])
    return ContourPart(
        lines, *_choose(found, ~is_finished), found.first[~is_finished], found.next[~is_finished]
    )


def _choose(
    found: _kernel.LinePieces, which: BoolArray
) -> tuple[Float64Array, Int64Array, Int32Array]:
    """Return points, offsets and levels of some pieces."""
    counts = np.diff(found.offsets)
    offsets = np.append(0, np.cumsum(counts[which])).astype(np.int64)
    return found.points[np.repeat(which, counts)], offsets, found.level[which]


class _Chain:
    """Pieces of one line, in order."""

    __slots__ = ("after", "first", "level", "pieces")

    def __init__(self, first: Key, after: Key, level: int, points: Float64Array) -> None:
        self.first = first
        self.after = after
        self.level = level
        self.pieces = deque([points])

    def join(self, other: _Chain) -> _Chain:
        """Return this and what comes behind it; the shorter one is moved."""
        if len(self.pieces) >= len(other.pieces):
            self.pieces.extend(other.pieces)
            self.after = other.after
            return self
        other.pieces.extendleft(reversed(self.pieces))
        other.first = self.first
        return other


class LineJoiner:
    """Joins pieces of lines, of tiles in any order.

    It holds the pieces of lines that are not finished: those that cross a side between a tile that
    was added and one that was not.
    """

    def __init__(self) -> None:
        self._by_first: dict[Key, _Chain] = {}
        self._by_after: dict[Key, _Chain] = {}

    @property
    def is_done(self) -> bool:
        """Whether no line waits for another piece."""
        return not (self._by_first or self._by_after)

    def add(self, part: ContourPart) -> Lines:
        """Take in a tile, and return the lines that are finished with it, those within it too."""
        found = [self._add_piece(*piece) for piece in _list_pieces(part)]
        lines = [line for line in found if line is not None]
        if not lines:
            return part.finished
        points = [np.concatenate(line.pieces) for line in lines]
        joined = Lines(
            np.concatenate(points),
            np.append(0, np.cumsum([len(one) for one in points])).astype(np.int64),
            np.array([line.level for line in lines], np.int32),
            np.array([line.first[1] != _BOUNDARY for line in lines], np.bool_),
        )
        return _concatenate([part.finished, joined])

    def _add_piece(self, first: Key, after: Key, level: int, points: Float64Array) -> _Chain | None:
        """Return the line that a piece finishes, if it does."""
        chain = _Chain(first, after, level, points)
        before = self._by_after.pop(first, None)
        if before is not None:
            self._by_first.pop(before.first, None)
            chain = before.join(chain)
        if chain.first == chain.after and chain.first[1] != _BOUNDARY:
            return chain
        behind = self._by_first.pop(chain.after, None)
        if behind is not None:
            self._by_after.pop(behind.after, None)
            chain = chain.join(behind)
        if chain.first[1] == chain.after[1] == _BOUNDARY:
            return chain
        if chain.first[1] != _BOUNDARY:
            self._by_first[chain.first] = chain
        if chain.after[1] != _BOUNDARY:
            self._by_after[chain.after] = chain
        return None


def _list_pieces(part: ContourPart) -> Iterator[tuple[Key, Key, int, Float64Array]]:
    levels, offsets = part.level.tolist(), part.offsets.tolist()
    ends = zip(part.first.tolist(), part.next.tolist(), strict=True)
    for k, (first, after) in enumerate(ends):
        level = levels[k]
        points = part.points[offsets[k] : offsets[k + 1]]
        yield (level, *first), (level, *after), level, points


def _concatenate(lines: list[Lines]) -> Lines:
    counts = np.concatenate([np.diff(one.offsets) for one in lines])
    return Lines(
        np.concatenate([one.points for one in lines]),
        np.append(0, np.cumsum(counts)).astype(np.int64),
        np.concatenate([one.level for one in lines]),
        np.concatenate([one.is_closed for one in lines]),
    )


def settle(lines: Lines, levels: Float64Array) -> _kernel.ContourLines:
    """Return lines as they are drawn: each point once, closed ones from their first point.

    They are sorted by level, then by their points: all lines of a surface have one order, to which
    the settled lines of several parts can be merged.
    """
    coordinates = np.zeros((len(lines.points), 3))
    coordinates[:, :2] = lines.points
    return _kernel.settle_contours(coordinates, lines.offsets, lines.level, lines.is_closed, levels)


def join(parts: Iterable[ContourPart], options: ContourOptions) -> Features:
    """Return the contours of the whole surface, of the parts of all tiles.

    Raises
    ------
    ValueError
        If a tile is missing.
    """
    joiner = LineJoiner()
    found = [joiner.add(part) for part in parts]
    if not joiner.is_done:
        raise ValueError("a line goes on in a tile that is missing")
    lines = settle(_concatenate(found), options.levels.values)
    return as_features(lines, options.levels, options.crs, options.elevation_unit)
