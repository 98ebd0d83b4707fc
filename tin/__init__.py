"""Points and lines become triangles: build, edit, query, check. Knows no files, no pictures."""

from ..errors import (
    CheckError,
    LinesError,
    MissingExtraError,
    OptionError,
    PointsError,
    TinsmithError,
)
from . import paper
from .building.survey import Survey
from .checking.checker import CheckResult, check
from .constraints.breaklines import Breakline, Lines, Water
from .construction import triangulate
from .meshing.refinement import refine
from .meshing.shape_quality import Quality, quality
from .paper.comparison import Comparison, Outcome, compare
from .report import Merge, Report
from .surface import TIN
from .types import Bounds, Grid
from .voronoi.diagram import Voronoi

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
    "OptionError",
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
