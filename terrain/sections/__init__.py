"""Sections: profiles along lines, cross sections, and features laid on the surface."""

from .crosswise import cross_sections, section_lines
from .draping import drape
from .profiles import profile

__all__ = ["cross_sections", "drape", "profile", "section_lines"]
