"""Volumes and differences of surfaces, in closed form."""

from .differences import Difference, difference
from .planes import level_surface
from .storage import stage_storage
from .volumes import volume

__all__ = ["Difference", "difference", "level_surface", "stage_storage", "volume"]
