"""The same with the driver of virtual rasters: another child, since drivers hold for a process."""

from __future__ import annotations

from ..isolated.gdal import REFERRING_DRIVERS, environment
from .gdal_child import _require_plain_drivers, header, strips

__all__ = ["ENVIRONMENT", "header", "prepare", "strips"]

ENVIRONMENT = environment(allowed=["VRT"])


def prepare() -> None:
    """Load the library, and make sure that no other driver is loaded that follows references."""
    _require_plain_drivers(set(REFERRING_DRIVERS) - {"VRT"})
