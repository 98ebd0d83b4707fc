"""The paper's algorithms of growth, exactly as written: for reference and comparison."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
