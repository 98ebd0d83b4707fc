"""The meaning room: what a terrain surface says. Knows no files."""

from .errors import OptionError, RenderError
from .lift import lift
from .preview import preview
from .slope import aspect, slope

__all__ = [
    "OptionError",
    "RenderError",
    "aspect",
    "lift",
    "preview",
    "slope",
]
