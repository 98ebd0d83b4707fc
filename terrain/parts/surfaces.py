"""Parts of a surface as surfaces, and the triangles that a tile owns."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...tin import TIN, Report
from ...tin.tiling import find_around, find_triangles_at

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...base.crs import CRS, Unit
    from ...base.types import Bounds
    from ...tin.tiling import LocalTriangulation
    from ..surface import Surface


def as_surface(
    part: LocalTriangulation, crs: CRS | None = None, elevation_unit: Unit | None = None
) -> TIN:
    """Return the TIN of some triangles of a whole surface; one at least."""
    return TIN(
        points=part.points,
        triangles=part.triangles,
        neighbors=part.neighbors,
        constrained=part.constrained,
        vertex_of=np.arange(len(part.points), dtype=np.int32),
        report=Report(
            n_rows=len(part.points), n_vertices=len(part.points), n_triangles=len(part.triangles)
        ),
        crs=crs,
        elevation_unit=elevation_unit,
    )


def are_owned(places: Float64Array, box: Bounds) -> BoolArray:
    """Tell which places, (..., 2 or more), lie in a box without its east and north sides.

    Of boxes that tile the plane each place is in one.
    """
    x, y = places[..., 0], places[..., 1]
    is_owned: BoolArray = (x >= box.xmin) & (x < box.xmax) & (y >= box.ymin) & (y < box.ymax)
    return is_owned


def are_owned_triangles(part: LocalTriangulation | Surface, box: Bounds) -> BoolArray:
    """Tell which triangles a tile owns: those whose vertex of least easting it does.

    Of several it is that of least northing. A triangle meets the box of its owner.
    """
    return are_owned(part.points[part.triangles[:, 0]], box)


def are_inner(part: LocalTriangulation, box: Bounds, rings: int) -> BoolArray:
    """Tell which triangles are not in the last of some rings around those that meet a box.

    A side of theirs without a neighbour is on the boundary of the whole surface.
    """
    is_inner = np.zeros(len(part.triangles), np.bool_)
    if not len(is_inner):
        return is_inner
    chosen = find_triangles_at(part.points, part.triangles, box)
    for _ in range(rings - 1):
        chosen = find_around(part.triangles, chosen, len(part.points))
    is_inner[chosen] = True
    return is_inner
