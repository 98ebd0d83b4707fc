"""Contours of a TIN: lines, bands, labels, and what keeps simplified lines apart."""

from .bands import contour_bands
from .checking import ContourCheck, check_contours
from .labels import contour_labels, count_decimals
from .levels import LevelOptions, Levels, as_levels
from .lines import as_features, contours

__all__ = [
    "ContourCheck",
    "LevelOptions",
    "Levels",
    "as_features",
    "as_levels",
    "check_contours",
    "contour_bands",
    "contour_labels",
    "contours",
    "count_decimals",
]
