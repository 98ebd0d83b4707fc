"""The distance from a polygon as a surface, the form of all its side slopes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....tin import TIN, triangulate
from ..zones import join_segments
from .edge_cells import find_rays

if TYPE_CHECKING:
    from ....arrays import Float64Array, Int64Array

__all__ = ["measure_distances"]

_SHARE = 1e-7
"""Of the largest distance: what is nearer to each other is one place."""


def measure_distances(pad: Any, reach: float, tolerance: float) -> TIN:
    """Return the distance from a polygon without holes around it, as elevations.

    It is exact where an edge is nearest, and along the rays of corners, which are two degrees
    apart: between them the cone about a corner is cut flat. Where slopes meet it breaks. Places
    nearer than ``tolerance`` are one.
    """
    import shapely

    ring = shapely.get_coordinates(pad.exterior)[:-1]
    origin = ring.mean(axis=0)
    rays, is_free = find_rays(ring - origin, reach)
    places = np.concatenate([ring, rays.ends + origin])
    distances = np.concatenate([np.zeros(len(ring)), rays.length])
    places = np.column_stack([places, distances])
    number = _merge(places[:, :2], max(tolerance, _SHARE * reach))
    ends = number[len(ring) :]
    follows = rays.cell[1:] == rays.cell[:-1]
    tops = np.stack([ends[:-1], ends[1:]], axis=1)
    is_fan = rays.cell >= len(ring)
    fans = np.stack([rays.cell[is_fan] - len(ring), ends[is_fan]], axis=1)
    segments = np.concatenate([tops[follows], fans])
    outline = tops[is_free[:-1]]
    outer, inner = _find_rings(places, outline[outline[:, 0] != outline[:, 1]])
    edge = np.column_stack([ring, np.zeros(len(ring))])
    segments = np.unique(np.sort(segments, axis=1), axis=0)
    lines = list(places[segments[segments[:, 0] != segments[:, 1]]])
    return triangulate(
        places[np.unique(number)],
        breaklines=lines,
        boundary=[outer],
        holes=[edge, *inner],
        duplicates="last",
    )


def _merge(xy: Float64Array, tolerance: float) -> Int64Array:
    """Return for each place the first one that is the same within a tolerance."""
    import shapely

    points = shapely.points(xy)
    pairs = shapely.STRtree(points).query(points, predicate="dwithin", distance=tolerance)
    first = np.arange(len(xy))
    while True:
        least = first.copy()
        np.minimum.at(least, pairs[0], first[pairs[1]])
        if (least == first).all():
            return first
        first = least


def _find_rings(
    places: Float64Array, segments: Int64Array
) -> tuple[Float64Array, list[Float64Array]]:
    """Return the rings that segments make: the one around all others, and these."""
    import shapely

    chains = join_segments(segments[:, 0], segments[:, 1])
    rings = [places[chain] for chain in chains if chain[0] == chain[-1] and len(chain) > 3]
    areas = [float(shapely.area(shapely.polygons(ring[:, :2]))) for ring in rings]
    outer = rings.pop(int(np.argmax(areas)))
    return outer, rings
