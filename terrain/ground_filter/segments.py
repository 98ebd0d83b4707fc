"""Segments of lowest points that no step parts, and which of them continue the ground.

An opening takes the edge of a terrace off as it takes a roof off, and the densification does not
climb back to it: the triangles there are steep. But the terrace goes on without a step into ground
that is known, and the roof ends in steps all around::

        ground  ______ taken off            ______ roof
                      |            taken off
     =================+...                 |      |
                      |____        ________|      |________

     most contacts even                most contacts steps

References
----------
D. Tóvári and N. Pfeifer, "Segmentation based robust interpolation: a new approach to laser data
filtering", International Archives of Photogrammetry and Remote Sensing 36 3/W19 (2005): all points
of a segment are judged together. J. Zhang and X. Lin, "Filtering airborne LiDAR data by embedding
smoothness-constrained segmentation in progressive TIN densification", ISPRS Journal 81 (2013),
doi:10.1016/j.isprsjprs.2013.04.001: segments that smoothness joins to the ground are added to the
TIN. They segment all points in space by normals; here neighbours are those of a TIN of the lowest
points, and a segment is judged by its contacts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin import triangulate
from ..surface import join_components

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from .parameters import Parameters

_SHARE = 0.4
"""Of a segment's contacts that are not steps down: the edge of a terrace has more, a roof less."""

_FEWEST = 2
"""Even contacts of a segment: one may be a bush."""


class Links(NamedTuple):
    """Pairs of neighbouring points, each once."""

    one: Int64Array
    other: Int64Array
    """Both (n,)."""
    rise: Float64Array
    """(n,), from one point to the other, metres."""
    is_even: BoolArray
    """(n,), whether the points differ by no more than noise and the terrain's slope allow."""


def link(points: Float64Array, ring: Float64Array, parameters: Parameters) -> Links:
    """Link points that are neighbours in their TIN, and no further apart than the edge length.

    Points are (n, 3), at different places, in metres; those of the ring around them, (k, 3) and not
    all in line, are linked with none.
    """
    one, other = triangulate(np.concatenate([points, ring])).edges.T
    is_inner = np.maximum(one, other) < len(points)
    one, other = (end[is_inner].astype(np.int64) for end in (one, other))
    east, north, rise = (axis[other] - axis[one] for axis in np.ascontiguousarray(points.T))
    length = np.hypot(east, north)
    is_even = np.abs(rise) <= parameters.tolerance / 2 + parameters.terrain_slope * length
    is_near = length <= parameters.edge_length
    return Links(one[is_near], other[is_near], rise[is_near], is_even[is_near])


def list_continuing(links: Links, is_ground: BoolArray) -> BoolArray:
    """Tell which points that are not ground belong to segments that continue it.

    Of the links between such a segment and the ground enough are even, or lead up to the ground.
    """
    one, other, rise, is_even = links
    is_inner = is_even & ~is_ground[one] & ~is_ground[other]
    segment = join_components(len(is_ground), one[is_inner], other[is_inner])
    is_contact = is_ground[one] != is_ground[other]
    starts_on_ground = is_ground[one[is_contact]]
    own = segment[np.where(starts_on_ground, other[is_contact], one[is_contact])]
    is_even = is_even[is_contact]
    leads_down = ~is_even & ((rise[is_contact] > 0) == starts_on_ground)
    total, even, down = (
        np.bincount(own[which], minlength=len(is_ground))
        for which in (slice(None), is_even, leads_down)
    )
    continues = (even >= _FEWEST) & (total - down >= _SHARE * total)
    found: BoolArray = continues[segment] & ~is_ground
    return found
