"""Mean and standard deviation of weighted values, from sums that are exact."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel

if TYPE_CHECKING:
    from ...base.arrays import Float64Array

_SPLITTER = 2.0**27 + 1
"""Dekker's: cuts a double into two halves of 26 bits."""


def list_terms(values: Float64Array, weights: Float64Array) -> Float64Array:
    """Return the sums of weights, of weighted values and of weighted squares, (3, t).

    Each as doubles that add up to it, exactly: products are split into what is rounded and the
    rest, which a double holds for values that are no smaller than some 1e-140.
    """
    first, rest = _multiply(values, weights)
    second = [*_multiply(first, values), *_multiply(rest, values)]
    rows = ([weights], [first, rest], second)
    return np.concatenate([_kernel.merge_terms(np.concatenate(row)[None, :]) for row in rows])


def merge_terms(one: Float64Array, other: Float64Array) -> Float64Array:
    """Return the sums of two parts together."""
    return _kernel.merge_terms(np.concatenate([one, other], axis=1))


def _multiply(a: Float64Array, b: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Return products, and what these are short of the true ones."""
    product = a * b
    (p, q), (r, s) = _split(a), _split(b)
    return product, q * s - (((product - p * r) - q * r) - p * s)


def _split(value: Float64Array) -> tuple[Float64Array, Float64Array]:
    scaled = _SPLITTER * value
    high = scaled - (scaled - value)
    return high, value - high


def summarise(terms: Float64Array) -> tuple[float, float, float]:
    """Return the whole weight, the mean and the standard deviation; NaN without any weight."""
    if not np.isfinite(terms).all():
        return math.nan, math.nan, math.nan
    whole, first, second = (sum(map(Fraction, row.tolist()), Fraction(0)) for row in terms)
    if not whole:
        return 0.0, math.nan, math.nan
    variance = max(Fraction(0), (second * whole - first * first) / (whole * whole))
    return float(whole), float(first / whole), math.sqrt(variance)
