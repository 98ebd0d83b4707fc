"""What is derived from a TIN: slope, 3D models, previews, charts. Knows no files."""

from ..errors import OptionError, RenderError
from .charts.comparison import comparison_picture
from .charts.contour_map import contour_map
from .charts.earthwork import earthwork_map
from .charts.histogram import histogram
from .earthwork import Difference, difference, level_surface, stage_storage, volume
from .isolines import ContourCheck, check_contours, contour_bands, contour_labels, contours
from .lift import lift
from .preview.picture import preview
from .results import Features, Raster, Table
from .slope import aspect, slope

__all__ = [
    "ContourCheck",
    "Difference",
    "Features",
    "OptionError",
    "Raster",
    "RenderError",
    "Table",
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
    "level_surface",
    "lift",
    "preview",
    "slope",
    "stage_storage",
    "volume",
]
