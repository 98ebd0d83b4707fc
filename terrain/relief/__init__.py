"""Relief: slope and aspect, their classes and statistics, curvature."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
