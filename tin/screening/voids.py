"""Voids that are filled with an elevation that stands for none: plateaus with a cliff around."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .nodata import CUSTOMARY
from .parts import find_parts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ..triangulation import Triangulation

_MOST_SHARE = 0.5
"""Of the vertices: where more have the elevation it is that of the ground."""
_FEWEST = 4
"""So many points at least are a plateau; fewer are judged one by one."""
_CLIFF = 5.0
"""Around a void the surface falls by so many times the relief of a steep triangle elsewhere."""
_STEEP = 95.0
"""Percentile of the relief of triangles."""
_OPEN = 2.0
"""Per cent of the edges around a void that may be lower than a cliff."""
_SAMPLE = 20_000


class Void(NamedTuple):
    """Points of one elevation that lie together, and the ground around them."""

    vertices: Int32Array
    """(k,), ascending."""
    value: float
    lowest: float
    highest: float
    """Elevations of the points around."""


def find_voids(surface: Triangulation) -> list[Void]:
    """Find plateaus of an elevation that programs write for none, with a cliff all around.

    A lake or the sea at the same elevation is none, for its shores come near the water in places:
    all but 2 % of the edges around a void rise, or fall, by more than five times what 95 % of the
    other triangles do. Neither is ground that more than half of the points share. Linear in the
    triangles.
    """
    found: list[Void] = []
    z = surface.points[:, 2]
    lowest, highest = z.min(initial=np.inf), z.max(initial=-np.inf)
    for value in (one for one in CUSTOMARY if lowest <= one <= highest):
        is_in = z == value
        if _FEWEST <= is_in.sum() <= _MOST_SHARE * len(is_in):
            found += _find_plateaus(surface, is_in, value)
    return found


def _find_plateaus(surface: Triangulation, is_in: BoolArray, value: float) -> Iterator[Void]:
    first, second, third = (is_in[corner] for corner in surface.triangles.T)
    is_inside, touches = first & second & third, first | second | third
    outside = np.flatnonzero(~touches)
    if len(outside) == 0 or not is_inside.any():
        return
    # the difference of elevations within a steep one of some triangles
    some = outside[:: max(1, len(outside) // _SAMPLE)]
    z = surface.points[surface.triangles[some], 2]
    cliff = _CLIFF * float(np.percentile(np.ptp(z, axis=1), _STEEP))
    of_vertex = _number_plateaus(surface, is_inside)
    around = surface.triangles[touches & ~is_inside]
    owners, rises = _list_rises(around, of_vertex, surface.points[:, 2] - value)
    members = np.argsort(of_vertex, kind="stable")[np.count_nonzero(of_vertex < 0) :]
    vertices = np.split(members, np.flatnonzero(np.diff(of_vertex[members])) + 1)
    parts = np.split(rises, np.searchsorted(owners, np.arange(1, len(vertices))))
    for own, rise in zip(vertices, parts, strict=True):
        if len(own) >= _FEWEST and len(rise) and 0 < cliff < _measure_cliff(rise):
            low, high = float(rise.min()) + value, float(rise.max()) + value
            yield Void(own.astype(np.int32), value, low, high)


def _number_plateaus(surface: Triangulation, is_inside: BoolArray) -> Int64Array:
    """Return for each vertex the connected part of some triangles that it is of, -1 for none."""
    inside = np.flatnonzero(is_inside)
    numbers = np.full(len(surface.points), -1, np.int64)
    parts = find_parts(surface, inside)
    numbers[surface.triangles[inside]] = parts[:, None]  # of several that meet, one has the vertex
    return np.where(
        numbers < 0, -1, np.unique(numbers, return_inverse=True)[1] - (numbers < 0).any()
    )


def _list_rises(
    around: Int32Array, of_vertex: Int64Array, rises: Float64Array
) -> tuple[Int64Array, Float64Array]:
    """Return plateau and rise of all edges that leave one, sorted by plateau and rise."""
    starts, ends = np.concatenate([around[:, [k, (k + 1) % 3]] for k in range(3)]).T
    starts, ends = np.concatenate([starts, ends]), np.concatenate([ends, starts])
    leaves = (of_vertex[starts] >= 0) & (rises[ends] != 0.0)
    owners, found = of_vertex[starts[leaves]], rises[ends[leaves]]
    order = np.lexsort((found, owners))
    return owners[order], found[order]


def _measure_cliff(rises: Float64Array) -> float:
    """Return how far almost all of some rises, ascending, are at least; 0 on both sides."""
    few = int(_OPEN / 100.0 * len(rises))
    return max(float(rises[few]), -float(rises[len(rises) - 1 - few]))
