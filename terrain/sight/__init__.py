"""Sight: what is seen from where on a surface."""

from .lines import line_of_sight
from .vertices import visible_vertices
from .views import viewshed

__all__ = ["line_of_sight", "viewshed", "visible_vertices"]
