"""What is derived from a TIN: slope, 3D models, previews, charts. Knows no files."""

from ..errors import OptionError, RenderError
from .charts.comparison import comparison_picture
from .charts.histogram import histogram
from .lift import lift
from .preview.picture import preview
from .relief import aspect_classes, curvature, hillshade, slope_classes, slope_statistics
from .results import Features, Raster, Table
from .slope import aspect, slope

__all__ = [
    "Features",
    "OptionError",
    "Raster",
    "RenderError",
    "Table",
    "aspect",
    "aspect_classes",
    "comparison_picture",
    "curvature",
    "hillshade",
    "histogram",
    "lift",
    "preview",
    "slope",
    "slope_classes",
    "slope_statistics",
]
