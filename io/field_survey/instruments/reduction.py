"""Radial shots reduced to coordinates.

The slope distance s, the zenith angle v and the azimuth a from a station give, in the plane,
``e = e0 + s sin v sin a`` and ``n = n0 + s sin v cos a``; in height ``z = z0 + i + s cos v - t``
with the heights i of the instrument and t of the target. The curvature of the earth and refraction
raise the target by ``(1 - k) (s sin v)^2 / 2R`` where a coefficient k is given. Nothing else is
applied: no scale of a projection, no sea level, no weather, no constant of a prism.
"""

from __future__ import annotations

import math
from typing import NamedTuple

EARTH_RADIUS = 6_371_000.0
"""Metres; the difference to any curvature of the ellipsoid is below 1 % of a correction of
millimetres."""

NOT_APPLIED = "no scale of the projection, sea level, weather or prism constant"


class Station(NamedTuple):
    """Where an instrument stood, all in one unit of length; NaN for what is not known."""

    easting: float
    northing: float
    elevation: float
    """These three are those of the mark."""
    instrument_height: float
    orientation: float
    """Azimuth of the circle's zero, radians clockwise from north."""

    @property
    def is_known(self) -> bool:
        """Whether shots from here can be reduced."""
        return all(map(math.isfinite, self))


class Shot(NamedTuple):
    """What an instrument read: angles in radians, lengths in the unit of its station."""

    circle: float
    zenith: float
    distance: float
    target_height: float

    @property
    def is_known(self) -> bool:
        """Whether all of it is there."""
        return all(map(math.isfinite, self)) and self.distance > 0

    @property
    def on_face_one(self) -> Shot:
        """The same with the telescope the right way up."""
        zenith = self.zenith % (2 * math.pi)
        if zenith <= math.pi:
            return self._replace(zenith=zenith)
        return self._replace(circle=self.circle - math.pi, zenith=2 * math.pi - zenith)


def reduce_shot(
    station: Station, shot: Shot, *, refraction: float | None, metres: float
) -> tuple[float, float, float]:
    """Return easting, northing and elevation of a target.

    Parameters
    ----------
    station : Station
    shot : Shot
    refraction : float or None
        Coefficient of refraction, such as 0.13; None leaves curvature and refraction alone.
    metres : float
        Length of the unit.
    """
    read = shot.on_face_one
    azimuth = read.circle + station.orientation
    across = read.distance * math.sin(read.zenith)
    up = station.instrument_height + read.distance * math.cos(read.zenith) - read.target_height
    if refraction is not None:
        up += (1.0 - refraction) * across * across * metres / (2.0 * EARTH_RADIUS)
    return (
        station.easting + across * math.sin(azimuth),
        station.northing + across * math.cos(azimuth),
        station.elevation + up,
    )


def to_radians(value: float, unit: str) -> float:
    """Return an angle in radians.

    Parameters
    ----------
    value : float
        A sexagesimal angle as DDD.MMSS, DDD.MMSSs and so on.
    unit : {"gon", "degrees", "sexagesimal", "mil"}
    """
    if unit == "gon":
        return math.radians(value * 0.9)
    if unit == "mil":
        return value * math.pi / 3200.0
    if unit == "degrees":
        return math.radians(value)
    return math.radians(_from_sexagesimal(value))


def _from_sexagesimal(value: float) -> float:
    """Return degrees; NaN if minutes or seconds are 60 or more."""
    packed = round(abs(value) * 1e8)
    degrees, rest = divmod(packed, 10**8)
    minutes, seconds = divmod(rest, 10**6)
    if minutes >= 60 or seconds >= 60 * 10**4:
        return math.nan
    return math.copysign(degrees + minutes / 60.0 + seconds / 3.6e7, value)
