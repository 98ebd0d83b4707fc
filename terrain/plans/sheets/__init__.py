"""Section sheets: cross sections on paper, each with its grid, its figures, its cut and fill."""

from .cells import TINTS, Cell, Measures, Section, choose_measures
from .cross_sections import SectionSheets, section_sheets
from .gathering import Units, describe_elevations, list_sections
from .legend import draw_legend, draw_samples, draw_scales
from .long_profiles import ProfileSheets, profile_sheets

__all__ = [
    "TINTS",
    "Cell",
    "Measures",
    "ProfileSheets",
    "Section",
    "SectionSheets",
    "Units",
    "choose_measures",
    "describe_elevations",
    "draw_legend",
    "draw_samples",
    "draw_scales",
    "list_sections",
    "profile_sheets",
    "section_sheets",
]
