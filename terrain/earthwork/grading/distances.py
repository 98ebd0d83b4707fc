"""The distance from a polygon as a surface, the form of all its side slopes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....tin import TIN, triangulate

if TYPE_CHECKING:
    from ....arrays import Float64Array

__all__ = ["measure_distances"]

_QUARTER = 45
"""Facets of a cone in a right angle, each two degrees."""
_SHARE = 5e-4
"""Of the largest distance: so much the surface may be off."""
_MOST_RINGS = 64


def measure_distances(pad: Any, reach: float) -> TIN:
    """Return the distance from a polygon without holes around it, as elevations.

    They are exact at the vertices: those of the polygon, and of lines of equal distance, as many as
    it takes to be exact within 0.0005 of ``reach`` in the middles of triangles, at most 64.
    """
    import shapely

    count = 1
    while True:
        surface = _surround(pad, reach, count)
        middles = surface.points[surface.triangles].mean(axis=1)
        apart = np.abs(shapely.distance(pad, shapely.points(middles[:, :2])) - middles[:, 2])
        if count >= _MOST_RINGS or float(apart.max()) <= _SHARE * reach:
            return surface
        count *= 4


def _surround(pad: Any, reach: float, count: int) -> TIN:
    """Return the surface over some lines of equal distance."""
    import shapely

    inner = _measure(pad, shapely.get_coordinates(pad.exterior))
    inner[:, 2] = 0.0
    lines = [inner]
    for number in range(1, count + 1):
        around = shapely.buffer(pad, reach * number / count, quad_segs=_QUARTER)
        lines += [_measure(pad, shapely.get_coordinates(ring)) for ring in _list_rings(around)]
    outer = [ring for ring in lines[1:] if shapely.is_ccw(shapely.linearrings(ring[:, :2]))][-1]
    return triangulate(
        np.concatenate(lines), breaklines=lines, boundary=[outer], holes=[inner], duplicates="last"
    )


def _list_rings(polygon: Any) -> list[Any]:
    import shapely

    return list(shapely.get_rings(shapely.orient_polygons(polygon)))


def _measure(pad: Any, xy: Float64Array) -> Float64Array:
    import shapely

    return np.column_stack([xy, shapely.distance(pad, shapely.points(xy))])
