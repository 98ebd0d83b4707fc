"""Units: what the numbers of a CRS mean on the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pyproj

    from ..tin import TIN

__all__ = ["Ground", "Unit", "ground_of"]


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit of length.

    Attributes
    ----------
    symbol : str
        What is written behind a number; "" if the unit is unknown.
    metres : float
        Length of one unit; 1 if unknown.
    """

    symbol: str
    metres: float


METRE = Unit("m", 1.0)
UNKNOWN = Unit("", 1.0)
_SYMBOLS = {"metre": "m", "foot": "ft", "US survey foot": "US ft", "kilometre": "km"}
_VERTICAL = frozenset({"up"})
_HORIZONTAL = frozenset({"east", "north", "west", "south"})


@dataclass(frozen=True, slots=True)
class Ground:
    """How a TIN's coordinates are drawn true to scale.

    Attributes
    ----------
    crs_name : str
        Name for a caption, for example "WGS 84 / UTM zone 16N (EPSG:32616)".
    unit : Unit
        Of horizontal lengths in the picture.
    elevation_unit : Unit
    scale : tuple of float
        Factors from easting, northing and elevation to ``unit``.
    """

    crs_name: str
    unit: Unit
    elevation_unit: Unit
    scale: tuple[float, float, float]


def ground_of(tin: TIN) -> Ground:
    """Read the units of a TIN from its CRS.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    Ground
        Elevations have the unit of the CRS's vertical axis; without one the horizontal unit, or
        metres above a geographic CRS. Degrees are drawn as metres along the ellipsoid at the
        middle of the TIN, which holds for small areas.
    """
    crs = _parsed(tin.crs)
    if crs is None:
        name = "CRS unknown" if tin.crs is None else f"CRS {tin.crs:.40}"
        return _ground(name, UNKNOWN, UNKNOWN, (1.0, 1.0))
    vertical = _unit_along(crs, _VERTICAL)
    if crs.is_geographic:
        return _ground(_caption(crs), METRE, vertical or METRE, _degree_lengths(crs, tin))
    unit = _unit_along(crs, _HORIZONTAL) or UNKNOWN
    return _ground(_caption(crs), unit, vertical or unit, (1.0, 1.0))


def _ground(name: str, unit: Unit, vertical: Unit, horizontal: tuple[float, float]) -> Ground:
    return Ground(name, unit, vertical, (*horizontal, vertical.metres / unit.metres))


def _parsed(text: str | None) -> pyproj.CRS | None:
    """Return the CRS, or None where a caption is all that an unreadable one is worth."""
    if text is None:
        return None
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        return CRS.from_user_input(text)
    except CRSError:
        return None


def _caption(crs: pyproj.CRS) -> str:
    authority = crs.to_authority(min_confidence=100)
    return crs.name if authority is None else f"{crs.name} ({':'.join(authority)})"


def _unit_along(crs: pyproj.CRS, directions: frozenset[str]) -> Unit | None:
    """Return the unit of the first axis that points one of these ways, if there is one."""
    for axis in crs.axis_info:
        if axis.direction in directions and axis.unit_conversion_factor > 0:
            return Unit(_SYMBOLS.get(axis.unit_name, axis.unit_name), axis.unit_conversion_factor)
    return None


def _degree_lengths(crs: pyproj.CRS, tin: TIN) -> tuple[float, float]:
    """Return metres per CRS unit along a parallel and along a meridian, mid-TIN."""
    to_radians = float(crs.axis_info[0].unit_conversion_factor)
    latitude = tin.bounds.center[1] * to_radians
    ellipsoid: Any = crs.ellipsoid  # every geographic CRS has one
    major, minor = ellipsoid.semi_major_metre, ellipsoid.semi_minor_metre
    squared = 1.0 - (minor / major) ** 2
    bulge = 1.0 - squared * math.sin(latitude) ** 2
    prime_vertical = major / math.sqrt(bulge)
    meridian = prime_vertical * (1.0 - squared) / bulge
    return prime_vertical * math.cos(latitude) * to_radians, meridian * to_radians
