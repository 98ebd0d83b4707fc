"""Lengths of lines and areas of polygons, and polygons that meet themselves by rounding."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.errors import PointsError
from ...base.georeference import find_scales
from ...base.sentences import counted

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array, ObjectArray
    from ...base.crs import CRS
    from ...tin import TIN

_ROUNDINGS = 32.0
"""So many roundings the boundary of a polygon may be off."""
_SHARE = 1e-9
"""Of the area of the TIN: what sums of floats may differ by."""


class PolygonParts(NamedTuple):
    """Polygons as the kernel returns them, by band."""

    points: Float64Array
    """(n, 2)."""
    ring_offsets: Int64Array
    polygon_offsets: Int64Array
    band: Int32Array
    """(k,), of each polygon."""


def repair_polygons(
    parts: PolygonParts, *, together: bool = False
) -> tuple[PolygonParts, tuple[str, ...]]:
    """Make polygons valid that meet themselves, or with ``together`` others of theirs; say so."""
    shapely = optional.load("shapely")
    offsets = parts.ring_offsets, parts.polygon_offsets
    shapes = shapely.from_ragged_array(shapely.GeometryType.POLYGON, parts.points, offsets)
    if together:  # polygons that are valid together are so by themselves
        _, owner = np.unique(parts.band, return_inverse=True)
        order = np.argsort(owner, kind="stable")
        wholes = shapely.multipolygons(shapes[order], indices=owner[order])
        is_bad = ~shapely.is_valid(wholes)[owner]
    else:
        is_bad = ~shapely.is_valid(shapes)
    if not is_bad.any():
        return parts, ()
    bands = np.unique(parts.band[is_bad])
    pieces, numbers = [], []
    for band in np.unique(parts.band):
        members = shapes[parts.band == band]
        if band in bands:
            members = _make_valid(members)
        pieces.append(members)
        numbers.append(np.full(len(members), band, np.int32))
    note = (
        f"{counted(int(is_bad.sum()), 'polygon')} met themselves within the rounding of "
        "coordinates, where triangles are thinner than it, and were made valid."
    )
    return as_parts(np.concatenate(pieces), np.concatenate(numbers)), (note,)


def _make_valid(shapes: ObjectArray) -> ObjectArray:
    shapely = optional.load("shapely")
    try:
        whole = shapely.union_all(shapely.make_valid(shapes))
    except shapely.errors.GEOSException as error:
        raise PointsError(
            "Polygons meet themselves within the rounding of coordinates, and cannot be made "
            "valid: triangles are too thin for coordinates of this size; subtract an origin from "
            "them."
        ) from error
    found = shapely.get_parts(whole)
    return take_polygons(found)


def take_polygons(shapes: ObjectArray) -> ObjectArray:
    """Return the shapes that are polygons with an area, turned; none of nothing."""
    shapely = optional.load("shapely")
    is_polygon = shapely.get_type_id(shapes) == shapely.GeometryType.POLYGON
    polygons = shapes[is_polygon & ~shapely.is_empty(shapes)]
    kept: ObjectArray = np.array([_turn(one) for one in polygons], object)
    return kept


def _turn(polygon: Any) -> Any:
    """Return a polygon whose exterior runs counter-clockwise, and its holes clockwise."""
    orient = optional.load("shapely.geometry.polygon").orient
    return orient(polygon)


def as_parts(shapes: ObjectArray, band: Int32Array) -> PolygonParts:
    """Return polygons of shapely as the kernel returns its own."""
    shapely = optional.load("shapely")
    if len(shapes) == 0:  # nothing is left of what is thinner than rounding
        none = np.zeros(1, np.int64)
        return PolygonParts(np.zeros((0, 2)), none, none, band)
    _, points, (rings, polygons) = shapely.to_ragged_array(shapes)
    return PolygonParts(
        np.ascontiguousarray(points[:, :2]),
        np.asarray(rings, np.int64),
        np.asarray(polygons, np.int64),
        band,
    )


def is_whole(tin: TIN, parts: PolygonParts) -> bool:
    """Whether areas add up to that of the surface, but for rounding along all rings."""
    return has_area(parts, tin.triangulation.area)


def has_area(parts: PolygonParts, area: float) -> bool:
    """Whether areas add up to another, but for rounding along all rings."""
    found = float(measure_ring_areas(None, parts.points, parts.ring_offsets).sum())
    length = float(measure_lengths(None, parts.points, parts.ring_offsets).sum())
    rounding = float(np.spacing(np.abs(parts.points).max(initial=0.0)))
    return bool(abs(found - area) <= _SHARE * area + _ROUNDINGS * rounding * length)


def require_whole(tin: TIN, parts: PolygonParts) -> None:
    """Refuse polygons whose areas do not add up to that of the surface.

    Raises PointsError if more is missing than rounding along all rings can account for.
    """
    if not is_whole(tin, parts):
        found = float(measure_ring_areas(None, parts.points, parts.ring_offsets).sum())
        area = tin.triangulation.area
        raise PointsError(
            f"The bands add up to an area of {found:g}, the surface has {area:g}: its "
            "triangles are too thin for coordinates of this size; subtract an origin from them."
        )


def measure_lengths(
    crs: CRS | None, coordinates: Float64Array, offsets: Int64Array
) -> Float64Array:
    """Measure lines of two points or more in the plane.

    In CRS units; in a geographic CRS in metres along the ellipsoid, which holds for segments of
    some kilometres.
    """
    run, rise = np.diff(coordinates[:, 0]), np.diff(coordinates[:, 1])
    if crs is not None and crs.is_geographic:
        middle = 0.5 * (coordinates[1:, 1] + coordinates[:-1, 1])
        scales = find_scales(crs, None, middle)
        run, rise = run * scales.east, rise * scales.north
    spans = np.hypot(run, rise, out=run)
    spans[offsets[1:-1] - 1] = 0.0  # from one line to the next
    return sum_parts(spans, offsets[:-1])


def measure_ring_areas(
    crs: CRS | None, coordinates: Float64Array, offsets: Int64Array
) -> Float64Array:
    """Measure the areas inside closed rings, the first point of each repeated.

    In CRS units squared, in a geographic CRS square metres; positive where the ring runs
    counter-clockwise.
    """
    origin = np.repeat(coordinates[offsets[:-1]], np.diff(offsets), axis=0)
    x, y = (coordinates - origin).T
    doubled = np.append(x[:-1] * y[1:] - x[1:] * y[:-1], 0.0)
    doubled[offsets[1:] - 1] = 0.0
    if crs is not None and crs.is_geographic:
        north = coordinates[:, 1]
        scales = find_scales(crs, None, (north + np.append(north[1:], 0.0) + origin[:, 1]) / 3)
        doubled *= scales.east * scales.north
    return 0.5 * sum_parts(doubled, offsets[:-1])


def sum_parts(values: Float64Array, starts: Int64Array) -> Float64Array:
    """Sum consecutive parts of an array, none of them empty, that start at these places."""
    if len(starts) == 0:
        return np.zeros(0)
    sums: Float64Array = np.add.reduceat(values, starts)
    return sums
