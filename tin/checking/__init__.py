"""Proof that a TIN is what it says: levels of checks that trust nobody who made it."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
