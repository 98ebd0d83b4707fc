"""Coordinates as GeoJSON wants them: WGS 84 by RFC 7946, or the CRS's own by the older rule."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.crs import CRS, METRE
from ....base.errors import CrsError, WriteError
from ....base.sentences import FILE, coordinate, counted, inflect
from ...reprojection.transformation import reproject

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, ObjectArray
    from ....base.crs import Unit

__all__ = [
    "Places",
    "format_positions",
    "keep_in_crs",
    "project_to_wgs84",
    "require_one_piece",
]

DEGREE_DECIMALS = 9  # a tenth of a millimetre on the ground
ELEVATION_DECIMALS = 6  # a micrometre
_HALF_TURN = 180.0
_BATCH = 65_536


class Places(NamedTuple):
    """Coordinates as they are written."""

    xyz: Float64Array
    """(n, 3)."""
    crs_member: str | None = None
    """JSON text of the old-style ``crs`` member; None where RFC 7946 forbids one."""
    members: tuple[tuple[str, str], ...] = ()
    """Further members of the file, which tell the unit of elevations."""


def project_to_wgs84(points: Float64Array, crs: CRS | None, elevation_unit: Unit | None) -> Places:
    """Move points, (n, 3), to WGS 84 longitude, latitude and elevation in metres, rounded.

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
            'example `crs="EPSG:32616"`, or keep the coordinates as they are with `projected=True`.'
        )
    has_datum = crs.vertical_unit is not None
    target = CRS.of("EPSG:4979" if has_datum else "OGC:CRS84")
    found = reproject(points, crs, target, unit=elevation_unit, wanted=METRE, needs_datum=False)
    moved = found.points
    outside = (np.abs(moved[:, :2]) > (180.0, 90.0)).any(axis=1)
    if outside.any():
        row = int(np.argmax(outside))
        x, y = points[row, :2]
        count = int(outside.sum())
        raise CrsError(
            f"{counted(count, 'point')} {'is no place' if count == 1 else 'are no places'} on "
            f"Earth in this CRS (first: point {row} at {coordinate(x)}, {coordinate(y)}): "
            "longitudes of -180 to "
            "180 and latitudes of -90 to 90 are allowed; check that the CRS is the right one.",
            crs=crs,
        )
    moved[:, :2] = np.round(moved[:, :2], DEGREE_DECIMALS)
    moved[:, 2] = np.round(moved[:, 2], ELEVATION_DECIMALS)
    members: tuple[tuple[str, str], ...] = ()
    usual = crs.usual_elevation_unit
    if elevation_unit is None and usual is not None and usual != METRE:
        text = f"metres; their unit was not known and taken to be the {usual.name}, that of the CRS"
        members = (("elevations", text),)
    if found.quality.keeps_datum:
        text = f"metres; their datum is that of {crs.name}, as PROJ has no grid to the ellipsoid"
        members = (("elevations", text),)
    return Places(moved + 0.0, members=members)


def keep_in_crs(points: Float64Array, crs: CRS | None, elevation_unit: Unit | None) -> Places:
    """Keep points as they are, and name their CRS by the rule of 2008 (``null``: unknown)."""
    members = () if elevation_unit is None else (("elevation_unit", elevation_unit.name),)
    if crs is None:
        return Places(points, "null", members)
    authority = crs.to_authority()
    name = f"urn:ogc:def:crs:{authority[0]}::{authority[1]}" if authority else str(crs)
    return Places(points, json.dumps({"type": "name", "properties": {"name": name}}), members)


def format_positions(xyz: Float64Array) -> ObjectArray:
    """Return each position as JSON text, in the fewest digits that give the same double back.

    Parameters
    ----------
    xyz : (n, 3) or (n, 2) float64 array
    """
    position = f"[{','.join(['%r'] * xyz.shape[1])}]"
    written = np.empty(len(xyz), object)
    for start in range(0, len(xyz), _BATCH):
        batch = xyz[start : start + _BATCH]
        written[start : start + _BATCH] = list(
            map(position.__mod__, zip(*batch.T.tolist(), strict=True))
        )
    return written


def require_one_piece(longitudes: Float64Array) -> None:
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
    count = int(wide.sum())
    if count:
        crossing = inflect("[crosses|cross] the antimeridian or [holds|hold]", count)
        raise WriteError(
            f"Cannot write {FILE}: {counted(count, 'triangle')} {crossing} a pole, "
            "which longitude and latitude cannot show in one piece; keep the coordinates "
            "of the CRS with `projected=True`."
        )
