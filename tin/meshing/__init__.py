"""Meshes for finite elements: how well shaped triangles are, and points that better them."""
