"""Bands whose polygons were lost to rounding, built anew from the parts of single triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.sentences import counted
from .. import _kernel
from ..surface import (
    PolygonParts,
    as_parts,
    measure_lengths,
    measure_ring_areas,
    measure_rounding,
    sum_parts,
    take_polygons,
)

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, ObjectArray
    from ...tin import TIN

_ROUNDINGS = 32.0
"""So many roundings the boundary of a polygon may be off."""
_SHARE = 1e-9
"""Of the area of the TIN: what sums of floats may differ by."""


def rebuild_wrong_bands(
    tin: TIN, levels: Float64Array, parts: PolygonParts
) -> tuple[PolygonParts, tuple[str, ...]]:
    """Build the bands anew whose area is not what lies between their levels, and say so.

    ``parts`` are of one band more than there are levels. Where a triangle is thinner than the
    rounding of its coordinates the segments around a band can cross, and no ring goes through them
    in the right order. The part of each triangle in a band is convex, and GEOS joins these to valid
    polygons.
    """
    under = _kernel.stage_sums(tin.points, tin.triangles, levels, 1.0)[:, 0]
    area, rounding = float(tin.triangulation.area), measure_rounding(tin.points)
    extent = float(np.ptp(tin.points[:, :2], axis=0).sum())
    off, slack = measure_off(parts, under, area, slack_of=(rounding, extent))
    wrong = np.flatnonzero(off > slack)
    if len(wrong) == 0:
        return parts, ()
    shapes, numbers = _list_shapes(parts)
    is_kept = ~np.isin(numbers, wrong)
    pieces, bands = [shapes[is_kept]], [numbers[is_kept]]
    for band in wrong.tolist():
        made = _join_parts(tin, levels, band)
        pieces.append(made)
        bands.append(np.full(len(made), band, np.int32))
    every, number = np.concatenate(pieces), np.concatenate(bands)
    order = np.argsort(number, kind="stable")
    note = (
        f"The polygons of {counted(len(wrong), 'band')} crossed themselves within the rounding of "
        "coordinates, where triangles are thinner than it, and were joined from the parts of "
        "single triangles."
    )
    return as_parts(every[order], number[order]), (note,)


def measure_off(
    parts: PolygonParts, under: Float64Array, area: float, *, slack_of: tuple[float, float]
) -> tuple[Float64Array, Float64Array]:
    """Return how far the area of each band is from that of the surface, and how far it may be.

    Parameters
    ----------
    parts : PolygonParts
    under : (k,) float64 array
        Area of the surface below each level.
    area : float
        Of the surface.
    slack_of : (float, float)
        The rounding of the largest coordinate, and width and height together.
    """
    true = np.diff(np.concatenate([[0.0], under, [area]]))
    rings = measure_ring_areas(None, parts.points, parts.ring_offsets)
    lengths = measure_lengths(None, parts.points, parts.ring_offsets)
    found, around = (
        np.bincount(parts.band, sum_parts(values, parts.polygon_offsets[:-1]), len(true))
        for values in (rings, lengths)
    )
    rounding, extent = slack_of
    slack = np.asarray(_SHARE * area + _ROUNDINGS * rounding * (around + extent))
    return np.abs(found - true), slack.astype(np.float64)


def _list_shapes(parts: PolygonParts) -> tuple[ObjectArray, Int32Array]:
    shapely = optional.load("shapely")
    offsets = parts.ring_offsets, parts.polygon_offsets
    shapes: Any = shapely.from_ragged_array(shapely.GeometryType.POLYGON, parts.points, offsets)
    return shapes, np.asarray(parts.band, np.int32)


def _join_parts(tin: TIN, levels: Float64Array, band: int) -> ObjectArray:
    """Return the polygons of a band: the parts of all triangles in it, joined."""
    shapely = optional.load("shapely")
    bounds = np.concatenate([[-np.inf], levels, [np.inf]])
    low, high = float(bounds[band]), float(bounds[band + 1])
    corners = tin.points[tin.triangles]
    heights = corners[..., 2]
    is_met = (heights.max(axis=1) >= low) & (heights.min(axis=1) < high)
    rings = [_cut_between(triangle, low, high) for triangle in corners[is_met].tolist()]
    parts = np.array([shapely.Polygon(ring) for ring in rings if len(ring) > 2], object)
    parts = parts[shapely.is_valid(parts) & (shapely.area(parts) > 0.0)]
    return take_polygons(shapely.get_parts(shapely.union_all(parts)))


def _cut_between(corners: list[list[float]], low: float, high: float) -> list[tuple[float, float]]:
    """Return the part of a triangle between two elevations (Sutherland and Hodgman)."""
    ring = [tuple(corner) for corner in corners]
    for level, side in ((low, 1.0), (high, -1.0)):
        if not np.isfinite(level):
            continue
        kept: list[tuple[float, ...]] = []
        for start, end in zip(ring, ring[1:] + ring[:1], strict=True):
            is_in, goes_in = side * (start[2] - level) >= 0, side * (end[2] - level) >= 0
            if is_in:
                kept.append(start)
            if is_in != goes_in:
                kept.append(_cross(start, end, level))
        ring = kept
    return [(corner[0], corner[1]) for corner in ring]


def _cross(one: tuple[float, ...], other: tuple[float, ...], level: float) -> tuple[float, ...]:
    """Return where an edge has an elevation, from its lower end on, as lines have it."""
    low, high = (one, other) if one[2] < other[2] else (other, one)
    share = (level - low[2]) / (high[2] - low[2])
    x, y = (low[k] + share * (high[k] - low[k]) for k in (0, 1))
    return x, y, level
