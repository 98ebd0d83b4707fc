"""Sections: profiles along lines, cross sections, and features laid on the surface."""

from .crosswise import cross_sections, section_lines
from .draping import drape
from .geometries import as_features
from .profiles import lines_to_segments, profile
from .segments import as_segments

__all__ = [
    "as_features",
    "as_segments",
    "cross_sections",
    "drape",
    "lines_to_segments",
    "profile",
    "section_lines",
]
