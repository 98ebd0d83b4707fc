"""Volumes and differences of surfaces, in closed form."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
