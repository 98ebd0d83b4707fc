"""A triangle mesh made sound after rounding, and cut where a linear function is zero."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import LinesError, PointsError
from ...tin import TIN, check, topology, triangulate
from ...tin.report import Report
from ..surface import double_areas, number_components, turns

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ...base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, Int64Array

_MOST_ROUNDS = 64
"""Flat triangles lie side by side in short chains; each round takes one off an end."""


_SNAPS = (0.0, 64.0)
"""Roundings of the largest coordinate: lines closer than this may be brought together."""


def mend(points: Float64Array, triangles: Int32Array) -> tuple[Float64Array, Int32Array] | None:
    """Remove triangles that rounding has made flat or turned over; None if that is not enough.

    Vertices that were rounded to one place become one. A flat triangle on the boundary is dropped;
    the longest edge of another one is flipped, as its third vertex lies on it but for rounding.
    What moves is as thin as coordinates can tell.
    """
    try:
        return _mend_rounds(points, triangles)
    except PointsError:  # edges with more than two triangles: lines run through each other
        return None


def _mend_rounds(
    points: Float64Array, triangles: Int32Array
) -> tuple[Float64Array, Int32Array] | None:
    merged = _merge_places(points, triangles)
    for _ in range(_MOST_ROUNDS):
        flat = np.flatnonzero(turns(points, merged) <= 0)
        if not len(flat):
            found = drop_unused(points, merged)
            return found if _is_sound(*found) else None
        merged = _remove_flat(points, merged, flat)
    return None


def _is_sound(points: Float64Array, triangles: Int32Array) -> bool:
    """Whether triangles, all of them counter-clockwise, do not lie over each other."""
    if not len(triangles):
        return False
    return bool(check(as_mesh(points, triangles), level=2).ok)


def as_mesh(points: Float64Array, triangles: Int32Array, **reference: Any) -> TIN:
    """Return a TIN whose edges are all constrained: none of them may be flipped."""
    return TIN(
        points=points,
        triangles=triangles,
        neighbors=topology.neighbors_of(triangles, len(points)),
        constrained=np.ones((len(triangles), 3), bool),
        vertex_of=np.arange(len(points), dtype=np.int32),
        report=Report(n_rows=len(points), n_vertices=len(points), n_triangles=len(triangles)),
        **reference,
    )


def rebuild(
    points: Float64Array, triangles: Int32Array, holds: Callable[[Any], Any]
) -> Iterator[tuple[Float64Array, Int32Array]]:
    """Triangulate anew with all edges as lines, which are split where rounding lets them cross.

    Points and triangles are as they were made, before rounding is looked at; ``holds`` tells
    whether places, (k, 2), are inside: what is not is cut away. Yields sound points and triangles:
    without snapping, then snapped.
    """
    start, end = topology.directed_edges(triangles)
    once = np.unique(topology.edge_keys(np.stack([start, end], axis=-1), len(points)))
    pairs = np.stack([once // len(points), once % len(points)], axis=1)
    pairs = pairs[(points[pairs[:, 0], :2] != points[pairs[:, 1], :2]).any(axis=1)]
    yield from unite(points, pairs, holds)


def unite(
    points: Float64Array, pairs: Int64Array, holds: Callable[[Any], Any]
) -> Iterator[tuple[Float64Array, Int32Array]]:
    """Triangulate points with lines between pairs of them, (k, 2), and keep what is inside.

    As :func:`rebuild`.
    """
    lines = list(points[pairs])
    rounding = float(np.spacing(np.abs(points[:, :2]).max()))
    for roundings in _SNAPS:
        snap = roundings * rounding
        try:
            tin = triangulate(points, breaklines=lines, duplicates="first", snap=snap)
        except (LinesError, PointsError):  # lines meet anew wherever they are split
            continue
        found = drop_unused(tin.points, tin.triangles[_is_inside(tin, holds)])
        if _is_sound(*found):
            yield found


def _is_inside(tin: TIN, holds: Callable[[Any], Any]) -> BoolArray:
    """Tell which triangles are inside, cell by cell.

    What is reached from the outside without crossing a line is outside, however thin: the rounded
    boundary and its hull lie a rounding apart.
    """
    cell = number_parts(tin.neighbors, tin.constrained)
    is_open = np.zeros(int(cell.max()) + 1, bool)
    is_open[cell[((tin.neighbors < 0) & ~tin.constrained).any(axis=1)]] = True
    largest = np.empty(len(is_open), np.int64)
    order = np.argsort(tin.triangulation.triangle_areas, kind="stable")
    largest[cell[order]] = order
    centers = tin.points[tin.triangles[largest], :2].mean(axis=1)
    inside: BoolArray = (holds(centers) & ~is_open)[cell]
    return inside


def number_parts(neighbors: Int32Array, barrier: BoolArray) -> Int32Array:
    """Give the triangles of each part that no barrier divides one number.

    Both arrays are (m, 3); an edge without a neighbour divides anyway.
    """
    joined = np.where(barrier, np.int32(topology.NO_NEIGHBOR), neighbors)
    numbers: Int32Array = np.unique(number_components(joined), return_inverse=True)[1].astype(
        np.int32
    )
    return numbers


def _merge_places(points: Float64Array, triangles: Int32Array) -> Int32Array:
    order = np.lexsort((points[:, 1], points[:, 0]))
    is_new = np.ones(len(points), bool)
    is_new[1:] = (np.diff(points[order, :2], axis=0) != 0).any(axis=1)
    if is_new.all():
        return triangles
    kept = np.empty(len(points), np.int32)
    kept[order] = order[is_new][np.cumsum(is_new) - 1]
    merged = kept[triangles]
    a, b, c = merged.T
    return np.ascontiguousarray(merged[(a != b) & (b != c) & (c != a)])


def part_places(points: Float64Array, triangles: Int32Array) -> Float64Array:
    """Move vertices of one place and different elevations apart, by a rounding each.

    They are the top and the foot of a wall, rounded to one place: each goes towards the middle of
    its triangles, weighted by their areas, so that both sides keep their elevations.
    """
    is_wall = _find_walls(points)
    corners = points[triangles, :2]
    weights = np.abs(double_areas(points, triangles))[:, None, None]
    ways = (corners.mean(axis=1)[:, None] - corners) * weights
    pull = np.zeros((len(points), 2))
    np.add.at(pull, triangles, ways)
    with np.errstate(divide="ignore", invalid="ignore"):
        toward = np.nan_to_num(pull / np.hypot(*pull.T)[:, None])
    parted = points.copy()
    parted[is_wall, :2] += float(np.spacing(np.abs(points[:, :2]).max())) * toward[is_wall]
    return parted


def _find_walls(points: Float64Array) -> BoolArray:
    """Tell which points share their place with one of another elevation."""
    order = np.lexsort((points[:, 1], points[:, 0]))
    starts = np.flatnonzero(np.append(True, (np.diff(points[order, :2], axis=0) != 0).any(axis=1)))
    heights = points[order, 2]
    differs = np.minimum.reduceat(heights, starts) < np.maximum.reduceat(heights, starts)
    found = np.empty(len(points), np.bool_)
    found[order] = np.repeat(differs, np.diff(np.append(starts, len(points))))
    return found


def _remove_flat(points: Float64Array, triangles: Int32Array, flat: Int64Array) -> Int32Array:
    """Drop the flat triangles along the boundary; if there are none, flip edges of the others."""
    neighbors = topology.neighbors_of(triangles, len(points))
    xy = points[triangles[flat], :2]
    edges = xy[:, [2, 0, 1]] - xy[:, [1, 2, 0]]
    longest = np.argmax(np.hypot(edges[..., 0], edges[..., 1]), axis=1)  # corners opposite
    is_outside = neighbors[flat] == topology.NO_NEIGHBOR
    loose = is_outside[np.arange(len(flat)), longest] | (is_outside.sum(axis=1) > 1)
    if loose.any():
        return np.delete(triangles, flat[loose], axis=0)
    corners = triangles.copy()
    is_touched = np.zeros(len(corners), bool)
    for triangle, corner in zip(flat.tolist(), longest.tolist(), strict=True):
        across = int(neighbors[triangle, corner])
        if is_touched[triangle] or is_touched[across]:
            continue
        is_touched[[triangle, across]] = True
        apex, start, end = (int(corners[triangle, (corner + k) % 3]) for k in range(3))
        far = int(next(v for v in corners[across] if v not in (start, end)))
        corners[triangle], corners[across] = (apex, start, far), (apex, far, end)
    return corners


def drop_unused(points: Float64Array, triangles: Int32Array) -> tuple[Float64Array, Int32Array]:
    """Leave out points that no triangle has."""
    used = topology.mark_corners(triangles, len(points))
    number = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return points[used], np.ascontiguousarray(number[triangles])


def cut_at_zero(points: Float64Array, triangles: Int32Array) -> tuple[Float64Array, Int32Array]:
    r"""Cut triangles along the line where the elevation is 0, which becomes edges.

    It leaves a corner at 0 where there is one, else it cuts two sides::

        +  alone                  +
       / \                       / \
           x---x   both ends    or   0   \      from a vertex at 0
     /    _\  of the line        \-__x
    -____/  -                     \__ \
                                          `--
    """
    return divide_at_zero(points, triangles)[:2]


def classify_signs(points: Float64Array, triangles: Int32Array) -> Int8Array:
    """Return the sign of the third coordinate in each triangle, +1, -1 or 0.

    No triangle has both signs, but for roundings, which the mean does not mind.
    """
    signs: Int8Array = np.sign(points[triangles, 2].sum(axis=1)).astype(np.int8)
    return signs


def divide_at_zero(
    points: Float64Array, triangles: Int32Array
) -> tuple[Float64Array, Int32Array, Int64Array]:
    """Cut triangles as :func:`cut_at_zero`, and return also the one that each is a part of.

    Points, (n, 3 or more), may have further columns, which are linear along the edges.
    """
    whole = np.arange(len(triangles))
    signs = np.sign(points[triangles, 2]).astype(np.int8)
    is_cut = (signs.max(axis=1) > 0) & (signs.min(axis=1) < 0)
    if not is_cut.any():
        return points, triangles, whole
    corners, signs = _turn_alone_first(triangles[is_cut], signs[is_cut])
    points, second, third = _place_zeros(points, corners, signs)
    a, b, c = corners.T
    is_apart = signs[:, 1] != 0  # else the line runs from corner b: then only a-c is cut
    parts = [
        np.stack([a, second, third], axis=1),
        np.stack([second, b, third], axis=1)[is_apart],
        np.stack([b, c, third], axis=1),
    ]
    cut = whole[is_cut]
    parents = np.concatenate([whole[~is_cut], cut, cut[is_apart], cut])
    return points, np.concatenate([triangles[~is_cut], *parts]).astype(np.int32), parents


def _turn_alone_first(corners: Int32Array, signs: Int8Array) -> tuple[Int32Array, Int8Array]:
    """Turn triangles until corner 0 alone has its sign; one at 0, if there is one, is corner 1."""
    first = np.argmax(signs * np.sign(-signs.sum(axis=1, dtype=np.int64))[:, None], axis=1)
    zero = np.argmin(np.abs(signs), axis=1)
    first = np.where((signs == 0).any(axis=1), (zero + 2) % 3, first)
    turned = (first[:, None] + np.arange(3)) % 3
    return np.take_along_axis(corners, turned, axis=1), np.take_along_axis(signs, turned, axis=1)


def _place_zeros(
    points: Float64Array, corners: Int32Array, signs: Int8Array
) -> tuple[Float64Array, Int32Array, Int32Array]:
    """Make the vertices at 0 on the edges 0-1 and 0-2; a corner 1 at 0 is one already."""
    is_edge = np.stack([signs[:, 1] != 0, np.ones(len(corners), bool)], axis=1)
    pairs = np.stack([corners[:, [0, 1]], corners[:, [0, 2]]], axis=1)[is_edge]
    keys, inverse = np.unique(topology.edge_keys(pairs, len(points)), return_inverse=True)
    made = _interpolate_zeros(points, keys // len(points), keys % len(points))
    vertices = np.repeat(corners[:, [1]], 2, axis=1)
    vertices[is_edge] = len(points) + inverse
    return np.concatenate([points, made]), vertices[:, 0], vertices[:, 1]


def _interpolate_zeros(points: Float64Array, one: Int64Array, other: Int64Array) -> Float64Array:
    """Return where the elevation is 0 between vertices, from the lower of them on."""
    is_lower = points[one, 2] < points[other, 2]
    low, high = (points[np.where(is_lower, *pair)] for pair in ((one, other), (other, one)))
    share = (low[:, 2] / (low[:, 2] - high[:, 2]))[:, None]
    made: Float64Array = np.where(
        share <= 0.5, low + share * (high - low), high + (1.0 - share) * (low - high)
    )
    made[:, 2] = 0.0
    return made
