"""Pictures in tests: surfaces that are drawn, and the pixels of what was drawn."""

from __future__ import annotations

import math

import numpy as np
from PIL import Image

from tinsmith import triangulate


def make_dipping_plane(azimuth, *, steepness=0.5, extent=100.0):
    """Return a plane that falls towards an azimuth."""
    turn = math.radians(azimuth)
    corners = np.array([(0, 0), (extent, 0), (extent, extent), (0, extent)], float)
    z = -steepness * (corners @ (math.sin(turn), math.cos(turn)))
    return triangulate(np.column_stack([corners, z]))


def read_pixels(path):
    """Return red, green and blue of a picture, as integers that may be subtracted."""
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB")).astype(int)
