"""The meaning room: what a terrain surface says. Knows no files."""

from .errors import RenderError
from .slope import aspect, slope

__all__ = [
    "RenderError",
    "aspect",
    "slope",
]
