"""The meaning room: what a terrain surface says. Knows no files."""

from ..errors import OptionError, RenderError
from .comparison import comparison_picture
from .histogram import histogram
from .lift import lift
from .preview import preview
from .slope import aspect, slope

__all__ = [
    "OptionError",
    "RenderError",
    "aspect",
    "comparison_picture",
    "histogram",
    "lift",
    "preview",
    "slope",
]
