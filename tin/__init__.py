"""The shape room: points become triangles. Knows no files, no CRS, no pictures."""

from ..errors import CheckError, LinesError, MissingExtraError, PointsError, TinsmithError
from . import paper
from .check import CheckResult, check
from .compare import Comparison, Outcome, compare
from .lines import Breakline, Lines, Water
from .quality import Quality, quality
from .refine import refine
from .report import Merge, Report
from .surface import TIN
from .survey import Survey
from .triangulate import triangulate
from .types import Bounds, Grid
from .voronoi import Voronoi

__all__ = [
    "TIN",
    "Bounds",
    "Breakline",
    "CheckError",
    "CheckResult",
    "Comparison",
    "Grid",
    "Lines",
    "LinesError",
    "Merge",
    "MissingExtraError",
    "Outcome",
    "PointsError",
    "Quality",
    "Report",
    "Survey",
    "TinsmithError",
    "Voronoi",
    "Water",
    "check",
    "compare",
    "paper",
    "quality",
    "refine",
    "triangulate",
]
