"""Coordinates as GeoJSON wants them: WGS 84 by RFC 7946, or the CRS's own by the older rule."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .crs import as_crs, elevation_unit, length_unit, transform_points
from .errors import CrsError, WriteError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["Places", "crs_places", "require_one_piece", "texts", "unit_metres", "wgs84_places"]

DEGREE_DECIMALS = 9  # a tenth of a millimetre on the ground
ELEVATION_DECIMALS = 6  # a micrometre
_HALF_TURN = 180.0
_BATCH = 65_536


class Places(NamedTuple):
    """Coordinates as they are written.

    Attributes
    ----------
    xyz : (n, 3) float64 array
    crs_member : str or None
        JSON text of the old-style ``crs`` member; None where RFC 7946 forbids one.
    """

    xyz: NDArray[np.float64]
    crs_member: str | None = None


def wgs84_places(points: NDArray[np.float64], crs: str | None) -> Places:
    """Move points to WGS 84 longitude, latitude and elevation in metres, rounded.

    Parameters
    ----------
    points : (n, 3) float64 array, CRS units
    crs : str or None

    Raises
    ------
    CrsError
        If the CRS is not known, or puts a point outside the range of longitude and latitude.

    Notes
    -----
    The elevation's datum is changed only where the CRS has a vertical part, and then only as far
    as PROJ finds the geoid grid; otherwise the elevation keeps its datum and only its unit
    becomes the metre.
    """
    if crs is None:
        raise CrsError(
            "The CRS of these points is not known, and GeoJSON is in WGS 84: declare it, for "
            'example crs="EPSG:32616", or keep the coordinates as they are with projected=True.'
        )
    # Of CRSs of the same kind PROJ changes heights only between systems that both have them.
    target = "EPSG:4979" if _has_heights(crs) else "OGC:CRS84"
    moved = transform_points(points, crs, target)
    if not _has_heights(crs):
        moved[:, 2] *= elevation_unit(crs).metres or 1.0
    _require_on_earth(moved, points, crs)
    moved[:, :2] = np.round(moved[:, :2], DEGREE_DECIMALS)
    moved[:, 2] = np.round(moved[:, 2], ELEVATION_DECIMALS)
    return Places(moved + 0.0)


def crs_places(points: NDArray[np.float64], crs: str | None) -> Places:
    """Keep points as they are, and name their CRS by the rule of 2008 (``null``: unknown)."""
    if crs is None:
        return Places(points, "null")
    authority = as_crs(crs).to_authority(min_confidence=100)
    name = f"urn:ogc:def:crs:{authority[0]}::{authority[1]}" if authority else crs
    return Places(points, json.dumps({"type": "name", "properties": {"name": name}}))


def unit_metres(crs: str | None) -> tuple[float | None, float | None]:
    """Return the metres in a unit of easting, and of elevation; None where not known."""
    along = length_unit(crs).metres
    return along, None if crs is None else elevation_unit(crs).metres


def texts(xyz: NDArray[np.float64]) -> NDArray[np.object_]:
    """Return each position as JSON text, in the fewest digits that give the same double back."""
    written = np.empty(len(xyz), object)
    for start in range(0, len(xyz), _BATCH):
        batch = xyz[start : start + _BATCH]
        written[start : start + _BATCH] = list(
            map("[%r,%r,%r]".__mod__, zip(*batch.T.tolist(), strict=True))
        )
    return written


def require_one_piece(longitudes: NDArray[np.float64], path: Path) -> None:
    """Refuse features that reach from one end of the longitudes to the other.

    Parameters
    ----------
    longitudes : (m, k) float64 array, degrees
        Of the k corners of each feature.

    Raises
    ------
    WriteError
        If two corners of a feature are more than half a turn apart.
    """
    wide = np.ptp(longitudes, axis=1) > _HALF_TURN
    if wide.any():
        raise WriteError(
            f"Cannot write '{path}': {int(wide.sum())} triangles cross the antimeridian or hold "
            "a pole, which longitude and latitude cannot show in one piece; keep the coordinates "
            "of the CRS with projected=True.",
            path=path,
        )


def _has_heights(crs: str) -> bool:
    return len(as_crs(crs).axis_info) > 2


def _require_on_earth(moved: NDArray[np.float64], points: NDArray[np.float64], crs: str) -> None:
    outside = (np.abs(moved[:, :2]) > (180.0, 90.0)).any(axis=1)
    if outside.any():
        row = int(np.argmax(outside))
        x, y = points[row, :2]
        raise CrsError(
            f"{int(outside.sum())} points are no places on Earth in this CRS (first: point {row} "
            f"at {x:.12g}, {y:.12g}): longitudes of -180 to 180 and latitudes of -90 to 90 are "
            "allowed; check that the CRS is the right one.",
            crs=crs,
        )
