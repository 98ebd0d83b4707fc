"""Meshes for finite elements: how well shaped triangles are, and points that better them."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
