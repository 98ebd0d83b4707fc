"""Water: what of a surface lies under levels, as polygons, with areas and volumes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin import topology
from .. import _kernel
from ..surface import DividedMesh, PolygonParts, dissolve, fan_out, repair_polygons, require_finite

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array


class Polygons(NamedTuple):
    """Polygons as :meth:`Features.of_polygons` takes them, and the region of each feature."""

    points: Float64Array
    ring_offsets: Int64Array
    polygon_offsets: Int64Array
    feature_offsets: Int64Array
    regions: Int64Array
    notes: tuple[str, ...]


class Waters(NamedTuple):
    """Waters that stand in triangles, each with a level of its own."""

    triangles: Int64Array
    """(k,), of the surface, with a corner under water."""
    numbers: Int64Array
    """(k,), the water in each."""
    levels: Float64Array
    """(w,)."""


def measure_waters(
    points: Float64Array, triangles: Int32Array, waters: Waters, up: float
) -> tuple[Float64Array, Float64Array]:
    """Measure areas and volumes of waters, (w,) each, exact but for rounding.

    Points and triangles are those of the surface; ``up`` is the factor from elevations to the unit
    of eastings.
    """
    corners = triangles[waters.triangles]
    depths = waters.levels[waters.numbers][:, None] - points[corners, 2]
    # Each triangle with vertices of its own, for at one vertex several levels may meet.
    apart = np.ascontiguousarray(points[corners].reshape(-1, 3))
    rows = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
    groups = waters.numbers.astype(np.int32)
    sums = _kernel.sum_heights(apart, rows, depths.ravel(), groups, len(waters.levels), up)
    require_finite(sums)
    column = _kernel.SUMS.index
    return sums[:, column("fill_area")], sums[:, column("fill")] * up


def cut_below(points: Float64Array, triangles: Int32Array, waters: Waters) -> DividedMesh:
    r"""Cut off what of triangles lies above the water in them.

    A corner at the level is dry. A place where the level crosses an edge is made once for both
    triangles of the edge, and is the vertex itself if that lies at the level::

             dry            corner k is under water: with the crossings of both edges
            /   \           it makes a triangle; two such corners make two
        ---x-----x---
          k ----- wet
    """
    # Each water with vertices of its own: waters may lie in each other.
    keys = waters.numbers[:, None] * len(points) + triangles[waters.triangles]
    own, corners = np.unique(keys, return_inverse=True)
    corners, points = corners.reshape(-1, 3), points[own % len(points)]
    levels = waters.levels[waters.numbers]
    depths = levels[:, None] - points[corners, 2]
    wet = depths > 0.0
    shore = _cross_edges(points, corners, levels, wet)
    cells: list[list[Int64Array]] = []
    for k in range(3):
        cells += [
            [np.where(wet[:, k], corners[:, k], -1)],
            [np.where(wet[:, k] != wet[:, (k + 1) % 3], shore.vertices[:, (k + 2) % 3], -1)],
        ]
    slots = np.concatenate(cells).T
    used = slots >= 0
    offsets = topology.find_offsets(used.sum(axis=1))
    made, cell = fan_out(offsets, slots[used].astype(np.int32))
    sound = (made != np.roll(made, 1, axis=1)).all(axis=1)
    triangles, cell = np.ascontiguousarray(made[sound]), cell[sound]
    return DividedMesh.of(shore.points, triangles, waters.numbers[cell])


class _Shore(NamedTuple):
    """Where levels cross the edges opposite corners: vertices, -1 where they do not."""

    points: Float64Array
    vertices: Int64Array


def _cross_edges(
    points: Float64Array,
    corners: Int64Array,
    levels: Float64Array,
    wet: BoolArray,
) -> _Shore:
    vertices = np.full(corners.shape, -1)
    rows, k = np.nonzero(np.roll(wet, -1, axis=1) != np.roll(wet, -2, axis=1))
    start, end = corners[rows, (k + 1) % 3], corners[rows, (k + 2) % 3]
    is_up = wet[rows, (k + 1) % 3]
    low, high = np.where(is_up, start, end), np.where(is_up, end, start)
    keys = low * len(points) + high
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    low, high, level = low[first], high[first], levels[rows[first]]
    z = points[:, 2]
    at_vertex = z[high] == level
    share = ((level - z[low]) / (z[high] - z[low]))[:, None]
    places = points[low, :2] + share * (points[high, :2] - points[low, :2])
    found = np.where(at_vertex, high, len(points) + np.arange(len(high)))
    vertices[rows, k] = found[number]
    return _Shore(np.concatenate([points[:, :2], places]), vertices)


def gather_polygons(patches: DividedMesh) -> Polygons:
    """Join the triangles of each region to polygons that are valid."""
    found = dissolve(patches, patches.owners)
    counts = np.diff(found.feature_offsets)
    parts, notes = repair_polygons(
        PolygonParts(
            np.ascontiguousarray(patches.points[found.vertices, :2]),
            found.ring_offsets,
            found.polygon_offsets,
            np.repeat(found.classes, counts).astype(np.int32),
        ),
        together=True,
    )
    regions, first = np.unique(parts.band, return_index=True)
    return Polygons(
        parts.points,
        parts.ring_offsets,
        parts.polygon_offsets,
        np.append(first, len(parts.band)).astype(np.int64),
        regions.astype(np.int64),
        notes,
    )
