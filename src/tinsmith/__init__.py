"""tinsmith: exact terrain surfaces (TINs) from elevation points.

>>> import tinsmith as ts
>>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
>>> tin.interpolate([[2.0, 1.0]]).round(3)
array([6.5])
"""

from typing import TYPE_CHECKING

from ._lazy import lazy_names

if TYPE_CHECKING:
    from . import io, terrain, tin
    from .crs import CRS, Unit
    from .errors import (
        CheckError,
        CrsError,
        FormatError,
        LinesError,
        MissingExtraError,
        OptionError,
        PointsError,
        ReadError,
        RenderError,
        TinsmithError,
        WriteError,
    )
    from .io import read, write
    from .tin import (
        TIN,
        Bounds,
        Breakline,
        CheckResult,
        Grid,
        Lines,
        Report,
        Survey,
        Water,
        check,
        triangulate,
    )

__version__ = "0.1.0"

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        ".crs": ("CRS", "Unit"),
        ".errors": (
            "CheckError",
            "CrsError",
            "FormatError",
            "LinesError",
            "MissingExtraError",
            "OptionError",
            "PointsError",
            "ReadError",
            "RenderError",
            "TinsmithError",
            "WriteError",
        ),
        ".io": ("read", "write"),
        ".terrain": (),
        ".tin": (
            "TIN",
            "Bounds",
            "Breakline",
            "CheckResult",
            "Grid",
            "Lines",
            "Report",
            "Survey",
            "Water",
            "check",
            "triangulate",
        ),
    },
)

__all__ = [
    "CRS",
    "TIN",
    "Bounds",
    "Breakline",
    "CheckError",
    "CheckResult",
    "CrsError",
    "FormatError",
    "Grid",
    "Lines",
    "LinesError",
    "MissingExtraError",
    "OptionError",
    "PointsError",
    "ReadError",
    "RenderError",
    "Report",
    "Survey",
    "TinsmithError",
    "Unit",
    "Water",
    "WriteError",
    "__version__",
    "check",
    "io",
    "read",
    "terrain",
    "tin",
    "triangulate",
    "write",
]
