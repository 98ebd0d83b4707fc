"""Georeference: CRS and units of surfaces, scales on the ground, and where a CRS applies."""

from .agreement import (
    PlaneUnits,
    Reference,
    Referenced,
    agree,
    describe_unknown,
    find_plane_units,
    require_same_crs,
)
from .axes import find_axes, gives_northing_first, label_axes, undo_north_up
from .units import find_scales

__all__ = [
    "PlaneUnits",
    "Reference",
    "Referenced",
    "agree",
    "describe_unknown",
    "find_axes",
    "find_plane_units",
    "find_scales",
    "gives_northing_first",
    "label_axes",
    "require_same_crs",
    "undo_north_up",
]
