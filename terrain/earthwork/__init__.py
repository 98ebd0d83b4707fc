"""Volumes and differences of surfaces, in closed form."""

from .cells import Pieces
from .differences import Difference, difference
from .planes import as_plane, level_surface
from .reference import Surface, make_reference
from .regions import as_regions
from .slivers import measure_rounding
from .storage import stage_storage
from .volumes import volume

__all__ = [
    "Difference",
    "Pieces",
    "Surface",
    "as_plane",
    "as_regions",
    "difference",
    "level_surface",
    "make_reference",
    "measure_rounding",
    "stage_storage",
    "volume",
]
