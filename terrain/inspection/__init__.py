"""Inspection: blunders, marks of missing data, gaps, and flat triangles of contour data."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
