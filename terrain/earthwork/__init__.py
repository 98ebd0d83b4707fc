"""Volumes and differences of surfaces, in closed form."""

from .differences import Difference, difference
from .storage import stage_storage
from .volumes import volume

__all__ = ["Difference", "difference", "stage_storage", "volume"]
