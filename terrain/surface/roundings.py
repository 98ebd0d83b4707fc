"""Rounding: how closely coordinates are known, and what products lose by it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array

_DECIMALS = range(3, 10)
"""Coordinates with fewer, such as whole numbers, are taken as they are."""
_SPACINGS = 4.0
"""Spacings of floating point numbers: what a few operations leave."""


_MEANINGFUL = 16.0
"""Spacings: a last decimal below is one that every number of this size has."""

_SPLITTER = 2.0**27 + 1
"""Dekker's: cuts a double into two halves of 26 bits."""


def find_rounding(xy: Float64Array) -> float:
    """Return how far from the places meant coordinates, (n, 2), may lie because of their rounding.

    Half a unit of the last decimal in either direction, if all of them are written with so few
    decimals, from 3 to 9; at least a few spacings of floating point numbers of their size.
    """
    return max(find_written_rounding(xy), _SPACINGS * _find_spacing(xy))


def find_written_rounding(xy: Float64Array) -> float:
    """Return the same for coordinates that are taken as they are unless decimals tell more."""
    if (np.round(xy, _DECIMALS[0] - 1) == xy).all():
        return 0.0
    decimals = next((n for n in _DECIMALS if (np.round(xy, n) == xy).all()), None)
    if decimals is None or 10.0**-decimals < _MEANINGFUL * _find_spacing(xy):
        return 0.0
    return float(np.hypot(0.5, 0.5)) * 10.0**-decimals


def _find_spacing(xy: Float64Array) -> float:
    return float(np.spacing(np.abs(xy).max(initial=1.0)))


def multiply_exactly(a: Float64Array, b: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Return products, and what these are short of the true ones."""
    product = a * b
    (p, q), (r, s) = _split(a), _split(b)
    return product, q * s - (((product - p * r) - q * r) - p * s)


def _split(value: Float64Array) -> tuple[Float64Array, Float64Array]:
    scaled = _SPLITTER * value
    high = scaled - (scaled - value)
    return high, value - high
