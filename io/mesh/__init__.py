"""Mesh formats: PLY, OBJ, STL, VTK, Gmsh."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
