"""Regions of flat triangles: what bounds them, and what landform that tells of."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....tin.topology import NO_NEIGHBOR, edges_at
from ...surface import number_components

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ....tin import TIN

KINDS = ("unclear", "ridge", "valley", "peak", "pit")
"""Landforms of flat regions; ``Regions.kinds`` holds places in this list."""

NARROWEST = 1e-6
"""What is narrower than this part of its length is there by a rounding: slivers beside contours
that run straight, and along a hull that is straight but for its points' last digits."""

CAPS = (KINDS.index("peak"), KINDS.index("pit"))
"""Kinds that one contour encloses, so that no other one says how high they are."""


class Border(NamedTuple):
    """Edges of flat triangles with no flat one beyond, or with a line between."""

    triangles: Int64Array
    corners: Int64Array
    """Both (k,), flat triangle, and its corner opposite the edge."""
    regions: Int64Array
    """(k,)."""
    is_contour: BoolArray
    """(k,), whether the edge is one of a line; others are exits, or the end of the surface."""
    is_exit: BoolArray
    """(k,), whether a triangle beyond, with no line between, leads to another elevation."""
    rises: Float64Array
    """(k,), height of the far corner of the triangle beyond, above the edge; 0 if there is none."""
    runs: Float64Array
    """(k,), its distance from the line through the edge, in CRS units."""

    def take(self, part: slice) -> Border:
        """Return some of the edges."""
        return Border._make(array[part] for array in self)


class Regions(NamedTuple):
    """Flat triangles joined across edges that are not of a line."""

    region_of: Int64Array
    """(m,), region of each triangle, -1 for those that are not flat."""
    size: int
    """How many."""
    kinds: Int64Array
    """(r,), indices into ``KINDS``."""
    elevations: Float64Array
    """(r,)."""
    rises: Float64Array
    """(r,), from the region to the next contour that its triangles lead to; of caps, to what the
    next contour would be, inwards.
    """
    slopes: Float64Array
    """(r,), of caps: rise over run outside, the median along the contour."""
    border: Border


def find_regions(tin: TIN) -> Regions:
    """Find the regions of flat triangles, but for water.

    A triangle is flat if its corners have one elevation, to the last digit. Where the triangles at
    a region's border lead to higher contours alone it is a ridge's, to lower ones alone a valley's;
    if the ground beyond the lines around it goes the same way, or it leads both ways, it is
    unclear, and so it is without any line around. A region that leads nowhere is a peak or a pit,
    as the ground around it falls or rises.
    """
    is_flat = _find_flat(tin)
    region_of, count = _number_regions(tin, is_flat)
    border = _find_border(tin, region_of)
    rises, kinds = np.zeros(count), np.zeros(count, np.int64)
    slopes = np.zeros(count)
    starts = np.searchsorted(border.regions, np.arange(count + 1)).tolist()
    for region in range(count):
        part = slice(starts[region], starts[region + 1])
        kinds[region], rises[region], slopes[region] = _classify(border.take(part))
    first = np.full(count, -1)
    flat = np.flatnonzero(region_of >= 0)
    first[region_of[flat][::-1]] = flat[::-1]
    elevations = tin.points[tin.triangles[first, 0], 2] if count else np.empty(0)
    is_cap = np.isin(kinds, CAPS)
    z = tin.points[edges_at(tin.triangles, tin.constrained), 2]
    levels = np.unique(z[z[:, 0] == z[:, 1], 0])  # of contours, whose edges are level
    rises[is_cap] = _limit_rises(rises[is_cap], elevations[is_cap], levels)
    return Regions(region_of, count, kinds, elevations, rises, slopes, border)


def _limit_rises(
    rises: Float64Array, elevations: Float64Array, levels: Float64Array
) -> Float64Array:
    """Limit the rises of caps to the next level, where there is none to the least distance of two.

    The ground outside a cap may lead across several levels at once, where contours are missing.
    """
    bounded = np.concatenate([[-np.inf], levels, [np.inf]])
    above = bounded[np.searchsorted(bounded, elevations, side="right")] - elevations
    below = elevations - bounded[np.searchsorted(bounded, elevations, side="left") - 1]
    ahead = np.where(rises > 0.0, above, below)
    gaps = np.where(np.isfinite(ahead), ahead, np.diff(levels).min(initial=np.inf))
    return np.sign(rises) * np.minimum(np.abs(rises), gaps)


def _find_flat(tin: TIN) -> BoolArray:
    z = tin.points[tin.triangles, 2]
    is_flat = (z[:, 0] == z[:, 1]) & (z[:, 0] == z[:, 2])
    is_shore = np.zeros(len(tin.points), np.bool_)
    for kind, chain in zip(tin.lines.kinds, tin.lines.chains(), strict=True):
        if kind == "water":
            is_shore[chain] = True
    return np.asarray(is_flat & ~is_shore[tin.triangles].all(axis=1))


def _number_regions(tin: TIN, is_flat: BoolArray) -> tuple[Int64Array, int]:
    """Return the region of each triangle, -1 for none, and how many there are."""
    is_joined = (tin.neighbors != NO_NEIGHBOR) & ~tin.constrained
    is_joined &= is_flat[:, None] & is_flat[tin.neighbors]
    roots = number_components(np.where(is_joined, tin.neighbors, np.int32(NO_NEIGHBOR)))
    region_of = np.full(len(is_flat), -1, np.int64)
    found, numbers = np.unique(roots[is_flat], return_inverse=True)
    region_of[is_flat] = numbers
    return region_of, len(found)


def _find_border(tin: TIN, region_of: Int64Array) -> Border:
    """Return the border edges, region by region."""
    beyond = np.where(tin.neighbors == NO_NEIGHBOR, -1, region_of[tin.neighbors])
    is_border = (region_of[:, None] >= 0) & ((beyond < 0) | tin.constrained)
    triangles, corners = np.nonzero(is_border)
    order = np.argsort(region_of[triangles], kind="stable")
    triangles, corners = triangles[order], corners[order]
    across = tin.neighbors[triangles, corners]
    has_beyond = (across != NO_NEIGHBOR) & (beyond[triangles, corners] < 0)
    start = tin.points[tin.triangles[triangles, (corners + 1) % 3]]
    end = tin.points[tin.triangles[triangles, (corners + 2) % 3]]
    apex = tin.points[find_apexes(tin, triangles, across)]
    rise = np.where(has_beyond, apex[:, 2] - start[:, 2], 0.0)
    along, out = (end - start)[:, :2], (apex - start)[:, :2]
    width = np.hypot(*along.T)
    run = np.abs(along[:, 0] * out[:, 1] - along[:, 1] * out[:, 0]) / width
    is_line = tin.constrained[triangles, corners]
    is_exit = has_beyond & ~is_line & (rise != 0.0) & (run > NARROWEST * width)
    return Border(triangles, corners, region_of[triangles], is_line, is_exit, rise, run)


def find_apexes(tin: TIN, triangles: Int64Array, across: Int32Array) -> Int64Array:
    """Return the corner of each triangle beyond an edge that is not on the edge."""
    back = tin.neighbors[across] == triangles[:, None]
    apexes: Int64Array = tin.triangles[across, back.argmax(axis=1)].astype(np.int64)
    return apexes


def _classify(border: Border) -> tuple[int, float, float]:
    """Return the kind of a region, the rise to the next contour, and the slope around it."""
    exits = border.rises[border.is_exit]
    around = border.is_contour & (border.rises != 0.0) & (border.runs > 0.0)
    outside = float(np.sign(border.rises[around]).sum())
    if not border.is_contour.any():
        return 0, 0.0, 0.0
    if len(exits):
        way = np.sign(exits[0])
        if (np.sign(exits) != way).any() or outside * way > 0:
            return 0, 0.0, 0.0
        return KINDS.index("ridge" if way > 0 else "valley"), float(way * np.abs(exits).min()), 0.0
    if outside == 0.0:
        return 0, 0.0, 0.0
    rises = np.abs(border.rises[around])
    slope = float(np.median(rises / border.runs[around]))
    kind = "peak" if outside < 0 else "pit"
    return KINDS.index(kind), float(-np.sign(outside) * rises.min()), slope
