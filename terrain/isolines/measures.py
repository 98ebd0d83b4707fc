"""Lengths of lines and areas of polygons in the plane, on the ground where CRSs are in degrees."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.georeference.units import find_scales

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from ...base.crs import CRS

__all__ = ["measure_lengths", "measure_ring_areas", "sum_parts"]


def measure_lengths(
    crs: CRS | None, coordinates: Float64Array, offsets: Int64Array
) -> Float64Array:
    """Measure lines of two points or more in the plane.

    In CRS units; in a geographic CRS in metres along the ellipsoid, which holds for segments of
    some kilometres.
    """
    run, rise = np.diff(coordinates[:, 0]), np.diff(coordinates[:, 1])
    if crs is not None and crs.is_geographic:
        middle = 0.5 * (coordinates[1:, 1] + coordinates[:-1, 1])
        scales = find_scales(crs, None, middle)
        run, rise = run * scales.east, rise * scales.north
    spans = np.hypot(run, rise, out=run)
    spans[offsets[1:-1] - 1] = 0.0  # from one line to the next
    return sum_parts(spans, offsets[:-1])


def measure_ring_areas(
    crs: CRS | None, coordinates: Float64Array, offsets: Int64Array
) -> Float64Array:
    """Measure the areas inside closed rings, the first point of each repeated.

    In CRS units squared, in a geographic CRS square metres; positive where the ring runs
    counter-clockwise.
    """
    origin = np.repeat(coordinates[offsets[:-1]], np.diff(offsets), axis=0)
    x, y = (coordinates - origin).T
    doubled = np.append(x[:-1] * y[1:] - x[1:] * y[:-1], 0.0)
    doubled[offsets[1:] - 1] = 0.0
    if crs is not None and crs.is_geographic:
        north = coordinates[:, 1]
        scales = find_scales(crs, None, (north + np.append(north[1:], 0.0) + origin[:, 1]) / 3)
        doubled *= scales.east * scales.north
    return 0.5 * sum_parts(doubled, offsets[:-1])


def sum_parts(values: Float64Array, starts: Int64Array) -> Float64Array:
    """Sum consecutive parts of an array, none of them empty, that start at these places."""
    if len(starts) == 0:
        return np.zeros(0)
    sums: Float64Array = np.add.reduceat(values, starts)
    return sums
