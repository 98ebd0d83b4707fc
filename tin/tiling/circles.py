"""Circumscribed circles of triangles, with bounds that rounding cannot break."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .boxes import are_in_box

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.types import Bounds

_ROUNDING = 2.0**-53
_TRUSTED = 2.0**-20
"""Relative error of a determinant up to which its double is used."""


class Discs(NamedTuple):
    """Closed discs that hold the closed circumscribed discs of triangles.

    Attributes
    ----------
    centers : (k, 2) float64 array
    radii : (k,) float64 array
        Infinite where a disc is too large for doubles.
    """

    centers: Float64Array
    radii: Float64Array

    def choose(self, which: BoolArray | Int64Array) -> Discs:
        """Return some of them."""
        return Discs(self.centers[which], self.radii[which])

    def are_within(self, box: Bounds) -> BoolArray:
        """Tell which lie in a closed box, for certain."""
        low, high = self.centers - self.radii[:, None], self.centers + self.radii[:, None]
        slack = 4 * _ROUNDING * (np.abs(self.centers) + self.radii[:, None])
        is_within: BoolArray = are_in_box(low - slack, box) & are_in_box(high + slack, box)
        return is_within


def bound_discs(points: Float64Array, triangles: Int32Array) -> Discs:
    """Bound the closed circumscribed disc of each triangle from outside.

    Parameters
    ----------
    points : (n, 2 or more) float64 array
    triangles : (k, 3) int32 array
        None of them flat.

    Notes
    -----
    The centre is the solution of two linear equations. A forward error analysis bounds how far
    the rounded one is off; where the determinant has lost too many digits, as that of a needle,
    both are computed in fractions instead.
    """
    a, b, c = (points[triangles[:, k], :2] for k in range(3))
    bx, by, cx, cy = *(b - a).T, *(c - a).T
    with np.errstate(all="ignore"):
        right, left = bx * cy, by * cx
        cross = right - left
        cross_error = 4 * _ROUNDING * (np.abs(right) + np.abs(left))
        b_square, c_square = bx * bx + by * by, cx * cx + cy * cy
        x, y = cy * b_square - by * c_square, bx * c_square - cx * b_square
        x_error = 10 * _ROUNDING * (np.abs(cy) * b_square + np.abs(by) * c_square)
        y_error = 10 * _ROUNDING * (np.abs(bx) * c_square + np.abs(cx) * b_square)
        x, y = x / (2 * cross), y / (2 * cross)
        divisor = 2 * np.abs(cross) * (1 - 2 * _TRUSTED)
        error = np.hypot(
            (x_error + 2 * np.abs(x) * cross_error) / divisor,
            (y_error + 2 * np.abs(y) * cross_error) / divisor,
        )
        centers = a + np.column_stack([x, y])
        size = np.abs(a).max(axis=1, initial=0.0) + np.hypot(x, y)
        radii = (np.hypot(x, y) + 2 * error + 8 * _ROUNDING * size) * (1 + 8 * _ROUNDING)
        is_trusted = (cross_error <= _TRUSTED * np.abs(cross)) & np.isfinite(radii)
    for k in np.flatnonzero(~is_trusted).tolist():
        centers[k], radii[k] = _bound_exactly(*(one[k].tolist() for one in (a, b, c)))
    return Discs(centers, radii)


def _bound_exactly(*corners: list[float]) -> tuple[tuple[float, float], float]:
    """Return a rounded centre, and a radius around it that is large enough."""
    (ax, ay), *others = [[Fraction(value) for value in corner] for corner in corners]
    (bx, by), (cx, cy) = [(x - ax, y - ay) for x, y in others]
    cross = 2 * (bx * cy - by * cx)
    b_square, c_square = bx * bx + by * by, cx * cx + cy * cy
    x = (cy * b_square - by * c_square) / cross
    y = (bx * c_square - cx * b_square) / cross
    try:
        center = float(ax + x), float(ay + y)
        off = abs(ax + x - Fraction(center[0])) + abs(ay + y - Fraction(center[1]))
        radius = float((_find_root_above(x * x + y * y) + off) * (1 + Fraction(1, 2**50)))
    except OverflowError:
        return (0.0, 0.0), np.inf
    return center, radius


def _find_root_above(square: Fraction) -> Fraction:
    """Return a number that is no smaller than the square root, by a relative 2^-60 at most."""
    shift = max(0, 120 - square.numerator.bit_length() + square.denominator.bit_length()) // 2
    whole = -((-square.numerator << (2 * shift)) // square.denominator)
    return Fraction(isqrt(whole) + 1, 1 << shift)
