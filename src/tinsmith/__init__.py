"""tinsmith: exact terrain surfaces (TINs) from elevation points.

>>> import tinsmith as ts
>>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
>>> tin.interpolate([[2.0, 1.0]]).round(3)
array([6.5])
"""

from typing import TYPE_CHECKING

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
    from .io import (
        Format,
        find_format,
        known_formats,
        length_unit,
        lines_from_codes,
        read,
        read_lines,
        read_polygons,
        read_rings,
        read_water,
        transform_points,
        with_lines,
        write,
    )
    from .terrain import comparison_picture, histogram
    from .terrain.lift import lift
    from .terrain.preview.picture import preview
    from .terrain.results import Features, Raster, Table
    from .terrain.slope import aspect, slope
    from .tin import (
        TIN,
        Bounds,
        Breakline,
        CheckResult,
        Comparison,
        Grid,
        Lines,
        Merge,
        Outcome,
        Quality,
        Report,
        Survey,
        Voronoi,
        Water,
        check,
        compare,
        paper,
        quality,
        refine,
        triangulate,
    )
    from .tin.voronoi import voronoi
else:  # a type checker takes every name for one that such a __getattr__ has
    from ._lazy import lazy_names

    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            ".crs": (
                "CRS",
                "Unit",
            ),
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
            ".io": (
                "Format",
                "find_format",
                "known_formats",
                "length_unit",
                "lines_from_codes",
                "read",
                "read_lines",
                "read_polygons",
                "read_rings",
                "read_water",
                "transform_points",
                "with_lines",
                "write",
            ),
            ".terrain": (
                "aspect",
                "comparison_picture",
                "histogram",
                "lift",
                "preview",
                "slope",
            ),
            ".terrain.results": ("Features", "Raster", "Table"),
            ".tin": (
                "TIN",
                "Bounds",
                "Breakline",
                "CheckResult",
                "Comparison",
                "Grid",
                "Lines",
                "Merge",
                "Outcome",
                "Quality",
                "Report",
                "Survey",
                "Voronoi",
                "Water",
                "check",
                "compare",
                "paper",
                "quality",
                "refine",
                "triangulate",
            ),
            ".tin.voronoi": ("voronoi",),
        },
    )

__version__ = "0.1.0"

__all__ = [
    "CRS",
    "TIN",
    "Bounds",
    "Breakline",
    "CheckError",
    "CheckResult",
    "Comparison",
    "CrsError",
    "Features",
    "Format",
    "FormatError",
    "Grid",
    "Lines",
    "LinesError",
    "Merge",
    "MissingExtraError",
    "OptionError",
    "Outcome",
    "PointsError",
    "Quality",
    "Raster",
    "ReadError",
    "RenderError",
    "Report",
    "Survey",
    "Table",
    "TinsmithError",
    "Unit",
    "Voronoi",
    "Water",
    "WriteError",
    "__version__",
    "aspect",
    "check",
    "compare",
    "comparison_picture",
    "find_format",
    "histogram",
    "io",
    "known_formats",
    "length_unit",
    "lift",
    "lines_from_codes",
    "paper",
    "preview",
    "quality",
    "read",
    "read_lines",
    "read_polygons",
    "read_rings",
    "read_water",
    "refine",
    "slope",
    "terrain",
    "tin",
    "transform_points",
    "triangulate",
    "voronoi",
    "with_lines",
    "write",
]
