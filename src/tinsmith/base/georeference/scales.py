"""Scales: how the coordinates of a TIN are measured on the ground, each in its own unit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from ..crs import Unit, assume_elevation_unit, scale_elevations
from .agreement import Referenced, find_plane_units

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..crs import CRS
    from ..types import Bounds

NOT_KNOWN = Unit("unit", "", None)


class Scales(NamedTuple):
    """Factors from easting, northing and elevation to one unit of length."""

    east: Any
    north: Any
    """Both are (k,) arrays above longitude and latitude, one value a place."""
    up: float


class Ellipsoid(NamedTuple):
    """Shape of the earth under a geographic CRS."""

    major: float
    """Half axis in the plane of the equator, metres."""
    squared: float
    """Squared eccentricity."""
    to_radians: float
    """Radians of a unit of the CRS."""


class Located(Referenced, Protocol):
    """What has a CRS, a unit of elevations and an extent, as every TIN."""

    @property
    def bounds(self) -> Bounds:
        """In CRS units."""


@dataclass(frozen=True, slots=True)
class Ground:
    """How a TIN's coordinates are drawn true to scale."""

    crs_name: str
    """Name for a caption, for example "WGS 84 / UTM zone 16N (EPSG:32616)"."""
    unit: Unit
    """Of horizontal lengths in the picture."""
    elevation_unit: Unit
    """The one that elevations are taken to have."""
    is_assumed: bool
    """Whether that unit is the usual one of the CRS, and not known."""
    scale: tuple[float, float, float]
    """Factors from easting, northing and elevation to ``unit``."""

    @property
    def elevation_caption(self) -> str:
        """The unit of elevations behind their name: "m", "m assumed", or nothing."""
        symbol = self.elevation_unit.symbol
        return f"{symbol} assumed" if symbol and self.is_assumed else symbol


def find_ground(tin: Located) -> Ground:
    """Read the units of a TIN from its CRS and its unit of elevations.

    Degrees are drawn as metres along the ellipsoid at the middle of the TIN, which holds for small
    areas.
    """
    crs = tin.crs
    up = assume_elevation_unit(crs, tin.elevation_unit) or NOT_KNOWN
    scales = find_scales(crs, tin.elevation_unit, tin.bounds.center[1])
    return Ground(
        "CRS unknown" if crs is None else crs.caption,
        find_plane_units(crs).length or NOT_KNOWN,
        up,
        tin.elevation_unit is None,
        (float(scales.east), float(scales.north), scales.up),
    )


def find_scales(crs: CRS | None, unit: Unit | None, northing: ArrayLike) -> Scales:
    """Return the factors that make all three coordinates lengths of one unit.

    That is the unit of eastings, in a geographic CRS metres along the ellipsoid, for which
    ``northing`` tells where: a number, or an array of k. If ``unit``, that of elevations, is not
    known the usual one of the CRS is taken. Where a unit is not known it is taken to be the same as
    the other.
    """
    if crs is None or not crs.is_geographic:
        return Scales(1.0, 1.0, scale_elevations(crs, unit))
    up = assume_elevation_unit(crs, unit)
    metres = None if up is None else up.metres
    major, squared, to_radians = _read_ellipsoid(crs)
    turn = np.asarray(northing, np.float64) * to_radians
    bulge = 1.0 - squared * np.sin(turn) ** 2
    prime_vertical = major / np.sqrt(bulge)
    meridian = prime_vertical * (1.0 - squared) / bulge
    return Scales(prime_vertical * np.cos(turn) * to_radians, meridian * to_radians, metres or 1.0)


def find_ellipsoid(crs: CRS | None) -> Ellipsoid | None:
    """Return the ellipsoid of a geographic CRS, None for others."""
    return None if crs is None or not crs.is_geographic else _read_ellipsoid(crs)


def _read_ellipsoid(crs: CRS) -> Ellipsoid:
    parsed: Any = crs.to_pyproj()  # every geographic CRS has axes and an ellipsoid
    major, minor = parsed.ellipsoid.semi_major_metre, parsed.ellipsoid.semi_minor_metre
    to_radians = float(parsed.axis_info[0].unit_conversion_factor)
    return Ellipsoid(float(major), 1.0 - (minor / major) ** 2, to_radians)
