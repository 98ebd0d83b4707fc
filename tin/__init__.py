"""The shape room: points become triangles. Knows no files, no CRS, no pictures."""

from .check import CheckResult, check
from .errors import CheckError, MissingExtraError, PointsError, TinsmithError
from .report import Merge, Report
from .surface import TIN
from .survey import Survey
from .triangulate import triangulate
from .types import Bounds, Grid

__all__ = [
    "TIN",
    "Bounds",
    "CheckError",
    "CheckResult",
    "Grid",
    "Merge",
    "MissingExtraError",
    "PointsError",
    "Report",
    "Survey",
    "TinsmithError",
    "check",
    "triangulate",
]
