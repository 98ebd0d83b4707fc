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
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ...base.georeference import Referenced
    from ...tin import TIN

SYMBOLS = {"degrees": "°", "percent": "%", "ratio": ""}
"""What stands behind a slope; nothing for a ratio."""

_PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)


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
    tin: TIN, *, unit: SlopeUnit = "degrees", percentiles: ArrayLike = _PERCENTILES
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
    Area, mean and standard deviation come from exact sums, rounded once: the same for any order of
    triangles.

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
    found = find_weighted_percentiles(values, weights, shares)
    measured |= {f"p{share:g}": value for share, value in zip(shares, found, strict=True)}
    return as_table(measured, unit, tin)


def as_table(measured: Mapping[str, float], unit: SlopeUnit, surface: Referenced) -> Table:
    """Return the area and slopes of a surface as a table of one row."""
    symbols = dict.fromkeys(measured, SYMBOLS[unit] or "ratio")
    return Table(
        {name: np.array([value]) for name, value in measured.items()},
        units={**symbols, "area": find_plane_units(surface.crs).area},
        name="slope_statistics",
        notes=describe_unknown(surface.crs, surface.elevation_unit),
    )


def find_weighted_percentiles(
    values: Float64Array, weights: Float64Array, shares: Float64Array
) -> Float64Array:
    """Return the least values that so many percent of the weight do not exceed.

    Examples
    --------
    >>> weights, shares = np.array([3.0, 1.0]), np.array([75.0, 76.0])
    >>> find_weighted_percentiles(np.array([1.0, 2.0]), weights, shares)
    array([1., 2.])
    """
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order])
    wanted = shares / 100.0 * reached[-1]
    places = np.minimum(np.searchsorted(reached, wanted), len(values) - 1)
    found: Float64Array = values[order][places]
    return found
