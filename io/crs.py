"""Coordinate reference systems: from text and back, transformation of points, units.

Everywhere else a CRS travels as text: an authority code ("EPSG:32616") or WKT. Coordinates are
always in the order easting, northing (longitude, latitude), whatever the authority says.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from .errors import CrsError

if TYPE_CHECKING:
    import pyproj
    from numpy.typing import NDArray

__all__ = [
    "METRE",
    "LengthUnit",
    "as_crs",
    "crs_label",
    "crs_text",
    "elevation_unit",
    "fitting_utm",
    "is_geographic",
    "length_unit",
    "normalised",
    "transform_points",
]

_SHOWN_LETTERS = 60


@dataclass(frozen=True, slots=True)
class LengthUnit:
    """A unit of length.

    Attributes
    ----------
    name : str
        As the authority writes it, for example "US survey foot".
    symbol : str
        As it stands behind a number, for example "m".
    metres : float or None
        Its length; None if it is unknown, or an angle.
    """

    name: str
    symbol: str
    metres: float | None


METRE = LengthUnit("metre", "m", 1.0)
_UNKNOWN = LengthUnit("unit", "units", None)
_SYMBOLS = {
    "metre": "m",
    "meter": "m",
    "foot": "ft",
    "US survey foot": "US ft",
    "kilometre": "km",
}


@lru_cache(maxsize=32)
def as_crs(text: str) -> pyproj.CRS:
    """Look a coordinate reference system up.

    Parameters
    ----------
    text : str
        Authority code ("EPSG:32616", or the bare number), WKT, PROJ string or PROJJSON.

    Raises
    ------
    CrsError
        If PROJ does not know it.

    Examples
    --------
    >>> as_crs("EPSG:32616").name
    'WGS 84 / UTM zone 16N'
    """
    import pyproj
    from pyproj.exceptions import CRSError

    wanted = str(text).strip()
    try:
        return pyproj.CRS.from_user_input(f"EPSG:{wanted}" if wanted.isdecimal() else wanted)
    except CRSError as error:
        raise CrsError(
            f"Unknown CRS '{_shortened(wanted)}': an authority code such as EPSG:32616, "
            "a WKT or a PROJ text is needed.",
            crs=text,
        ) from error


def crs_text(crs: pyproj.CRS) -> str:
    """Return the authority code of a CRS if it has one that means exactly this, else its WKT."""
    authority = crs.to_authority(min_confidence=100)
    return ":".join(authority) if authority else str(crs.to_wkt())


def normalised(text: str | None) -> str | None:
    """Return a caller's CRS text in the form in which it travels; None stays None.

    Raises
    ------
    CrsError
        If PROJ does not know it.
    """
    return None if text is None else crs_text(as_crs(text))


def crs_label(text: str | None) -> str:
    """Return a short name of a CRS for people: its code, else its name."""
    if text is None:
        return "unknown"
    return text if len(text) <= 24 else str(as_crs(text).name)


def is_geographic(text: str | None) -> bool:
    """Whether coordinates in this CRS are longitude and latitude."""
    return text is not None and bool(as_crs(text).is_geographic)


def length_unit(text: str | None) -> LengthUnit:
    """Return the unit of eastings and northings; ``metres`` is None where it is no known length.

    Examples
    --------
    >>> length_unit("EPSG:2274")
    LengthUnit(name='US survey foot', symbol='US ft', metres=0.30480060960121924)
    """
    axes = [] if text is None else as_crs(text).axis_info
    if not axes:
        return _UNKNOWN
    if is_geographic(text):
        return LengthUnit("degree", "°", None)
    return _unit(axes[0].unit_name, axes[0].unit_conversion_factor)


def elevation_unit(text: str | None) -> LengthUnit:
    """Return the unit of elevations.

    That of the CRS's vertical axis; without one the unit of its eastings, since who works in
    State Plane feet levels in feet; metres above longitude and latitude, or where nothing is known.
    """
    axes = [] if text is None else as_crs(text).axis_info
    if len(axes) >= 3:
        return _unit(axes[2].unit_name, axes[2].unit_conversion_factor)
    along = length_unit(text)
    return METRE if along.metres is None else along


def _unit(name: str, metres: float) -> LengthUnit:
    return LengthUnit(name, _SYMBOLS.get(name, name), float(metres))


def transform_points(points: NDArray[np.float64], source: str, target: str) -> NDArray[np.float64]:
    """Move points from one CRS to another.

    Parameters
    ----------
    points : (n, 3) float64 array
        Easting (longitude), northing (latitude), elevation.
    source, target : str
        CRS as authority code or WKT.

    Returns
    -------
    (n, 3) float64 array
        Elevations change only where both systems have a vertical axis.

    Raises
    ------
    CrsError
        If a CRS is unknown, no transformation exists, or a point lies outside its domain.
    """
    import pyproj
    from pyproj.exceptions import ProjError

    points = np.asarray(points, np.float64)
    names = f"from {crs_label(source)} to {crs_label(target)}"
    try:
        transformer = pyproj.Transformer.from_crs(as_crs(source), as_crs(target), always_xy=True)
        moved = np.stack(transformer.transform(*points.T), axis=1)
    except ProjError as error:
        raise CrsError(f"No transformation {names} is known.", crs=target) from error
    lost = ~np.isfinite(moved).all(axis=1)
    if lost.any():
        row = int(np.argmax(lost))
        x, y = points[row, :2]
        raise CrsError(
            f"{int(lost.sum())} points have no image {names} (first: point {row} at {x:g}, {y:g}): "
            "check that the CRS of the points is the right one.",
            crs=target,
        )
    return np.ascontiguousarray(moved)


def fitting_utm(longitude: float, latitude: float) -> str:
    """Return the code of the WGS 84 UTM zone (near the poles: UPS) that holds a place.

    Examples
    --------
    >>> fitting_utm(-84.2, 36.4)
    'EPSG:32616'
    """
    if latitude >= 84.0:
        return "EPSG:32661"
    if latitude < -80.0:
        return "EPSG:32761"
    zone = int((longitude + 180.0) % 360.0 // 6.0) + 1
    return f"EPSG:{326 if latitude >= 0 else 327}{zone:02d}"


def _shortened(text: str) -> str:
    return text if len(text) <= _SHOWN_LETTERS else text[: _SHOWN_LETTERS - 3] + "..."
