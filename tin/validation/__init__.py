"""What callers give, checked on entry: options, tables of coordinates, points."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
