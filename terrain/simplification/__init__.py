"""Few of the points of a surface or a raster, with all others within a tolerance of them."""

from .surfaces import simplify

__all__ = ["simplify"]
