"""Do coordinates lie where their CRS applies? What tells northing from easting, and nonsense."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS

if TYPE_CHECKING:
    import pyproj

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array

_WGS84 = "EPSG:4326"
_MARGIN_DEGREES = 2.0
"""Surveys at the edge of a zone keep its CRS some way beyond; two degrees are a third of a zone."""
_SPREAD = 64
_ORIGIN_METRES = 20_000.0
"""Coordinates of a local grid, or degrees, are as small as this; UTM's begin at 166,000."""


@dataclass(frozen=True, slots=True)
class AreaOfUse:
    """The areas of use of the CRS of some coordinates, and of the one that they are moved to."""

    source: CRS
    """CRS of the coordinates."""
    targets: tuple[CRS, ...]
    """CRSs whose areas count, without those whose area is not known."""

    @classmethod
    def of(cls, source: CRS | None, target: CRS | None) -> AreaOfUse | None:
        """Return the areas to look at; None if nothing is known of them, or of the places.

        Of places nothing is known in an engineering CRS, or one whose projection PROJ lacks.
        """
        declared = source or target
        if declared is None:
            return None
        targets = {crs: None for crs in (declared, target) if crs is not None}
        known = tuple(crs for crs in targets if _find_area(crs) is not None)
        has_places = bool(known) and _make_angle_transformer(declared) is not None
        return cls(declared, known) if has_places else None

    @property
    def label(self) -> str:
        """The CRSs and the narrowest of their areas in degrees, for a sentence."""
        names = " and ".join(crs.label for crs in self.targets)
        area = min((_find_area(crs) for crs in self.targets), key=_measure_width)
        return (
            f"{names} (longitude {area.west:g} to {area.east:g}, "
            f"latitude {area.south:g} to {area.north:g})"
        )

    def covers(self, xy: Float64Array, *, margin: float = _MARGIN_DEGREES) -> BoolArray:
        """Whether each point, (n, 2), lies in all areas, a margin of some degrees included."""
        longitude, latitude = _convert_to_degrees(self.source, xy)
        inside: BoolArray = np.isfinite(longitude) & np.isfinite(latitude)
        for crs in self.targets:
            inside &= _is_within(_find_area(crs), longitude, latitude, margin)
        return inside

    def covers_most(self, xy: Float64Array) -> bool:
        """Whether more than half of some points, spread over all of them, lie in the areas."""
        some = xy[:: max(1, len(xy) // _SPREAD)]
        return bool(2 * self.covers(some).sum() > len(some))

    def covers_whole(self, xy: Float64Array) -> bool:
        """Whether the outermost of some points, and some between, lie in the areas themselves."""
        return len(xy) > 0 and bool(self.covers(xy[_find_outermost(xy)], margin=0.0).all())

    def covers_as_degrees(self, xy: Float64Array) -> bool:
        """Whether points, spread over all of them, lie in all areas as longitude and latitude."""
        longitude, latitude = xy[_find_outermost(xy)].T
        areas = (_find_area(crs) for crs in self.targets)
        return all(_is_within(area, longitude, latitude, 0.0).all() for area in areas)

    def is_local(self, xy: Float64Array) -> bool:
        """Whether points lie about the origin of the coordinates, and in no area but its margin."""
        if len(xy) == 0 or self.source.is_geographic:
            return False
        if np.abs(xy).max() * self.source.horizontal_unit.metres > _ORIGIN_METRES:
            return False
        return not self.covers(xy[_find_outermost(xy)], margin=0.0).any()

    def find_outside(self, xy: Float64Array) -> Int64Array:
        """Return the rows that lie outside; all are looked at only if the outermost do not fit."""
        if len(xy) == 0 or self.covers(xy[_find_outermost(xy)]).all():
            return np.empty(0, np.int64)
        return np.flatnonzero(~self.covers(xy))


def _find_outermost(xy: Float64Array) -> list[int]:
    """Return the rows of the corners of the octagon around the points, and some between."""
    x, y = xy.T
    with np.errstate(over="ignore", invalid="ignore"):
        sides = (x, y, x + y, x - y)
        corners = [int(f(side)) for side in sides for f in (np.argmin, np.argmax)]
    return [*corners, *range(0, len(xy), max(1, len(xy) // _SPREAD))]


def _convert_to_degrees(source: CRS, xy: Float64Array) -> tuple[AnyArray, AnyArray]:
    """Return longitude from Greenwich and latitude, infinite where there is no image.

    They are those of the CRS's own datum, which are found fast and near enough for a margin of
    degrees.
    """
    found = _make_angle_transformer(source)
    if found is None:  # which AreaOfUse.of has looked at
        return np.full(len(xy), np.nan), np.full(len(xy), np.nan)
    to_angles, degrees, meridian = found
    longitude, latitude = to_angles.transform(xy[:, 0], xy[:, 1])
    return np.asarray(longitude) * degrees + meridian, np.asarray(latitude) * degrees


@lru_cache(maxsize=8)
def _make_angle_transformer(source: CRS) -> tuple[pyproj.Transformer, float, float] | None:
    """Return what makes longitude and latitude, the degrees of their unit, and the meridian.

    None where PROJ cannot transform the CRS.
    """
    import pyproj
    from pyproj.exceptions import ProjError

    crs = source.to_pyproj()
    crs = crs.sub_crs_list[0] if crs.is_compound else crs
    base = crs.geodetic_crs or CRS.of(_WGS84).to_pyproj()
    degrees = float(np.degrees(base.to_2d().axis_info[0].unit_conversion_factor))
    prime = base.prime_meridian
    meridian = 0.0
    if prime is not None:
        meridian = float(np.degrees(prime.longitude * float(prime.unit_conversion_factor)))
    try:
        transformer = pyproj.Transformer.from_crs(crs.to_2d(), base.to_2d(), always_xy=True)
    except ProjError:
        return None
    return transformer, degrees, meridian


def _find_area(crs: CRS) -> Any:
    """Return the area of use of a CRS, of its horizontal part if only that has one, or None."""
    known = crs.to_pyproj()
    if known.area_of_use is None and known.is_compound:
        return known.sub_crs_list[0].area_of_use
    return known.area_of_use


def _measure_width(area: pyproj.aoi.AreaOfUse) -> float:
    return (float(area.east - area.west) % 360.0 or 360.0) * float(area.north - area.south)


def _is_within(
    area: pyproj.aoi.AreaOfUse,
    longitude: AnyArray,
    latitude: AnyArray,
    margin: float,
) -> BoolArray:
    span = (area.east - area.west) % 360.0 or 360.0
    with np.errstate(invalid="ignore"):
        is_between = (longitude - area.west + margin) % 360.0 <= span + 2 * margin
        is_inside = is_between & (latitude >= area.south - margin)
        is_inside &= (latitude <= area.north + margin) & (np.abs(latitude) <= 90.0)
        inside: BoolArray = is_inside & (np.abs(longitude) <= 360.0)
    return inside
