"""Gaps that a TIN spans without a word: voids between points, slivers along the hull."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...crs import assume_elevation_unit, scale_elevations
from ..constraints.clipping import Surface, trim
from ..topology import NO_NEIGHBOR

if TYPE_CHECKING:
    from ...arrays import BoolArray, Float64Array, Int64Array
    from ..surface import TIN

__all__ = ["describe_gaps"]

_USUAL = 95.0
_FAR = 5.0
"""An edge is long beyond so many times the length that 95 % of the edges do not exceed."""

_STEEP = 30.0
_STEEPER = 5.0
"""A sliver is steep above 30 degrees, if its gradient is 5 times that of 90 % of the triangles."""

_SAMPLE = 20_000

_EARTH_RADIUS = 6_371_000.0
"""Metres."""
_POLE = 1e-3
"""Meridians are no nearer to each other than this share of their distance at the equator."""


def describe_gaps(tin: TIN) -> list[str]:
    """Tell of triangles that span places without points.

    A sentence for long edges along the boundary, one for those inside, one for steep slivers along
    the hull; none for edges of lines. Linear in the triangles. Long is an edge of more than five
    times the 95th percentile of edge lengths, so that neither scan lines nor contour lines, whose
    points are dense along them alone, are found to have gaps.

    Examples
    --------
    >>> from tinsmith import triangulate
    >>> square = [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    >>> describe_gaps(triangulate(square))
    []
    """
    squares = _square_lengths(tin)
    some = squares[:: max(1, len(squares) // _SAMPLE)]
    limit = _round_up(_FAR * float(np.sqrt(np.percentile(some, _USUAL))))
    is_long = ((squares > limit**2) & ~tin.constrained).any(axis=1)
    stays = np.ones(len(squares), np.bool_)
    if is_long.any():
        surface = Surface(tin.points, tin.triangles, tin.neighbors, tin.constrained)
        stays = trim(surface, stays, limit, everywhere=False)
    unit = "units" if tin.crs is None else tin.crs.horizontal_unit.symbol
    return [
        *_describe_long(
            squares[~stays],
            unit,
            "along the boundary",
            f"far longer than usual: max_edge={limit:g} trims them.",
        ),
        *_describe_long(
            squares[is_long & stays],
            unit,
            "inside",
            f"as over a void: max_edge={limit:g} with trim='everywhere' leaves them out.",
        ),
        *_describe_slivers(tin, squares, stays),
    ]


def _square_lengths(tin: TIN) -> Float64Array:
    """Return the squares of the lengths of the edges opposite the corners, (m, 3), in the plane."""
    x, y = (np.ascontiguousarray(axis)[tin.triangles] for axis in tin.points[:, :2].T)
    squares = np.empty(tin.triangles.shape)
    for k in range(3):
        start, end = (k + 1) % 3, (k + 2) % 3
        squares[:, k] = (x[:, end] - x[:, start]) ** 2 + (y[:, end] - y[:, start]) ** 2
    return squares


def _round_up(length: float) -> float:
    """Round up to two digits."""
    unit = 10.0 ** (np.floor(np.log10(length)) - 1)
    return float(f"{np.ceil(length / unit) * unit:.6g}")


def _describe_long(squares: Float64Array, unit: str, where: str, what: str) -> list[str]:
    """Tell of triangles with long edges, given as squares: where they are, and what to do."""
    if len(squares) == 0:
        return []
    longest = f"{np.sqrt(squares.max()):.6g} {unit}"
    return [f"{_count_triangles(len(squares))} {where} with edges of up to {longest}, {what}"]


def _describe_slivers(tin: TIN, squares: Float64Array, stays: BoolArray) -> list[str]:
    """Tell of triangles along the hull that are far steeper than the ground."""
    is_outer = (tin.neighbors == NO_NEIGHBOR) & ~tin.constrained
    outer = np.flatnonzero(is_outer.any(axis=1) & stays)
    usual = np.percentile(
        _compute_gradients(tin, slice(None, None, max(1, len(stays) // _SAMPLE))), 90
    )
    slivers = outer[_compute_gradients(tin, outer) > _STEEPER * usual]
    degrees = _measure_slopes(tin, slivers)
    slivers, degrees = slivers[degrees > _STEEP], degrees[degrees > _STEEP]
    if len(slivers) == 0:
        return []
    shortest = float(np.sqrt(squares[slivers].max(axis=1).min()))
    return [
        f"{_count_triangles(len(slivers))} along the hull as steep as {degrees.max():.1f} "
        f"degrees, where the ground is not: a max_edge below {shortest:.4g} trims them."
    ]


def _compute_gradients(tin: TIN, chosen: Any) -> Float64Array:
    """Return the gradients of some triangles, in whatever units there are."""
    a, b, c = (tin.points[tin.triangles[chosen, k]] for k in range(3))
    east, north, up = np.cross(b - a, c - a).T
    with np.errstate(divide="ignore", invalid="ignore"):
        gradients = np.hypot(east, north) / up
    steep: Float64Array = np.nan_to_num(gradients, nan=0.0)  # infinite is the largest
    return steep


def _measure_slopes(tin: TIN, chosen: Int64Array) -> Float64Array:
    """Return the slopes of some triangles in degrees, elevations in the unit of eastings."""
    a, b, c = (tin.points[tin.triangles[chosen, k]] * _find_factors(tin) for k in range(3))
    east, north, up = np.cross(b - a, c - a).T
    slopes: Float64Array = np.degrees(np.arctan2(np.hypot(east, north), up))
    return slopes


def _find_factors(tin: TIN) -> Float64Array:
    """Return factors that make all coordinates lengths; degrees are those of a sphere."""
    crs = tin.crs
    if crs is None or not crs.is_geographic:
        return np.array([1.0, 1.0, scale_elevations(crs, tin.elevation_unit)])
    up = assume_elevation_unit(crs, tin.elevation_unit)
    metres = None if up is None else up.metres
    along = _EARTH_RADIUS * float(crs.to_pyproj().axis_info[0].unit_conversion_factor)
    latitude = float(np.median(tin.points[:, 1])) * along / _EARTH_RADIUS
    return np.array([along * max(np.cos(latitude), _POLE), along, metres or 1.0])


def _count_triangles(count: int) -> str:
    return f"There {'is 1 triangle' if count == 1 else f'are {count:,} triangles'}"
