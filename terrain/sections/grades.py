"""Grades: how steep surfaces are along lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...tin.topology import NO_NEIGHBOR
from ..surface import multiply_exactly

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...tin import TIN
    from ..surface import Segments
    from .rows import Rows
    from .surfaces import Surfaces


def measure_grades(surfaces: Surfaces, segments: Segments, rows: Rows) -> Float64Array:
    """Measure the slope of each surface along the line from each row to the next one, (n, k).

    Rise over run, elevations not converted to the unit of eastings: NaN in gaps and at ends. Taken
    from the plane of the triangle, or from the two rows where rounding harms that less: the one
    where they are close to each other, the other where the triangle is a sliver.
    """
    directions = segments.directions[rows.places.segments]
    grades = np.full(rows.elevations.shape, np.nan)
    for k, (tin, factor) in enumerate(zip(surfaces.tins, surfaces.factors, strict=True)):
        has = np.flatnonzero((rows.triangles[:, k] != NO_NEIGHBOR) & ~rows.is_last)
        gradient = factor * _compute_gradients(tin, rows.triangles[has, k])
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            of_plane = (gradient * directions[has]).sum(axis=1)
            plane_error = np.abs(gradient).sum(axis=1) * np.finfo(float).eps
            of_rows, row_error = _measure_rise_over_run(rows, has, k)
        is_plane = np.isfinite(of_plane) & ~(row_error < plane_error)
        grades[has, k] = np.where(is_plane, of_plane, of_rows)
    return grades


def _measure_rise_over_run(
    rows: Rows, has: Int64Array, k: int
) -> tuple[Float64Array, Float64Array]:
    """Return the grades from rows to the next ones, and how far off rounding may have them."""
    xy, z = rows.places.xy, rows.elevations[:, k]
    run = np.hypot(*(xy[has + 1] - xy[has]).T)
    grade = (z[has + 1] - z[has]) / run
    places = np.spacing(np.abs(xy[has]).max(axis=1))
    heights = np.spacing(np.maximum(np.abs(z[has]), np.abs(z[has + 1])))
    return grade, (heights + places * np.abs(grade)) / run


def _compute_gradients(tin: TIN, triangles: Int32Array) -> Float64Array:
    """Return the rise of triangles eastwards and northwards, (n, 2).

    Counted from the corner opposite the longest side, so that differences lose the least; whichever
    corner is named first.
    """
    chosen, inverse = np.unique(triangles, return_inverse=True)
    corners = _begin_at_first(tin.points[tin.triangles[chosen]])
    sides = np.roll(corners, -1, axis=1) - np.roll(corners, -2, axis=1)
    first = np.argmax(np.hypot(sides[:, :, 0], sides[:, :, 1]), axis=1)
    row = np.arange(len(chosen))
    a, b, c = (corners[row, (first + k) % 3] for k in range(3))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        (x, y, z), (u, v, w) = (b - a).T, (c - a).T
        area = _subtract_products(x, v, y, u)
        east = _subtract_products(z, v, y, w) / area
        north = _subtract_products(x, w, z, u) / area
    return np.stack([east, north], axis=1)[inverse.reshape(-1)]


def _begin_at_first(corners: Float64Array) -> Float64Array:
    """Turn triangles, (n, 3, 3), to their first corner by easting, then northing."""
    x, y = corners[:, :, 0], corners[:, :, 1]
    is_west = x == x.min(axis=1)[:, None]
    first = np.argmin(np.where(is_west, y, np.inf), axis=1)
    turned: Float64Array = corners[
        np.arange(len(corners))[:, None], (first[:, None] + (0, 1, 2)) % 3
    ]
    return turned


def _subtract_products(
    a: Float64Array, b: Float64Array, c: Float64Array, d: Float64Array
) -> Float64Array:
    """Return a b - c d, good to a few roundings: what each product loses is given back."""
    (left, left_rest), (right, right_rest) = multiply_exactly(a, b), multiply_exactly(c, d)
    mended = (left - right) + (left_rest - right_rest)
    return np.where(np.isfinite(mended), mended, left - right)
