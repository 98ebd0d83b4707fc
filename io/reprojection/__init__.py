"""Coordinates from one CRS to another, and whether they lie where a CRS applies."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
