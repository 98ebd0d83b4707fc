"""Slips of the pen: a number that is right but for a factor that people and programs mistake."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array

FACTORS = {
    10.0: "ten times",
    0.1: "a tenth of",
    100.0: "a hundred times",
    0.01: "a hundredth of",
    1000.0: "a thousand times (millimetres for metres, or no decimal mark)",
    1 / 0.3048: "1 / 0.3048 times (feet for metres)",
    0.3048: "0.3048 times (metres for feet)",
    -1.0: "minus",
}
"""What a number may be of the one that was meant, and how it is said."""

_SHARE = 0.1
"""The factor must explain all but so much of what is wrong."""
BEYOND = 50_000.0
"""No elevation of the earth is larger, in feet or in metres."""
_GROUPS = {1000.0: FACTORS[1000.0], 0.001: "a thousandth of"}
"""Factors that many elevations may have at a time, as where files in two units are joined."""
_FEWEST = 3
"""So many others at least tell what elevations there are."""
_PAD = 1.0
"""Elevations that were multiplied are right again within so many ranges of the others."""


def name_factor(value: float, expected: float, tolerance: float) -> str | None:
    """Say of which factor a number is off; None if of none.

    Examples
    --------
    >>> name_factor(3204.1, 320.5, 1.0)
    'ten times'
    """
    for factor, words in FACTORS.items():
        rest = abs(value - factor * expected)
        if rest <= max(1.0, abs(factor)) * tolerance and rest <= _SHARE * abs(value - expected):
            return words
    return None


class Multiplied(NamedTuple):
    """Elevations that a factor parts from most of the others."""

    is_wrong: BoolArray
    """(n,)."""
    words: str
    """The factor, for a sentence."""
    lowest: float
    highest: float
    """Of the others."""


def find_multiplied(z: Float64Array) -> Multiplied | None:
    """Find elevations that are a thousand times the others, or a thousandth of them.

    They are fewer than the others, or higher than the earth is; a gap wider than the range of
    either parts them, and the factor brings all of them within the range of the others or beside
    it. None if there are none.

    Examples
    --------
    >>> found = find_multiplied(np.array([512.0, 512.4, 513.1, 512350.0]))
    >>> found.is_wrong.tolist(), found.lowest, found.highest
    ([False, False, False, True], 512.0, 513.1)
    """
    if len(z) == 0 or not _may_be_apart(float(z.min()), float(z.max())):
        return None
    with np.errstate(over="ignore", invalid="ignore"):  # elevations may be as large as doubles are
        return _find_multiplied(z)


def _find_multiplied(z: Float64Array) -> Multiplied | None:
    ordered = np.sort(z)
    at = int(np.argmax(np.diff(ordered))) + 1
    low, high = ordered[:at], ordered[at:]
    is_high = float(high[0]) > BEYOND or (len(high) <= len(low) and not float(-low[-1]) > BEYOND)
    fewer, more = (high, low) if is_high else (low, high)
    gap, widest = float(high[0] - low[-1]), max(float(np.ptp(low)), float(np.ptp(high)))
    if not gap > widest or len(more) < _FEWEST:
        return None
    lowest, highest = float(more[0]), float(more[-1])
    pad = _PAD * (highest - lowest)
    for factor, words in _GROUPS.items():
        with np.errstate(over="ignore"):
            right = fewer / factor
        if (right >= lowest - pad).all() and (right <= highest + pad).all():
            is_wrong: BoolArray = z >= high[0] if is_high else z <= low[-1]
            return Multiplied(is_wrong, words, lowest, highest)
    return None


def _may_be_apart(lowest: float, highest: float) -> bool:
    """Whether two elevations may be a hundred times each other: others need no further look."""
    small, large = sorted((abs(lowest), abs(highest)))
    return (lowest > 0.0) == (highest > 0.0) and 0.0 < 100.0 * small < large
