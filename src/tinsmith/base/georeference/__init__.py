"""Georeference: CRS and units of surfaces, scales on the ground, and where a CRS applies."""

from .agreement import (
    Agreement,
    PlaneUnits,
    Referenced,
    agree,
    describe_unknown,
    find_plane_units,
    require_same_crs,
)

__all__ = [
    "Agreement",
    "PlaneUnits",
    "Referenced",
    "agree",
    "describe_unknown",
    "find_plane_units",
    "require_same_crs",
]
