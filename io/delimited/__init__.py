"""Survey points as delimited text: its layout found, its rows checked and parsed."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
