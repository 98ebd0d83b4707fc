"""The same with the driver of virtual rasters: another child, since drivers hold for a process."""

from __future__ import annotations

from ..isolated import REFERRING_DRIVERS, make_environment
from .gdal_child import _require_plain_drivers
from .gdal_child import read_header as read_header
from .gdal_child import read_strips as read_strips

ENVIRONMENT = make_environment(allowed=["VRT"])


def prepare() -> None:
    """Load the library, and make sure that no other driver is loaded that follows references."""
    _require_plain_drivers(set(REFERRING_DRIVERS) - {"VRT"})
