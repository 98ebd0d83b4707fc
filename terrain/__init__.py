"""What is derived from a TIN: slope, 3D models, previews, charts. Knows no files."""

from ..errors import OptionError, RenderError
from .charts.comparison import comparison_picture
from .charts.earthwork import earthwork_map
from .charts.histogram import histogram
from .earthwork import Difference, difference, stage_storage, volume
from .lift import lift
from .preview.picture import preview
from .results import Features, Raster, Table
from .slope import aspect, slope

__all__ = [
    "Difference",
    "Features",
    "OptionError",
    "Raster",
    "RenderError",
    "Table",
    "aspect",
    "comparison_picture",
    "difference",
    "earthwork_map",
    "histogram",
    "lift",
    "preview",
    "slope",
    "stage_storage",
    "volume",
]
