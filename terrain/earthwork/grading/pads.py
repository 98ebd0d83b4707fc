"""A pad and its side slopes as one surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....tin import Breakline, triangulate
from .seams import measure_tolerance

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from ....tin import TIN
    from .slopes import Slope


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
