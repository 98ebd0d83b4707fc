"""Measures of planes that a raster can hold: slope, aspect and light."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .gradients import measure_aspects, measure_slopes
from .light import shade

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.policies import RasterValue
    from .light import Light

__all__ = ["PlaneMeasure"]


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
