"""Profiles and draping over a surface in parts: the triangles that lines meet are few.

A tile returns the triangles that lines meet in it, and those around them. Joined they are a surface
that has everything that lies on the lines: :func:`tinsmith.profile`,
:func:`tinsmith.cross_sections` and :func:`tinsmith.drape` of it are those of the whole.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.types import Bounds, seal
from ...tin import TIN, triangulate
from ...tin.tiling import intersect
from ..sections.rims import move_aside
from ..surface import Segments
from .surfaces import as_surface

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.crs import CRS, Unit
    from ...tin.tiling import LocalTriangulation

RINGS = 1
"""Rings of triangles that a part needs: a line may meet a triangle in a vertex only."""


class LineOptions(NamedTuple):
    """Lines over a surface."""

    segments: Segments
    """Of the lines."""
    rim: Float64Array
    """(k, 3), the vertices on the boundary of the whole surface, of which the skeleton of its
    points has all where no ring cuts it. Lines along it are followed as far beside it as its
    coordinates are rounded."""


class SurfacePart(NamedTuple):
    """Some triangles of a surface."""

    points: Float64Array
    """(n, 3)."""
    numbers: Int64Array
    """(n,), of the vertices in the whole."""
    triangles: Int32Array
    """(m, 3)."""
    constrained: BoolArray
    """(m, 3), whether the edge opposite each corner is a segment of a line."""


def find_reach(box: Bounds, options: LineOptions) -> Bounds | None:
    """Return the box of which a part is needed, within that of a tile; None if no line is there."""
    ends = [end for segments in _list_near(box, options) for end in segments[:2]]
    return intersect(Bounds.of(np.concatenate(ends)), box) if ends else None


def _list_near(box: Bounds, options: LineOptions) -> Iterator[Segments]:
    """Yield the segments whose bounds meet a box, and those beside a boundary that do, if any."""
    low, high = (box.xmin, box.ymin), (box.xmax, box.ymax)
    for segments in (options.segments, *move_aside(options.segments, options.rim[:, :2])):
        starts, ends = segments.starts, segments.ends
        near = (np.minimum(starts, ends) <= high) & (np.maximum(starts, ends) >= low)
        rows = near.all(axis=1) & (starts != ends).any(axis=1)
        if rows.any():
            yield Segments._make(array[rows] for array in segments)


def compute_part(part: LocalTriangulation, box: Bounds, options: LineOptions) -> SurfacePart:
    """Return the triangles that lines meet in a tile, and others.

    Parameters
    ----------
    part : LocalTriangulation
        All triangles that meet :func:`find_reach`, with :data:`RINGS` rings around them.
    box : Bounds
        Of the tile; of those that tile the plane each place on a line is in one at least.
    options : LineOptions
    """
    chosen = np.zeros(len(part.triangles), np.bool_)
    if len(chosen):
        chosen = _are_met(part, box, options)
    used, corners = np.unique(part.triangles[chosen], return_inverse=True)
    return SurfacePart(
        part.points[used],
        part.numbers[used],
        corners.reshape(-1, 3).astype(np.int32),
        part.constrained[chosen],
    )


def _are_met(part: LocalTriangulation, box: Bounds, options: LineOptions) -> BoolArray:
    """Tell which triangles lines meet, or have a vertex of one that they meet."""
    is_corner = np.zeros(len(part.points), np.bool_)
    locator = as_surface(part).triangulation.locator
    for segments in _list_near(box, options):
        traced = locator.trace(
            np.ascontiguousarray(segments.starts), np.ascontiguousarray(segments.ends)
        )
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
    found = [one for one in parts if len(one.triangles)]
    if found:
        tin = _join_parts(found, options, crs, elevation_unit)
        n_vertices = len(tin.points) - len(options.rim)
        rim = np.arange(n_vertices, len(tin.points), dtype=np.int32)
        tin.triangulation.__dict__["rings"] = (seal(rim),)  # the edges of the part are none
        return tin
    tin = triangulate(options.rim)  # lines beside the surface are beside this one
    return TIN.from_triangles(tin.points, tin.triangles, crs=crs, elevation_unit=elevation_unit)


def _join_parts(
    found: list[SurfacePart], options: LineOptions, crs: CRS | None, unit: Unit | None
) -> TIN:
    """Return the triangles of all parts, each once, with the vertices of the rim behind theirs."""
    numbers, first = np.unique(np.concatenate([one.numbers for one in found]), return_index=True)
    points = np.concatenate([one.points for one in found])[first]
    corners = [np.searchsorted(numbers, one.numbers)[one.triangles] for one in found]
    triangles, own = np.unique(np.concatenate(corners), axis=0, return_index=True)
    return TIN.from_triangles(
        np.concatenate([points, options.rim]),
        triangles,
        constrained=np.concatenate([one.constrained for one in found])[own],
        crs=crs,
        elevation_unit=unit,
    )
