"""The oracle of surfaces in tiles: the whole triangulation, in memory."""

from __future__ import annotations

import numpy as np

import tinsmith as ts
from tinsmith.tin.tiling.boxes import widen
from tinsmith.tin.tiling.local_triangulation import find_triangles_at, triangulate_box

from .point_cells import PointCells


def divide(points, side):
    """Divide points between side x side cells of equal size."""
    bounds = ts.Bounds.of(points)
    xs, ys = (
        np.linspace(low, high, side + 1)[1:-1]
        for low, high in ((bounds.xmin, bounds.xmax), (bounds.ymin, bounds.ymax))
    )
    return PointCells(points, xs, ys)


def list_corners(points, triangles):
    """Return the corners of triangles, each from its least vertex, as a sorted array."""
    corners = [[tuple(points[v]) for v in triangle] for triangle in triangles.tolist()]
    return sorted((*one[k:], *one[:k]) for one in corners for k in [one.index(min(one))])


def require_triangles_of_the_whole(points, source, *, margin, duplicates="mean"):
    """Require of each cell the triangles, elevations and numbers that the whole has there."""
    whole = ts.triangulate(points, duplicates=duplicates)
    first = np.full(len(whole.points), len(points))
    np.minimum.at(first, whole.vertex_of, np.arange(len(points)))
    number_at = {
        tuple(xyz): number for xyz, number in zip(whole.points.tolist(), first, strict=True)
    }
    rounds = 0
    for key in source.list_cells():
        box = source.box_of(key)
        local = triangulate_box(source, box, around=widen(box, margin), duplicates=duplicates)
        chosen = find_triangles_at(whole.points, whole.triangles, box)
        wanted = list_corners(whole.points.tolist(), whole.triangles[chosen])
        assert list_corners(local.points.tolist(), local.triangles) == wanted, f"tile {key}"
        for xyz, number in zip(local.points.tolist(), local.numbers.tolist(), strict=True):
            assert number_at[tuple(xyz)] == number, f"tile {key}: row of {xyz}"
        rounds = max(rounds, local.rounds)
    return rounds
