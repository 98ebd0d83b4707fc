"""Findings of a check: problems, notes and counts as they come up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.sentences import inflect

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_SHOWN = 5


@dataclass(frozen=True, slots=True)
class Problem:
    """One kind of fault, however often it occurs.

    Attributes
    ----------
    kind : str
        Short name: ``"shape"``, ``"coordinates"``, ``"index"``, ``"left_out"``, ``"corners"``,
        ``"neighbors"``, ``"constrained"``, ``"edge"``, ``"unused"``, ``"chains"``,
        ``"orientation"``, ``"boundary"``, ``"hull"``, ``"overlap"``, ``"euler"``, ``"area"``,
        ``"delaunay"``, ``"lines"``, ``"rows"``; among notes ``"tie"``, ``"lines"``, ``"stopped"``.
    count : int
        How often it occurs.
    first : tuple of int
        Numbers of the first few triangles, vertices, rows, chains or lines at fault, as the
        sentence says.
    sentence : str
        What is wrong, in one sentence.
    """

    kind: str
    count: int
    first: tuple[int, ...]
    sentence: str


class Findings:
    """Problems, notes and counts as they come up."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []
        self.notes: list[Problem] = []
        self.counts: dict[str, int] = {}

    def report(self, kind: str, at: ArrayLike, sentence: str) -> None:
        """Report a problem at the numbers ``at``; nothing if there are none.

        ``{count}`` and ``{first}`` in the sentence are filled in, and of ``[is|are]`` the word is
        taken that fits the count.
        """
        _add(self.problems, kind, at, sentence)

    def note(self, kind: str, at: ArrayLike, sentence: str) -> None:
        """Note what is no fault, as :meth:`report`."""
        _add(self.notes, kind, at, sentence)

    def fail(self, kind: str, sentence: str) -> None:
        """Report a problem of the TIN as a whole."""
        self.problems.append(Problem(kind, 1, (), sentence))


def _add(into: list[Problem], kind: str, at: ArrayLike, sentence: str) -> None:
    numbers = np.asarray(at)
    if numbers.size:
        first = tuple(int(number) for number in numbers[:_SHOWN])
        text = inflect(sentence, numbers.size).format(
            count=numbers.size, first=", ".join(map(str, first))
        )
        into.append(Problem(kind, int(numbers.size), first, text))
