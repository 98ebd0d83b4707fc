"""Mean and standard deviation of weighted values, from sums that are exact."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel
from ..surface import multiply_exactly

if TYPE_CHECKING:
    from ...base.arrays import Float64Array


def list_terms(values: Float64Array, weights: Float64Array) -> Float64Array:
    """Return the sums of weights, of weighted values and of weighted squares, (3, t).

    Each as doubles that add up to it, exactly: products are split into what is rounded and the
    rest, which a double holds for values that are no smaller than some 1e-140.
    """
    first, rest = multiply_exactly(values, weights)
    second = [*multiply_exactly(first, values), *multiply_exactly(rest, values)]
    rows = ([weights], [first, rest], second)
    return np.concatenate([_kernel.merge_terms(np.concatenate(row)[None, :]) for row in rows])


def merge_terms(one: Float64Array, other: Float64Array) -> Float64Array:
    """Return the sums of two parts together."""
    return _kernel.merge_terms(np.concatenate([one, other], axis=1))


def summarise(terms: Float64Array) -> tuple[float, float, float]:
    """Return the whole weight, the mean and the standard deviation; NaN without any weight."""
    if not np.isfinite(terms).all():
        return math.nan, math.nan, math.nan
    whole, first, second = (sum(map(Fraction, row.tolist()), Fraction(0)) for row in terms)
    if not whole:
        return 0.0, math.nan, math.nan
    variance = max(Fraction(0), (second * whole - first * first) / (whole * whole))
    return float(whole), float(first / whole), math.sqrt(variance)
