"""Normals of triangles and at vertices, slopes, aspects and light of planes, areas of triangles."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_number, require_tin
from ...base.errors import choice
from ...base.georeference import find_axes, find_scales
from ...base.policies import SlopeUnit, SurfacePart
from ...tin.validation import thread_count
from .. import _kernel

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array, Int32Array, UInt8Array
    from ...base.crs import CRS
    from ...base.policies import PlaneValue
    from ...tin import TIN, Surface

DARKEST, BRIGHTEST = 1, 255
"""As gdaldem writes them; 0 is outside."""


def measure_slopes(upward: Float64Array, unit: SlopeUnit) -> Float64Array:
    """Return the slope of planes with some upward normals, (k, 3), NaN where there is none."""
    east, north, up = upward.T
    run = np.hypot(east, north)
    if unit == "degrees":
        found = np.degrees(np.arctan2(run, up))
    else:
        with np.errstate(divide="ignore", invalid="ignore"):
            found = run / up * (100.0 if unit == "percent" else 1.0)
    values: Float64Array = np.where((run == 0.0) & (up == 0.0), np.nan, found)
    return values


def measure_aspects(upward: Float64Array) -> Float64Array:
    """Return the aspect of planes with some upward normals, (k, 3), NaN where they are level."""
    east, north, _ = upward.T
    azimuth: Float64Array = np.degrees(np.arctan2(east, north)) % 360.0
    # A hair west of north rounds up to the full circle, which is north.
    azimuth[azimuth == 360.0] = 0.0
    azimuth[(east == 0.0) & (north == 0.0)] = np.nan
    return azimuth


def measure_plane_areas(tin: TIN) -> Float64Array:
    """Return the area of each triangle in the plane, (m,), in the units of `find_plane_units`.

    That is in CRS units squared, as all products have it; above longitude and latitude square
    metres.
    """
    scales = find_scales(tin.crs, None, _average_northings(tin))
    measured: Float64Array = tin.triangulation.triangle_areas * scales.east * scales.north
    return measured


def measure_areas(tin: TIN) -> Float64Array:
    """Return the area of each triangle in the plane, (m,), in square metres, as GeoJSON tells it.

    In CRS units squared where those are not known.
    """
    scale = find_area_scale(tin.crs, _average_northings(tin))
    measured: Float64Array = tin.triangulation.triangle_areas * scale
    return measured


def double_areas(points: Float64Array, triangles: Int32Array) -> Float64Array:
    """Return twice the signed area of triangles in the plane, (m,), each computed in doubles."""
    workers = thread_count(None, len(triangles))
    corners = np.ascontiguousarray(triangles, np.int32)
    return _kernel.double_areas(np.ascontiguousarray(points), corners, workers)


def measure_ring_area(crs: CRS | None, ring: Float64Array) -> float:
    """Measure the area inside a ring in the plane on the ground, as :func:`measure_areas` does.

    Corners, (k, 2) or (k, 3), are in order, the first not repeated. Positive if the ring runs
    counter-clockwise.
    """
    x, y = (ring[:, :2] - ring[0, :2]).T
    steps = x * np.roll(y, -1) - np.roll(x, -1) * y
    middle = (ring[:, 1] + np.roll(ring[:, 1], -1) + ring[0, 1]) / 3
    return float((steps * find_area_scale(crs, middle)).sum()) / 2


def find_area_scale(crs: CRS | None, northing: ArrayLike) -> Any:
    """Return the factor from areas in CRS units squared to square metres, at each northing."""
    scales = find_scales(crs, None, northing)
    metres = None if crs is None else crs.horizontal_unit.metres
    return scales.east * scales.north * (metres or 1.0) ** 2


def compute_normals(tin: Surface) -> Float64Array:
    """Return the upward normal of each triangle, its length twice the triangle's area in space.

    They are (m, 3), of the true surface, as in :func:`slope`: in CRS units squared, in a geographic
    CRS square metres. The horizontal part points downhill, to the east and the north whatever the
    axes of the CRS are; the vertical part is positive.
    """
    require_tin(tin)
    surface = tin.triangulation
    workers = thread_count(None, len(surface.triangles))
    normals, slivers = _kernel.triangle_normals(surface.points, surface.triangles, workers)
    for row in slivers.tolist():
        # The corners of a sliver lie nearly in a line, so that the products of its sides cancel.
        normals[row] = [float(one) for one in cross_exactly(surface.points[surface.triangles[row]])]
    for axis, factor in enumerate(_find_normal_factors(tin)):
        if np.ndim(factor) > 0 or factor != 1.0:
            normals[:, axis] *= factor
    axes = find_axes(tin.crs)
    return normals if axes.are_usual else axes.turn(normals)


def _find_normal_factors(tin: Surface) -> tuple[Any, Any, Any]:
    """Return the factors from products of two coordinates each to areas, of each triangle."""
    east, north, up = find_scales(tin.crs, tin.elevation_unit, _average_northings(tin))
    return north * up, east * up, east * north


def cross_exactly(corners: Float64Array) -> tuple[Fraction, Fraction, Fraction]:
    """Return the normal of a triangle of corners (3, 3), without any rounding."""
    a, b, c = ([Fraction(value) for value in corner] for corner in corners.tolist())
    u, v = ([end - start for start, end in zip(a, other, strict=True)] for other in (b, c))
    east, north, area = (u[i] * v[j] - u[j] * v[i] for i, j in ((1, 2), (2, 0), (0, 1)))
    return east, north, area


def sum_normals(tin: TIN, per: SurfacePart) -> Float64Array:
    """Return the upward normals of triangles, or their sums at each vertex, (n, 3).

    Raises OptionError for another place.
    """
    choice("per", per, SurfacePart)
    upward = compute_normals(tin)
    if per == "triangle":
        return upward
    return sum_at_vertices(tin, upward)


def sum_at_vertices(tin: Surface, upward: Float64Array) -> Float64Array:
    """Return the sums at each vertex, (n, 3), of the normals of triangles, (m, 3).

    They do not depend on the order of triangles.
    """
    surface = tin.triangulation
    threads = thread_count(None, len(surface.points))
    return _kernel.vertex_normals(surface.points, surface.triangles, upward, threads)


def _average_northings(tin: Surface) -> Any:
    """Return the northing at the middle of each triangle if scales depend on it, else 0."""
    if tin.crs is None or not tin.crs.is_geographic:
        return 0.0
    south, middle, north = np.sort(tin.points[:, 1][tin.triangles], axis=1).T
    return (south + middle + north) / 3.0


class Light(NamedTuple):
    """Where the light comes from, degrees."""

    azimuth: float
    """Clockwise from north."""
    altitude: float
    """Above the horizon."""


NORTHWEST = Light(315.0, 45.0)
"""The light of maps, and of whatever is not told of another."""


def as_light(azimuth: Any, altitude: Any) -> Light:
    """Return a light, or say which number is out of range."""
    return Light(
        as_number("azimuth", azimuth, unit="of degrees"),
        as_number("altitude", altitude, least=0, most=90, unit="degrees"),
    )


def shade(upward: Float64Array, light: Light) -> UInt8Array:
    """Return the light on planes: 1 (none) to 255 (from straight above), the cosine of the angle.

    Parameters
    ----------
    upward : (k, 3) float64 array
        Normals of any length.
    light : Light

    Examples
    --------
    >>> shade(np.array([[0.0, 0.0, 2.0]]), NORTHWEST)
    array([181], dtype=uint8)
    """
    turn, rise = math.radians(light.azimuth), math.radians(light.altitude)
    towards = (math.sin(turn) * math.cos(rise), math.cos(turn) * math.cos(rise), math.sin(rise))
    return _kernel.shade_planes(upward, *towards, DARKEST, BRIGHTEST)


def normalise(vectors: Float64Array) -> Float64Array:
    """Return vectors of length 1, NaN for those without a direction."""
    with np.errstate(invalid="ignore"):
        small = vectors / np.abs(vectors).max(axis=1, keepdims=True)  # no square is 0 or infinite
        return np.asarray(small / np.linalg.norm(small, axis=1, keepdims=True), np.float64)


class PlaneMeasure(NamedTuple):
    """What is measured of a plane: degrees of slope or aspect, or light from 1 to 255."""

    value: PlaneValue
    light: Light
    exaggeration: float = 1.0

    def of(self, upward: Float64Array) -> Float64Array:
        """Return the value of planes with some upward normals, (k, 3); NaN where there is none."""
        factor = self.exaggeration
        normals = upward if factor == 1.0 else upward * (factor, factor, 1.0)
        if self.value == "slope":
            return measure_slopes(normals, "degrees")
        if self.value == "aspect":
            return measure_aspects(normals)
        lights = shade(normals, self.light).astype(np.float64)
        lights[np.isnan(normals[:, 2])] = np.nan
        return lights
