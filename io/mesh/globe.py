"""Where points in a CRS lie on the globe."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

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
