"""Plan sheets and section sheets: surfaces on paper, true to scale."""

from .paper import PLAN_SUFFIXES, REPORT_SUFFIXES, SHEET_SUFFIXES
from .production import Plan, plan
from .reports import VolumeReport, volume_report
from .sheets import ProfileSheets, SectionSheets, profile_sheets, section_sheets
from .template import find_logo

__all__ = [
    "PLAN_SUFFIXES",
    "REPORT_SUFFIXES",
    "SHEET_SUFFIXES",
    "Plan",
    "ProfileSheets",
    "SectionSheets",
    "VolumeReport",
    "find_logo",
    "plan",
    "profile_sheets",
    "section_sheets",
    "volume_report",
]
