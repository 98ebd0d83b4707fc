"""Pads: what is graded into the ground, level or an inclined plane."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from ....base.checks import as_floats, as_number
from ....base.errors import LinesError, OptionError
from ....base.sentences import height
from ....tin import TIN
from ....tin.constraints import gather_rings_of_regions
from .distances import measure_distances
from .seams import measure_tolerance

if TYPE_CHECKING:
    from ....base.arrays import Float64Array


class Work(Protocol):
    """What slopes begin at: a pad, or a region that is held fixed."""

    @property
    def polygon(self) -> Any:
        """Of shapely, without holes."""

    def measure_heights(self, xy: Float64Array) -> Float64Array:
        """Return the elevations of its edge at places, (n, 2)."""

    def find_range(self) -> tuple[float, float]:
        """Return the lowest and the highest elevation."""

    def make_skirt(self, reach: float, rate: float, tolerance: float) -> TIN:
        """Return the slope all around it, which rises by ``rate`` for a unit along."""


class Pad(NamedTuple):
    """A polygon of shapely without holes, and its plane."""

    polygon: Any
    level: float
    """At the centroid."""
    east: float = 0.0
    north: float = 0.0
    """Both the rise for a unit of easting and of northing, in the unit of elevations."""

    @property
    def is_level(self) -> bool:
        """Whether it does not rise."""
        return self.east == 0.0 == self.north

    def measure_heights(self, xy: Float64Array) -> Float64Array:
        """Return the elevations of its plane at places, (n, 2)."""
        if self.is_level:
            return np.full(len(xy), self.level)
        center = self.polygon.centroid
        rise = self.east * (xy[:, 0] - center.x) + self.north * (xy[:, 1] - center.y)
        return np.asarray(self.level + rise)

    def find_range(self) -> tuple[float, float]:
        """Return the lowest and the highest elevation."""
        import shapely

        heights = self.measure_heights(shapely.get_coordinates(self.polygon.exterior))
        return float(heights.min()), float(heights.max())

    def make_skirt(self, reach: float, rate: float, tolerance: float) -> TIN:
        """Return the slope all around it, which rises by ``rate`` for a unit along."""
        distances = measure_distances(self.polygon, reach, tolerance)
        points = distances.points * (1.0, 1.0, rate)
        points[:, 2] += self.measure_feet(points[:, :2])
        return TIN.from_triangles(points, distances.triangles)

    def measure_feet(self, xy: Float64Array) -> Float64Array:
        """Return the elevations of its edge where it is nearest to places, (n, 2)."""
        if self.is_level:
            return np.full(len(xy), self.level)
        import shapely

        edge = self.polygon.exterior
        stations = shapely.line_locate_point(edge, shapely.points(xy))
        feet = shapely.get_coordinates(shapely.line_interpolate_point(edge, stations))
        return self.measure_heights(feet)


def read_polygon(pad: Any) -> tuple[Any, Float64Array]:
    """Return a pad as a polygon of shapely, and its ring as given.

    Raises OptionError, LinesError.
    """
    import shapely

    regions = gather_rings_of_regions([pad], "pad")
    if len(regions) != 1 or len(regions[0]) != 1:
        raise OptionError("pad", "several rings", "one ring, without holes")
    ring = regions[0][0]
    polygon = shapely.Polygon(ring[:, :2])
    polygon = shapely.remove_repeated_points(polygon, measure_tolerance(ring))
    if not polygon.is_valid or not polygon.area > 0:
        raise LinesError(f"Invalid pad: {shapely.is_valid_reason(polygon)}.")
    return shapely.orient_polygons(polygon), ring


def find_level(ring: Float64Array, elevation: Any) -> float:
    """Return the elevation that is given, or that of the ring."""
    if elevation is not None:
        return as_number("elevation", elevation)
    if ring.shape[1] < 3:
        raise OptionError("elevation", None, "a number, where the pad's ring has no elevations")
    low, high = float(ring[:, 2].min()), float(ring[:, 2].max())
    if low != high:
        raise OptionError(
            "elevation",
            None,
            f"a number: the pad's ring is not level ({height(low)} to {height(high)})",
        )
    return low


def make_pad(polygon: Any, level: float, gradient: Any, up: float, *slopes: float) -> Pad:
    """Return a pad whose gradient is less steep than the side slopes, horizontal over vertical.

    ``up`` is the factor from elevations to the unit of eastings. Raises OptionError; LinesError if
    a pad that is not level has notches.
    """
    if gradient is None:
        return Pad(polygon, level)
    given = as_floats(gradient)
    if given is None or given.shape != (2,) or not np.isfinite(given).all():
        raise OptionError(
            "gradient", gradient, "two numbers: the rise to the east and to the north"
        )
    if not given.any():
        return Pad(polygon, level)
    most = 1.0 / max(slopes)
    if math.hypot(*given) >= most:
        raise OptionError("gradient", gradient, f"below that of the side slopes, {most:g}")
    beyond = float(polygon.convex_hull.area - polygon.area)
    if beyond > 1e-9 * float(polygon.area):
        raise LinesError(
            "The pad has notches, in which the side slopes of an inclined pad do not meet: an "
            "inclined pad must be convex."
        )
    east, north = (given / up).tolist()
    return Pad(polygon, level, east, north)
