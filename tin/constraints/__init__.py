"""Lines that the surface must hold: given, noded, draped, and what they cut away."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
