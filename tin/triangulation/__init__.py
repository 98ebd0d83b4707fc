"""The triangles of a surface, and where things lie among them."""

from .illegal_edges import mark_illegal_edges
from .triangulation import Triangulation

__all__ = ["Triangulation", "mark_illegal_edges"]
