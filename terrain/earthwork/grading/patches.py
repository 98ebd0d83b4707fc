"""Pad and slopes as one surface, which is put into the ground."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.errors import PointsError
from ....base.progress import Progress
from ....base.sentences import coordinate
from ....tin import Breakline, triangulate
from .seams import find_area, measure_tolerance
from .slopes import find_slope

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from ....tin import TIN
    from .pads import Pad, Work
    from .slopes import Slope

_SHARE = 1e-6
"""Of the area of pad and slopes: less of it may lie beyond the ground by rounding."""
_SLOPE = 0.2
"""Of the work as it is told, following the one slope or the other."""


def make_patch(
    tin: TIN, pad: Pad, ratios: tuple[float, float], up: float, area: Any, done: Progress
) -> TIN:
    """Return a pad that lies on the ground and its slopes, of cuts and of fills, as a surface.

    ``up`` is the factor from elevations to the unit of eastings, and ``area`` what the ground
    covers. Raises PointsError if it ends before a slope meets it.
    """
    cut, fill = (sign / (ratio * up) for sign, ratio in zip((1, -1), ratios, strict=True))
    local = tin.replace(crs=None, elevation_unit=None)
    used = tin.points[tin.triangles, 2]
    low, high = pad.find_range()
    farthest = {cut: (used.max() - low) / cut, fill: (used.min() - high) / fill}
    slopes = []
    # Farther away is no ground.
    across = math.hypot(*(tin.points.max(axis=0) - tin.points.min(axis=0))[:2])
    for number, (rate, reach) in enumerate(farthest.items(), 1):
        if reach > 0:
            slopes.append(find_slope(local, area, pad, rate, min(float(reach), across)))
        done(number * _SLOPE)
    patch = build_patch(tin, pad, slopes)
    most = _SHARE * patch.area
    require_on_ground(area, find_area(patch), "A slope reaches beyond", most)
    return patch


def require_on_ground(
    area: Any, shape: Any, what: str = "The pad lies off", most: float = 0.0
) -> None:
    """Refuse a pad, or a shape of which more than an area lies off the ground.

    Raises PointsError.
    """
    import shapely

    beyond = shapely.difference(shape, area)
    if beyond.area > most or (most == 0.0 and not beyond.is_empty):
        place = shapely.point_on_surface(beyond)
        raise PointsError(f"{what} the ground, at {coordinate(place.x)} {coordinate(place.y)}.")


def build_patch(tin: TIN, pad: Work, slopes: list[Slope], name: str = "pad edge") -> TIN:
    """Return pad and slopes as one surface, in which the edge of the pad has a name."""
    edges, rings, lines = outline_patch(tin, pad, slopes)
    return triangulate(
        np.concatenate(rings),
        breaklines=[*(Breakline(one, name=name, priority=1) for one in edges), *lines],
        boundary=rings,
        duplicates="last",
        crs=tin.crs,
        elevation_unit=tin.elevation_unit,
    )


def outline_patch(
    tin: TIN, pad: Work, slopes: list[Slope]
) -> tuple[list[Float64Array], list[Float64Array], list[Breakline]]:
    """Return the edges of a pad, the rings around pad and slopes, and lines where slopes break."""
    import shapely

    tolerance = measure_tolerance(tin.points)
    rims = [rim for slope in slopes for rim in slope.find_rim(pad.polygon, tolerance)]
    edges = [_insert(pad, ring, rims, tolerance) for ring in shapely.get_rings(pad.polygon)]
    rings = [_lift(ring, tin, slopes, [*edges, *rims]) for ring in _trace(edges, rims, slopes)]
    breaks = [line for slope in slopes for line in slope.find_breaks()]
    _snap(breaks, np.concatenate([*edges, *rims]), tolerance)
    lines = [Breakline(line, name="slope") for line in breaks if np.ptp(line[:, :2], axis=0).any()]
    return edges, rings, lines


def _insert(pad: Work, exterior: Any, rims: list[Float64Array], tolerance: float) -> Float64Array:
    """Return a ring of the pad with the ends of daylight lines, which are moved onto it."""
    import shapely

    ring = shapely.get_coordinates(exterior)
    stations = {float(exterior.project(shapely.Point(xy))): xy for xy in ring[:-1]}
    for rim in rims:
        for end in (0, -1):
            here = shapely.Point(rim[end, :2])
            if exterior.distance(here) > tolerance:
                continue
            station = float(exterior.project(here))
            near = [one for one in stations if abs(one - station) <= tolerance]
            if not near and abs(station - exterior.length) <= tolerance:
                near = [0.0]
            place = stations.setdefault(near[0] if near else station, rim[end, :2].copy())
            rim[end] = [*place, *pad.measure_heights(place[None])]
    path = np.array([stations[one] for one in sorted(stations)])
    closed = np.vstack([path, path[:1]])
    return np.column_stack([closed, pad.measure_heights(closed)])


def _trace(
    edges: list[Float64Array], rims: list[Float64Array], slopes: list[Slope]
) -> list[Float64Array]:
    """Return the rings around pad and slopes, (k, 2) each."""
    import shapely

    lines = [shapely.linestrings(line[:, :2]) for line in (*edges, *rims)]
    work = shapely.union_all(lines)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(work)))
    pad = shapely.Polygon(edges[0][:, :2], [edge[:, :2] for edge in edges[1:]])
    places = shapely.point_on_surface(faces)
    shapely.prepare(pad)
    is_kept = shapely.contains(pad, places)
    for slope in slopes:
        is_kept |= slope.are_made(shapely.get_coordinates(places))
    joined = shapely.coverage_union_all(faces[is_kept])
    return [shapely.get_coordinates(ring) for ring in shapely.get_rings(joined)]


def _lift(
    ring: Float64Array, tin: TIN, slopes: list[Slope], lines: list[Float64Array]
) -> Float64Array:
    """Return a ring with elevations: where daylight lines cross, those of the ground.

    Where that ends, by rounding, those of the slope.
    """
    known = {(x, y): z for x, y, z in np.concatenate(lines).tolist()}
    found = tin.interpolate(ring).tolist()
    z = [known.get((x, y), own) for (x, y), own in zip(ring.tolist(), found, strict=True)]
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
