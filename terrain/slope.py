"""Slope and aspect: how steep each triangle is, and which way it falls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..tin import TIN

__all__ = ["aspect", "normals", "slope"]


def slope(tin: TIN) -> NDArray[np.float64]:
    """Measure the slope of each triangle.

    Parameters
    ----------
    tin : TIN
        Elevation in the same unit as easting and northing.

    Returns
    -------
    (m,) float64 array, degrees
        Angle between the triangle and the horizontal plane, 0 (level) to below 90.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 0], [1, 0, 1], [0, 1, 0]], [[0, 1, 2]])
    >>> slope(tin).round(6)
    array([45.])
    """
    east, north, up = normals(tin).T
    degrees: NDArray[np.float64] = np.degrees(np.arctan2(np.hypot(east, north), up))
    return degrees


def aspect(tin: TIN) -> NDArray[np.float64]:
    """Find the direction in which each triangle falls.

    Parameters
    ----------
    tin : TIN
        Elevation in any unit: only the direction of the fall counts.

    Returns
    -------
    (m,) float64 array, degrees
        Azimuth of the steepest descent, clockwise from grid north, 0 up to but not including
        360; NaN where a triangle is level and falls nowhere.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 0], [1, 0, 1], [0, 1, 0]], [[0, 1, 2]])
    >>> aspect(tin)
    array([270.])
    """
    east, north, _ = normals(tin).T
    azimuth: NDArray[np.float64] = np.degrees(np.arctan2(east, north)) % 360.0
    # A hair west of north rounds up to the full circle, which is north.
    azimuth[azimuth == 360.0] = 0.0
    azimuth[(east == 0.0) & (north == 0.0)] = np.nan
    return azimuth


def normals(tin: TIN) -> NDArray[np.float64]:
    """Return the upward normal of each triangle, its length twice the triangle's area in space.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    (m, 3) float64 array, CRS units squared
        Its horizontal part points downhill; the vertical part is positive.
    """
    corners = [tin.points[tin.triangles[:, k]] for k in range(3)]
    upward: NDArray[np.float64] = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    return upward
