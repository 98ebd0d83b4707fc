"""The triangles of a surface, and where things lie among them."""

from .triangulation import Triangulation

__all__ = ["Triangulation"]
