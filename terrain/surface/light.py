"""Light: how bright a surface is under a low sun; and what else is measured of planes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_number
from .. import _kernel
from .normals import measure_aspects, measure_slopes

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, UInt8Array
    from ...base.policies import RasterValue

DARKEST, BRIGHTEST = 1, 255
"""As gdaldem writes them; 0 is outside."""


class Light(NamedTuple):
    """Where the light comes from, degrees."""

    azimuth: float
    """Clockwise from north."""
    altitude: float
    """Above the horizon."""


def as_light(azimuth: Any, altitude: Any) -> Light:
    """Return a light, or say which number is out of range."""
    return Light(
        as_number("azimuth", azimuth, unit="of degrees"),
        as_number("altitude", altitude, least=0, most=90, unit="degrees"),
    )


def shade(upward: Float64Array, light: Light) -> UInt8Array:
    """Return the light on planes: 1 (none) to 255 (from straight above), the cosine of the angle.

    Parameters
    ----------
    upward : (k, 3) float64 array
        Normals of any length.
    light : Light

    Examples
    --------
    >>> shade(np.array([[0.0, 0.0, 2.0]]), Light(315.0, 45.0))
    array([181], dtype=uint8)
    """
    turn, rise = math.radians(light.azimuth), math.radians(light.altitude)
    towards = (math.sin(turn) * math.cos(rise), math.cos(turn) * math.cos(rise), math.sin(rise))
    return _kernel.shade_planes(upward, *towards, DARKEST, BRIGHTEST)


def normalise(vectors: Float64Array) -> Float64Array:
    """Return vectors of length 1, NaN for those without a direction."""
    with np.errstate(invalid="ignore"):
        small = vectors / np.abs(vectors).max(axis=1, keepdims=True)  # no square is 0 or infinite
        return np.asarray(small / np.linalg.norm(small, axis=1, keepdims=True), np.float64)


class PlaneMeasure(NamedTuple):
    """What is measured of a plane: degrees of slope or aspect, or light from 1 to 255."""

    value: RasterValue
    light: Light
    exaggeration: float = 1.0

    def of(self, upward: Float64Array) -> Float64Array:
        """Return the value of planes with some upward normals, (k, 3); NaN where there is none."""
        factor = self.exaggeration
        normals = upward if factor == 1.0 else upward * (factor, factor, 1.0)
        if self.value == "slope":
            return measure_slopes(normals, "degrees")
        if self.value == "aspect":
            return measure_aspects(normals)
        lights = shade(normals, self.light).astype(np.float64)
        lights[np.isnan(normals[:, 2])] = np.nan
        return lights
