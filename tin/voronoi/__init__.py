"""The Voronoi diagram of a TIN's vertices: the dual of their Delaunay triangulation."""

from .diagram import Voronoi, voronoi

__all__ = ["Voronoi", "voronoi"]
