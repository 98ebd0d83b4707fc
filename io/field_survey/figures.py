"""Figures: the shots of one code and number in their order, from the begin of a line to its end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from .code_table import Rule
    from .descriptions import Coded
    from .styles import Meaning

RINGS = ("boundary", "hole", "erase", "water")
NO_LINES = ("point", "exclude")
"""Kinds whose codes make no line."""


class Curve(NamedTuple):
    """Shots of a figure, from the first to the last, through which a curve goes."""

    first: int
    last: int
    is_tangent: bool


class Fault(NamedTuple):
    """What is odd in the codes, and at which rows.

    ``kind`` is a row of ``remarks.tsv``; ``what`` a line or a word.
    """

    kind: str
    what: str
    rows: tuple[int, ...]


@dataclass
class Figure:
    """The shots of one line."""

    name: str
    """Code and number."""
    rule: Rule
    rows: list[int] = field(default_factory=list)
    """Of its shots."""
    marks: dict[int, tuple[Meaning, ...]] = field(default_factory=dict)
    """What the marks at a shot say, by its place in ``rows``; most shots have none."""
    is_closed: bool = False
    """Whether it comes back to its first shot."""
    is_rectangle: bool = False
    """Whether a fourth corner closes it."""
    is_begun: bool = False
    is_ended: bool = False
    """Whether marks say that it begins, and ends."""
    n_added: int = 0
    """Vertices of its curves that are no shots."""

    @property
    def is_long_enough(self) -> bool:
        """Whether it has as many shots as it needs."""
        return len(self.rows) >= self.least

    @property
    def is_ring(self) -> bool:
        """Whether it bounds an area."""
        return self.is_closed or self.rule.is_closed or self.rule.kind in RINGS

    @property
    def least(self) -> int:
        """How many shots it needs."""
        return 3 if self.is_ring or self.is_rectangle else 2

    @property
    def key(self) -> tuple[object, ...]:
        """What tells it from another one: two readings with equal keys are one line."""
        curves = tuple(find_curves(self))
        return (self.rule.kind, tuple(self.rows), self.is_ring, self.is_rectangle, curves)


def follow_figures(
    rows: Sequence[int], shots: Sequence[Sequence[tuple[str, Coded]]], rules: dict[str, Rule]
) -> tuple[list[Figure], list[Fault]]:
    """Follow every line through the shots, in the order of the first shot of each.

    Parameters
    ----------
    rows : sequence of int
        In the order in which lines run.
    shots : sequence of sequences of (name, Coded)
        Of each row the names of its lines, with what the codes say.
    rules : dict of str to Rule

    Returns
    -------
    figures : list of Figure
    faults : list of Fault
    """
    follower = _Follower(rules)
    running, add = follower.running, follower.add
    for row, codes in zip(rows, shots, strict=True):
        for name, one in codes:
            figure = None if one.marks else running.get(name)
            if figure is None:
                add(row, one)
            else:
                figure.rows.append(row)
    follower.finish()
    return follower.figures, follower.faults


class _Follower:
    """Holds the lines that run."""

    def __init__(self, rules: dict[str, Rule]) -> None:
        self.rules = rules
        self.figures: list[Figure] = []
        self.faults: list[Fault] = []
        self.running: dict[str, Figure] = {}

    def add(self, row: int, one: Coded) -> None:
        """Add a shot to its line."""
        marks = one.marks
        if "other" in marks:
            for word, meaning in zip(one.words, marks, strict=True):
                if meaning == "other":
                    self.faults.append(Fault("mark not applied", word, (row,)))
        if "exclude" in marks:
            return
        if "begin" in marks and _is_before(marks, ("end", "close"), "begin"):
            self._append(one, row, marks[: marks.index("begin")])
            marks = marks[marks.index("begin") :]
        self._append(one, row, marks)

    def _append(self, one: Coded, row: int, marks: tuple[Meaning, ...]) -> None:
        name = one.name
        is_alone = name not in self.running and "begin" not in marks
        if is_alone and "end" in marks:
            self.faults.append(Fault("end without a begin", name, (row,)))
        if is_alone and "continue" in marks:
            self.faults.append(Fault("nothing to continue", name, (row,)))
        figure = self.running.get(name)
        if figure is None or "begin" in marks:
            figure = Figure(name, self.rules[one.code], is_begun="begin" in marks)
            self.running[name] = figure
            self.figures.append(figure)
        if marks:
            figure.marks[len(figure.rows)] = marks
        figure.rows.append(row)
        if "end" in marks or "close" in marks or "rectangle" in marks:
            self.running.pop(name)
            figure.is_ended = True
            figure.is_closed = "close" in marks
            figure.is_rectangle = "rectangle" in marks

    def finish(self) -> None:
        """Tell of lines that do not end as others do."""
        ends = any(figure.is_ended for figure in self.figures)
        for figure in self.figures:
            rows = figure.rows
            if "continue" in figure.marks.get(len(rows) - 1, ()):
                self.faults.append(Fault("nothing to continue", figure.name, (rows[-1],)))
            if ends and figure.is_begun and not figure.is_ended and len(rows) > 1:
                ends_at = (rows[0], rows[-1])
                self.faults.append(Fault("line without an end", figure.name, ends_at))


def _is_before(marks: Sequence[Meaning], some: Sequence[Meaning], other: Meaning) -> bool:
    return any(one in some for one in marks[: marks.index(other)])


def _say_nothing(fault: Fault) -> None:
    """Take a fault that has been told already."""
    del fault


def find_curves(figure: Figure, note: Callable[[Fault], None] = _say_nothing) -> list[Curve]:
    """Find the curves of a line, and tell of those that have too few shots, or no begin.

    A curve goes on to its end; without one it is the arc through three shots.
    """
    curves: list[Curve] = []
    begun: tuple[int, bool] | None = None
    for i, marks in figure.marks.items():
        for meaning in _order_marks(marks, is_open=begun is not None):
            if meaning == "end_curve":
                if begun is None:
                    note(Fault("end of no curve", figure.name, (figure.rows[i],)))
                else:
                    _close_curve(figure, Curve(begun[0], i, begun[1]), curves, note)
                begun = None
            else:
                if begun is not None:
                    _take_three(figure, begun[0], i, curves, note)
                begun = (i, meaning == "begin_tangent_curve")
    if begun is not None:
        _take_three(figure, begun[0], len(figure.rows) - 1, curves, note)
    return curves


def _order_marks(marks: Sequence[Meaning], *, is_open: bool) -> list[Meaning]:
    """Return the marks of curves, the end of one before the begin of the next."""
    found: list[Meaning] = [one for one in marks if one == "end_curve"]
    if "toggle_curve" in marks:
        found.append("end_curve" if is_open else "begin_curve")
    return found + [one for one in marks if one in ("begin_curve", "begin_tangent_curve")]


def _close_curve(
    figure: Figure, curve: Curve, curves: list[Curve], note: Callable[[Fault], None]
) -> None:
    least = 1 if curve.is_tangent else 2
    if curve.last - curve.first < least:
        rows = tuple(figure.rows[curve.first : curve.last + 1])
        note(Fault("curve of too few points", figure.name, rows))
    else:
        curves.append(curve)


def _take_three(
    figure: Figure, first: int, last: int, curves: list[Curve], note: Callable[[Fault], None]
) -> None:
    """Take the arc through three shots for a curve that has no end."""
    rows = tuple(figure.rows[first : min(first + 2, last) + 1])
    if last - first < 2:
        note(Fault("curve of too few points", figure.name, rows))
        return
    note(Fault("curve without an end", figure.name, rows))
    curves.append(Curve(first, first + 2, is_tangent=False))
