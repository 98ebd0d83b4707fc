"""Meshes for finite elements: how well shaped triangles are, and points that better them."""

from .clipping import Clipped, clip_tin
from .shape_quality import measure_smallest_angles
from .simplification import simplify_convex

__all__ = ["Clipped", "clip_tin", "measure_smallest_angles", "simplify_convex"]
