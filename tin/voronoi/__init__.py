"""The Voronoi diagram of a TIN's vertices: the dual of their Delaunay triangulation."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
