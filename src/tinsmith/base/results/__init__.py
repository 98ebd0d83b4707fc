"""What products of a TIN are returned as: features, rasters and tables."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
