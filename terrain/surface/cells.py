"""The overlay of two surfaces as triangles that are sound after rounding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...tin.predicates import columns, orientation
from .. import _kernel
from .reference import Surface

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array, Int32Array, Int64Array


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """The parts of a surface's triangles in some groups."""

    surface: Surface
    groups: Int32Array
    """(m,)."""


def fan_out(offsets: Int64Array, corners: Int32Array) -> tuple[Int32Array, Int64Array]:
    """Cut convex cells into triangles from their first corners.

    Returns the triangles, (m, 3), and the cell of each, (m,).
    """
    counts = np.diff(offsets) - 2
    cells = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(cells)) - np.repeat(np.cumsum(counts) - counts, counts)
    apex = offsets[cells]
    second = apex + within + 1
    return np.stack([corners[apex], corners[second], corners[second + 1]], axis=1), cells


def turns(points: Float64Array, triangles: Int32Array) -> AnyArray:
    """Return +1 for counter-clockwise triangles, -1 for clockwise, 0 for none; exactly."""
    xy = columns(points)
    return orientation(xy, *(triangles[:, k] for k in range(3)))


def cut_pieces(surface: Surface, regions: Pieces) -> Pieces:
    """Cut a surface along the edges of regions; what is in none of them is left out.

    The regions' triangles have the elevation 0.
    """
    made = _kernel.overlay(
        surface.points, surface.triangles, regions.surface.points, regions.surface.triangles
    )
    points = made.vertices.copy()
    points[:, 2] = 0.0 - points[:, 2]  # 0 above the surface is minus its elevation
    own = made.origins[:, 0] >= 0
    points[own, 2] = surface.points[made.origins[own, 0], 2]
    triangles, cells = fan_out(made.offsets, made.corners)
    # Rounding turns over what is thinner than coordinates can tell, which has no area to speak of.
    sound = turns(points, triangles) > 0
    groups = regions.groups[made.triangles[cells[sound], 1]]
    return Pieces(Surface(points, np.ascontiguousarray(triangles[sound])), groups)
