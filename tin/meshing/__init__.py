"""Meshes for finite elements: how well shaped triangles are, and points that better them."""

from .simplification import simplify_convex

__all__ = ["simplify_convex"]
