"""Pieces: the parts of lines that are left, as chains of vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

__all__ = ["Pieces"]


class Pieces(NamedTuple):
    """Parts of lines: chains of vertices, and the line that each comes from."""

    vertices: NDArray[np.int32]
    offsets: NDArray[np.int32]
    lines: NDArray[np.int32]

    @classmethod
    def none(cls) -> Pieces:
        """Return no pieces."""
        empty = np.empty(0, np.int32)
        return cls(empty, np.zeros(1, np.int32), empty)

    @classmethod
    def of_chains(cls, chains: Sequence[Sequence[int]], lines: Sequence[int]) -> Pieces:
        """Return chains of vertices, each of the line named."""
        counts = [len(chain) for chain in chains]
        return cls(
            np.array([v for chain in chains for v in chain], np.int32),
            np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
            np.array(lines, np.int32),
        )

    def steps(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return every step, as (s, 2) vertex pairs, and the line of each."""
        is_start = np.ones(len(self.vertices), np.bool_)
        is_start[self.offsets[1:] - 1] = False
        start = np.flatnonzero(is_start)
        piece = np.repeat(np.arange(len(self.lines)), np.diff(self.offsets))
        return (
            np.stack([self.vertices[start], self.vertices[start + 1]], axis=1),
            self.lines[piece[start]],
        )

    def kept(self, keep: NDArray[np.bool_]) -> Pieces:
        """Return the pieces that are left when only some steps are kept."""
        if keep.all() and (np.diff(self.offsets) > 1).all():
            return self
        is_start = np.ones(len(self.vertices), np.bool_)
        is_start[self.offsets[1:] - 1] = False
        goes_on = np.zeros(len(self.vertices), np.bool_)
        goes_on[np.flatnonzero(is_start)[keep]] = True
        comes = np.concatenate([[False], goes_on[:-1]])
        is_used = goes_on | comes
        piece = np.repeat(np.arange(len(self.lines)), np.diff(self.offsets))
        begins = np.flatnonzero((goes_on & ~comes)[is_used])
        return Pieces(
            self.vertices[is_used],
            np.append(begins, is_used.sum()).astype(np.int32),
            self.lines[piece[is_used]][begins],
        )

    def renumbered(self, number: NDArray[np.int32]) -> Pieces:
        """Return the same pieces with vertex ``v`` called ``number[v]``."""
        return self._replace(vertices=number[self.vertices])
