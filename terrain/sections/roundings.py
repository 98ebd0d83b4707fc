"""How closely coordinates are known: as far as their last decimal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...arrays import Float64Array

__all__ = ["find_rounding"]

_DECIMALS = range(3, 10)
"""Coordinates with fewer, such as whole numbers, are taken as they are."""
_SPACINGS = 4.0
"""Spacings of floating point numbers: what a few operations leave."""


def find_rounding(xy: Float64Array) -> float:
    """Return how far from the places meant coordinates, (n, 2), may lie because of their rounding.

    Half a unit of the last decimal in either direction, if all of them are written with so few
    decimals, from 3 to 9; at least a few spacings of floating point numbers of their size.
    """
    least = _SPACINGS * float(np.spacing(np.abs(xy).max(initial=1.0)))
    if (np.round(xy, _DECIMALS[0] - 1) == xy).all():
        return least
    decimals = next((n for n in _DECIMALS if (np.round(xy, n) == xy).all()), None)
    return least if decimals is None else max(float(np.hypot(0.5, 0.5)) * 10.0**-decimals, least)
