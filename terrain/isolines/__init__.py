"""Contours of a TIN: lines, bands, labels, and what keeps simplified lines apart."""

from .bands import contour_bands
from .lines import contours

__all__ = ["contour_bands", "contours"]
