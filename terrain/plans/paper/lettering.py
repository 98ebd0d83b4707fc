"""Lettering: how wide texts are, how they are made to fit, and where they have room."""

from __future__ import annotations

import unicodedata
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ... import drawing
from ..windows import turn

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import Float64Array
    from ....tin import Bounds
    from ...drawing import Lettering

FONT = "DejaVu Sans"
"""Comes with matplotlib, and is embedded in a PDF."""
PURPOSE = "A plan"
CAPITAL = 0.73
"""Height of capitals and digits by the size of letters."""

_ODD_LETTER = "\N{REPLACEMENT CHARACTER}"
_SMALLER = 0.94

_CELL = 8.0
"""Millimetres; a text is looked for in the cells that it covers."""


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
    return drawing.fit_text(text, width, _list_sizes(size, least), measure_text, lines=lines)


def _list_sizes(size: float, least: float) -> Iterator[float]:
    while size > least:
        yield size
        size *= _SMALLER
    yield least


def outline_text(
    center: tuple[float, float], width: float, height: float, rotation: float = 0.0
) -> Float64Array:
    """Return the corners of the rectangle around a text, (4, 2)."""
    half = np.array([(-width, -height), (width, -height), (width, height), (-width, height)]) / 2
    corners: Float64Array = turn(half, rotation) + np.asarray(center)
    return corners


class Room:
    """What is left of a frame for texts."""

    def __init__(self, frame: Bounds) -> None:
        self._frame = frame
        self._taken: dict[tuple[int, int], list[Float64Array]] = {}

    def take(self, corners: Float64Array) -> bool:
        """Take the room of a text, unless it leaves the frame or meets another one."""
        low, high = corners.min(axis=0), corners.max(axis=0)
        frame = self._frame
        if not (frame.xmin <= low[0] and high[0] <= frame.xmax):
            return False
        if not (frame.ymin <= low[1] and high[1] <= frame.ymax):
            return False
        cells = _list_cells(corners)
        if any(_overlap(corners, other) for cell in cells for other in self._taken.get(cell, ())):
            return False
        self.occupy(corners)
        return True

    def occupy(self, corners: Float64Array) -> None:
        """Leave a rectangle to what is drawn there, whatever it meets."""
        for cell in _list_cells(corners):
            self._taken.setdefault(cell, []).append(corners)


def _list_cells(corners: Float64Array) -> list[tuple[int, int]]:
    ends = (corners.min(axis=0), corners.max(axis=0))
    (left, bottom), (right, top) = ((one // _CELL).astype(int).tolist() for one in ends)
    return [(i, j) for i in range(left, right + 1) for j in range(bottom, top + 1)]


def _overlap(one: Float64Array, other: Float64Array) -> bool:
    """Tell whether two rectangles overlap: no side of either parts them."""
    for sides in (one, other):
        for across in (sides[1] - sides[0], sides[3] - sides[0]):
            first, second = one @ across, other @ across
            if first.max() <= second.min() or second.max() <= first.min():
                return False
    return True
