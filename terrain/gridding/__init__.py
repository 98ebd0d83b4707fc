"""Gridding: a surface as a raster of cells, and cells' grids."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
