"""Relief: slope, aspect and light, their classes and statistics, hillshade, curvature."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
