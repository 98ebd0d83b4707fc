"""The Voronoi diagram of a TIN's vertices: the dual of their Delaunay triangulation."""

from .construction import voronoi
from .diagram import Voronoi

__all__ = ["Voronoi", "voronoi"]
