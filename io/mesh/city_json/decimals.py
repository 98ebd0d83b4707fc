"""Decimal grids: whole numbers that stand for coordinates, and the coordinates back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array

__all__ = ["DecimalGrid", "choose_digits"]

_MOST_DIGITS = 15
_LARGEST_EXACT = 2.0**53


@dataclass(frozen=True)
class DecimalGrid:
    """Places at a whole number of steps from an origin."""

    digits: int
    """Decimals: the step is 10 to the power of minus this."""
    origin: int
    """In whole units."""

    @property
    def step(self) -> float:
        """Distance of two neighbours."""
        return float(f"1e-{self.digits}")

    def count(self, values: Float64Array) -> Int64Array:
        """Return the nearest place of each value."""
        return np.asarray(np.rint((values - self.origin) * 10.0**self.digits), np.int64)

    def restore(self, counts: Int64Array) -> Float64Array:
        """Return the decimals, each rounded once to the nearest float64."""
        whole = counts.astype(np.float64) + self.origin * 10.0**self.digits
        return np.asarray(whole / 10.0**self.digits)


def choose_digits(values: Float64Array) -> int:
    """Return the fewest decimals that hold every value; else those at which float64 ends.

    Examples
    --------
    >>> choose_digits(np.array([745000.25, 1.5]))
    2
    """
    largest = float(np.abs(values).max(initial=1.0))
    most = int(np.clip(np.floor(np.log10(_LARGEST_EXACT / max(largest, 1.0))), 0, _MOST_DIGITS))
    for digits in range(most):
        factor = 10.0**digits
        if (np.rint(values * factor) / factor == values).all():
            return digits
    return most
