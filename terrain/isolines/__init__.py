"""Contours of a TIN: lines, bands, labels, and what keeps simplified lines apart."""

from .bands import contour_bands
from .checking import ContourCheck, check_contours
from .labels import contour_labels
from .lines import contours

__all__ = ["ContourCheck", "check_contours", "contour_bands", "contour_labels", "contours"]
