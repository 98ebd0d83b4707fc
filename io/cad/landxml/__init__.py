"""LandXML 1.0 to 2.0: surfaces, their source data and survey points."""

from ....base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
