"""Side slopes: a surface that rises or falls from a pad, as far as the ground is met."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import PointsError
from ....base.sentences import coordinate
from ....tin import TIN, topology
from ..differences import subtract_skirt
from ..zones import classify, join_segments, number_zones
from .seams import measure_tolerance

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from .pads import Work

_MARGIN = 1.01
"""Slopes are made so much longer than they can be: at their end there is no daylight."""
_PLANE = 1e-6
"""Gradients that differ by less are those of one plane."""


class Slope(NamedTuple):
    """One of the slopes where it is made: cut or filled."""

    surface: TIN
    """The difference to the ground, cut along all edges."""
    is_made: BoolArray
    """(m,), its triangles that hang together with the pad."""
    elevations: Float64Array
    """(n,), of the slope at its vertices."""

    def find_rim(self, pad: Any, tolerance: float) -> list[Float64Array]:
        """Return the daylight lines, (k, 3) each."""
        start, end = _find_outline(self.surface, self.is_made)
        xy = self.surface.points[:, :2]
        off = ~lie_on(pad, (xy[start] + xy[end]) / 2, tolerance)
        chains = join_segments(start[off], end[off])
        return [np.column_stack([xy[chain], self.elevations[chain]]) for chain in chains]

    def are_made(self, xy: Float64Array) -> BoolArray:
        """Tell at which places, (k, 2), the slope is made."""
        triangle = self.surface.locate(xy)
        return np.asarray((triangle >= 0) & self.is_made[triangle])

    def interpolate(self, place: Float64Array) -> float:
        """Return the elevation of the slope nearest to a place."""
        return float(self.elevations[self.surface.closest_vertex(place[None])[0]])

    def find_breaks(self) -> list[Float64Array]:
        """Return the lines along which the slope breaks, (k, 3) each."""
        import shapely

        mesh = self.surface.triangulation
        points = np.column_stack([mesh.points[:, :2], self.elevations])
        gradients = _measure_gradients(points, mesh.triangles)
        triangle, corner = np.nonzero(self.is_made[:, None] & (mesh.neighbors >= 0))
        other = mesh.neighbors[triangle, corner]
        with np.errstate(invalid="ignore"):  # of triangles thinner than a rounding: no break
            apart = np.abs(gradients[triangle] - gradients[other]).max(axis=1)
        chosen = self.is_made[other] & (triangle < other) & (apart > _PLANE)
        start, end = topology.ends(mesh.triangles, triangle[chosen], corner[chosen])
        segments = shapely.linestrings(points[np.stack([start, end], axis=1)])
        merged = shapely.line_merge(shapely.multilinestrings(segments))
        return [shapely.get_coordinates(one, include_z=True) for one in shapely.get_parts(merged)]


def find_slope(
    tin: TIN, area: Any, work: Work, rate: float, reach: float, *, least: float = 0.0
) -> Slope:
    """Follow a slope from the pad until daylight, at most as far as the ground's relief needs.

    ``tin`` is the ground, without a CRS, and ``area`` what it covers; ``rate`` is the rise of the
    slope for a unit along, negative over a fill, and ``reach`` how far it can go on the highest, or
    lowest, of the ground. It begins where the edge is off the ground by more than ``least``, or if
    that is 0 where it would cut or fill. Raises PointsError if the ground ends before.
    """
    pad = work.polygon
    far: float = min(reach, _estimate_reach(tin, work, rate))
    tolerance = measure_tolerance(tin.points)
    while True:
        skirt = work.make_skirt(far * _MARGIN, rate, tolerance)
        slope, ends = meet_ground(tin, skirt, pad, -np.sign(rate), least)
        if not len(ends):
            return slope
        require_ground(ends if far >= reach else _take_on(area, ends, tolerance), rate)
        far = float(min(2.0 * far, reach))


def meet_ground(
    tin: TIN, skirt: TIN, pad: Any, sign: float, least: float = 0.0, *, share: float = 0.0
) -> tuple[Slope, Float64Array]:
    """Return where a surface around a pad is cut into the ground, and where it ends before it.

    ``sign`` is -1 of cuts, 1 of fills, ``pad`` a polygon of shapely. Parts that are off the ground
    by no more than ``least`` along its edge are left. The ends, (k, 2), are middles
    of edges at the outline of the surface, off the pad. Volumes between both may be off by a
    ``share``, as those of :func:`subtract_skirt`.
    """
    tolerance = measure_tolerance(tin.points)
    xy = skirt.points[:, :2]
    found = subtract_skirt(take_near(tin, xy.min(axis=0), xy.max(axis=0)), skirt, share)
    is_made = _find_made(found, pad, sign, tolerance, least=least)
    start, end = _find_outline(found, is_made, only_outer=True)
    middles = (found.points[start, :2] + found.points[end, :2]) / 2
    ends = middles[~lie_on(pad, middles, tolerance)]
    return Slope(found, is_made, _measure_elevations(found, skirt, tin)), ends


def require_ground(lost: Float64Array, rate: float) -> None:
    """Refuse a slope that ends at places before it meets the ground.

    Raises PointsError.
    """
    if len(lost):
        x, y = lost[0]
        raise PointsError(
            f"The {'cut' if rate > 0 else 'fill'} slope does not meet the ground before it "
            f"ends, at {coordinate(x)} {coordinate(y)}: a larger ground is needed, or a "
            "steeper slope."
        )


def _take_on(area: Any, places: Float64Array, tolerance: float) -> Float64Array:
    return places[lie_on(area, places, tolerance)]


def _estimate_reach(tin: TIN, work: Work, rate: float) -> float:
    """Return how far a slope goes on ground as far from the pad as that at its edge."""
    import shapely

    pad = work.polygon
    places = shapely.get_coordinates(shapely.segmentize(pad, pad.length / 64))
    above = tin.interpolate(places) - work.measure_heights(places)
    rise = np.nanmax(above * np.sign(rate), initial=0.0)
    return float(max(2.0 * rise / abs(rate), pad.length / 64))


def take_near(tin: TIN, low: Float64Array, high: Float64Array) -> TIN:
    """Return the triangles of a surface that reach into a box, (2,) each, without a CRS."""
    xy = tin.points[tin.triangles, :2]
    near = ((xy.max(axis=1) >= low) & (xy.min(axis=1) <= high)).all(axis=1)
    used, corners = np.unique(tin.triangles[near], return_inverse=True)
    return TIN.from_triangles(tin.points[used], corners.reshape(-1, 3))


def _find_made(found: TIN, pad: Any, sign: float, tolerance: float, *, least: float) -> BoolArray:
    """Tell which triangles of a difference are cut (or filled) and hang together with the pad."""
    mesh = found.triangulation
    classes = classify(mesh)
    _, part = number_zones(mesh, classes)
    triangle, corner = np.nonzero((mesh.neighbors < 0) & (classes == sign)[:, None])
    start, end = topology.ends(mesh.triangles, triangle, corner)
    middles = (mesh.points[start, :2] + mesh.points[end, :2]) / 2
    is_off = (mesh.points[start, 2] + mesh.points[end, 2]) / 2 * sign > least if least else True
    at_pad = triangle[lie_on(pad, middles, tolerance) & is_off]
    return np.isin(part, part[at_pad])


def _measure_elevations(found: TIN, skirt: TIN, ground: TIN) -> Float64Array:
    """Return the elevations of a slope at the vertices of its difference to the ground.

    Where that is 0 they are those of the ground: faces of the slope that are thinner than
    coordinates are rounded have elevations of their own there.
    """
    xy = found.points[:, :2]
    elevations: Float64Array = skirt.interpolate(xy, extrapolate="nearest")  # at edges, by rounding
    at_daylight = np.flatnonzero(found.points[:, 2] == 0.0)
    if len(at_daylight):
        known = ground.interpolate(xy[at_daylight])
        elevations[at_daylight] = np.where(np.isnan(known), elevations[at_daylight], known)
    return elevations


def _find_outline(
    surface: TIN, chosen: BoolArray, *, only_outer: bool = False
) -> tuple[Int64Array, Int64Array]:
    """Return the edges around some triangles; only those where the surface ends."""
    mesh = surface.triangulation
    is_outer = mesh.neighbors < 0
    ends_here = is_outer if only_outer else is_outer | ~chosen[mesh.neighbors]
    triangle, corner = np.nonzero(ends_here & chosen[:, None])
    return topology.ends(mesh.triangles, triangle, corner)


def lie_on(area: Any, xy: Float64Array, tolerance: float) -> BoolArray:
    """Tell which places are on the outline of an area."""
    import shapely

    outline = shapely.boundary(area)
    shapely.prepare(outline)
    is_near: BoolArray = shapely.dwithin(outline, shapely.points(xy), tolerance)
    return is_near


def _measure_gradients(points: Float64Array, triangles: Int32Array) -> Float64Array:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    east, north, up = np.cross(b - a, c - a).T
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack([-east / up, -north / up], axis=1)
