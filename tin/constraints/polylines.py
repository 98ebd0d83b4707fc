"""Polylines: many chains of vertices in one ragged array."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ..topology import find_offsets, find_owners

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ...base.arrays import AnyArray, BoolArray, Int32Array, Int64Array


@dataclass(frozen=True, eq=False)
class Polylines:
    """Chains of vertices; polyline ``i`` is ``vertices[offsets[i]:offsets[i + 1]]``.

    Positions count the entries of ``vertices``. A segment goes from one position to the next one::

        offsets    0           3        5
        vertices   4   7   2   9   4
        segments   4-7 7-2     9-4
    """

    vertices: Int32Array
    """(k,)."""
    offsets: Int32Array
    """(l + 1,)."""
    lines: Int32Array
    """(l,), the line that each polyline is, or is a part of: its place in a table of constraints.
    """

    @classmethod
    def whole(cls, vertices: Int32Array, offsets: AnyArray) -> Polylines:
        """Return one polyline for each line."""
        lines = np.arange(len(offsets) - 1, dtype=np.int32)
        return cls(vertices, offsets.astype(np.int32), lines)

    @classmethod
    def of_chains(cls, chains: Sequence[Sequence[int]]) -> Polylines:
        """Return one polyline for each chain of vertices."""
        vertices = np.array([v for chain in chains for v in chain], np.int32)
        return cls.whole(vertices, find_offsets(map(len, chains)))

    def __len__(self) -> int:
        return len(self.lines)

    def __iter__(self) -> Iterator[Int32Array]:
        return (self.vertices[start:end] for start, end in pairwise(self.offsets.tolist()))

    # ---------------------------------------------------------------- questions

    @property
    def lengths(self) -> Int32Array:
        """Number of vertices of each polyline."""
        return np.diff(self.offsets)

    @property
    def owners(self) -> Int64Array:
        """The polyline of each position."""
        return find_owners(self.offsets)

    def starts(self) -> Int64Array:
        """Return the position from which each segment goes."""
        is_start = np.ones(len(self.vertices), np.bool_)
        is_start[self.offsets[1:] - 1] = False
        return np.flatnonzero(is_start)

    def segments(self) -> Int32Array:
        """Return the ends of every segment, (s, 2) vertex pairs in order."""
        start = self.starts()
        return np.stack([self.vertices[start], self.vertices[start + 1]], axis=1)

    def segment_owners(self) -> Int64Array:
        """Return the polyline of each segment."""
        return np.repeat(np.arange(len(self)), np.maximum(self.lengths - 1, 0))

    def segment_lines(self) -> Int32Array:
        """Return the line of each segment."""
        return self.lines[self.segment_owners()]

    # ------------------------------------------------------------------ changes

    def keep(self, is_kept: BoolArray) -> Polylines:
        """Return what is left when only some segments are kept: parts of lines.

        ::

            vertices   a---b---c   d---e      the segment b-c goes
            goes_on    1   0   -   1   -      a segment is kept behind the position
            comes      -   1   0   -   1      ... and in front of it
        """
        if is_kept.all() and (self.lengths > 1).all():
            return self
        goes_on = np.zeros(len(self.vertices), np.bool_)
        goes_on[self.starts()[is_kept]] = True
        comes = np.concatenate([[False], goes_on[:-1]])
        is_used = goes_on | comes
        begins = np.flatnonzero((goes_on & ~comes)[is_used])
        return Polylines(
            self.vertices[is_used],
            np.append(begins, is_used.sum()).astype(np.int32),
            self.lines[self.owners[is_used]][begins],
        )

    def renumber(self, number_of: Int32Array) -> Polylines:
        """Return the same polylines with vertex ``v`` called ``number_of[v]``."""
        return replace(self, vertices=number_of[self.vertices])

    def insert(self, at: Int64Array, vertices: Int32Array) -> Polylines:
        """Put vertices behind the positions ``at``, from which segments go, ascending."""
        added = np.searchsorted(at, self.offsets)
        return replace(
            self,
            vertices=np.insert(self.vertices, at + 1, vertices),
            offsets=(self.offsets + added).astype(np.int32),
        )

    def choose_positions(self, is_chosen: BoolArray) -> Polylines:
        """Return the polylines through some of their positions only."""
        return replace(
            self,
            vertices=self.vertices[is_chosen],
            offsets=find_offsets(is_chosen)[self.offsets].astype(np.int32),
        )
