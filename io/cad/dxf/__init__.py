"""DXF drawings through ezdxf: faces, points and lines by layer."""

from ....base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
