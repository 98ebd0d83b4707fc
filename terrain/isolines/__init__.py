"""Contours of a TIN: lines, bands, labels, and what keeps simplified lines apart."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
