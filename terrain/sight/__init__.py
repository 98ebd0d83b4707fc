"""Sight: what is seen from where on a surface."""

from .lines import line_of_sight
from .views import viewshed, visible_vertices

__all__ = ["line_of_sight", "viewshed", "visible_vertices"]
