"""The nearest places of an alignment: pieces that may hold one, then perpendiculars on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from .elements import measure_elements

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from .elements import Element

_BLOCK = 20_000
_STEPS = 60


class Pieces(NamedTuple):
    """Short pieces of an alignment, in order."""

    elements: Int64Array
    """(m,)."""
    begins: Float64Array
    ends: Float64Array
    """(m,), distances from the start of their element."""
    places: Float64Array
    """(m, 2, 2), of both ends."""
    bulge: float
    """How far one may lie from its chord, at most."""


class Feet(NamedTuple):
    """Nearest places of points."""

    elements: Int64Array
    distances: Float64Array
    """(n,), from the start of the element."""
    offsets: Float64Array
    """(n,), positive where the point lies in the direction from the first axis to the second."""
    is_beyond: BoolArray
    """Whether a point lies before the start or beyond the end of all."""
    is_twofold: BoolArray
    """Whether another place is as near."""


def cut_pieces(elements: Sequence[Element]) -> Pieces:
    """Cut elements into pieces that turn little."""
    owners, begins, ends, places, bulge = [], [], [], [], 0.0
    for k, element in enumerate(elements):
        at = element.cut()
        along = element.places(at)
        owners.append(np.full(len(at) - 1, k))
        begins.append(at[:-1])
        ends.append(at[1:])
        places.append(np.stack([along[:-1], along[1:]], axis=1))
        # A curve of length s and turn t lies within s t / 4 of its chord.
        step = float(np.diff(at).max())
        bulge = max(bulge, 0.25 * step * step * element.largest_curvature)
    joined = [np.concatenate(one) for one in (owners, begins, ends, places)]
    return Pieces(joined[0], joined[1], joined[2], joined[3], bulge)


def find_nearest(elements: Sequence[Element], pieces: Pieces, points: Float64Array) -> Feet:
    """Return the nearest place of each point, of equally near ones the first."""
    shapely = optional.load("shapely")  # which takes time to load
    tree = shapely.STRtree(shapely.linestrings(pieces.places))
    parts = [
        _find_block(elements, pieces, tree, points[k : k + _BLOCK])
        for k in range(0, len(points), _BLOCK)
    ]
    return Feet(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _find_block(
    elements: Sequence[Element], pieces: Pieces, tree: Any, points: Float64Array
) -> Feet:
    shapes = optional.load("shapely").points(points)
    _, nearest = tree.query_nearest(shapes, all_matches=False, return_distance=True)
    reach = (nearest + 2.0 * pieces.bulge) * (1.0 + 1e-9) + np.spacing(np.abs(points).max())
    point, piece = tree.query(shapes, predicate="dwithin", distance=reach)
    order = np.lexsort([piece, point])
    point, piece = point[order], piece[order]
    at = _drop_perpendiculars(elements, pieces, piece, points[point])
    foot, tangent = measure_elements(elements, pieces.elements[piece], at)
    away = points[point] - foot
    distance = np.hypot(away[:, 0], away[:, 1])
    first = np.flatnonzero(np.append(True, np.diff(point) > 0))
    least = np.minimum.reduceat(distance, first)
    near = 1e-12 * np.abs(points[point]).max(axis=1) + 1e-12 * distance
    is_least = distance <= np.repeat(least, np.diff(np.append(first, len(point)))) + near
    chosen = np.flatnonzero(is_least)
    chosen = chosen[np.append(True, np.diff(point[chosen]) > 0)]
    last = np.flatnonzero(is_least)
    last = last[np.append(np.diff(point[last]) > 0, True)]
    apart = np.hypot(*(foot[last] - foot[chosen]).T)
    # At a kink both tangents count: their mean tells the side.
    side = tangent[chosen] + tangent[last] * (apart <= near[chosen])[:, None]
    across = side[:, 0] * away[chosen, 1] - side[:, 1] * away[chosen, 0]
    along = (tangent[chosen] * away[chosen]).sum(axis=1)
    return Feet(
        pieces.elements[piece[chosen]],
        at[chosen],
        np.copysign(distance[chosen], across),
        _lie_beyond(pieces, piece[chosen], at[chosen], along),
        apart > 1e3 * near[chosen],
    )


def _lie_beyond(
    pieces: Pieces, piece: Int64Array, at: Float64Array, along: Float64Array
) -> BoolArray:
    """Whether points lie before the first end, or beyond the last one; ``along`` is how far."""
    rounding = 1e-12 * (np.abs(pieces.places).max() + np.abs(along).max())
    before = (piece == 0) & (at <= pieces.begins[0]) & (along < -rounding)
    last = len(pieces.ends) - 1
    beyond: BoolArray = before | ((piece == last) & (at >= pieces.ends[last]) & (along > rounding))
    return beyond


def _drop_perpendiculars(
    elements: Sequence[Element], pieces: Pieces, piece: Int64Array, points: Float64Array
) -> Float64Array:
    """Return the distance along its element at which each piece is nearest to a point.

    Newton's steps for (P - C(s)) . T(s) = 0, halved where they leave the bracket.
    """
    owner = pieces.elements[piece]
    low, high = pieces.begins[piece].copy(), pieces.ends[piece].copy()
    rising = [_ask(elements, owner, at, points) for at in (low, high)]
    is_inside = (rising[0] > 0.0) & (rising[1] < 0.0)
    ends = np.stack([measure_elements(elements, owner, at)[0] for at in (low, high)])
    away = np.hypot(*np.moveaxis(points - ends, -1, 0))
    at = np.where(away[0] <= away[1], low, high)
    open_ = np.flatnonzero(is_inside)
    rounding = 4.0 * np.spacing(np.maximum(high, np.abs(points).max(axis=1, initial=0.0)))
    at[open_] = _guess(pieces, piece[open_], points[open_])
    for _ in range(_STEPS):
        if not len(open_):
            break
        now, where = at[open_], owner[open_]
        foot, tangent = measure_elements(elements, where, now)
        offset = points[open_] - foot
        value = (offset * tangent).sum(axis=1)
        low[open_] = np.where(value > 0.0, now, low[open_])
        high[open_] = np.where(value > 0.0, high[open_], now)
        bent = _curve(elements, where, now)
        rate = 1.0 - bent * (tangent[:, 0] * offset[:, 1] - tangent[:, 1] * offset[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = now + value / rate
        is_out = ~((step >= low[open_]) & (step <= high[open_]))
        at[open_] = np.where(is_out, 0.5 * (low[open_] + high[open_]), step)
        is_moving = np.abs(at[open_] - now) > rounding[open_]
        open_ = open_[is_moving]
    return at


def _guess(pieces: Pieces, piece: Int64Array, points: Float64Array) -> Float64Array:
    """Return where perpendiculars on the chords meet them."""
    start, stop = pieces.places[piece, 0], pieces.places[piece, 1]
    chord = stop - start
    share = ((points - start) * chord).sum(axis=1) / (chord * chord).sum(axis=1)
    begin, end = pieces.begins[piece], pieces.ends[piece]
    guess: Float64Array = begin + np.clip(share, 0.0, 1.0) * (end - begin)
    return guess


def _ask(
    elements: Sequence[Element], owner: Int64Array, at: Float64Array, points: Float64Array
) -> Float64Array:
    foot, tangent = measure_elements(elements, owner, at)
    along: Float64Array = ((points - foot) * tangent).sum(axis=1)
    return along


def _curve(elements: Sequence[Element], owner: Int64Array, at: Float64Array) -> Float64Array:
    found = np.empty(len(at))
    for k in np.unique(owner).tolist():
        own = owner == k
        found[own] = elements[k].curvatures(at[own])
    return found
