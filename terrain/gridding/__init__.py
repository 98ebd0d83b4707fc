"""Gridding: a surface as a raster of cells, and cells' grids."""

from .bands import SurfaceBand
from .ground_heights import height_above
from .rasters import rasterize
from .relief_bands import ReliefBand

__all__ = ["ReliefBand", "SurfaceBand", "height_above", "rasterize"]
