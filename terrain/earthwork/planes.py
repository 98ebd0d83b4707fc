"""A level or a plane, as the base of a volume."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_floats
from ...base.errors import OptionError
from ...tin import TIN

if TYPE_CHECKING:
    from ...base.arrays import Float64Array

_ALLOWED = "a level, or three points (easting, northing, elevation) of a plane"


@dataclass(frozen=True, slots=True)
class Plane:
    """A plane through a point, with its rise in both directions."""

    point: tuple[float, float, float]
    """Easting, northing, elevation."""
    east: float = 0.0
    north: float = 0.0
    """Both the rise for a unit of easting and of northing, in the unit of elevations."""

    def heights_above(self, points: Float64Array) -> Float64Array:
        """Return how far the plane lies above (n, 3) points."""
        x, y, z = self.point
        rise = self.east * (points[:, 0] - x) + self.north * (points[:, 1] - y)
        heights: Float64Array = (z - points[:, 2]) + rise
        return heights

    def steepness(self, up: float) -> float:
        """Return the area in space of an area of 1 in the plane of eastings and northings."""
        return float(np.hypot(1.0, np.hypot(self.east, self.north) * up))


def as_plane(base: Any) -> Plane:
    """Return the plane that a level or three points stand for."""
    given = as_floats(base)
    if given is None or given.shape not in ((), (3, 3)) or isinstance(base, bool | str):
        raise OptionError("base", base, allowed=_ALLOWED)
    if not np.isfinite(given).all():
        raise OptionError("base", base, allowed="finite")
    if given.shape == ():
        return Plane((0.0, 0.0, float(given)))
    first, second = given[1] - given[0], given[2] - given[0]
    doubled = first[0] * second[1] - first[1] * second[0]
    if doubled == 0.0:
        raise OptionError("base", given.tolist(), allowed="three points that are not on one line")
    east = (first[2] * second[1] - second[2] * first[1]) / doubled
    north = (second[2] * first[0] - first[2] * second[0]) / doubled
    x, y, z = given[0].tolist()
    return Plane((x, y, z), float(east), float(north))


def level_surface(tin: TIN, base: Any) -> TIN:
    """Return a level or a plane as a TIN of two triangles that covers another one.

    The base is one as for :func:`tinsmith.volume`; OptionError if it is none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    >>> level_surface(tin, 6.5).points[:, 2]
    array([6.5, 6.5, 6.5, 6.5])
    """
    box = tin.bounds
    east, north = [box.xmin, box.xmax, box.xmax, box.xmin], [box.ymin, box.ymin, box.ymax, box.ymax]
    corners = np.column_stack([east, north])
    flat = np.column_stack([corners, np.zeros(4)])
    flat[:, 2] = as_plane(base).heights_above(flat)
    return TIN.from_triangles(
        flat, [[0, 1, 2], [0, 2, 3]], crs=tin.crs, elevation_unit=tin.elevation_unit
    )
