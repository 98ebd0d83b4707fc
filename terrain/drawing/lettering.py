"""Lettering: texts that are made to fit, by whatever measures how wide they are."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    Measure = Callable[..., float]
    """Of a text and ``size``, that of its letters."""

_ELLIPSIS = "..."
_LONGEST = 1000
"""Letters that are looked at: no line of any picture holds more."""


class Lettering(NamedTuple):
    """A text in lines, as it fits."""

    lines: tuple[str, ...]
    size: float
    """Of the letters."""
    is_cut: bool
    """Whether the end is left out, which three dots show."""


def fit_text(
    text: str, width: float, sizes: Iterable[float], measure: Measure, *, lines: int = 1
) -> Lettering:
    """Return a text in at most so many lines, in the first of some sizes in which it fits.

    Where it fits in none it is cut in the last one; ``width`` is the room for a line.

    Examples
    --------
    >>> fit_text("A site plan", 5.0, [2.0, 1.0], lambda text, size: size * len(text), lines=2)
    Lettering(lines=('A', 'si...'), size=1.0, is_cut=True)
    """
    kept = text[:_LONGEST]
    for size in sizes:
        measured = partial(measure, size=size)
        wrapped = _wrap(kept, width, measured)
        if len(wrapped) <= lines and kept == text:
            return Lettering(tuple(wrapped), size, is_cut=False)
    last = " ".join(wrapped[lines - 1 :])
    cut = last[: _count_fitting(last, width, measured, _ELLIPSIS)].rstrip() + _ELLIPSIS
    return Lettering((*wrapped[: lines - 1], cut), size, is_cut=True)


def _wrap(text: str, width: float, measure: Measure) -> list[str]:
    """Part a text into lines, between words where it can be done."""
    lines = []
    while text and measure(text) > width:
        count = max(_count_fitting(text, width, measure), 1)
        gap = text.rfind(" ", 1, count + 1)
        stop = count if gap < 0 else gap
        lines.append(text[:stop].rstrip())
        text = text[stop:].lstrip()
    return [*lines, text]


def _count_fitting(text: str, width: float, measure: Measure, end: str = "") -> int:
    """Return how many letters fit, by halving: a longer text is never narrower."""
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        if measure(text[:middle] + end) <= width:
            low = middle
        else:
            high = middle - 1
    return low
