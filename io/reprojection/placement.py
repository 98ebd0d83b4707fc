"""Points of a file come to the CRS in which they are wanted; degrees do not make a TIN."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, NoReturn

import numpy as np

from ...base.crs import CRS, require_same_unit
from ...base.errors import CrsError, ReadError
from ...base.sentences import FILE, coordinate
from .contradictions import are_small_degrees, look_at_degrees, look_at_order, look_at_place
from .transformation import convert_elevations, find_utm_zone, reproject, transform_points

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import Unit

__all__ = ["DegreesError", "Placed", "place", "settle_unit"]

_WGS84 = "EPSG:4326"
_MOST_DEGREES = 540.0
"""Longitudes go on beyond 360 where data cross the antimeridian; latitudes never do."""


class DegreesError(ReadError):
    """The points would be in degrees, as no other CRS was asked for."""


class Placed(NamedTuple):
    """Points in the CRS wanted."""

    points: Float64Array
    """(n, 3)."""
    crs: CRS | None
    elevation_unit: Unit | None
    """None if it is not known."""
    notes: tuple[str, ...]
    """What was done to the elevations, and whether points lie where the CRS does not apply."""
    noted: tuple[str, ...] = ()
    """The latter alone."""


def place(
    points: Float64Array,
    *,
    source: CRS | None,
    target: CRS | None,
    unit: Unit | None = None,
    looks_at_area: bool = True,
    looks_at_order: bool | None = None,
) -> Placed:
    """Bring points, (n, 3), into a projected CRS: the target, else their source.

    Points without a source are declared to be in the target. ``unit`` is that of the elevations, if
    it is known otherwise than by the source. Which points lie outside the area of use of either CRS
    is not looked at where the reader has done so; nor, unless ``looks_at_order`` tells otherwise,
    which coordinate comes first.

    Raises
    ------
    ReadError
        If the points would be in degrees.
    CrsError
        If they cannot be transformed, or contradict their CRS: they lie in its area of use only
        exchanged, or only as degrees.
    """
    notes: tuple[str, ...] = ()
    if source is None and target is not None and are_small_degrees(points, target):
        source = CRS.of(_WGS84)
        notes = (
            f"The file names no CRS, and its coordinates lie in the area of {target.label} as "
            "longitude and latitude only: they were taken to be degrees of WGS 84.",
        )
    wanted = target if target is not None else source
    if wanted is not None and wanted.is_geographic:
        _refuse_degrees(points, wanted, source or wanted)
    outside = look_at_place(points, source, target) if looks_at_area else ()
    is_open = source is None and (looks_at_area if looks_at_order is None else looks_at_order)
    order = look_at_order(points, target) if is_open else ()
    noted = (*notes, *(outside or look_at_degrees(points, source or target)), *order)
    if source is None or wanted is None or source.is_same(wanted):
        placed = _keep_in_place(points, wanted, unit)
        return placed._replace(notes=(*noted, *placed.notes), noted=noted)
    moved = reproject(points, source, wanted, unit=unit)
    return Placed(moved.points, wanted, moved.unit, (*noted, *moved.notes), noted)


def _keep_in_place(points: Float64Array, crs: CRS | None, unit: Unit | None) -> Placed:
    """Leave points where they are; elevations take the unit of the CRS's vertical axis."""
    vertical = None if crs is None else crs.vertical_unit
    if vertical is None or unit is None or unit == vertical:
        return Placed(points, crs, vertical or unit, ())
    note = f"Elevations were converted from {unit.name} to {vertical.name}."
    return Placed(convert_elevations(points, unit, vertical), crs, vertical, (note,))


def settle_unit(declared: Unit | None, found: Unit | None) -> Unit | None:
    """Return the unit of a file's elevations: what the file says, else what the caller declares.

    Raises
    ------
    OptionError
        If the two differ.
    """
    if declared is not None and found is not None:
        require_same_unit(found, declared, f"as {FILE} itself says")
    return declared if found is None else found


def _refuse_degrees(points: Float64Array, wanted: CRS, source: CRS) -> NoReturn:
    _require_degrees(points, source)
    suggestion = _suggest_zone(points, source)
    fitting = f"`crs='{suggestion}'`" if suggestion else "the option `crs`"
    raise DegreesError(
        f"{wanted.label} measures in degrees, and a TIN needs a projected CRS: "
        f"give {fitting} to reproject from longitude and latitude.",
    )


def _require_degrees(points: Float64Array, source: CRS) -> None:
    """Refuse coordinates that are in degrees by their CRS, and cannot be."""
    if not source.is_geographic or len(points) == 0:
        return
    middle = np.median(points[:, :2], axis=0)
    if (np.abs(middle) > _MOST_DEGREES).any():
        x, y = middle.tolist()
        raise CrsError(
            f"{FILE} is in {source.label}, in degrees, by what it says, and its coordinates, "
            f"about ({coordinate(x)}, {coordinate(y)}), are none: the CRS of the file is "
            "another one.",
            crs=source,
        )


def _suggest_zone(points: Float64Array, source: CRS) -> str | None:
    """Return the UTM zone of the middle of the points."""
    if len(points) == 0:
        return None
    middle = np.append((points[:, :2].min(axis=0) + points[:, :2].max(axis=0)) / 2, 0.0)
    try:
        longitude, latitude, _ = transform_points(middle[None, :], source, _WGS84)[0]
    except CrsError:
        return None
    return find_utm_zone(float(longitude), float(latitude))
