"""Profiles and draping over a surface in parts: the triangles that lines meet are few.

A tile returns those of the triangles that it owns which a line meets, and those around them. Joined
they are a surface that has everything that lies on the lines: :func:`tinsmith.profile`,
:func:`tinsmith.cross_sections` and :func:`tinsmith.drape` of it are those of the whole.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.types import seal
from ...tin import TIN
from ..sections.rims import move_aside
from .surfaces import are_owned_triangles, as_surface

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.crs import CRS, Unit
    from ...base.types import Bounds
    from ...tin.tiling import LocalTriangulation
    from ..surface import Segments

__all__ = ["RINGS", "LineOptions", "SurfacePart", "compute_part", "join"]

RINGS = 1
"""Rings of triangles that a part needs: a line may meet a triangle in a vertex only."""


class LineOptions(NamedTuple):
    """Lines over a surface.

    Attributes
    ----------
    segments : Segments
        Of the lines.
    rim : (k, 3) float64 array
        The vertices on the boundary of the whole surface, of which the skeleton of its points has
        all. Lines along it are followed as far beside it as its coordinates are rounded.
    """

    segments: Segments
    rim: Float64Array


class SurfacePart(NamedTuple):
    """Some triangles of a surface; ``numbers`` (n,) are those of the vertices in the whole."""

    points: Float64Array
    numbers: Int64Array
    triangles: Int32Array


def compute_part(part: LocalTriangulation, box: Bounds, options: LineOptions) -> SurfacePart:
    """Return the triangles that lines meet, of those that a tile owns.

    Parameters
    ----------
    part : LocalTriangulation
        All triangles that meet the box, with :data:`RINGS` rings around them.
    box : Bounds
        Of the tile; of those that tile the plane each triangle is owned by one.
    options : LineOptions
    """
    chosen = np.zeros(len(part.triangles), np.bool_)
    if len(chosen):
        chosen = are_owned_triangles(part, box) & _are_met(part, options)
    used, corners = np.unique(part.triangles[chosen], return_inverse=True)
    return SurfacePart(
        part.points[used], part.numbers[used], corners.reshape(-1, 3).astype(np.int32)
    )


def _are_met(part: LocalTriangulation, options: LineOptions) -> BoolArray:
    """Tell which triangles lines meet, or have a vertex of one that they meet."""
    low, high = part.points[:, :2].min(axis=0), part.points[:, :2].max(axis=0)
    is_corner = np.zeros(len(part.points), np.bool_)
    locator = as_surface(part).triangulation.locator
    for segments in (options.segments, *move_aside(options.segments, options.rim[:, :2])):
        starts, ends = segments.starts, segments.ends
        near = (np.minimum(starts, ends) <= high) & (np.maximum(starts, ends) >= low)
        rows = near.all(axis=1) & (starts != ends).any(axis=1)
        traced = locator.trace(np.ascontiguousarray(starts[rows]), np.ascontiguousarray(ends[rows]))
        for triangles in (traced.triangles, traced.edges // 3):
            is_corner[part.triangles[triangles[triangles >= 0]]] = True
        is_corner[traced.vertices[traced.vertices >= 0]] = True
    return np.asarray(is_corner[part.triangles].any(axis=1))


def join(
    parts: Iterable[SurfacePart],
    options: LineOptions,
    crs: CRS | None = None,
    elevation_unit: Unit | None = None,
) -> TIN:
    """Return the surface along the lines, of the parts of all tiles in any order.

    Its boundary is that of the whole, as far as products of lines ask for it.
    """
    found = list(parts)
    numbers, first = np.unique(np.concatenate([one.numbers for one in found]), return_index=True)
    points = np.concatenate([one.points for one in found])[first]
    corners = [np.searchsorted(numbers, one.numbers)[one.triangles] for one in found]
    tin = TIN.from_triangles(
        np.concatenate([points, options.rim]),
        np.concatenate(corners),
        crs=crs,
        elevation_unit=elevation_unit,
    )
    rim = np.arange(len(points), len(points) + len(options.rim), dtype=np.int32)
    tin.triangulation.__dict__["rings"] = (seal(rim),)  # the edges of the part are none
    return tin
