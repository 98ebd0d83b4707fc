"""Screening: what looks wrong with the points and lines of a TIN, and gaps that it spans."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
