"""Changes of a TIN: operations on its inputs, their history, and a mesh changed in place."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
