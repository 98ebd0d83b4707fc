"""Sections: profiles along lines, cross sections, and features laid on the surface."""

from .alignments import Alignment, VerticalAlignment
from .axes import CHORD, Axis, as_axis, lines_to_segments
from .crosswise import as_reaches, cross_sections, place_sections, section_lines
from .draping import check_features, drape, drape_points
from .profiles import profile
from .quantities import find_balanced, measure_section_areas, section_volumes
from .surfaces import Surfaces, as_surfaces

__all__ = [
    "CHORD",
    "Alignment",
    "Axis",
    "Surfaces",
    "VerticalAlignment",
    "as_axis",
    "as_reaches",
    "as_surfaces",
    "check_features",
    "cross_sections",
    "drape",
    "drape_points",
    "find_balanced",
    "lines_to_segments",
    "measure_section_areas",
    "place_sections",
    "profile",
    "section_lines",
    "section_volumes",
]
