"""Meshes for finite elements: how well shaped triangles are, and points that better them."""

from .shape_quality import measure_smallest_angles
from .simplification import simplify_convex

__all__ = ["measure_smallest_angles", "simplify_convex"]
