"""What is derived from a TIN: slope, 3D models, previews, charts. Knows no files."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..errors import OptionError, RenderError
    from .charts.blunders import blunder_map
    from .charts.comparison import comparison_picture
    from .charts.earthwork import earthwork_map
    from .charts.histogram import histogram
    from .charts.isolines import contour_map
    from .charts.profiles import profile_picture
    from .charts.relief import relief_map
    from .charts.sections import section_picture
    from .charts.triangles import to_matplotlib
    from .drawing.models import lift
    from .earthwork import Difference, difference, stage_storage, volume
    from .earthwork.grading import grade, paste
    from .gridding import height_above, rasterize
    from .ground_filter import GroundPoints, ground
    from .hydrology import (
        catchments,
        depressions,
        flow_accumulation,
        flow_path,
        pits,
        ponds,
        ridges_and_valleys,
    )
    from .inspection.findings import blunders
    from .inspection.flat_triangles import flats, mend_flats
    from .isolines import ContourCheck, check_contours, contour_bands, contour_labels, contours
    from .preview import Preview, preview
    from .relief.classes import aspect_classes, slope_classes
    from .relief.curvatures import curvature
    from .relief.gradients import aspect, slope
    from .relief.shading import hillshade
    from .relief.statistics import slope_statistics
    from .results import Features, Raster, Table
    from .sections import cross_sections, drape, profile, section_lines
    from .sheets import Plan, plan
    from .sight import line_of_sight, viewshed, visible_vertices
    from .simplification import simplify
else:  # a type checker takes every name for one that such a __getattr__ has
    from .._lazy import lazy_names

    # A small job starts at once, as it loads what it uses.
    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            "..errors": ("OptionError", "RenderError"),
            ".charts.blunders": ("blunder_map",),
            ".charts.comparison": ("comparison_picture",),
            ".charts.earthwork": ("earthwork_map",),
            ".charts.histogram": ("histogram",),
            ".charts.isolines": ("contour_map",),
            ".charts.profiles": ("profile_picture",),
            ".charts.relief": ("relief_map",),
            ".charts.sections": ("section_picture",),
            ".earthwork": ("Difference", "difference", "stage_storage", "volume"),
            ".inspection.flat_triangles": ("flats", "mend_flats"),
            ".gridding": ("height_above", "rasterize"),
            ".inspection.findings": ("blunders",),
            ".ground_filter": ("GroundPoints", "ground"),
            ".isolines": (
                "ContourCheck",
                "check_contours",
                "contour_bands",
                "contour_labels",
                "contours",
            ),
            ".earthwork.grading": ("grade", "paste"),
            ".drawing.models": ("lift",),
            ".preview": ("Preview", "preview"),
            ".relief.classes": ("aspect_classes", "slope_classes"),
            ".relief.curvatures": ("curvature",),
            ".relief.shading": ("hillshade",),
            ".relief.statistics": ("slope_statistics",),
            ".results": ("Features", "Raster", "Table"),
            ".sections": ("cross_sections", "drape", "profile", "section_lines"),
            ".sheets": ("Plan", "plan"),
            ".simplification": ("simplify",),
            ".relief.gradients": ("aspect", "slope"),
            ".charts.triangles": ("to_matplotlib",),
            ".hydrology": (
                "catchments",
                "depressions",
                "flow_accumulation",
                "flow_path",
                "pits",
                "ponds",
                "ridges_and_valleys",
            ),
            ".sight": (
                "line_of_sight",
                "viewshed",
                "visible_vertices",
            ),
        },
    )

__all__ = [
    "ContourCheck",
    "Difference",
    "Features",
    "GroundPoints",
    "OptionError",
    "Plan",
    "Preview",
    "Raster",
    "RenderError",
    "Table",
    "aspect",
    "aspect_classes",
    "blunder_map",
    "blunders",
    "catchments",
    "check_contours",
    "comparison_picture",
    "contour_bands",
    "contour_labels",
    "contour_map",
    "contours",
    "cross_sections",
    "curvature",
    "depressions",
    "difference",
    "drape",
    "earthwork_map",
    "flats",
    "flow_accumulation",
    "flow_path",
    "grade",
    "ground",
    "height_above",
    "hillshade",
    "histogram",
    "lift",
    "line_of_sight",
    "mend_flats",
    "paste",
    "pits",
    "plan",
    "ponds",
    "preview",
    "profile",
    "profile_picture",
    "rasterize",
    "relief_map",
    "ridges_and_valleys",
    "section_lines",
    "section_picture",
    "simplify",
    "slope",
    "slope_classes",
    "slope_statistics",
    "stage_storage",
    "to_matplotlib",
    "viewshed",
    "visible_vertices",
    "volume",
]
