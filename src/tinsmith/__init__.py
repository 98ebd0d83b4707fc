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
        LossWarning,
        MissingExtraError,
        OptionError,
        PlugInWarning,
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
        reproject,
        transform_points,
        with_lines,
        write,
    )
    from .terrain import (
        comparison_picture,
        contour_map,
        earthwork_map,
        histogram,
        profile_picture,
        relief_map,
        section_picture,
    )
    from .terrain.earthwork import Difference, difference, stage_storage, volume
    from .terrain.gridding import height_above, rasterize
    from .terrain.isolines import (
        ContourCheck,
        check_contours,
        contour_bands,
        contour_labels,
        contours,
    )
    from .terrain.lift import lift
    from .terrain.preview import Preview, preview
    from .terrain.relief import (
        aspect_classes,
        curvature,
        hillshade,
        slope_classes,
        slope_statistics,
    )
    from .terrain.results import Features, Raster, Table
    from .terrain.sections import cross_sections, drape, profile, section_lines
    from .terrain.sheets import Plan, plan
    from .terrain.simplification import simplify
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
    from ._notebook import register_card

    # What records cannot make themselves, for they know no pictures.
    register_card("TIN", "tinsmith.terrain.preview.card:make_card")
    register_card("Survey", "tinsmith.terrain.cards.survey:make_survey_card")
    register_card("Report", "tinsmith.terrain.cards.survey:make_report_card")
    register_card("Features", "tinsmith.terrain.cards.results:make_features_card")
    register_card("Raster", "tinsmith.terrain.cards.results:make_raster_card")
    register_card("Table", "tinsmith.terrain.cards.results:make_table_card")

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
                "LossWarning",
                "MissingExtraError",
                "OptionError",
                "PlugInWarning",
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
                "reproject",
                "transform_points",
                "with_lines",
                "write",
            ),
            ".terrain": (
                "ContourCheck",
                "Difference",
                "aspect",
                "check_contours",
                "comparison_picture",
                "contour_bands",
                "contour_labels",
                "contour_map",
                "contours",
                "difference",
                "earthwork_map",
                "histogram",
                "lift",
                "Preview",
                "preview",
                "profile_picture",
                "relief_map",
                "section_picture",
                "simplify",
                "slope",
                "stage_storage",
                "volume",
            ),
            ".io.raster.cells": ("rasterize",),  # which reads the file of `like`, too
            ".terrain.gridding": ("height_above",),
            ".terrain.relief": (
                "aspect_classes",
                "curvature",
                "hillshade",
                "slope_classes",
                "slope_statistics",
            ),
            ".terrain.sections": ("cross_sections", "drape", "profile", "section_lines"),
            ".terrain.sheets": ("Plan", "plan"),
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
    "ContourCheck",
    "CrsError",
    "Difference",
    "Features",
    "Format",
    "FormatError",
    "Grid",
    "Lines",
    "LinesError",
    "LossWarning",
    "Merge",
    "MissingExtraError",
    "OptionError",
    "Outcome",
    "Plan",
    "PlugInWarning",
    "PointsError",
    "Preview",
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
    "aspect_classes",
    "check",
    "check_contours",
    "compare",
    "comparison_picture",
    "contour_bands",
    "contour_labels",
    "contour_map",
    "contours",
    "cross_sections",
    "curvature",
    "difference",
    "drape",
    "earthwork_map",
    "find_format",
    "height_above",
    "hillshade",
    "histogram",
    "io",
    "known_formats",
    "length_unit",
    "lift",
    "lines_from_codes",
    "paper",
    "plan",
    "preview",
    "profile",
    "profile_picture",
    "quality",
    "rasterize",
    "read",
    "read_lines",
    "read_polygons",
    "read_rings",
    "read_water",
    "refine",
    "relief_map",
    "reproject",
    "section_lines",
    "section_picture",
    "simplify",
    "slope",
    "slope_classes",
    "slope_statistics",
    "stage_storage",
    "terrain",
    "tin",
    "transform_points",
    "triangulate",
    "volume",
    "voronoi",
    "with_lines",
    "write",
]
