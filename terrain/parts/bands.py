"""Bands between contours, tile by tile: the segments around them, from which polygons are made.

A tile lists the segments in the triangles that it owns, band by band. The polygons of a band are
made of all its segments, so that one band at a time is in memory.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from .. import _kernel
from ..isolines import as_band_features, measure_off
from ..surface import (
    PolygonParts,
    find_slivers,
    find_thin,
    has_area,
    keep_triangles,
    repair_polygons,
)
from .surfaces import are_inner, are_owned_triangles

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...base.crs import CRS, Unit
    from ...base.results import Features
    from ...base.types import Bounds
    from ...tin.tiling import LocalTriangulation
    from ..isolines import Levels

RINGS = 3
"""Rings of triangles that a part needs around those that meet the tile's box: as contours do, and
one for what is left out along the boundary."""


_NEARLY = 0.99
"""Of how far off the area of a band may be."""


class BandOptions(NamedTuple):
    """What bands are filled."""

    levels: Levels
    rounding: float
    """Distance of neighbouring doubles at the largest coordinate of the whole surface: thinner
    triangles along its boundary are left out."""
    extent: float
    """Width and height of the whole surface together."""
    crs: CRS | None = None
    elevation_unit: Unit | None = None


class BandPart(NamedTuple):
    """Segments around bands in a tile."""

    segments: Float64Array
    """(n, 4), from and to, the band on the left."""
    offsets: Int64Array
    """(b + 1,), those of band i are ``segments[offsets[i]:offsets[i + 1]]``."""
    areas: Float64Array
    """(1, t), doubles that add up to the area of the tile's triangles, exactly."""
    under: Float64Array
    """(k,), area of the tile's triangles below each level."""


def compute_part(part: LocalTriangulation, box: Bounds, options: BandOptions) -> BandPart:
    """List the segments around bands in the triangles that a tile owns.

    Parameters
    ----------
    part : LocalTriangulation
        All triangles that meet the box, with :data:`RINGS` rings around them.
    box : Bounds
    options : BandOptions

    Raises
    ------
    PointsError
        If a row of triangles thinner than rounding leads out of the part.
    """
    is_owned = are_owned_triangles(part, box)
    is_inner = are_inner(part, box, RINGS)
    _require_decided(part, is_owned, is_inner, options.rounding)
    owned = np.ascontiguousarray(part.triangles[is_owned])
    areas = _kernel.terms_of_areas(part.points, owned, np.zeros(len(owned), np.int32), 1)
    levels = options.levels.values
    under = _kernel.stage_sums(part.points, owned, levels, 1.0)[:, 0]
    is_sliver = find_slivers(
        part.points, part.triangles, part.neighbors, options.rounding, is_inner=is_inner
    )
    kept = keep_triangles(part.triangles, part.neighbors, ~is_sliver)
    found = _kernel.list_band_boundaries(
        part.points, *kept, levels, np.ascontiguousarray(is_owned[~is_sliver])
    )
    return BandPart(found.segments, found.offsets, areas, under)


def _require_decided(
    part: LocalTriangulation, is_owned: BoolArray, is_inner: BoolArray, rounding: float
) -> None:
    """Refuse a part in which it cannot be told what is left out along the boundary.

    A thin triangle is left out if the next one is: so all thin ones in a row must be there.
    """
    is_thin = find_thin(part.points, part.triangles, rounding)
    if not is_thin.any():
        return
    is_corner = np.zeros(len(part.points), np.bool_)
    is_corner[part.triangles[is_owned]] = True
    reached = is_corner[part.triangles].any(axis=1) & is_thin
    pending = np.flatnonzero(reached).tolist()
    while pending:
        triangle = pending.pop()
        if not is_inner[triangle]:
            raise PointsError(
                "A row of triangles thinner than the rounding of coordinates leads out of a tile: "
                "bands need larger tiles here."
            )
        for beyond in part.neighbors[triangle].tolist():
            if beyond >= 0 and is_thin[beyond] and not reached[beyond]:
                reached[beyond] = True
                pending.append(beyond)


def join(parts: Sequence[BandPart], options: BandOptions) -> Features:
    """Return the bands of the whole surface, of the parts of all tiles in any order.

    Raises
    ------
    PointsError
        If rounding leaves no polygons, or some that must be built anew from all triangles.
    """
    levels = options.levels.values
    filled = [_fill(parts, band) for band in range(len(levels) + 1)]
    made = [one for one in filled if len(one.band)]
    if not made:
        raise PointsError("No triangle is left that is thicker than the rounding of coordinates.")
    found, notes = repair_polygons(_concatenate(made))
    area = float(_kernel.sum_rows(np.concatenate([part.areas for part in parts], axis=1))[0])
    if notes or not has_area(found, area):
        _require_right(found, np.sum([part.under for part in parts], axis=0), area, options)
    return as_band_features(found, options.levels, options.crs, options.elevation_unit, notes)


def _require_right(
    found: PolygonParts, under: Float64Array, area: float, options: BandOptions
) -> None:
    """Refuse bands whose area is not what lies between their levels: memory builds these anew.

    Sums over tiles are rounded otherwise than those of the whole: so bands are refused, too, that
    are only nearly as far off.
    """
    slack_of = options.rounding, options.extent
    off, slack = measure_off(found, under, area, slack_of=slack_of)
    if (off > _NEARLY * slack).any() or not has_area(found, area):
        raise PointsError(
            "Polygons of bands meet themselves within the rounding of coordinates, and can only be "
            "made valid in memory: fill the bands of a part of the surface, or subtract an origin."
        )


def _fill(parts: Sequence[BandPart], band: int) -> PolygonParts:
    some = [part.segments[part.offsets[band] : part.offsets[band + 1]] for part in parts]
    filled = _kernel.fill_band(np.concatenate(some), band)
    return PolygonParts(filled.points, filled.ring_offsets, filled.polygon_offsets, filled.band)


def _concatenate(made: list[PolygonParts]) -> PolygonParts:
    """Return the polygons of several bands one after the other."""
    rings, polygons = [np.zeros(1, np.int64)], [np.zeros(1, np.int64)]
    for one in made:
        polygons.append(one.polygon_offsets[1:] + sum(map(len, rings)) - 1)
        rings.append(one.ring_offsets[1:] + rings[-1][-1])
    return PolygonParts(
        np.concatenate([one.points for one in made]),
        np.concatenate(rings),
        np.concatenate(polygons),
        np.concatenate([one.band for one in made]),
    )
