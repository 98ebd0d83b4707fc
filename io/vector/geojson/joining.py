"""Features that were cut at the antimeridian, as RFC 7946 asks, are joined again."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base import optional
from ....base.errors import CrsError
from ....base.sentences import counted, inflect
from ...reprojection import reproject
from .antimeridian import HALF_TURN, TURN, find_west_and_east

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array, ObjectArray
    from ....base.crs import CRS
    from ..layers import Layer

_MULTI_LINE, _MULTI_POLYGON = 5, 6
_TRIANGLE = 4
"""Coordinates of its ring."""

_STEP, _FARTHEST = 1e-6, 1e3
"""Degrees between places, and how many times as far apart the map may have them across its end."""

_FLAT = 0.01
"""Of the length of a side: how far a crossing lies from it at most in longitude and latitude."""


def join_at_antimeridian(features: Layer, target: CRS | None) -> Layer:
    """Join the parts of features that meet at the antimeridian, where the target goes on there.

    Longitudes of a layer with such features go on beyond 180, and a note tells it. The layer stays
    as it is if no feature was cut; if it is more than 180 degrees wide, as that of the whole world,
    of which other features must not move; or if the map of the target ends there. Triangles are
    triangles again.

    Parameters
    ----------
    features : Layer
    target : CRS or None
        To which they will be brought.
    """
    shapely = optional.load("shapely")
    shapes, crs = features.geometries, features.crs
    if crs is None or not crs.is_geographic or target is None or target.is_geographic:
        return features
    bounds, kinds = shapely.bounds(shapes), shapely.get_type_id(shapes)
    is_across = (bounds[:, 0] == -HALF_TURN) & (bounds[:, 2] == HALF_TURN)
    rows = np.flatnonzero(is_across & np.isin(kinds, (_MULTI_LINE, _MULTI_POLYGON)))
    if len(rows) == 0:
        return features
    spans = shapely.bounds(shapely.get_parts(shapes))[:, [0, 2]]
    west, east = find_west_and_east(spans)
    is_narrow = west > east and TURN + east - west <= HALF_TURN
    if not is_narrow or not _goes_on(crs, target, bounds[rows][:, [1, 3]].ravel()):
        return features
    moved = shapes.copy()
    for has_z in (False, True):
        some = shapely.has_z(shapes) == has_z
        moved[some] = shapely.transform(
            shapes[some], lambda xyz: _go_on(xyz, west), include_z=has_z
        )
    for row in rows.tolist():
        join = _join_lines if kinds[row] == _MULTI_LINE else _join_polygons
        moved[row] = join(shapely.get_parts(moved[row]))
    is_joined = shapely.get_num_geometries(moved) < shapely.get_num_geometries(shapes)
    count = int(is_joined.sum())
    if count == 0:
        return features
    _restore_triangles(moved, np.flatnonzero(is_joined))
    what = inflect(f"{counted(count, 'feature')} that [was|were] cut", count)
    note = f"'{features.path.name}': {what} at the antimeridian {inflect('[is|are]', count)}"
    return features._replace(geometries=moved, notes=(*features.notes, f"{note} joined again."))


def _goes_on(crs: CRS, target: CRS, latitudes: Float64Array) -> bool:
    """Whether the map of the target has no end at the antimeridian."""
    ways = HALF_TURN - _STEP * np.array([3.0, 1.0, -1.0])
    rows = np.array([(x, y, 0.0) for y in np.unique(latitudes) for x in (ways + HALF_TURN) % TURN
                     - HALF_TURN])  # fmt: skip
    try:
        found = reproject(rows, crs.horizontal, target.horizontal, unit=None).points
    except CrsError:
        return False
    steps = np.linalg.norm(np.diff(found.reshape(-1, 3, 3)[..., :2], axis=1), axis=2)
    return bool((steps[:, 1] <= _FARTHEST * steps[:, 0]).all())


def _go_on(xyz: Float64Array, west: float) -> Float64Array:
    moved = xyz.copy()
    moved[moved[:, 0] < west, 0] += TURN
    return moved


def _join_lines(parts: ObjectArray) -> object:
    """Join each part to the one before that ends where it begins."""
    shapely = optional.load("shapely")
    has_z = bool(shapely.has_z(parts).all())
    joined: list[Float64Array] = []
    for part in parts.tolist():
        xyz = shapely.get_coordinates(part, include_z=has_z)
        end = joined[-1][-1] if joined else None
        if end is not None and end[0] == HALF_TURN and np.array_equal(end, xyz[0]):
            joined[-1] = np.concatenate([joined[-1], xyz[1:]])
        else:
            joined.append(xyz)
    lines = [shapely.LineString(xyz) for xyz in joined]
    return lines[0] if len(lines) == 1 else shapely.MultiLineString(lines)


def _join_polygons(parts: ObjectArray) -> object:
    """Unite the parts that reach the antimeridian, which others do not."""
    shapely = optional.load("shapely")
    bounds = shapely.bounds(parts)
    reaches = (bounds[:, 0] == HALF_TURN) | (bounds[:, 2] == HALF_TURN)
    united = shapely.get_parts(shapely.union_all(parts[reaches]))
    polygons = [*parts[~reaches], *shapely.orient_polygons(united)]
    return polygons[0] if len(polygons) == 1 else shapely.MultiPolygon(polygons)


def _restore_triangles(shapes: ObjectArray, rows: Int64Array) -> None:
    """Leave the crossings away where all others are triangles, and these are without them."""
    others = np.delete(shapes, rows)
    if not (_has_corners(others) == _TRIANGLE).all():
        return
    corners = _has_corners(shapes[rows])
    if not np.isin(corners, (_TRIANGLE, _TRIANGLE + 1, _TRIANGLE + 2)).all():
        return
    found = [_restore_triangle(shape) for shape in shapes[rows]]
    if all(one is not None for one in found):
        shapes[rows] = found


def _has_corners(shapes: ObjectArray) -> Int64Array:
    """Return how many coordinates the ring of each polygon has; 0 of anything else."""
    shapely = optional.load("shapely")
    is_ring = (shapely.get_type_id(shapes) == 3) & (shapely.get_num_interior_rings(shapes) == 0)
    return np.where(is_ring, shapely.get_num_coordinates(shapes), 0)


def _restore_triangle(shape: object) -> object | None:
    """Return a polygon without the one or two flattest corners on the antimeridian."""
    shapely = optional.load("shapely")
    xyz = shapely.get_coordinates(shape, include_z=bool(shapely.has_z(shape)))[:-1]
    while len(xyz) > 3:
        before, after = np.roll(xyz, 1, axis=0)[:, :2], np.roll(xyz, -1, axis=0)[:, :2]
        side, here = after - before, xyz[:, :2] - before
        away = np.abs(side[:, 0] * here[:, 1] - side[:, 1] * here[:, 0]) / (side**2).sum(axis=1)
        away[xyz[:, 0] != HALF_TURN] = np.inf
        if away.min() > _FLAT:
            return None
        xyz = np.delete(xyz, int(away.argmin()), axis=0)
    triangle: object = shapely.Polygon(xyz)
    return triangle
