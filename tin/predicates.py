"""Exact signs of the plane predicates for whole arrays, in numpy alone.

A second, independent implementation of what the compiled core decides, for proofs. Two stages:
plain doubles with Shewchuk's error bound [1]_ decide nearly all rows; for the others the
differences of the coordinates become integers of several limbs (digits to base 2^28), as many
as their size asks for, on which the determinant is evaluated without any rounding.

Exact for coordinates that are 0 or of a magnitude in ``EXACT_RANGE``: a product of four
differences then stays among normal doubles, and 18 limbs hold every difference.

References
----------
.. [1] J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
   Predicates, Discrete & Computational Geometry 18 (1997), doi:10.1007/PL00009321.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ..base.arrays import (
        AnyArray,
        BoolArray,
        Float64Array,
        Int8Array,
        Int32Array,
        Int64Array,
    )

EXACT_RANGE = (2.0**-200, 2.0**250)
"""Smallest (but 0) and largest magnitude of a coordinate for which the signs are exact."""

LARGEST_ELEVATION = 1e300
"""Magnitude that an elevation may have: sums and differences of some are finite."""

Columns = tuple["Float64Array", "Float64Array"]
"""Eastings and northings, each contiguous."""

_BLOCK = 1 << 14  # rows at a time: temporary arrays stay in the processor's cache
_UNIT_ROUNDOFF = 2.0**-53
ORIENTATION_BOUND = (3 + 16 * _UNIT_ROUNDOFF) * _UNIT_ROUNDOFF
"""Of the error of a turn in doubles, relative to the sizes of its two products."""

_FALL_BOUND = 8 * _UNIT_ROUNDOFF
"""Of the error of a fall in doubles, relative to its products: three factors rounded, and sums."""

_IN_CIRCLE_BOUND = (10 + 96 * _UNIT_ROUNDOFF) * _UNIT_ROUNDOFF

# Limbs of 28 bits: with 18 of them a sum of 36 products of limbs below 2^29 fits 63 bits.
_LIMB_BITS = 28
_LIMB_MASK = (1 << _LIMB_BITS) - 1

_MANTISSA_BITS = 52
_EXPONENT_BIAS = 1023


def columns(points: Float64Array) -> Columns:
    """Take the eastings and northings out of (n, 3) points."""
    return np.ascontiguousarray(points[:, 0]), np.ascontiguousarray(points[:, 1])


def blocks(count: int) -> Iterator[slice]:
    """Cut ``count`` rows into slices that fit the processor's cache."""
    for start in range(0, count, _BLOCK):
        yield slice(start, min(start + _BLOCK, count))


def orientation(xy: Columns, a: AnyArray, b: AnyArray, c: AnyArray) -> Int8Array:
    """Tell on which side of the line from ``a`` to ``b`` every ``c`` lies, all by vertex numbers.

    Returns (k,) int8 signs: +1 left, -1 right, 0 on the line.
    """
    signs = np.empty(len(a), np.int8)
    for block in blocks(len(a)):
        (ax, ay), (bx, by), (cx, cy) = (
            _gather_coordinates(xy, corner[block]) for corner in (a, b, c)
        )
        left = (ax - cx) * (by - cy)
        right = (ay - cy) * (bx - cx)
        bound = ORIENTATION_BOUND * (np.abs(left) + np.abs(right))
        terms = ((ax, cx), (ay, cy), (bx, cx), (by, cy))
        signs[block] = _decide(left - right, bound, terms, _decide_cross)
    return signs


def in_circle(xy: Columns, a: AnyArray, b: AnyArray, c: AnyArray, d: AnyArray) -> Int8Array:
    """Tell whether every ``d`` lies in the circle through counter-clockwise ``a``, ``b``, ``c``.

    Returns (k,) int8 signs: +1 inside, -1 outside, 0 on the circle.
    """
    signs = np.empty(len(a), np.int8)
    for block in blocks(len(a)):
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = (
            _gather_coordinates(xy, corner[block]) for corner in (a, b, c, d)
        )
        value = permanent = np.zeros(())  # permanent: the same with all terms positive
        corners = [(x - dx, y - dy) for x, y in ((ax, ay), (bx, by), (cx, cy))]
        for k in range(3):
            (x, y), (px, py), (qx, qy) = corners[k:] + corners[:k]
            lift = x * x + y * y
            left, right = px * qy, qx * py
            value = value + lift * (left - right)
            permanent = permanent + lift * (np.abs(left) + np.abs(right))
        terms = ((ax, dx), (ay, dy), (bx, dx), (by, dy), (cx, dx), (cy, dy))
        signs[block] = _decide(value, _IN_CIRCLE_BOUND * permanent, terms, _decide_in_circle)
    return signs


def falls_across(
    points: Float64Array, triangles: Int32Array
) -> tuple[Int8Array, Float64Array, Float64Array]:
    """Tell whether triangles fall across their edges, each opposite a corner, all (m, 3).

    Triangles are counter-clockwise, of (n, 3) points whose elevations are of a magnitude in
    ``EXACT_RANGE``, too, or 0. Returns exact signs: +1 if the steepest descent leaves the triangle
    across the edge, -1 if it enters there, 0 if it runs along the edge, or the plane is level; then
    descent times the length of the edge, times twice the area, rounded, and bounds of the error of
    these.
    """
    signs = np.empty(triangles.shape, np.int8)
    values, bounds = np.empty(triangles.shape), np.empty(triangles.shape)
    x, y, z = (np.ascontiguousarray(axis) for axis in points.T)
    for block in blocks(len(triangles)):
        vertices = np.ascontiguousarray(triangles[block].T, np.int64)
        corners = list(zip(*(axis.take(vertices) for axis in (x, y, z)), strict=True))
        for k in range(3):
            (cx, cy, cz), (ax, ay, az), (bx, by, bz) = corners[k:] + corners[:k]
            ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
            square = ux * ux + uy * uy
            value = vz * square - uz * (ux * vx + uy * vy)
            bound = np.abs(vz) * square + np.abs(uz) * (np.abs(ux * vx) + np.abs(uy * vy))
            bound *= _FALL_BOUND
            terms = ((bx, ax), (by, ay), (bz, az), (cx, ax), (cy, ay), (cz, az))
            # Where all products are 0, so is the value: within the range none underflows.
            decided = _decide(value, np.where(bound == 0.0, -1.0, bound), terms, _decide_fall)
            signs[block, k], values[block, k], bounds[block, k] = decided, value, bound
    return signs, values, bounds


def is_last(xy: Columns, p: AnyArray, q: AnyArray) -> BoolArray:
    """Tell whether vertex ``p`` comes after ``q`` by easting, then northing."""
    x, y = xy
    after: BoolArray = (x[p] > x[q]) | ((x[p] == x[q]) & (y[p] > y[q]))
    return after


def _gather_coordinates(xy: Columns, vertices: AnyArray) -> Columns:
    return xy[0].take(vertices), xy[1].take(vertices)


# -------------------------------------------------------------------- doubles


def _decide(
    value: Float64Array,
    bound: Float64Array,
    terms: tuple[tuple[Float64Array, Float64Array], ...],
    exact_sign: Callable[[Int64Array], Int8Array],
) -> Int8Array:
    """Take the sign of the rounded value where the bound allows, else decide exactly.

    ``terms`` are the pairs of coordinates whose differences the exact determinant is made of.
    """
    signs = np.sign(value).astype(np.int8)
    open_rows = np.flatnonzero(np.abs(value) <= bound)
    if len(open_rows):
        signs[open_rows] = _decide_exactly(
            np.stack([minuend[open_rows] for minuend, _ in terms]),
            np.stack([subtrahend[open_rows] for _, subtrahend in terms]),
            exact_sign,
        )
    return signs


# -------------------------------------------------------------------- limbs


def _decide_exactly(
    minuends: Float64Array,
    subtrahends: Float64Array,
    exact_sign: Callable[[Int64Array], Int8Array],
) -> Int8Array:
    """Decide rows on the integers that their (terms, rows) differences are multiples of."""
    # the rounded difference and what the rounding left out (Knuth's two-sum)
    high = minuends - subtrahends
    b_part = minuends - high
    a_part = high + b_part
    low = (b_part - subtrahends) + (minuends - a_part)
    unit = np.minimum(_find_lowest_bit(high), _find_lowest_bit(low)).min(axis=0)
    limbs = (_find_top_bit(high).max(axis=0) - unit) // _LIMB_BITS + 1
    limbs[~high.any(axis=0)] = 1
    signs = np.empty(len(unit), np.int8)
    for count in np.unique(limbs):
        rows = np.flatnonzero(limbs == count)
        numbers = _split(high[:, rows], unit[rows], int(count))
        if low[:, rows].any():
            numbers += _split(low[:, rows], unit[rows], int(count))
        signs[rows] = exact_sign(numbers)
    return signs


_NO_BIT = np.int64(1 << 20)


def _find_top_bit(values: Float64Array) -> Int64Array:
    """Return the exponent of the highest bit of each double."""
    return ((values.view(np.int64) >> _MANTISSA_BITS) & 0x7FF) - _EXPONENT_BIAS


def _find_lowest_bit(values: Float64Array) -> Int64Array:
    """Return the exponent of the lowest bit that is set in each double, a large one for 0."""
    mantissa = values.view(np.int64) & ((1 << _MANTISSA_BITS) - 1) | (1 << _MANTISSA_BITS)
    place = _find_top_bit((mantissa & -mantissa).astype(np.float64)) - _MANTISSA_BITS
    return np.where(values == 0.0, _NO_BIT, _find_top_bit(values) + place)


def _split(values: Float64Array, unit: Int64Array, count: int) -> Int64Array:
    """Return ``values / 2^unit`` as integers of ``count`` limbs, (terms, count, rows).

    Limbs have the sign of their number, lowest first, magnitudes below 2^28.
    """
    scaled = np.ldexp(values, -unit)
    limbs = np.empty((len(values), count, values.shape[1]), np.int64)
    for place in range(count - 1, -1, -1):
        weight = 2.0 ** (_LIMB_BITS * place)
        digit = np.trunc(scaled / weight)
        scaled -= digit * weight
        limbs[:, place] = digit
    return limbs


def _decide_cross(numbers: Int64Array) -> Int8Array:
    acx, acy, bcx, bcy = numbers
    return _find_sign(_multiply(acx, bcy) - _multiply(acy, bcx))


def _decide_in_circle(numbers: Int64Array) -> Int8Array:
    adx, ady, bdx, bdy, cdx, cdy = numbers
    a_term = _multiply(_lift(adx, ady), _multiply_crosswise(bdx, bdy, cdx, cdy))
    b_term = _multiply(_lift(bdx, bdy), _multiply_crosswise(cdx, cdy, adx, ady))
    c_term = _multiply(_lift(cdx, cdy), _multiply_crosswise(adx, ady, bdx, bdy))
    return _find_sign(a_term + b_term + c_term)


def _decide_fall(numbers: Int64Array) -> Int8Array:
    ux, uy, uz, vx, vy, vz = numbers
    along = _carry(_multiply(ux, vx) + _multiply(uy, vy))
    return _find_sign(_multiply(vz, _carry(_lift(ux, uy))) - _multiply(uz, along))


def _lift(x: Int64Array, y: Int64Array) -> Int64Array:
    return _multiply(x, x) + _multiply(y, y)


def _multiply_crosswise(
    px: Int64Array,
    py: Int64Array,
    qx: Int64Array,
    qy: Int64Array,
) -> Int64Array:
    return _multiply(px, qy) - _multiply(qx, py)


def _multiply(a: Int64Array, b: Int64Array) -> Int64Array:
    """Multiply (limbs, rows) integers; the product is carried."""
    product = np.zeros((len(a) + len(b), a.shape[1]), np.int64)
    for place, limb in enumerate(a):
        product[place : place + len(b)] += limb * b
    return _carry(product)


def _carry(number: Int64Array) -> Int64Array:
    """Bring all limbs but the highest into 0 to 2^28, in place; the highest bears the sign."""
    for lower, higher in pairwise(number):
        higher += lower >> _LIMB_BITS
        lower &= _LIMB_MASK
    return number


def _find_sign(number: Int64Array) -> Int8Array:
    _carry(number)
    return np.where(number[-1] < 0, -1, number.any(axis=0)).astype(np.int8)
