"""Sections: profiles along lines, cross sections, and features laid on the surface."""

from .axes import CHORD, Axis, as_axis, lines_to_segments
from .crosswise import as_reaches, cross_sections, place_sections, section_lines
from .draping import check_features, drape, drape_points
from .profiles import profile
from .quantities import find_balanced, section_volumes

__all__ = [
    "CHORD",
    "Axis",
    "as_axis",
    "as_reaches",
    "check_features",
    "cross_sections",
    "drape",
    "drape_points",
    "find_balanced",
    "lines_to_segments",
    "place_sections",
    "profile",
    "section_lines",
    "section_volumes",
]
