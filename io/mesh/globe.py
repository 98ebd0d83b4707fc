"""Where points in a CRS lie on the globe."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import numpy as np

from ...base.crs import CRS
from ..reprojection import reproject

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import Unit

_ELLIPSOIDAL = "EPSG:4979"


def place_on_globe(points: Float64Array, crs: CRS, unit: Unit | None) -> Float64Array:
    """Return longitude, latitude (degrees) and metres above the ellipsoid of points.

    Elevations of a CRS without a vertical part are taken to be above the ellipsoid, see
    :func:`describe_heights`.
    """
    if has_heights(crs):
        source = crs
    else:
        source, unit = crs.horizontal, unit or crs.usual_elevation_unit
    return reproject(points, source, CRS(_ELLIPSOIDAL), unit=unit).points


def find_frame(place: Float64Array, cartesian: Float64Array) -> Float64Array:
    """Return the (4, 4) matrix from metres to the east, to the north and up to EPSG:4978.

    Parameters
    ----------
    place : (3,) float64 array
        Longitude, latitude and height of its origin.
    cartesian : (3,) float64 array
        The origin itself.
    """
    longitude, latitude = np.radians(place[:2]).tolist()
    sin_x, cos_x = math.sin(longitude), math.cos(longitude)
    sin_y, cos_y = math.sin(latitude), math.cos(latitude)
    made = np.eye(4)
    made[:3, 0] = -sin_x, cos_x, 0.0
    made[:3, 1] = -sin_y * cos_x, -sin_y * sin_x, cos_y
    made[:3, 2] = cos_y * cos_x, cos_y * sin_x, sin_y
    made[:3, 3] = cartesian
    return made


def describe_heights(crs: CRS) -> str:
    """Return the sentence about elevations that are not known above the ellipsoid."""
    return (
        f"The elevations are not known above the ellipsoid in {crs.label}: they are written as if "
        "they were, and differ by the height of the geoid, up to 110 m."
    )


def has_heights(crs: CRS) -> bool:
    """Whether PROJ knows the way to the ellipsoid, and has the grid that it needs."""
    from pyproj.transformer import TransformerGroup

    if crs.vertical_unit is None:
        return False
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of a missing grid, which is told otherwise
        group = TransformerGroup(crs.to_pyproj(), CRS(_ELLIPSOIDAL).to_pyproj(), always_xy=True)
    if not group.transformers:
        return False
    return "ballpark vertical" not in group.transformers[0].description.lower()
