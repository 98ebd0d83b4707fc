"""Meshes for finite elements: how well shaped triangles are, and points that better them."""

from .refinement import refine
from .shape_quality import Quality, quality

__all__ = ["Quality", "quality", "refine"]
