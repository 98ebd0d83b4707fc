"""Sections: profiles along lines, cross sections, and features laid on the surface."""

from .crosswise import cross_sections, section_lines
from .draping import drape
from .profiles import lines_to_segments, profile

__all__ = ["cross_sections", "drape", "lines_to_segments", "profile", "section_lines"]
