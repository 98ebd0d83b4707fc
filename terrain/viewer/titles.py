"""Titles: words in the room there is for them, wrapped and smaller where they are many."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    from .overlay import Overlay

_LAYOUTS = (
    ((30.0, 27.0, 24.0), (62.0,), 92.0),
    ((24.0, 21.0), (41.0, 69.0), 96.0),
    ((18.0, 16.0, 14.0), (33.0, 54.0, 75.0), 98.0),
)
"""Sizes of letters, and how far below the upper edge the lines and the next line stand, for one,
two and three lines, design pixels."""

_MOST_LETTERS = 900
_ELLIPSIS = "..."


class Title(NamedTuple):
    """A title as it is written."""

    lines: tuple[str, ...]
    size: float
    """Of the letters, design pixels."""
    drops: tuple[float, ...]
    """How far below the upper edge each line stands."""
    next_drop: float
    """How far the line below the title stands."""


def fit_title(overlay: Overlay, words: str, room: float) -> Title:
    """Write a title in one line, or in up to three of smaller letters.

    The overlay measures words; ``room`` is the width for it, design pixels. A title that is too
    long for three lines is cut, which three dots at its end show.
    """
    kept = words[:_MOST_LETTERS]
    for sizes, drops, next_drop in _LAYOUTS:
        for size in sizes:
            lines = _wrap(kept, room, _measure_with(overlay, size))
            if len(lines) <= len(drops) and len(kept) == len(words):
                return Title(tuple(lines), size, drops[: len(lines)], next_drop)
    last = " ".join(lines[len(drops) - 1 :]) + _ELLIPSIS
    lines = [*lines[: len(drops) - 1], shorten(overlay, last, room, size=size, bold=True)]
    return Title(tuple(lines), size, drops, next_drop)


def shorten(overlay: Overlay, words: str, room: float, *, size: float, bold: bool = False) -> str:
    """Cut words that are too long for the room, and show that they are cut."""
    words = words[:_MOST_LETTERS]
    measure = _measure_with(overlay, size, bold=bold)
    if measure(words) <= room:
        return words
    return words[: _count_fitting(words, room, measure, _ELLIPSIS)].rstrip() + _ELLIPSIS


def _measure_with(overlay: Overlay, size: float, *, bold: bool = True) -> Callable[[str], float]:
    return lambda words: overlay.measure_text(words, size=size, bold=bold)


def _wrap(words: str, room: float, measure: Callable[[str], float]) -> list[str]:
    """Part words into lines, between words where it can be done."""
    lines = []
    rest = words
    while measure(rest) > room:
        count = max(_count_fitting(rest, room, measure), 1)
        gap = rest.rfind(" ", 1, count + 1)
        stop = count if gap < 0 else gap
        lines.append(rest[:stop].rstrip())
        rest = rest[stop:].lstrip()
    return [*lines, rest]


def _count_fitting(words: str, room: float, measure: Callable[[str], float], end: str = "") -> int:
    """Return how many letters fit, by halving: a longer text is never narrower."""
    low, high = 0, len(words)
    while low < high:
        middle = (low + high + 1) // 2
        if measure(words[:middle] + end) <= room:
            low = middle
        else:
            high = middle - 1
    return low
