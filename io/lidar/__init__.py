"""Lidar: LAS, LAZ and COPC point clouds, read and written through laspy."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
