"""Outlines: the area that a surface covers, and the rings of an area for a new surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....tin.constraints.clipping import in_rings

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ....base.arrays import AnyArray, Float64Array
    from ....tin import TIN

_SHARE = 1e-12
"""Of an area: by so much less it may fill its hull, by rounding."""


def find_area(tin: TIN) -> Any:
    """Return what a surface covers as a geometry of shapely."""
    return build_area(tin.points, tin.boundary)


def build_area(points: Float64Array, rings: Sequence[AnyArray]) -> Any:
    """Return the area within rings of vertices, which may touch themselves and one another."""
    import shapely

    outlines = [np.ascontiguousarray(points[ring, :2]) for ring in rings]
    lines = [shapely.linearrings(outline) for outline in outlines]
    vertices = np.concatenate(rings)
    if len(np.unique(vertices)) == len(vertices):
        return shapely.build_area(shapely.geometrycollections(lines))
    noded = shapely.get_parts(shapely.union_all(lines))
    faces = shapely.get_parts(shapely.polygonize(noded))
    places = shapely.get_coordinates(shapely.point_on_surface(faces))
    return shapely.coverage_union_all(faces[in_rings(places, outlines) > 0])


def fills_hull(area: Any) -> bool:
    """Tell whether an area is convex but for rounding."""
    import shapely

    return bool(shapely.convex_hull(area).area - area.area <= _SHARE * area.area)


def arrange_rings(
    area: Any, elevations: Mapping[tuple[float, float], float]
) -> dict[str, list[Any]]:
    """Return boundary and holes of an area, in which islands stay, for a triangulation.

    ``elevations`` are those of its vertices, by their places.
    """
    import shapely

    parts = shapely.get_parts(area)
    outer = shapely.get_exterior_ring(parts)
    around = shapely.STRtree(shapely.polygons(outer))
    found = around.query(shapely.point_on_surface(parts), predicate="within")[0]
    is_island = np.bincount(found, minlength=len(parts)) > 1
    inner = [ring for part in parts for ring in part.interiors] + list(outer[is_island])
    rings = [[_lift(ring, elevations) for ring in group] for group in (outer[~is_island], inner)]
    return {"boundary": rings[0], "holes": [rings[1]] if rings[1] else []}


def _lift(ring: Any, elevations: Mapping[tuple[float, float], float]) -> Float64Array:
    return np.array([[x, y, elevations[x, y]] for x, y in ring.coords])
