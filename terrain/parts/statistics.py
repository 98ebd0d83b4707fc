"""Statistics of the slope, tile by tile, in exact sums.

Percentiles need the slopes of all triangles in order, and are no part of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..relief.statistics import list_terms, merge_terms, summarise
from ..surface import compute_normals, measure_slopes
from .surfaces import are_owned_triangles, as_surface

if TYPE_CHECKING:
    from collections.abc import Iterable

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
    """Exact sums (3, t), and the least and the greatest slope."""

    terms: Float64Array
    minimum: float
    maximum: float


def compute_part(
    part: LocalTriangulation, box: Bounds, options: StatisticsOptions
) -> StatisticsPart:
    """Return the sums over the triangles that a tile owns, of all triangles that meet its box."""
    is_owned = are_owned_triangles(part, box)
    if not is_owned.any():
        nothing = np.zeros(0)
        return StatisticsPart(list_terms(nothing, nothing), np.inf, -np.inf)
    normals = compute_normals(as_surface(part, options.crs, options.elevation_unit))[is_owned]
    values = measure_slopes(normals, options.unit)
    terms = list_terms(values, 0.5 * normals[:, 2])
    return StatisticsPart(terms, float(values.min()), float(values.max()))


def join(parts: Iterable[StatisticsPart]) -> dict[str, float]:
    """Return area, minimum, mean, standard deviation and maximum of the whole surface."""
    nothing = np.zeros(0)
    found = StatisticsPart(list_terms(nothing, nothing), np.inf, -np.inf)
    for part in parts:
        found = StatisticsPart(
            merge_terms(found.terms, part.terms),
            min(found.minimum, part.minimum),
            max(found.maximum, part.maximum),
        )
    area, mean, deviation = summarise(found.terms)
    return {
        "area": area,
        "minimum": found.minimum,
        "mean": mean,
        "standard deviation": deviation,
        "maximum": found.maximum,
    }
