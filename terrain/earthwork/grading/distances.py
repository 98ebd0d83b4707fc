"""The distance from a polygon as a surface, the form of all its side slopes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....tin import TIN, triangulate
from .edge_cells import find_rays
from .seams import find_first_near

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array

_SHARE = 1e-6
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
    number = find_first_near(places[:, :2], max(tolerance, _SHARE * reach))
    ends = number[len(ring) :]
    follows = rays.cell[1:] == rays.cell[:-1]
    tops = np.stack([ends[:-1], ends[1:]], axis=1)
    is_fan = rays.cell >= len(ring)
    fans = np.stack([rays.cell[is_fan] - len(ring), ends[is_fan]], axis=1)
    segments = np.concatenate([tops[follows], fans])
    rings = [
        np.column_stack([own, np.full(len(own), reach)])
        for own in _list_rings(places[:, :2], tops[is_free[:-1]], pad)
    ]
    edge = np.column_stack([ring, np.zeros(len(ring))])
    segments = np.unique(np.sort(segments, axis=1), axis=0)
    lines = list(places[segments[segments[:, 0] != segments[:, 1]]])
    return triangulate(
        places[np.unique(number)],
        breaklines=lines,
        boundary=rings[:1],
        holes=[edge, *rings[1:]],
        duplicates="last",
    )


def _list_rings(xy: Float64Array, segments: Int64Array, pad: Any) -> list[Float64Array]:
    """Return the ring around a pad that segments make, and those of what they leave open."""
    import shapely

    lines = shapely.linestrings(xy[segments[segments[:, 0] != segments[:, 1]]])
    noded = shapely.get_parts(shapely.union_all(lines))  # where slopes just meet, lines overlap
    faces = shapely.get_parts(shapely.polygonize(noded))
    face = faces[shapely.contains_properly(faces, shapely.point_on_surface(pad))][0]
    return [shapely.get_coordinates(ring) for ring in shapely.get_rings(face)]
