"""Strips: triangles cut along the fall lines that pass through vertices.

All water of a strip leaves it across one edge, and enters one strip of the next triangle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import PointsError
from .. import _kernel
from .descent import MOVING, Drops, make_drops

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from .descent import Walker

SAME = 1e-12
"""Fall lines whose shares of the base differ by no more are one."""
_MOST_CUTS = 100_000_000


class Strips(NamedTuple):
    """Parts of triangles between neighbouring cuts, by triangle and share of the base."""

    offsets: Int64Array
    """(m + 1,), triangle t has strips ``offsets[t]`` to ``offsets[t + 1]``, a level one none."""
    starts: Float64Array
    """(s,), shares of the base; each ends where the next of the triangle starts, the last at 1."""

    def find_triangles(self, strips: Int64Array) -> Int64Array:
        """Return the triangles that strips are part of."""
        return self.offsets.searchsorted(strips, "right") - 1


def cut_strips(surface: _kernel.FallingSurface) -> Strips:
    """Cut triangles along the fall lines that come down to vertices.

    Raises PointsError if there are too many cuts.

    Notes
    -----
    A triangle whose water leaves across two edges is parted by the fall line through the vertex
    between them. That line is followed upwards, triangle by triangle, to where nothing comes from
    above, or a vertex, which has such lines of its own.
    """
    try:
        return Strips(*surface.cut_strips(_MOST_CUTS))
    except OverflowError:
        raise PointsError(
            f"The fall lines of this surface cross more than {_MOST_CUTS:,} triangles: "
            "simplify it first, or clip it."
        ) from None


def follow(
    bases: _kernel.Bases, edges: Int64Array, shares: Float64Array
) -> tuple[Int64Array, Float64Array]:
    """Return where the fall line through a place on an edge meets the base, or from it the side."""
    base, split = bases.edges, bases.splits
    on_base, before = edges == base, shares < split
    with np.errstate(divide="ignore", invalid="ignore"):
        from_base = np.where(before, 1.0 - shares / split, (1.0 - shares) / (1.0 - split))
    first = edges == (base + 2) % 3
    to_base = np.where(first, split * (1.0 - shares), 1.0 - shares * (1.0 - split))
    side = np.where(before, (base + 2) % 3, (base + 1) % 3)
    found = np.clip(np.where(on_base, np.nan_to_num(from_base), to_base), 0.0, 1.0)
    return np.where(on_base, side, base), found


def leave_strips(
    walker: Walker, surface: _kernel.FallingSurface, strips: Strips, rows: Int64Array
) -> Drops:
    """Return drops where the water from the middle of some strips leaves its triangle."""
    triangles = strips.find_triangles(rows)
    is_last = rows + 1 == strips.offsets[triangles + 1]
    following = np.minimum(rows + 1, len(strips.starts) - 1)
    ends = np.where(is_last, 1.0, strips.starts[following])
    shares = (strips.starts[rows] + ends) / 2
    bases = surface.bases_of(triangles)
    sides, at_side = follow(bases, bases.edges, shares)
    edges = np.where(bases.drains, bases.edges, sides)
    return walker.arrive(triangles, edges, np.where(bases.drains, shares, at_side))


def settle(walker: Walker, drops: Drops) -> tuple[Drops, Int64Array]:
    """Follow drops until each has come to a vertex or to an edge that is a channel, or has ended.

    Returns them, and the upper end of the edge along which each has left a vertex, -1 for others.
    """
    found = make_drops(len(drops.vertices))
    upper = np.full(len(drops.vertices), -1)
    rows = np.arange(len(drops.vertices))
    while len(rows):
        moved = walker.step(drops)
        left = (drops.vertices >= 0) & (moved.vertices >= 0) & (moved.ends == MOVING)
        upper[rows[left]] = drops.vertices[left]
        on = (moved.vertices < 0) & (moved.targets < 0) & (moved.ends == MOVING)
        found.put(rows[~on], moved.choose(np.flatnonzero(~on)))
        rows, drops = rows[on], moved.choose(np.flatnonzero(on))
    return found, upper
