"""Lettering: how wide texts are, and how they are made to fit."""

from __future__ import annotations

import unicodedata
from functools import lru_cache
from typing import Any, NamedTuple

from ...base import optional

FONT = "DejaVu Sans"
"""Comes with matplotlib, and is embedded in a PDF."""
PURPOSE = "A plan"

_ODD_LETTER = "\N{REPLACEMENT CHARACTER}"
_ELLIPSIS = "\N{HORIZONTAL ELLIPSIS}"
_LONGEST = 1000
"""Letters that are looked at: no cell holds more."""
_SMALLER = 0.94


class Lettering(NamedTuple):
    """A text in lines, as it fits."""

    lines: tuple[str, ...]
    size: float
    """Of the letters, millimetres."""
    is_cut: bool
    """Whether the end is left out."""


def clean_text(text: str) -> str:
    r"""Return a text on one line, without letters that no file may hold.

    Examples
    --------
    >>> clean_text(" Two\n lines\x00")
    'Two lines\ufffd'
    """
    plain = "".join(_ODD_LETTER if _is_odd(letter) else letter for letter in text)
    return " ".join(plain.split())


def _is_odd(letter: str) -> bool:
    """Whether XML takes a letter for an error: a control character or half a pair."""
    if letter.isspace() and letter not in "\x1c\x1d\x1e\x1f\x0b\x0c":
        return False
    return unicodedata.category(letter) in ("Cc", "Cs") or letter in "\ufffe\uffff"


class _Font(NamedTuple):
    """What is read of a font file: glyphs of letters, how far they move on, units of an em."""

    glyphs: dict[int, str]
    advances: Any
    units: float


@lru_cache(maxsize=1)
def _load_font() -> _Font:
    manager = optional.load("matplotlib.font_manager", PURPOSE)
    path = manager.findfont(manager.FontProperties(family=[FONT]))
    font = optional.load("fontTools.ttLib", PURPOSE).TTFont(path)
    return _Font(font.getBestCmap(), font["hmtx"], float(font["head"].unitsPerEm))


@lru_cache(maxsize=4096)
def _measure_letter(letter: str) -> float:
    """Return how far a letter moves on, as a share of the size."""
    font = _load_font()
    return float(font.advances[font.glyphs.get(ord(letter), ".notdef")][0]) / font.units


def measure_text(text: str, size: float) -> float:
    """Return the width of a text on one line, millimetres; pairs of letters are not drawn nearer.

    Examples
    --------
    >>> round(measure_text("318.5", 2.0), 2)
    5.73
    """
    return size * sum(map(_measure_letter, text))


def find_missing_letters(text: str) -> str:
    """Return the letters that the font does not have, each once.

    Examples
    --------
    >>> find_missing_letters("Plan \N{CJK UNIFIED IDEOGRAPH-56F3}")
    '\u56f3'
    """
    known = _load_font().glyphs
    return "".join(
        sorted({letter for letter in text if ord(letter) not in known and letter != " "})
    )


def fit_text(text: str, width: float, *, size: float, least: float, lines: int = 1) -> Lettering:
    """Return a text in at most so many lines, smaller if needed, cut where that is not enough.

    The text is clean; ``width`` is the room for a line, ``size`` that of letters if there is room,
    and ``least`` the smallest that is read, millimetres.

    Examples
    --------
    >>> fit_text("Site plan", 50.0, size=4.0, least=2.0)
    Lettering(lines=('Site plan',), size=4.0, is_cut=False)
    """
    is_long = len(text) > _LONGEST
    text = text[:_LONGEST]
    while True:
        wrapped = _wrap(text, width, size)
        if len(wrapped) <= lines and not is_long:
            return Lettering(tuple(wrapped), size, is_cut=False)
        if size <= least:
            break
        size = max(_SMALLER * size, least)
    kept = wrapped[:lines]
    while kept[-1] and measure_text(kept[-1] + _ELLIPSIS, size) > width:
        kept[-1] = kept[-1][:-1]
    return Lettering((*kept[:-1], kept[-1].rstrip() + _ELLIPSIS), size, is_cut=True)


def _wrap(text: str, width: float, size: float) -> list[str]:
    """Break a text between words, and words that are too long between letters."""
    lines = [""]
    for word in text.split(" "):
        longer = f"{lines[-1]} {word}".strip()
        if measure_text(longer, size) <= width:
            lines[-1] = longer
            continue
        if lines[-1]:
            lines.append("")
        for letter in word:
            if lines[-1] and measure_text(lines[-1] + letter, size) > width:
                lines.append("")
            lines[-1] += letter
    return lines
