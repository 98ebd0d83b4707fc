"""Statistics of the slope, weighted by area, from sums that are exact."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from ...base.checks import as_percentages
from ...base.errors import choice
from ...base.georeference import describe_unknown, find_plane_units
from ...base.policies import SlopeUnit
from ...base.products import product
from ...base.results import Table
from .. import _kernel
from ..surface import compute_normals, measure_slopes, multiply_exactly

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, UInt64Array
    from ...base.georeference import Referenced
    from ...tin import TIN

SYMBOLS = {"degrees": "°", "percent": "%", "ratio": ""}
"""What stands behind a slope; nothing for a ratio."""

PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)
"""Shares of the area, where none are asked for."""


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


@product
def slope_statistics(
    tin: TIN, *, unit: SlopeUnit = "degrees", percentiles: ArrayLike = PERCENTILES
) -> Table:
    """Summarise the slope of a surface, every triangle weighted by its area in the plane.

    Parameters
    ----------
    tin : TIN
    unit : {"degrees", "percent", "ratio"}, optional
    percentiles : sequence of float, optional
        Shares of the area, 0 to 100.

    Returns
    -------
    Table
        One row: ``area``, ``minimum``, ``mean``, ``standard deviation``, ``maximum``, and for each
        percentile ``p50`` the least slope that so much of the area does not exceed.

    Raises
    ------
    OptionError
        If the unit is another, or percentiles are not from 0 to 100.

    Notes
    -----
    Area, mean and standard deviation come from exact sums, rounded once; for percentiles areas are
    whole numbers of some 2^-52 of all. So all are the same for any order of triangles.

    Examples
    --------
    >>> import tinsmith as ts
    >>> roof = [[0, 0, 0], [4, 0, 3], [4, 4, 3], [0, 4, 0], [9, 0, 3], [9, 4, 3]]
    >>> table = ts.slope_statistics(ts.triangulate(roof), unit="percent", percentiles=[50, 90])
    >>> table["mean"].round(2), table["p50"], table["p90"]
    (array([33.33]), array([0.]), array([75.]))
    """
    choice("unit", unit, SlopeUnit)
    shares = as_percentages("percentiles", percentiles)
    normals = compute_normals(tin)
    values, weights = measure_slopes(normals, unit), 0.5 * normals[:, 2]
    area, mean, deviation = summarise(list_terms(values, weights))
    measured = {
        "area": area,
        "minimum": values.min(),
        "mean": mean,
        "standard deviation": deviation,
        "maximum": values.max(),
    }
    found = find_weighted_percentiles(values, weights, shares, area)
    measured |= name_percentiles(shares, found)
    return as_table(measured, unit, tin)


def name_percentiles(shares: Float64Array, values: Float64Array) -> dict[str, float]:
    """Return percentiles by the names of their columns."""
    return {
        f"p{share:g}": value for share, value in zip(shares.tolist(), values.tolist(), strict=True)
    }


def as_table(measured: Mapping[str, float], unit: SlopeUnit, surface: Referenced) -> Table:
    """Return the area and slopes of a surface as a table of one row."""
    symbols = dict.fromkeys(measured, SYMBOLS[unit] or "ratio")
    return Table(
        {name: np.array([value]) for name, value in measured.items()},
        units={**symbols, "area": find_plane_units(surface.crs).area},
        name="slope_statistics",
        notes=describe_unknown(surface.crs, surface.elevation_unit),
    )


def weigh(weights: Float64Array, whole: float) -> Float64Array:
    """Return weights as whole numbers of some 2^-52 of all, whose sums are never rounded."""
    unit = math.frexp(whole)[1] - 52 if math.isfinite(whole) else 0
    return np.rint(np.ldexp(weights, -unit))


def find_weighted_percentiles(
    values: Float64Array, weights: Float64Array, shares: Float64Array, whole: float
) -> Float64Array:
    """Return the least values that so many percent of the weight do not exceed.

    Parameters
    ----------
    values, weights : (n,) float64 array
    shares : (k,) float64 array
    whole : float
        Sum of the weights.

    Examples
    --------
    >>> weights, shares = np.array([3.0, 1.0]), np.array([75.0, 76.0])
    >>> find_weighted_percentiles(np.array([1.0, 2.0]), weights, shares, 4.0)
    array([1., 2.])
    """
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weigh(weights, whole)[order])
    wanted = shares / 100.0 * reached[-1]
    places = np.minimum(np.searchsorted(reached, wanted), len(values) - 1)
    found: Float64Array = values[order][places]
    return found


_BITS = 16
"""Of a double that are told apart in a pass over all values."""


def select_weighted_percentiles(
    load: Callable[[], Iterable[tuple[Float64Array, Float64Array]]],
    shares: Float64Array,
    whole: float,
) -> Float64Array:
    """Return the same of values of several parts, which are never in memory together.

    Bits of the results are found from the first on, 16 in each of four passes over all parts: by
    the weights of the values that have those before, and each of the next 16 (radix selection).

    Parameters
    ----------
    load : callable
        Yields the values, not negative, and the weights of each part.
    shares : (k,) float64 array
    whole : float
        Sum of all weights.
    """
    found = np.zeros(len(shares), np.uint64)
    below = np.zeros(len(shares))
    wanted = None
    for shift in range(64 - _BITS, -1, -_BITS):
        counts = np.zeros((2, len(shares), 1 << _BITS))  # of weights, and of values
        for values, weights in load():
            keys, weighed = (values + 0.0).view(np.uint64), weigh(weights, whole)
            place = (keys >> np.uint64(shift)).astype(np.int64) & ((1 << _BITS) - 1)
            for k, prefix in enumerate(found):
                is_met = _find_same(keys, prefix, shift + _BITS)
                if not is_met.any():
                    continue
                for row, weight in enumerate((weighed, None)):
                    chosen = None if weight is None else weight[is_met]
                    counts[row, k] += np.bincount(place[is_met], chosen, 1 << _BITS)
        if wanted is None:
            wanted = shares / 100.0 * counts[0].sum(axis=1)
        reached = below[:, None] + np.cumsum(counts[0], axis=1)
        is_enough = (reached >= wanted[:, None]) & (counts[1] > 0)
        last = (1 << _BITS) - 1 - np.argmax(counts[1, :, ::-1] > 0, axis=1)
        chosen = np.where(is_enough.any(axis=1), np.argmax(is_enough, axis=1), last)
        rows = np.arange(len(shares))
        below = reached[rows, chosen] - counts[0, rows, chosen]
        found |= chosen.astype(np.uint64) << np.uint64(shift)
    return found.view(np.float64)


def _find_same(keys: UInt64Array, prefix: np.uint64, shift: int) -> BoolArray:
    """Tell which keys have the bits of a prefix from a place on; all where there are none."""
    if shift == 64:
        return np.ones(len(keys), np.bool_)
    found: BoolArray = keys >> np.uint64(shift) == prefix >> np.uint64(shift)
    return found
