"""Flat triangles of contour data: where they are, and points along their skeletons."""

from .finding import flats
from .repair import mend_flats

__all__ = ["flats", "mend_flats"]
