"""The ellipsoid WGS 84: places on it in space, and what of it can be seen beyond the horizon."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import Float64Array

__all__ = ["Sphere", "bound_by_sphere", "find_horizon_point", "to_cartesian"]

_RADIUS = 6_378_137.0
_FLATTENING = 1 / 298.257223563
_POLAR_RADIUS = _RADIUS * (1 - _FLATTENING)
_FARTHEST = 1000.0
"""Of the horizon point, in radii, where a tile is so large that there is none: half the globe."""


class Sphere(NamedTuple):
    """A sphere in space, metres."""

    center: Float64Array
    radius: float


def to_cartesian(places: Float64Array) -> Float64Array:
    """Return X, Y, Z (metres from the centre of the Earth) of longitude, latitude, height.

    Parameters
    ----------
    places : (n, 3) float64 array
        Degrees, degrees, metres above the ellipsoid.
    """
    longitude, latitude = np.radians(places[:, 0]), np.radians(places[:, 1])
    squeeze = _FLATTENING * (2 - _FLATTENING)
    normal = _RADIUS / np.sqrt(1 - squeeze * np.sin(latitude) ** 2)
    across = (normal + places[:, 2]) * np.cos(latitude)
    up = (normal * (1 - squeeze) + places[:, 2]) * np.sin(latitude)
    return np.column_stack([across * np.cos(longitude), across * np.sin(longitude), up])


def bound_by_sphere(points: Float64Array) -> Sphere:
    """Return a sphere about points: about the middle of their bounds."""
    center = (points.min(axis=0) + points.max(axis=0)) / 2
    return Sphere(center, float(np.linalg.norm(points - center, axis=1).max()))


def find_horizon_point(points: Float64Array, center: Float64Array) -> Float64Array:
    """Return the point that is below the horizon only where all points are.

    Parameters
    ----------
    points : (n, 3) float64 array
        In space, metres.
    center : (3,) float64 array
        Gives the direction of the point from the centre of the Earth.

    Returns
    -------
    (3,) float64 array
        In radii of the ellipsoid.

    References
    ----------
    K. Ring, "Computing the horizon occlusion point", Cesium blog, 2013.
    """
    radii = np.array([_RADIUS, _RADIUS, _POLAR_RADIUS])
    scaled = points / radii
    direction = center / radii
    direction = direction / np.linalg.norm(direction)
    length = np.maximum(np.linalg.norm(scaled, axis=1), 1.0)
    aside = scaled / np.linalg.norm(scaled, axis=1, keepdims=True)
    cos_a = aside @ direction
    sin_a = np.linalg.norm(np.cross(aside, direction), axis=1)
    cos_b = 1.0 / length
    sin_b = np.sqrt(np.maximum(length**2 - 1.0, 0.0)) * cos_b
    below = cos_a * cos_b - sin_a * sin_b
    nearest = float(below.min())
    return np.asarray(direction * (1.0 / nearest if nearest > 1.0 / _FARTHEST else _FARTHEST))
