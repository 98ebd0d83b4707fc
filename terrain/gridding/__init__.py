"""Gridding: a surface as a raster of cells, and cells' grids."""

from .ground_heights import height_above
from .rasters import rasterize

__all__ = ["height_above", "rasterize"]
