"""Grade a pad into the ground: side slopes up through a cut and down over a fill."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_number
from ....base.errors import LinesError, OptionError, PointsError
from ....base.products import product
from ....base.progress import Progress
from ....base.sentences import coordinate, height
from ....tin import Breakline, triangulate
from ....tin.constraints.polygons import gather_rings_of_regions
from ...surface import find_reference
from .pasting import join_surfaces
from .seams import find_area, measure_tolerance
from .slopes import find_slope

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ....base.arrays import Float64Array
    from ....tin import TIN
    from .slopes import Slope

_SHARE = 1e-6
"""Of the area of pad and slopes: less of it may lie beyond the ground by rounding."""
_SLOPE = 0.2
"""Of the work as it is told, following the one slope or the other."""


@product
def grade(
    tin: TIN,
    pad: ArrayLike | Any,
    elevation: float | None = None,
    *,
    cut_slope: float,
    fill_slope: float,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Grade a level pad into the ground, with side slopes to where they meet it.

    From the edge of the pad a slope rises where the ground is higher (cut), and falls where it is
    lower (fill), to the daylight line. Around corners the slopes are cones; in a notch that of the
    nearer edge counts.

    Parameters
    ----------
    tin : TIN
        The ground.
    pad : (k, 2) or (k, 3) array, or polygon
        Ring of the pad's edge in the CRS of the ground, convex or not.
    elevation : float, optional
        Of the pad, in the unit of the ground's; default that of the ring, which must be level.
    cut_slope, fill_slope : float
        Horizontal over vertical: 2 is 2:1, two along for one up or down.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, as slopes are followed and pasted into the
        ground. What it raises ends the call.

    Returns
    -------
    TIN
        Pad, slopes, and the ground beyond. Breaklines are named "pad edge", "daylight" and
        "slope", where slopes break. Volumes are those of ``ts.volume(tin, graded)``. Vertices of
        the ground keep their attributes, new ones have none.

    Raises
    ------
    OptionError
        If a slope is no number above 0, or the elevation none.
    LinesError
        If the pad is no ring, or crosses itself.
    PointsError
        If the pad lies off the ground, or the ground ends before a slope meets it: with the place.
    CrsError
        If coordinates are angles.

    Notes
    -----
    Slopes beside edges are exact planes, and cones have facets of two degrees: daylight is short by
    at most 0.00016 of its distance. Where the pad has a notch, slopes meet where they are as far
    from both edges. What is cut or filled farther away, and does not reach the pad along its slope,
    stays ground. Time and vertices are in proportion to the corners of the pad.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 5], [60, 0, 5], [60, 60, 5], [0, 60, 5]])
    >>> pad = [[25, 25], [35, 25], [35, 35], [25, 35]]
    >>> graded = ts.grade(flat, pad, 3.0, cut_slope=2, fill_slope=3)
    >>> graded.interpolate([[30, 30], [30, 37], [30, 45]]).round(9)
    array([3., 4., 5.])
    """
    done = Progress(progress)
    reference = find_reference(tin, "Slopes")
    cut = 1.0 / (_require_ratio("cut_slope", cut_slope) * reference.up)
    fill = -1.0 / (_require_ratio("fill_slope", fill_slope) * reference.up)
    polygon, level = _read_pad(pad, elevation)
    area = find_area(tin)
    _require_on_ground(area, polygon, "The pad lies off")
    local = tin.replace(crs=None, elevation_unit=None)
    used = tin.points[tin.triangles, 2]
    farthest = {cut: (used.max() - level) / cut, fill: (used.min() - level) / fill}
    slopes = []
    # Farther away is no ground.
    across = math.hypot(*(tin.points.max(axis=0) - tin.points.min(axis=0))[:2])
    for number, (rate, reach) in enumerate(farthest.items(), 1):
        if reach > 0:
            slope = find_slope(local, area, polygon, level, rate, min(float(reach), across))
            slopes.append(slope)
        done(number * _SLOPE)
    patch = build_patch(tin, polygon, level, slopes)
    most = _SHARE * patch.area
    _require_on_ground(area, find_area(patch), "A slope reaches beyond", most)
    done(0.5)
    graded = join_surfaces(tin, patch, reference, area, "daylight", progress=done.stage(0.5, 1.0))
    done.end()
    return graded


# ---------------------------------------------------------------- what is given


def _require_ratio(name: str, value: Any) -> float:
    unit = "(horizontal over vertical: 2 is 2:1)"
    return as_number(name, value, "a ratio", above=0, unit=unit)


def _read_pad(pad: Any, elevation: Any) -> tuple[Any, float]:
    """Return the pad as a polygon of shapely, and its level."""
    import shapely

    regions = gather_rings_of_regions([pad], "pad")
    if len(regions) != 1 or len(regions[0]) != 1:
        raise OptionError("pad", "several rings", "one ring, without holes")
    ring = regions[0][0]
    if elevation is None:
        elevation = _find_level(ring)
    level = as_number("elevation", elevation)
    polygon = shapely.Polygon(ring[:, :2])
    if not polygon.is_valid or not polygon.area > 0:
        raise LinesError(f"Invalid pad: {shapely.is_valid_reason(polygon)}.")
    return shapely.orient_polygons(polygon), level


def _find_level(ring: Float64Array) -> float:
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


def _require_on_ground(area: Any, shape: Any, what: str, most: float = 0.0) -> None:
    """Refuse a shape of which more lies off the ground than an area."""
    import shapely

    beyond = shapely.difference(shape, area)
    if beyond.area > most or (most == 0.0 and not beyond.is_empty):
        place = shapely.point_on_surface(beyond)
        raise PointsError(f"{what} the ground, at {coordinate(place.x)} {coordinate(place.y)}.")


def build_patch(tin: TIN, pad: Any, level: float, slopes: list[Slope]) -> TIN:
    """Return pad and slopes as one surface."""
    tolerance = measure_tolerance(tin.points)
    rims = [rim for slope in slopes for rim in slope.find_rim(pad, tolerance)]
    edge = _insert(pad, level, rims, tolerance)
    rings = _trace_outline(edge, rims, slopes)
    breaks = [line for slope in slopes for line in slope.find_breaks()]
    ends = np.concatenate([edge, *rims])
    lines = [Breakline(edge, name="pad edge", priority=1)]
    _snap(breaks, ends, tolerance)
    lines += [Breakline(line, name="slope") for line in breaks if np.ptp(line[:, :2], axis=0).any()]
    return triangulate(
        np.concatenate(rings),
        breaklines=lines,
        boundary=rings,
        duplicates="last",
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
    )


def _insert(pad: Any, level: float, rims: list[Float64Array], tolerance: float) -> Float64Array:
    """Return the pad's edge with the ends of daylight lines, which are moved onto it."""
    import shapely

    ring = shapely.get_coordinates(pad.exterior)
    stations = {float(pad.exterior.project(shapely.Point(xy))): xy for xy in ring[:-1]}
    for rim in rims:
        for end in (0, -1):
            here = shapely.Point(rim[end, :2])
            if pad.exterior.distance(here) > tolerance:
                continue
            station = float(pad.exterior.project(here))
            near = [one for one in stations if abs(one - station) <= tolerance]
            if not near and abs(station - pad.exterior.length) <= tolerance:
                near = [0.0]
            rim[end] = [*stations.setdefault(near[0] if near else station, rim[end, :2]), level]
    path = np.array([stations[one] for one in sorted(stations)])
    closed = np.vstack([path, path[:1]])
    return np.column_stack([closed, np.full(len(closed), level)])


def _trace_outline(
    edge: Float64Array, rims: list[Float64Array], slopes: list[Slope]
) -> list[Float64Array]:
    """Return the rings around pad and slopes."""
    import shapely

    lines = shapely.union_all(shapely.linestrings(edge[:, :2]))
    work = shapely.union_all([lines, *(shapely.linestrings(rim[:, :2]) for rim in rims)])
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(work)))
    pad = shapely.Polygon(edge[:, :2])
    places = [shapely.point_on_surface(face) for face in faces]
    kept = [
        face
        for face, place in zip(faces, places, strict=True)
        if pad.contains(place) or any(slope.is_made_at(place) for slope in slopes)
    ]
    known = {(x, y): z for x, y, z in np.concatenate([edge, *rims]).tolist()}
    joined = shapely.coverage_union_all(kept)
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(joined)]
    return [_lift(ring, known, slopes) for ring in rings]


def _lift(
    ring: Float64Array, known: dict[tuple[float, float], float], slopes: list[Slope]
) -> Float64Array:
    """Return a ring with elevations: where lines cross but for rounding, those of the slope."""
    z = [known.get((x, y), np.nan) for x, y in ring.tolist()]
    for slope in slopes:
        z = [
            slope.interpolate(place) if np.isnan(own) else own
            for own, place in zip(z, ring, strict=True)
        ]
    return np.column_stack([ring, z])


def _snap(lines: list[Float64Array], places: Float64Array, tolerance: float) -> None:
    """Move the ends of lines onto the nearest places that are there."""
    import shapely

    if not lines:
        return
    ends = np.array([line[end] for line in lines for end in (0, -1)])
    tree = shapely.STRtree(shapely.points(places[:, :2]))
    found, near = tree.query(shapely.points(ends[:, :2]), "dwithin", distance=tolerance)
    apart = np.hypot(*(places[near, :2] - ends[found, :2]).T)
    order = np.lexsort((near, apart, found))
    moved, first = np.unique(found[order], return_index=True)
    for end, place in zip(moved.tolist(), near[order][first].tolist(), strict=True):
        lines[end // 2][-(end % 2)] = places[place]
