"""Section sheets: cross sections on paper, each with its grid, its figures, its cut and fill."""

from .production import SectionSheets, section_sheets

__all__ = ["SectionSheets", "section_sheets"]
