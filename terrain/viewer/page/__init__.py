"""The terrain as one self-contained HTML page, drawn by WebGL in any browser, offline."""

from ....base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
