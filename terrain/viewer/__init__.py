"""Preview: a surface in 3D as a page, as a picture or in a window."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
