"""Walls: breaklines along one line with two elevations, put a stated distance apart."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_length
from ...base.crs import require_lengths
from ...base.errors import LinesError, OptionError, PointsError
from ...base.sentences import coordinate, counted
from .. import _kernel

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ..constraints import LineSet
    from .inputs import BuildInputs

    Measure = Callable[[Float64Array, Float64Array], Float64Array]

_LEAST = 1024.0
"""Roundings of coordinates: a smaller distance is not one that can be stated."""
_MARGIN = 8.0
"""Roundings by which the lower line is moved farther, so that none makes it nearer."""
_BESIDE = 0.05
"""Of a segment: so far beside it the elevations of the ground are compared."""
_SHARES = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
"""Places on a segment at which they are."""
_CLEAR = 0.75
"""Of the length of a wall: along so much of it one side must be the lower one."""
_SHARPEST = 0.05
"""1 plus the cosine of a turn, at least: sharper ones turn back."""
_BLOCK = 256
_SHOWN = 3


class _Wall(NamedTuple):
    """Breaklines along one line."""

    upper: int
    """The line that stays."""
    lower: tuple[int, ...]
    """Those that are moved."""
    path: Float64Array
    """(k, 2), in the direction of the upper one."""
    is_high: BoolArray
    """(k,), where elevations differ."""

    @property
    def is_closed(self) -> bool:
        """Whether it ends where it begins."""
        return bool((self.path[0] == self.path[-1]).all())


def separate_walls(inputs: BuildInputs, walls: Any, measure: Measure) -> BuildInputs:
    """Return inputs in which the lower of two breaklines along one line is moved aside.

    ``walls`` is by how much, CRS units; ``measure`` returns the elevations of the surface of points
    at places, NaN off it. The upper line stays where it is, and the lower one lies on the side
    where the ground is lower: so that no stored vertex of it is nearer, in the plane, than that.

    Raises
    ------
    OptionError
        If the distance is no length, within rounding, or not above that of ``snap``.
    CrsError
        If coordinates are angles.
    LinesError
        If three elevations are along one line, two cross each other, the ground does not tell on
        which side it is lower, or a wall turns too sharply for the distance.
    """
    distance = as_length("walls", walls)
    require_lengths(inputs.crs)
    lines = inputs.lines
    size = max(float(np.abs(one).max(initial=0.0)) for one in (lines.xy, inputs.points[:, :2]))
    rounding = float(np.spacing(size))
    if distance < _LEAST * rounding:
        allowed = f"at least {_LEAST * rounding:.2g}, below which coordinates are rounded"
        raise OptionError("walls", distance, allowed)
    if distance <= inputs.options.snap:
        allowed = f"above {inputs.options.snap:g}, the distance of `snap`"
        raise OptionError("walls", distance, allowed)
    found = _find_walls(lines)
    if not found:
        note = "There are no walls: no two breaklines run along one line with two elevations."
        return replace(inputs, notes=(*inputs.notes, note))
    sides = _find_sides(found, inputs, distance, measure)
    xy = lines.xy.copy()
    told, within = [], 0
    for wall, (side, share) in zip(found, sides, strict=True):
        moved = _move(wall, lines, -side * (distance + _MARGIN * rounding), distance)
        by_place = dict(zip(map(tuple, wall.path.tolist()), moved, strict=True))
        for line in wall.lower:
            rows = slice(int(lines.offsets[line]), int(lines.offsets[line + 1]))
            xy[rows] = [by_place[place] for place in map(tuple, lines.xy[rows].tolist())]
        told.append(_describe(wall, lines, side, share))
        within += _count_within(wall.path, moved, inputs)
    names = "; ".join(told[:_SHOWN])
    more = f"; and {len(told) - _SHOWN} more" if len(told) > _SHOWN else ""
    note = (
        f"{counted(len(told), 'wall')}: of breaklines along one line the lower one was moved by "
        f"{distance:g} CRS units to the side where the ground is lower ({names}{more})."
    )
    notes = [note]
    if within:
        notes.append(
            f"{counted(within, 'point')} within that distance of the upper line of a wall "
            f"{'is' if within == 1 else 'are'} between both lines, and shape its face."
        )
    return replace(inputs, lines=lines._replace(xy=xy), notes=(*inputs.notes, *notes))


def _find_walls(lines: LineSet) -> list[_Wall]:
    """Return what runs along one line with two elevations, in the order of the lines."""
    groups: dict[bytes, list[tuple[int, Float64Array]]] = {}
    for line, kind in enumerate(lines.kinds):
        rows = slice(int(lines.offsets[line]), int(lines.offsets[line + 1]))
        if kind in ("hard", "soft") and not np.isnan(lines.elevations[rows]).any():
            path = _turn(np.column_stack([lines.xy[rows], lines.elevations[rows]]))
            groups.setdefault(path[:, :2].tobytes(), []).append((line, path))
    walls = []
    for group in groups.values():
        heights = np.unique([path[:, 2] for _, path in group], axis=0)
        if len(heights) < 2:
            continue
        path = group[0][1][:, :2]
        if len(heights) > 2:
            raise LinesError(
                f"{len(heights)} breaklines with different elevations run along one line, "
                f"{_say_where(lines, group)}: a wall has two.",
                lines=[line for line, _ in group],
            )
        rise = heights[1] - heights[0]
        if rise.min() < 0.0 < rise.max():
            raise LinesError(
                f"The elevations of two breaklines along one line cross, {_say_where(lines, group)}"
                ": a wall has an upper and a lower one.",
                lines=[line for line, _ in group],
            )
        top = heights[int(rise.max() > 0.0)]
        upper = [line for line, one in group if (one[:, 2] == top).all()]
        lower = tuple(line for line, _ in group if line not in upper)
        rows = slice(int(lines.offsets[upper[0]]), int(lines.offsets[upper[0] + 1]))
        is_high = {tuple(place): bool(own) for place, own in zip(path.tolist(), rise, strict=True)}
        own = _leave_repeated(lines.xy[rows])
        walls.append(
            _Wall(upper[0], lower, own, np.array([is_high[p] for p in map(tuple, own.tolist())]))
        )
    return walls


def _turn(path: Float64Array) -> Float64Array:
    """Return a line in the direction, and a ring from the corner, that all along it have."""
    path = _leave_repeated(path)
    if (path[0, :2] == path[-1, :2]).all():
        first = int(np.lexsort(path[:-1, 1::-1].T)[0])
        path = np.concatenate([np.roll(path[:-1], -first, axis=0), path[first : first + 1]])
    turned = path[::-1]
    is_later = path[:, :2].tolist() > turned[:, :2].tolist()
    return np.ascontiguousarray(turned if is_later else path)


def _leave_repeated(path: Float64Array) -> Float64Array:
    """Return a line without vertices at the place of the one before."""
    is_new = np.append(True, (np.diff(path[:, :2], axis=0) != 0.0).any(axis=1))
    return np.asarray(path[is_new])


def _say_where(lines: LineSet, group: list[tuple[int, Float64Array]]) -> str:
    names = ", ".join(lines.label(line) for line, _ in group)
    x, y = group[0][1][0, :2].tolist()
    return f"{names}, from x {coordinate(x)}, y {coordinate(y)}"


def _find_sides(
    walls: list[_Wall], inputs: BuildInputs, distance: float, measure: Measure
) -> list[tuple[int, float]]:
    """Return on which side of each wall the ground is higher, 1 left, -1 right.

    And the share of its length along which it is. Raises LinesError if that cannot be told.
    """
    lines = inputs.lines
    taken = {line for wall in walls for line in (wall.upper, *wall.lower)}
    kept = np.array([line not in taken for line in range(len(lines.kinds))], np.bool_)
    others = lines.choose(kept & ~lines.is_draped)
    points = inputs.points if inputs.is_masked is None else inputs.points[~inputs.is_masked]
    ground = np.concatenate([points, np.column_stack([others.xy, others.elevations])])
    places, weights = [], []
    for wall in walls:
        start, way = wall.path[:-1], np.diff(wall.path, axis=0)
        length = np.hypot(*way.T)
        left = np.column_stack([-way[:, 1], way[:, 0]]) / length[:, None]
        beside = np.maximum(4.0 * distance, _BESIDE * length)[:, None, None] * left[:, None]
        at = start[:, None] + _SHARES[:, None] * way[:, None]
        places.append(np.stack([at + beside, at - beside]).reshape(2, -1, 2))
        weights.append(np.repeat(length, len(_SHARES)))
    try:
        found = measure(ground, np.concatenate(places, axis=1).reshape(-1, 2)).reshape(2, -1)
    except PointsError:  # too few
        found = np.full((2, sum(map(len, weights))), np.nan)
    rises = np.split(found[0] - found[1], np.cumsum(list(map(len, weights)))[:-1])
    sides = []
    for wall, rise, weight in zip(walls, rises, weights, strict=True):
        known = np.isfinite(rise)
        balance = float((rise * weight)[known].sum())
        side = 1 if balance > 0.0 else -1
        agrees = known & (rise * side > 0.0)
        share = float(weight[agrees].sum() / weight.sum())
        if share < _CLEAR:
            x, y = wall.path[0].tolist()
            raise LinesError(
                f"The points do not tell on which side of the wall along {lines.label(wall.upper)},"
                f" from x {coordinate(x)}, y {coordinate(y)}, the ground is lower: points beside "
                "it are needed.",
                lines=[wall.upper, *wall.lower],
            )
        sides.append((side, share))
    return sides


def _move(wall: _Wall, lines: LineSet, aside: float, least: float) -> Float64Array:
    """Return the places of the lower line, to the left by a distance.

    Raises LinesError if a place is nearer to the upper one than ``least``.
    """
    path = wall.path
    way = np.diff(path, axis=0)
    way /= np.hypot(*way.T)[:, None]
    left = np.column_stack([-way[:, 1], way[:, 0]])
    before, after = np.vstack([left[:1], left]), np.vstack([left, left[-1:]])
    if wall.is_closed:
        before[0], after[-1] = left[-1], left[0]
    spread = 1.0 + (before * after).sum(axis=1)
    is_sharp = spread < _SHARPEST
    _, first, count = np.unique(
        path[: len(path) - wall.is_closed], axis=0, return_index=True, return_counts=True
    )
    is_sharp[first[count > 1]] = True
    if not is_sharp.any():
        shift = (before + after) / spread[:, None] * aside
        moved = np.where(wall.is_high[:, None], path + shift, path)
        goes_on = (np.diff(moved, axis=0) * way).sum(axis=1) > 0.0
        near = _measure_nearest(moved[wall.is_high], path) < least
        is_sharp[wall.is_high] = near
        is_sharp[:-1] |= ~goes_on
        if not is_sharp.any() and not _crosses(wall, moved):
            return moved
    x, y = path[int(is_sharp.argmax())].tolist()
    raise LinesError(
        f"The wall along {lines.label(wall.upper)} turns too sharply, or touches itself, near "
        f"x {coordinate(x)}, y {coordinate(y)} for lines that are {least:g} apart.",
        lines=[wall.upper, *wall.lower],
    )


def _measure_nearest(places: Float64Array, path: Float64Array) -> Float64Array:
    """Return the distances of places from a line."""
    start, way = path[:-1], np.diff(path, axis=0)
    square = (way * way).sum(axis=1)
    found = np.empty(len(places))
    for k in range(0, len(places), _BLOCK):
        away = places[k : k + _BLOCK, None] - start
        share = np.clip((away * way).sum(axis=2) / square, 0.0, 1.0)
        off = away - share[:, :, None] * way
        found[k : k + _BLOCK] = np.hypot(off[:, :, 0], off[:, :, 1]).min(axis=1)
    return found


def _crosses(wall: _Wall, moved: Float64Array) -> bool:
    """Whether the lower line crosses itself or the upper one, between their vertices."""
    places, number = np.unique(np.concatenate([wall.path, moved]), axis=0, return_inverse=True)
    number = number.reshape(2, -1).astype(np.int32)
    segments = np.stack([number[:, :-1], number[:, 1:]], axis=-1).reshape(-1, 2)
    segments = np.unique(np.sort(segments, axis=1), axis=0)
    xy = np.ascontiguousarray(places)
    return len(_kernel.crossings(xy, np.ascontiguousarray(segments))) > 0


def _describe(wall: _Wall, lines: LineSet, side: int, share: float) -> str:
    names = " and ".join(lines.label(line) for line in wall.lower)
    how = "" if share > 0.995 else f", where it is so along {share:.0%} of it"
    where = "right" if side > 0 else "left"
    return f"{names} lies to the {where} of {lines.label(wall.upper)}{how}"


def _count_within(path: Float64Array, moved: Float64Array, inputs: BuildInputs) -> int:
    """Return how many points lie strictly between both lines."""
    points = inputs.points[:, :2]
    order = np.argsort(points[:, 0], kind="stable")
    sorted_x = points[order, 0]
    inside: set[int] = set()
    for k in range(len(path) - 1):
        corners = np.array([path[k], path[k + 1], moved[k + 1], moved[k]])
        low, high = corners.min(axis=0), corners.max(axis=0)
        near: Int64Array = order[slice(*np.searchsorted(sorted_x, [low[0], high[0]]))]
        near = near[(points[near, 1] > low[1]) & (points[near, 1] < high[1])]
        side = np.roll(corners, -1, axis=0) - corners
        away = points[near, None] - corners
        turn = side[:, 0] * away[:, :, 1] - side[:, 1] * away[:, :, 0]
        inside.update(near[(turn > 0.0).all(axis=1) | (turn < 0.0).all(axis=1)].tolist())
    return len(inside)
