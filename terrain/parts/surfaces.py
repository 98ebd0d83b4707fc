"""Parts of a surface as surfaces, what of them a tile owns, and what no tile can compute."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import OptionError
from ...tin import TIN, Report
from ...tin.tiling import find_around, find_triangles_at

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...base.crs import CRS, Unit
    from ...base.types import Bounds
    from ...tin.tiling import LocalTriangulation
    from ..surface import Surface

_WATER = (
    "water that falls on one tile runs through others, so that each place depends on all of the "
    "surface above it"
)

_SIGHT = "what is seen from a place may be hidden by any part of the surface between"

NOT_LOCAL = {
    "catchments": _WATER,
    "depressions": "a depression is as deep as the lowest way out of it, wherever that leads",
    "flow_accumulation": _WATER,
    "flow_path": "where water runs is known only by following it, from tile to tile",
    "ponds": "a pond is as deep as the lowest way out of it, wherever that leads",
    "ridges_and_valleys": _WATER,
    "line_of_sight": _SIGHT,
    "viewshed": _SIGHT,
    "visible_vertices": _SIGHT,
    "max_edge": (
        "triangles with long edges are removed one after the other from the boundary on, so that "
        "each depends on all between it and the boundary"
    ),
    "smooth": (
        "each line is rounded in what room the lines before it have left, so that each depends on "
        "all others"
    ),
    "simplify": (
        "points are dropped in the order of what they change along the whole line, or over the "
        "whole surface"
    ),
    "extrapolate": "the nearest place of the boundary may lie in any tile",
}
"""Why products and options are not local, by name: the surface is needed as a whole."""


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


def require_local(name: str) -> None:
    """Refuse a product, or an option of one, that needs the surface as a whole.

    Raises
    ------
    OptionError

    Examples
    --------
    >>> require_local("slope")
    >>> require_local("viewshed")
    Traceback (most recent call last):
    ...
    tinsmith.base.errors.OptionError: ...
    """
    if name in NOT_LOCAL:
        raise OptionError(name, "a surface in tiles", f"a surface in memory: {NOT_LOCAL[name]}")
