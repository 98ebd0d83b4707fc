"""Points put around all others, so that each of them lies within a triangle of seeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from .frame import Frame

    Doubles = Float64Array

_STEP = 5.0
"""Between neighbouring points, metres."""

_DEPTH = 15.0
"""How far seeds may lie behind the first one of their stretch to say how steep it is there."""

_FEWEST = 6
_FLATTEST = 1e-3
"""Share of the largest spread of seeds that the least must have for a plane through them."""


class _Side(NamedTuple):
    """A side of the rectangle, seen from within: places along it, and how far it is away."""

    axis: int
    edge: float
    places: Doubles
    start: float
    """Of the places along the side of all points, of which these are the ones from ``first`` on."""
    step: float
    first: int = 0


def surround(frame: Frame, seeds: Doubles) -> Doubles:
    """Return points around a frame, on planes through the seeds that are nearest to them.

    All are (n, 3), in metres. They are as far away from the outermost points as a cell is wide.
    """
    sides = [side for axis in (0, 1) for side in _list_sides(frame, axis)]
    ring = np.concatenate([_raise_side(side, seeds) for side in sides if len(side.places)])
    _, first = np.unique(ring[:, :2], axis=0, return_index=True)
    return ring[first]


def _list_sides(frame: Frame, axis: int) -> Iterator[_Side]:
    """Yield the two sides at which a coordinate is constant.

    At the rim of all points places are those that all points have; at other sides, which lie far
    from what is looked for, they begin at the corner.
    """
    along, margin = 1 - axis, frame.side
    low, high = frame.corners
    low, high = low - margin, high + margin
    whole, whole_step = _divide(-margin, frame.size[along] + margin)
    first, end = np.searchsorted(whole, [low[along], high[along]], side="left").tolist()
    own, step = _divide(float(low[along]), float(high[along]))
    for edge, is_rim in zip((low, high), frame.ends_at_rim, strict=True):
        if is_rim[axis]:
            yield _Side(axis, float(edge[axis]), whole[first : end + 1], -margin, whole_step, first)
        else:
            yield _Side(axis, float(edge[axis]), own, float(low[along]), step)


def _divide(low: float, high: float) -> tuple[Doubles, float]:
    """Return places from one end to the other, and the step between them."""
    count = max(2, int(np.ceil((high - low) / _STEP)) + 1)
    places = np.linspace(low, high, count)
    return places, float(places[1] - places[0])


def _raise_side(side: _Side, seeds: Doubles) -> Doubles:
    """Return the points of a side with their elevations."""
    count, along = len(side.places), 1 - side.axis
    stretch = np.rint((seeds[:, along] - side.start) / side.step).astype(np.int64) - side.first
    stretch = np.clip(stretch, 0, count - 1)
    away = np.abs(seeds[:, side.axis] - side.edge)
    nearest = _find_nearest(stretch, away, seeds, count)
    elevations = seeds[nearest, 2]
    rise, is_sound = _extrapolate(side, seeds, stretch, away, nearest)
    made = np.empty((count, 3))
    made[:, side.axis], made[:, along] = side.edge, side.places
    made[:, 2] = np.where(is_sound, rise, elevations)
    return made


def _find_nearest(stretch: Int64Array, away: Doubles, seeds: Doubles, count: int) -> Int64Array:
    """Return the seed nearest to the side in each stretch of it, or in the nearest that has one."""
    least = np.full(count, np.inf)
    np.minimum.at(least, stretch, away)
    rows = np.flatnonzero(away == least[stretch])
    order = rows[np.lexsort((seeds[rows, 1], seeds[rows, 0], seeds[rows, 2], stretch[rows]))]
    there, first = np.unique(stretch[order], return_index=True)
    wanted = np.arange(count)
    after = np.clip(np.searchsorted(there, wanted), 0, len(there) - 1)
    before = np.maximum(after - 1, 0)
    is_before = np.abs(there[before] - wanted) < np.abs(there[after] - wanted)
    return order[first[np.where(is_before, before, after)]]


def _extrapolate(
    side: _Side,
    seeds: Doubles,
    stretch: Int64Array,
    away: Doubles,
    nearest: Int64Array,
) -> tuple[Doubles, BoolArray]:
    """Return elevations of the planes of least squares at the points of a side, and which have one.

    Each plane is that of the seeds of three stretches behind the nearest seed.
    """
    limit = away[nearest] + _DEPTH
    widest = np.pad(limit, 1, mode="edge")
    widest = np.maximum(np.maximum(widest[:-2], widest[2:]), limit)
    rows = np.flatnonzero(away <= widest[stretch])
    x, y, z = seeds[rows].T
    order = rows[np.lexsort((y, x, z))]  # sums do not depend on the order of the input
    sums = np.zeros((len(side.places), 3, 4))
    for shift in (-1, 0, 1):
        own = stretch[order] + shift
        is_near = (own >= 0) & (own < len(limit))
        is_near[is_near] = away[order[is_near]] <= limit[own[is_near]]
        rows, own = order[is_near], own[is_near]
        lateral = (seeds[rows, 1 - side.axis] - side.places[own]) / _DEPTH
        height = seeds[rows, 2] - seeds[nearest[own], 2]
        sums += _sum_products(own, [np.ones(len(rows)), lateral, away[rows] / _DEPTH, height], sums)
    heights, is_sound = _solve_planes(sums[:, :, :3], sums[:, :, 3])
    return seeds[nearest, 2] + heights, is_sound


def _sum_products(own: Int64Array, terms: list[Doubles], like: Doubles) -> Doubles:
    """Return the sums of the products of terms for each point of a side."""
    sums = np.empty_like(like)
    for i, j in np.ndindex(like.shape[1:]):
        sums[:, i, j] = np.bincount(own, terms[i] * terms[j], len(like))
    return sums


def _solve_planes(matrix: Doubles, right: Doubles) -> tuple[Doubles, BoolArray]:
    """Return the planes' heights at the points of a side, and which are told by enough seeds."""
    spread = np.linalg.eigvalsh(matrix)
    is_sound = (matrix[:, 0, 0] >= _FEWEST) & (spread[:, 0] > _FLATTEST * spread[:, 2])
    matrix[~is_sound] = np.eye(3)
    heights = np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, 0, 0], np.float64)
    return heights, is_sound
