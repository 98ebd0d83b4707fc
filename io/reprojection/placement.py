"""Points of a file come to the CRS in which they are wanted; degrees do not make a TIN."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, NoReturn

import numpy as np

from ...base.crs import CRS, require_same_unit
from ...base.errors import CrsError, ReadError
from ...base.sentences import FILE, coordinate
from .crs_checks import Places, are_small_degrees
from .transformation import convert_elevations, find_utm_zone, reproject, transform_points

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import Unit

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
    placing = Placing(source, target, unit, looks_at_area, looks_at_order)
    placing.look(points)
    noted = placing.describe()
    placed = placing.move(points)
    return placed._replace(notes=(*noted, *placed.notes), noted=noted)


def stays(source: CRS | None, target: CRS | None) -> bool:
    """Whether points are certainly not reprojected."""
    return target is None or (source is not None and source.is_same(target))


class Placing:
    """Points of a file that are placed block by block, each by itself: see :func:`place`.

    Parameters
    ----------
    source, target, unit, looks_at_area, looks_at_order
        As of :func:`place`.

    Notes
    -----
    What a CRS is contradicted by is told of all points together, at the end. Whether coordinates
    without a CRS are degrees is decided by the first block; a later one that contradicts is
    refused.
    """

    def __init__(
        self,
        source: CRS | None,
        target: CRS | None,
        unit: Unit | None = None,
        looks_at_area: bool = True,
        looks_at_order: bool | None = None,
    ) -> None:
        self._source, self._target, self._unit = source, target, unit
        is_open = looks_at_area if looks_at_order is None else looks_at_order
        self._looks = (looks_at_area, is_open)
        self._places: Places | None = None
        self._degrees: Float64Array | None = None
        self._count = 0
        self._notes: tuple[str, ...] = ()
        self._last = Placed(np.empty((0, 3)), None, None, ())

    def add(self, points: Float64Array) -> Placed:
        """Place further points, (n, 3); the notes are those of the transformation alone."""
        if len(points) == 0:
            return self._last._replace(points=points)
        self.look(points)
        try:
            self._last = self.move(points)
        except CrsError:
            self.describe()  # a contradiction tells more than a point without an image
            raise
        self._count += len(points)
        return self._last

    @property
    def elevation_unit(self) -> Unit | None:
        """Unit of the elevations of the points that were placed; None before the first."""
        return self._last.elevation_unit

    def finish(self) -> tuple[str, ...]:
        """Return what is to be told of all points, in sentences.

        Raises
        ------
        CrsError
            If they contradict their CRS.
        """
        return (*self.describe(), *self._last.notes)

    def look(self, points: Float64Array) -> None:
        """Look at further points as they are in the file."""
        source, target = self._source, self._target
        if self._places is None:
            if source is None and target is not None and are_small_degrees(points, target):
                self._source = source = CRS.of(_WGS84)
                self._degrees = points
                self._notes = (
                    f"The file names no CRS, and its coordinates lie in the area of {target.label} "
                    "as longitude and latitude only: they were taken to be degrees of WGS 84.",
                )
            wanted = target if target is not None else source
            if wanted is not None and wanted.is_geographic:
                _refuse_degrees(points, wanted, source or wanted)
            looks_at_area, looks_at_order = self._looks
            self._places = Places(
                source,
                target,
                looks_at_area=looks_at_area,
                looks_at_order=looks_at_order and source is None,
            )
        elif self._degrees is not None:
            self._degrees = _require_small_degrees(self._degrees, points, target, self._count)
        self._places.add(points)

    def describe(self) -> tuple[str, ...]:
        """Tell what is odd of the points that were looked at.

        Raises
        ------
        CrsError
            If they contradict their CRS.
        """
        return self._notes if self._places is None else (*self._notes, *self._places.describe())

    def move(self, points: Float64Array) -> Placed:
        """Bring points to their place."""
        source = self._source
        wanted = self._target if self._target is not None else source
        if source is None or wanted is None or source.is_same(wanted):
            unit = self._unit
            vertical = None if wanted is None else wanted.vertical_unit
            if vertical is None or unit is None or unit == vertical:
                return Placed(points, wanted, vertical or unit, ())
            note = f"Elevations were converted from {unit.name} to {vertical.name}."
            return Placed(convert_elevations(points, unit, vertical), wanted, vertical, (note,))
        moved = reproject(points, source, wanted, unit=self._unit, first_row=self._count)
        return Placed(moved.points, wanted, moved.unit, moved.notes)


def _require_small_degrees(
    before: Float64Array, points: Float64Array, target: CRS | None, first_row: int
) -> Float64Array:
    """Return the outermost points; refuse further ones that are no degrees as those before were."""
    both = np.concatenate([before, points])
    if target is None or not are_small_degrees(both, target):
        x, y = points[0, :2].tolist()
        raise CrsError(
            f"the points before point {first_row} lie in the area of use as longitude and "
            f"latitude in degrees only, and those from it on ({coordinate(x)}, {coordinate(y)}) do "
            "not: name the CRS of the file.",
            crs=target,
        )
    outermost = [*both[:, :2].argmin(axis=0), *both[:, :2].argmax(axis=0)]
    return both[outermost]


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
