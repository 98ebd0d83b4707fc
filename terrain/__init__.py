"""What is derived from a TIN: slope, 3D models, previews, charts. Knows no files."""

from ..errors import OptionError, RenderError
from .blunders import blunders
from .charts.blunders import blunder_map
from .charts.comparison import comparison_picture
from .charts.earthwork import earthwork_map
from .charts.histogram import histogram
from .charts.isolines import contour_map
from .charts.profiles import profile_picture
from .charts.relief import relief_map
from .charts.sections import section_picture
from .earthwork import Difference, difference, stage_storage, volume
from .gridding import height_above, rasterize
from .isolines import ContourCheck, check_contours, contour_bands, contour_labels, contours
from .lift import lift
from .preview import Preview, preview
from .relief import aspect_classes, curvature, hillshade, slope_classes, slope_statistics
from .results import Features, Raster, Table
from .sections import cross_sections, drape, profile, section_lines
from .sheets import Plan, plan
from .slope import aspect, slope

__all__ = [
    "ContourCheck",
    "Difference",
    "Features",
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
    "check_contours",
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
    "height_above",
    "hillshade",
    "histogram",
    "lift",
    "plan",
    "preview",
    "profile",
    "profile_picture",
    "rasterize",
    "relief_map",
    "section_lines",
    "section_picture",
    "slope",
    "slope_classes",
    "slope_statistics",
    "stage_storage",
    "volume",
]
