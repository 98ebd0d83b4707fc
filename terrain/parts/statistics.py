"""Statistics of the slope, tile by tile: exact sums, and the slopes of which some are selected."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..relief import (
    PERCENTILES,
    list_terms,
    merge_terms,
    name_percentiles,
    select_weighted_percentiles,
    summarise,
)
from ..surface import compute_normals, measure_slopes
from .surfaces import are_owned_triangles, as_surface

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ...base.crs import CRS, Unit
    from ...base.policies import SlopeUnit
    from ...base.types import Bounds
    from ...tin.tiling import LocalTriangulation


class StatisticsOptions(NamedTuple):
    """As the arguments of :func:`tinsmith.slope_statistics`."""

    unit: SlopeUnit = "degrees"
    crs: CRS | None = None
    elevation_unit: Unit | None = None


class StatisticsPart(NamedTuple):
    """Exact sums (3, t), and the slopes and areas (m,) of triangles."""

    terms: Float64Array
    slopes: Float64Array
    areas: Float64Array


def compute_part(
    part: LocalTriangulation, box: Bounds, options: StatisticsOptions
) -> StatisticsPart:
    """Return the sums over the triangles that a tile owns, of all triangles that meet its box."""
    is_owned = are_owned_triangles(part, box)
    if not is_owned.any():
        nothing = np.zeros(0)
        return StatisticsPart(list_terms(nothing, nothing), nothing, nothing)
    normals = compute_normals(as_surface(part, options.crs, options.elevation_unit))[is_owned]
    slopes, areas = measure_slopes(normals, options.unit), 0.5 * normals[:, 2]
    return StatisticsPart(list_terms(slopes, areas), slopes, areas)


def join(
    load: Callable[[], Iterable[StatisticsPart]], percentiles: ArrayLike = PERCENTILES
) -> dict[str, float]:
    """Return area, minimum, mean, standard deviation, maximum and percentiles of the whole.

    Parameters
    ----------
    load : callable
        Yields the parts of all tiles, as often as it is called.
    percentiles : sequence of float
        As of :func:`tinsmith.slope_statistics`.
    """
    nothing = np.zeros(0)
    terms, low, high = list_terms(nothing, nothing), np.inf, -np.inf
    for part in load():
        terms = merge_terms(terms, part.terms)
        low = min(low, float(part.slopes.min(initial=np.inf)))
        high = max(high, float(part.slopes.max(initial=-np.inf)))
    area, mean, deviation = summarise(terms)
    shares = np.asarray(percentiles, np.float64)
    slopes = (
        select_weighted_percentiles(
            lambda: ((part.slopes, part.areas) for part in load()), shares, area
        )
        if len(shares)
        else shares
    )
    return {
        "area": area,
        "minimum": low,
        "mean": mean,
        "standard deviation": deviation,
        "maximum": high,
        **name_percentiles(shares, slopes),
    }
