"""Slope and aspect: how steep each triangle is, and which way it falls."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .units import find_scales

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..crs import CRS
    from ..tin import TIN

__all__ = ["aspect", "compute_normals", "measure_areas", "measure_ring_area", "slope"]


def slope(tin: TIN) -> NDArray[np.float64]:
    """Measure the slope of each triangle.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    (m,) float64 array, degrees
        Angle between the triangle and the horizontal plane, 0 (level) to below 90.

    Notes
    -----
    It is the slope of the true surface: elevations are converted from ``tin.elevation_unit`` to the
    unit of the CRS's eastings. If their unit is not known it is taken to be that of the eastings,
    metres above longitude and latitude. Degrees count as their length on the ellipsoid at the
    middle of each triangle, which holds for triangles of some kilometres.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 0], [1, 0, 1], [0, 1, 0]], [[0, 1, 2]])
    >>> slope(tin).round(6)
    array([45.])
    """
    east, north, up = compute_normals(tin).T
    degrees: NDArray[np.float64] = np.degrees(np.arctan2(np.hypot(east, north), up))
    return degrees


def aspect(tin: TIN) -> NDArray[np.float64]:
    """Find the direction in which each triangle falls.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    (m,) float64 array, degrees
        Azimuth of the steepest descent, clockwise from grid north (of a geographic CRS
        true north), 0 up to but not including 360; NaN where a triangle is level and falls nowhere.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 0], [1, 0, 1], [0, 1, 0]], [[0, 1, 2]])
    >>> aspect(tin)
    array([270.])
    """
    east, north, _ = compute_normals(tin).T
    azimuth: NDArray[np.float64] = np.degrees(np.arctan2(east, north)) % 360.0
    # A hair west of north rounds up to the full circle, which is north.
    azimuth[azimuth == 360.0] = 0.0
    azimuth[(east == 0.0) & (north == 0.0)] = np.nan
    return azimuth


def measure_areas(tin: TIN) -> NDArray[np.float64]:
    """Measure the area of each triangle in the plane on the ground.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    (m,) float64 array
        In square metres; in CRS units squared where those are not known.
    """
    measured: NDArray[np.float64] = tin.triangle_areas * find_area_scale(
        tin.crs, _average_northings(tin)
    )
    return measured


def measure_ring_area(crs: CRS | None, ring: NDArray[np.float64]) -> float:
    """Measure the area inside a ring in the plane on the ground, as :func:`measure_areas` does.

    Parameters
    ----------
    crs : CRS or None
    ring : (k, 2) or (k, 3) float64 array
        Corners in order, the first not repeated.

    Returns
    -------
    float
        Positive if the ring runs counter-clockwise.
    """
    x, y = (ring[:, :2] - ring[0, :2]).T
    steps = x * np.roll(y, -1) - np.roll(x, -1) * y
    middle = (ring[:, 1] + np.roll(ring[:, 1], -1) + ring[0, 1]) / 3
    return float((steps * find_area_scale(crs, middle)).sum()) / 2


def find_area_scale(crs: CRS | None, northing: ArrayLike) -> Any:
    """Return the factor from areas in CRS units squared to square metres, at each northing."""
    scales = find_scales(crs, None, northing)
    metres = None if crs is None else crs.horizontal_unit.metres
    return scales.east * scales.north * (metres or 1.0) ** 2


def compute_normals(tin: TIN) -> NDArray[np.float64]:
    """Return the upward normal of each triangle, its length twice the triangle's area in space.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    (m, 3) float64 array
        Of the true surface, as in :func:`slope`: in CRS units squared, in a geographic CRS square
        metres. Its horizontal part points downhill; the vertical part is positive.
    """
    corners = [tin.points[tin.triangles[:, k]] for k in range(3)]
    upward: NDArray[np.float64] = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    east, north, up = find_scales(tin.crs, tin.elevation_unit, _average_northings(tin))
    for axis, factor in enumerate((north * up, east * up, east * north)):
        upward[:, axis] *= factor
    return upward


def _average_northings(tin: TIN) -> NDArray[np.float64]:
    middle: NDArray[np.float64] = tin.points[:, 1][tin.triangles].mean(axis=1)
    return middle
