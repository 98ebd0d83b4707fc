"""Sums of products of doubles without any rounding."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array

_DIGITS = 53
_LOW_DIGITS = 26
_SPLITTER = 2.0**27 + 1.0
_MOST_AT_ONCE = 2**20
"""So many parts of 28 bits add up within the digits of a double."""


class ExactSum:
    """A sum of doubles as a whole number of 2^-1200: added in any order it is the same."""

    _UNIT = 1200

    def __init__(self) -> None:
        self._total = 0

    @property
    def value(self) -> Fraction:
        """The sum."""
        return Fraction(self._total, 1 << self._UNIT)

    def add(self, values: Float64Array) -> None:
        """Add finite doubles.

        Their whole numbers of units in the last place are summed for each exponent, the upper and
        the lower half by itself.
        """
        for begin in range(0, len(values), _MOST_AT_ONCE):
            part = values[begin : begin + _MOST_AT_ONCE]
            share, exponents = np.frexp(part[part != 0.0])
            if not len(share):
                continue
            whole = np.ldexp(share, _DIGITS).astype(np.int64)
            least = int(exponents.min())
            for half, shift in (
                (whole >> _LOW_DIGITS, _LOW_DIGITS),
                (whole & ((1 << _LOW_DIGITS) - 1), 0),
            ):
                sums = np.bincount(exponents - least, weights=half.astype(np.float64))
                for above, one in enumerate(sums.tolist()):
                    self._total += int(one) << (self._UNIT + least + above - _DIGITS + shift)

    def add_products(self, a: Float64Array, b: Float64Array) -> None:
        """Add products, each the sum of two doubles.

        References
        ----------
        .. T. J. Dekker, A floating-point technique for extending the available precision,
           Numerische Mathematik 18 (1971), doi:10.1007/BF01397083.
        """
        product = a * b
        a_high, b_high = _take_high(a), _take_high(b)
        a_low, b_low = a - a_high, b - b_high
        rest = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
        self.add(product)
        self.add(rest)


def _take_high(values: Float64Array) -> Float64Array:
    big = _SPLITTER * values
    return big - (big - values)


def add_doubled_areas(into: ExactSum, points: Float64Array, start: AnyArray, end: AnyArray) -> None:
    """Add twice the area on the left of edges, to the origin; of closed rings what they enclose."""
    x, y = points[:, 0], points[:, 1]
    into.add_products(x[start], y[end])
    into.add_products(-x[end], y[start])
