"""Findings of a check: problems, notes and counts as they come up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.sentences import inflect

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_SHOWN = 5
_WORDS = {
    **{one: f"[{one}|{one}s]" for one in ("chain", "edge", "line", "row", "segment", "triangle")},
    "constrained edge": "[constrained edge|constrained edges]",
    "entry": "[entry|entries]",
    "vertex": "[vertex|vertices]",
}
"""What is counted, as one and as several."""


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

    def report(self, kind: str, at: ArrayLike, things: str, what: str, **words: Any) -> None:
        """Report a problem of ``things``: at these numbers, or where flags are set, if anywhere.

        ``what`` goes on behind their number, with the one of ``[is|are]`` that fits it, ``before``
        stands in front; ``first`` are what is numbered, if that is something else.
        """
        self.problems += _describe(kind, at, things, what, **words)

    def note(self, kind: str, at: ArrayLike, things: str, what: str, **words: Any) -> None:
        """Note what is no fault, as :meth:`report`."""
        self.notes += _describe(kind, at, things, what, **words)

    def fail(self, kind: str, sentence: str, *, first: tuple[int, ...] = ()) -> None:
        """Report a problem of the TIN as a whole."""
        self.problems.append(Problem(kind, 1, first, sentence))

    def lack(self, *kinds: str) -> bool:
        """Whether no problem is of one of some kinds."""
        return all(problem.kind not in kinds for problem in self.problems)


def _describe(
    kind: str, at: ArrayLike, things: str, what: str, *, before: str = "", first: str = ""
) -> list[Problem]:
    """Return a problem with its sentence; none where there are no numbers."""
    numbers = np.asarray(at)
    numbers = np.flatnonzero(numbers) if numbers.dtype.kind == "b" else numbers
    if not numbers.size:
        return []
    shown = tuple(int(number) for number in numbers[:_SHOWN])
    where = f"(first: {_WORDS[first or things]} {', '.join(map(str, shown))})."
    words = filter(None, (f"{before}{numbers.size}", _WORDS[things], what, where))
    return [Problem(kind, numbers.size, shown, inflect(" ".join(words), numbers.size))]
