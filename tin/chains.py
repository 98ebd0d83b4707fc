"""Chains: lines as lists of vertices that can be changed, and who uses which step."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .pieces import Pieces

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["ChainTable", "Step", "as_pairs", "step_of", "with_middle"]

Step = tuple[int, int]
"""Two vertices that follow each other on a line, the smaller one first."""


def step_of(a: int, b: int) -> Step:
    """Return the step between two vertices."""
    return (a, b) if a < b else (b, a)


class ChainTable:
    """Chains of vertices with the steps that they share.

    Parameters
    ----------
    pieces : Pieces
        The chains to begin with; they are taken apart when one is first changed.
    """

    def __init__(self, pieces: Pieces) -> None:
        self._pieces: Pieces | None = pieces
        self._vertices: dict[int, list[int]] = {}
        self._line: dict[int, int] = {}
        self._users: dict[Step, list[int]] = defaultdict(list)
        self._chains_at: dict[int, set[int]] = defaultdict(set)
        self._next = 0

    def __bool__(self) -> bool:
        return len(self._pieces.lines) > 0 if self._pieces is not None else bool(self._vertices)

    def pieces(self) -> Pieces:
        """Return all chains as arrays."""
        if self._pieces is not None:
            return self._pieces
        return Pieces.of_chains(list(self._vertices.values()), list(self._line.values()))

    # ------------------------------------------------------------------ reading

    def at(self, vertex: int) -> list[int]:
        """Return the chains through a vertex."""
        self._take_apart()
        return sorted(self._chains_at.get(vertex, ()))

    def of_line(self, line: int) -> list[int]:
        """Return the chains of a line."""
        self._take_apart()
        return [chain for chain, own in self._line.items() if own == line]

    def vertices(self, chain: int) -> list[int]:
        """Return the vertices of a chain."""
        return list(self._vertices[chain])

    def lines_of_step(self, step: Step) -> list[int]:
        """Return the lines that take a step."""
        self._take_apart()
        return [self._line[chain] for chain in self._users.get(step, ())]

    # ----------------------------------------------------------------- changing

    def add(self, line: int, vertices: Sequence[int]) -> list[Step]:
        """Add a chain; return the steps that no other one takes."""
        self._take_apart()
        return self._enter(self._new(line), list(vertices))

    def drop(self, chain: int) -> list[Step]:
        """Drop a chain; return the steps that no other one takes."""
        self._take_apart()
        gone = self._leave(chain)
        del self._vertices[chain], self._line[chain]
        return gone

    def change(self, chain: int, vertices: Sequence[int]) -> tuple[list[Step], list[Step]]:
        """Give a chain other vertices; return the steps that are used no more, and the new ones."""
        self._take_apart()
        gone = set(self._leave(chain))
        new = set(self._enter(chain, list(vertices)))
        return sorted(gone - new), sorted(new - gone)

    def split(self, step: Step, vertex: int) -> None:
        """Put a vertex between the ends of a step, on every chain that takes it."""
        self._take_apart()
        for chain in set(self._users.get(step, ())):
            self.change(chain, with_middle(self._vertices[chain], step, vertex))

    # ------------------------------------------------------------------ keeping

    def _take_apart(self) -> None:
        if self._pieces is None:
            return
        pieces, self._pieces = self._pieces, None
        vertices, offsets = pieces.vertices.tolist(), pieces.offsets.tolist()
        for (start, end), line in zip(pairwise(offsets), pieces.lines.tolist(), strict=True):
            self._enter(self._new(line), vertices[start:end])

    def _new(self, line: int) -> int:
        chain = self._next
        self._next += 1
        self._line[chain] = line
        return chain

    def _enter(self, chain: int, vertices: list[int]) -> list[Step]:
        self._vertices[chain] = vertices
        new = []
        for a, b in pairwise(vertices):
            users = self._users[step_of(a, b)]
            if not users:
                new.append(step_of(a, b))
            users.append(chain)
        for vertex in vertices:
            self._chains_at[vertex].add(chain)
        return new

    def _leave(self, chain: int) -> list[Step]:
        vertices = self._vertices[chain]
        gone = []
        for a, b in pairwise(vertices):
            users = self._users[step_of(a, b)]
            users.remove(chain)
            if not users:
                del self._users[step_of(a, b)]
                gone.append(step_of(a, b))
        for vertex in set(vertices):
            self._chains_at[vertex].discard(chain)
        return gone


def with_middle(vertices: Iterable[int], step: Step, middle: int) -> list[int]:
    """Return a chain with a vertex between the ends of a step, wherever it takes that step."""
    result: list[int] = []
    for vertex in vertices:
        if result and step_of(result[-1], vertex) == step:
            result.append(middle)
        result.append(vertex)
    return result


def as_pairs(steps: Iterable[Step]) -> NDArray[np.int32]:
    """Return steps as a (k, 2) array."""
    return np.array(list(steps), np.int32).reshape(-1, 2)
