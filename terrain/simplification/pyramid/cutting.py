"""Triangles cut along the sides of a square.

A side cuts each edge at one point, computed from the ends of the edge in the order of their
coordinates: it is the same for the triangles on both sides of the edge, and in the squares on both
sides of the line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import PointsError
from ....tin import TIN, check
from ....tin.predicates import columns, orientation

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int32Array, Int64Array
    from ....base.types import Bounds


class Mesh(NamedTuple):
    """A part of a surface."""

    points: Float64Array
    """(n, 3), vertices, each once, ordered by easting, then northing."""
    triangles: Int32Array
    """(m, 3), counter-clockwise from the first vertex, in order: the same for the same
    triangles."""
    error: float = 0.0
    """Largest vertical distance from the whole surface."""


def cut(points: Float64Array, triangles: Int32Array, box: Bounds) -> Mesh:
    """Return the parts of triangles in a box.

    Parameters
    ----------
    points : (n, 3) float64 array
    triangles : (m, 3) int32 array
        Counter-clockwise.
    box : Bounds

    Returns
    -------
    Mesh
        Without parts that have no area where coordinates are rounded.

    Raises
    ------
    PointsError
        If rounding turned parts over, and the others do not make up one surface.
    """
    rings = triangles.astype(np.int64)
    for axis, low, high in ((0, box.xmin, box.xmax), (1, box.ymin, box.ymax)):
        whole = _Edges(len(points), np.empty((0, 2), np.int64))
        points, rings, whole = _keep_side(points, rings, whole, axis=axis, value=low, sign=1)
        points, rings, _ = _keep_side(points, rings, whole, axis=axis, value=high, sign=-1)
    parts = _divide(points, rings)
    found = settle(points, parts)
    if (orientation(columns(points), *parts.T) < 0).any() and not _is_sound(found):
        raise explain_narrow(box)
    return found


def explain_narrow(box: Bounds) -> PointsError:
    """Return the refusal of triangles that rounding turned over in a square."""
    return PointsError(
        f"The surface cannot be cut along the square from {box.xmin:g}, {box.ymin:g} to "
        f"{box.xmax:g}, {box.ymax:g}: it is so narrow there that its triangles lie over each "
        "other where coordinates are rounded. `tinsmith.simplify` in memory does not cut it."
    )


def _is_sound(mesh: Mesh) -> bool:
    """Tell whether triangles make up one surface with one boundary, which does not meet itself."""
    if not len(mesh.triangles):
        return True
    try:
        found = check(TIN.from_triangles(mesh.points, mesh.triangles), level=2)
    except PointsError:  # edges of more than two triangles
        return False
    kinds = {problem.kind for problem in found.problems}
    return kinds.isdisjoint({"orientation", "boundary", "overlap", "euler", "area"})


class _Edges(NamedTuple):
    """The edges that were cut along one axis already, which the other line cuts as wholes."""

    first: int
    """Number of the first point at which one was cut; the others follow."""
    ends: Int64Array
    """(k, 2)."""

    def find_whole(self, ends: Int64Array) -> Int64Array:
        """Return the ends of the edges of which some are parts."""
        found = ends.copy()
        for k in (0, 1):
            is_part = ends[:, k] >= self.first
            found[is_part] = self.ends[ends[is_part, k] - self.first]
        return found


def _keep_side(
    points: Float64Array,
    rings: Int64Array,
    edges: _Edges,
    *,
    axis: int,
    value: float,
    sign: int,
) -> tuple[Float64Array, Int64Array, _Edges]:
    """Return what of convex polygons lies on one side of a line; -1 fills up their rows."""
    is_corner = rings >= 0
    place = np.where(is_corner, np.sign(sign * (points[:, axis] - value))[rings], 0).astype(np.int8)
    is_inside = (place > 0).any(axis=1)
    is_cut = is_inside & (place < 0).any(axis=1)
    whole, parts, place = rings[is_inside & ~is_cut], rings[is_cut], place[is_cut]
    if not len(parts):
        return points, whole, edges
    after = (np.arange(parts.shape[1]) + 1) % (parts >= 0).sum(axis=1)[:, None]
    crosses = place * np.take_along_axis(place, after, axis=1) < 0
    ends = np.stack([parts[crosses], np.take_along_axis(parts, after, axis=1)[crosses]], axis=1)
    ends = np.sort(edges.find_whole(ends), axis=1)
    cuts, number = np.unique(ends, axis=0, return_inverse=True)
    made = np.full((len(parts), 2 * parts.shape[1]), -1, np.int64)
    made[:, ::2] = np.where(place >= 0, parts, -1)
    between = made[:, 1::2]
    between[crosses] = len(points) + number.ravel()
    made = np.take_along_axis(made, np.argsort(made < 0, axis=1, kind="stable"), axis=1)
    width = parts.shape[1] + 1
    padded = np.full((len(whole), width), -1, np.int64)
    padded[:, :-1] = whole
    new = _cut_edges(points[cuts[:, 0]], points[cuts[:, 1]], axis, value)
    kept = np.concatenate([padded, made[:, :width]])
    return np.concatenate([points, new]), kept, _Edges(len(points), cuts)


def _divide(points: Float64Array, rings: Int64Array) -> Int64Array:
    """Return the triangles of convex polygons: fans from where the smallest is largest."""
    found = []
    counts = (rings >= 0).sum(axis=1)
    for count in np.unique(counts).tolist():
        ring = rings[counts == count, :count]
        turns = (np.arange(count)[:, None] + np.arange(count)) % count
        fans = ring[:, turns]  # polygon, first corner, corner
        xy = points[fans, :2] - points[fans[:, :, :1], :2]
        before, after = xy[:, :, 1:-1], xy[:, :, 2:]
        areas = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
        best = areas.min(axis=2).argmax(axis=1)
        chosen = fans[np.arange(len(ring)), best]
        found += [chosen[:, [0, k, k + 1]] for k in range(1, count - 1)]
    return np.concatenate(found) if found else np.empty((0, 3), np.int64)


def _cut_edges(one: Float64Array, other: Float64Array, axis: int, value: float) -> Float64Array:
    """Return the point of each edge on a line, the ends taken in the order of coordinates."""
    is_turned = (other[:, 0] < one[:, 0]) | ((other[:, 0] == one[:, 0]) & (other[:, 1] < one[:, 1]))
    start = np.where(is_turned[:, None], other, one)
    end = np.where(is_turned[:, None], one, other)
    share = (value - start[:, axis]) / (end[:, axis] - start[:, axis])
    found = start + share[:, None] * (end - start)
    found = np.clip(found, np.minimum(start, end), np.maximum(start, end))
    found[:, axis] = value
    return np.asarray(found)


def settle(points: Float64Array, triangles: Int64Array, error: float = 0.0) -> Mesh:
    """Return triangles with each place once, in an order that is a function of the places."""
    points, triangles = _use(points + 0.0, triangles)
    order = np.lexsort((points[:, 2], points[:, 1], points[:, 0]))
    is_new = np.append(True, (np.diff(points[order, :2], axis=0) != 0).any(axis=1))[: len(order)]
    number = np.empty(len(order), np.int64)
    number[order] = np.cumsum(is_new) - 1
    points, triangles = points[order[is_new]], number[triangles]
    triangles = triangles[orientation(columns(points), *triangles.T) > 0]
    points, triangles = _use(points, triangles)
    turn = (triangles.argmin(axis=1)[:, None] + np.arange(3)) % 3 if len(triangles) else triangles
    triangles = np.take_along_axis(triangles, turn, axis=1)
    triangles = triangles[np.lexsort(triangles.T[::-1])]
    return Mesh(points, triangles.astype(np.int32), error)


def _use(points: Float64Array, triangles: Int64Array) -> tuple[Float64Array, Int64Array]:
    """Return the points that are corners, in their order."""
    used, corners = np.unique(triangles, return_inverse=True)
    return points[used], corners.reshape(-1, 3)
