"""Hydrology: where water runs on a surface, and where it stands."""

from .drainage import catchments, flow_accumulation
from .edges import ridges_and_valleys
from .paths import flow_path
from .water_bodies import depressions, pits, ponds

__all__ = [
    "catchments",
    "depressions",
    "flow_accumulation",
    "flow_path",
    "pits",
    "ponds",
    "ridges_and_valleys",
]
