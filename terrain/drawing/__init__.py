"""Drawing: what pages, plans, charts and notebooks share: lines, numbers, 3D models, HTML."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
