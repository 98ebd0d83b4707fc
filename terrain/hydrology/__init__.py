"""Hydrology: where water runs on a surface, and where it stands."""

from .edges import ridges_and_valleys
from .paths import flow_path
from .water_bodies import depressions, pits, ponds

__all__ = ["depressions", "flow_path", "pits", "ponds", "ridges_and_valleys"]
