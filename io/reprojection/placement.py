"""Points of a file come to the CRS in which they are wanted; degrees do not make a TIN."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, NoReturn

import numpy as np

from ..._sentences import coordinate, counted
from ...crs import require_same_unit
from ...errors import CrsError, ReadError
from ...tin.screening.area_of_use import AreaOfUse
from .transformation import convert_elevations, find_utm_zone, reproject, transform_points

if TYPE_CHECKING:
    from pathlib import Path

    from ...arrays import Float64Array
    from ...crs import CRS, Unit

__all__ = [
    "DegreesError",
    "Placed",
    "describe_local",
    "place",
    "require_no_degrees",
    "settle_unit",
]

_WGS84 = "EPSG:4326"
_DEGREES_ADVICE = (
    "set the CRS of the file to the one of its degrees, such as EPSG:4326, or read it without a "
    "CRS if they are lengths"
)
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


def place(
    points: Float64Array,
    *,
    source: CRS | None,
    target: CRS | None,
    path: Path,
    unit: Unit | None = None,
    looks_at_area: bool = True,
) -> Placed:
    """Bring points, (n, 3), into a projected CRS: the target, else their source.

    Points without a source are declared to be in the target. ``unit`` is that of the elevations, if
    it is known otherwise than by the source. Which points lie outside the area of use of either CRS
    is not told where the reader has looked at it.

    Raises
    ------
    ReadError
        If the points would be in degrees.
    CrsError
        If they cannot be transformed; if most lie outside the area of use, and inside it with
        coordinates exchanged, or as longitude and latitude.
    """
    wanted = target if target is not None else source
    if wanted is not None and wanted.is_geographic:
        _refuse_degrees(points, wanted, source or wanted, path)
    told = _require_in_area(points, source, target, path) if looks_at_area else ()
    if source is None or wanted is None or source.is_same(wanted):
        placed = _keep_in_place(points, wanted, unit)
        return placed._replace(notes=(*told, *placed.notes))
    try:
        moved = reproject(points, source, wanted, unit=unit)
    except CrsError as error:
        raise CrsError(f"'{path}': {error}", crs=wanted) from error
    return Placed(moved.points, wanted, moved.unit, (*told, *moved.notes))


def _require_in_area(
    points: Float64Array, source: CRS | None, target: CRS | None, path: Path
) -> tuple[str, ...]:
    """Tell how many points lie outside the areas of use; refuse those that are plainly others.

    Raises
    ------
    CrsError
    """
    area = AreaOfUse.of(source, target)
    if area is None or len(points) == 0:
        return ()
    is_moved = source is not None and target is not None and not source.is_same(target)
    require_no_degrees(points, area, path, "")
    if not is_moved and area.is_local(points[:, :2]):
        return (describe_local(points, area),)
    outside = area.find_outside(points[:, :2])
    if len(outside) == 0:
        return ()
    lie = "lies" if len(outside) == 1 else "lie"
    told = (
        f"{len(outside):,} of {counted(len(points), 'point')} {lie} outside the area of use of "
        f"{area.label}"
    )
    if not area.covers_most(points[outside][:, [1, 0]]):
        return (f"{told}: check that the CRS is the right one.",)
    if 2 * len(outside) <= len(points):
        return (f"{told} and, exchanged, inside: check the order of the coordinates.",)
    raise CrsError(
        f"'{path}': {told} and, exchanged, inside: the file has them in another order than "
        "easting (longitude), northing (latitude), or is in another CRS; put right whichever is "
        "wrong.",
        crs=area.source,
    )


def require_no_degrees(points: Float64Array, area: AreaOfUse, path: Path, advice: str) -> None:
    """Refuse longitudes and latitudes that are declared to be eastings and northings.

    Raises
    ------
    CrsError
        If the points lie about the origin of the coordinates, far from the area of use, and inside
        it as degrees.
    """
    xy = points[:, :2]
    if area.is_local(xy) and area.holds_as_degrees(xy):
        x, y = xy[0].tolist()
        raise CrsError(
            f"'{path}': the coordinates (first: {x:.10g}, {y:.10g}) lie inside the area of use of "
            f"{area.label} as longitude and latitude, and {area.source.label} measures in "
            f"{area.source.horizontal_unit.name}: {advice or _DEGREES_ADVICE}.",
            crs=area.source,
        )


def describe_local(points: Float64Array, area: AreaOfUse) -> str:
    """Tell of points about the origin of the coordinates, which may be local or degrees."""
    x, y = points[0, :2].tolist()
    return (
        f"The points lie about the origin of {area.source.label} (first: easting {coordinate(x)}, "
        f"northing {coordinate(y)}), outside its area of use: check that they are no local "
        "coordinates, and no degrees."
    )


def _keep_in_place(points: Float64Array, crs: CRS | None, unit: Unit | None) -> Placed:
    """Leave points where they are; elevations take the unit of the CRS's vertical axis."""
    vertical = None if crs is None else crs.vertical_unit
    if vertical is None or unit is None or unit == vertical:
        return Placed(points, crs, vertical or unit, ())
    note = f"Elevations were converted from {unit.name} to {vertical.name}."
    return Placed(convert_elevations(points, unit, vertical), crs, vertical, (note,))


def settle_unit(declared: Unit | None, found: Unit | None, path: Path) -> Unit | None:
    """Return the unit of a file's elevations: what the file says, else what the caller declares.

    Raises
    ------
    OptionError
        If the two differ.
    """
    if declared is not None and found is not None:
        require_same_unit(found, declared, f"as '{path}' itself says")
    return declared if found is None else found


def _refuse_degrees(points: Float64Array, wanted: CRS, source: CRS, path: Path) -> NoReturn:
    _require_degrees(points, source, path)
    suggestion = _suggest_zone(points, source)
    fitting = f"crs='{suggestion}'" if suggestion else "the option crs"
    raise DegreesError(
        f"'{path}': {wanted.label} measures in degrees, and a TIN needs a projected CRS: "
        f"give {fitting} to reproject from longitude and latitude.",
        path=path,
    )


def _require_degrees(points: Float64Array, source: CRS, path: Path) -> None:
    """Refuse coordinates that are in degrees by their CRS, and cannot be."""
    if not source.is_geographic or len(points) == 0:
        return
    middle = np.median(points[:, :2], axis=0)
    if (np.abs(middle) > _MOST_DEGREES).any():
        x, y = middle.tolist()
        raise CrsError(
            f"'{path}' is in {source.label}, in degrees, by what it says, and its coordinates, "
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
