"""Slips of the pen: a number that is right but for a factor that people and programs mistake."""

from __future__ import annotations

__all__ = ["FACTORS", "name_factor"]

FACTORS = {
    10.0: "ten times",
    0.1: "a tenth of",
    100.0: "a hundred times",
    0.01: "a hundredth of",
    1 / 0.3048: "1 / 0.3048 times (feet for metres)",
    0.3048: "0.3048 times (metres for feet)",
    -1.0: "minus",
}
"""What a number may be of the one that was meant, and how it is said."""

_SHARE = 0.1
"""The factor must explain all but so much of what is wrong."""


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
