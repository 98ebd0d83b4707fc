"""What products of a TIN are returned as: features, rasters and tables."""

from .features import Features
from .gridded import locate_centers
from .raster import Raster
from .table import Table

__all__ = ["Features", "Raster", "Table", "locate_centers"]
