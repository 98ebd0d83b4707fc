"""Values of triangles that a raster can hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..relief.gradients import aspect, compute_normals, slope
from ..relief.light import shade

if TYPE_CHECKING:
    from ...arrays import Float64Array
    from ...policies import RasterValue
    from ...tin import TIN
    from ..relief.light import Light

__all__ = ["measure_triangles"]


def measure_triangles(tin: TIN, value: RasterValue, light: Light) -> Float64Array | None:
    """Return the value of each triangle, (m,); None for elevations, which change within them."""
    if value == "elevation":
        return None
    if value == "slope":
        return slope(tin)
    if value == "aspect":
        return aspect(tin)
    return shade(compute_normals(tin), light).astype(np.float64)
