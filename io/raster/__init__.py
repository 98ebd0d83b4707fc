"""Elevation rasters as points, through GDAL in a child process."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
