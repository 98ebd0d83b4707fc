"""Points and lines become triangles: build, edit, query, check. Knows no files, no pictures."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
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
else:  # a type checker takes every name for one that such a __getattr__ has
    from .._lazy import lazy_names

    # A small job starts at once, as it loads what it uses.
    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            "..errors": (
                "CheckError",
                "LinesError",
                "MissingExtraError",
                "OptionError",
                "PointsError",
                "TinsmithError",
            ),
            ".building.survey": ("Survey",),
            ".checking.checker": ("CheckResult", "check"),
            ".constraints.breaklines": ("Breakline", "Lines", "Water"),
            ".construction": ("triangulate",),
            ".meshing.refinement": ("refine",),
            ".meshing.shape_quality": ("Quality", "quality"),
            ".paper.comparison": ("Comparison", "Outcome", "compare"),
            ".report": ("Merge", "Report"),
            ".surface": ("TIN",),
            ".types": ("Bounds", "Grid"),
            ".voronoi.diagram": ("Voronoi",),
        },
    )

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
