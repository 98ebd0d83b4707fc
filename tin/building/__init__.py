"""From checked inputs to a triangulated surface: rows merged, lines forced, parts cut away."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
