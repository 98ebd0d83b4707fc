"""Plan sheets and section sheets: surfaces on paper, true to scale."""

from .files import PLAN_SUFFIXES, REPORT_SUFFIXES, SHEET_SUFFIXES
from .production import Plan, plan
from .reports import VolumeReport, volume_report
from .sheets import SectionSheets, section_sheets

__all__ = [
    "PLAN_SUFFIXES",
    "REPORT_SUFFIXES",
    "SHEET_SUFFIXES",
    "Plan",
    "SectionSheets",
    "VolumeReport",
    "plan",
    "section_sheets",
    "volume_report",
]
