"""Interpolation: the elevation between vertices, by several methods."""
