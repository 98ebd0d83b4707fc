"""Values of triangles that a raster can hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...errors import OptionError
from ...tin.validation.options import is_finite_number
from ..slope import aspect, compute_normals, slope

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...policies import RasterValue
    from ...tin import TIN

__all__ = ["triangle_values"]


def triangle_values(
    tin: TIN, value: RasterValue, *, azimuth: float, altitude: float
) -> NDArray[np.float64] | None:
    """Return the value of each triangle; None for elevations, which change within them.

    Parameters
    ----------
    tin : TIN
    value : RasterValue
    azimuth, altitude : float
        Of the light, degrees; for hillshade.
    """
    if value == "elevation":
        return None
    if value == "slope":
        return slope(tin)
    return aspect(tin) if value == "aspect" else _shade(tin, azimuth, altitude)


def _shade(tin: TIN, azimuth: float, altitude: float) -> NDArray[np.float64]:
    """Return how bright triangles are, 0 to 255: the cosine of the angle to the light."""
    for name, angle, low, high in (("azimuth", azimuth, -360, 360), ("altitude", altitude, 0, 90)):
        if not (is_finite_number(angle) and low <= angle <= high):
            raise OptionError(name, angle, f"an angle from {low} to {high} degrees")
    turn, rise = np.radians(azimuth), np.radians(altitude)
    light = np.array([np.sin(turn) * np.cos(rise), np.cos(turn) * np.cos(rise), np.sin(rise)])
    upward = compute_normals(tin)
    longest = np.abs(upward).max(axis=1, keepdims=True)
    unit = upward / longest
    shade: NDArray[np.float64] = 255.0 * (unit @ light) / np.linalg.norm(unit, axis=1)
    return np.maximum(shade, 0.0)
