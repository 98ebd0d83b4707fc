"""Georeference: CRS and units of surfaces, scales on the ground, and where a CRS applies."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
