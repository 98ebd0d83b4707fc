"""Surfaces without single points, by building them anew: an oracle for residuals."""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts


def interpolate_without(points: Any, row: int, **lines: Any) -> float:
    """Return the elevation at a row of the surface of all others; NaN where there is none."""
    try:
        rest = ts.triangulate(np.delete(points, row, axis=0), **lines)
    except ts.PointsError:
        return np.nan
    return float(rest.interpolate(points[row : row + 1, :2])[0])


def rounding_of(points: Any) -> float:
    """Return how far two ways to interpolate between some points may differ by rounding.

    Weights of thin triangles are as good as the products of coordinates' differences, the mean is
    clamped between the corners: so no more than some roundings of the largest difference.
    """
    z = points[:, 2]
    return float(64 * np.finfo(float).eps * max(np.ptp(z), np.abs(z).max()))
