"""Volumes and differences of surfaces, in closed form."""

from .clipping import clip
from .differences import Difference, difference
from .error_models import ErrorModel
from .planes import as_plane, level_surface
from .regions import as_regions
from .storage import stage_storage
from .volumes import volume

__all__ = [
    "Difference",
    "ErrorModel",
    "as_plane",
    "as_regions",
    "clip",
    "difference",
    "level_surface",
    "stage_storage",
    "volume",
]
