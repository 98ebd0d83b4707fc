"""Sections: profiles along lines, cross sections, and features laid on the surface."""

from .crosswise import cross_sections, section_lines
from .draping import check_features, drape, drape_points
from .profiles import lines_to_segments, profile

__all__ = [
    "check_features",
    "cross_sections",
    "drape",
    "drape_points",
    "lines_to_segments",
    "profile",
    "section_lines",
]
