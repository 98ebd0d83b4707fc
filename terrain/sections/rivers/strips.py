"""Strips: what lies between two cross sections, as lines along the channel."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import LinesError, OptionError
from ....base.sentences import coordinate
from .channels import measure_channel

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array
    from .channels import Channel, CrossSection

MOST_VERTICES = 20_000_000
"""So many vertices are made; more are a slip of the spacing."""

_NEAR = 1e-6
"""Normalised offsets that are nearer are one line along the channel."""


class Strip(NamedTuple):
    """Lines along the channel from one section to the next."""

    first: Float64Array
    last: Float64Array
    """Both (k,), normalised offsets at either section, from left to right."""
    places: Float64Array
    """(k, n, 3), on each line from one section to the other."""
    names: list[str]
    """(k,), of each line: that of the bank or thalweg which it follows, else "string"."""


def make_strips(channel: Channel, spacing: float) -> list[Strip]:
    """Return what lies between sections, in steps no longer than a spacing.

    Raises OptionError if there would be too many vertices; LinesError if lines across fold.
    """
    pairs = list(pairwise(channel.sections))
    steps = [int(np.ceil(round((b.station - a.station) / spacing, 9))) for a, b in pairs]
    count = sum(n * (len(a.points) + len(b.points)) for n, (a, b) in zip(steps, pairs, strict=True))
    if count > MOST_VERTICES:
        least = spacing * count / MOST_VERTICES
        allowed = f"{least:.3g} or more here, where at most {MOST_VERTICES:,} vertices are made"
        raise OptionError("spacing", spacing, allowed)
    placing = _settle(channel)
    return [_fill(channel, k, max(n, 1), placing[k]) for k, n in enumerate(steps)]


def _settle(channel: Channel) -> list[tuple[Float64Array, Float64Array]]:
    """Return the offsets at both ends of the lines of each strip.

    At every point of either section a line begins, and it ends at the same offset of the other one:
    at its point if that is as near as can be told apart.
    """
    own = [_join(one.offsets, one) for one in channel.sections]
    pairs = [_match(a, b) for a, b in pairwise(own)]
    # of all lines that meet a section those as good as at one place meet there
    for k, points in enumerate(own):
        ends = [pairs[k - 1][1]] if k > 0 else []
        ends += [pairs[k][0]] if k < len(pairs) else []
        every = np.unique(np.concatenate([points, *ends]))
        joined = _cluster(every, points)
        if k > 0:
            pairs[k - 1] = (pairs[k - 1][0], joined[np.searchsorted(every, pairs[k - 1][1])])
        if k < len(pairs):
            pairs[k] = (joined[np.searchsorted(every, pairs[k][0])], pairs[k][1])
    return pairs


def _join(offsets: Float64Array, section: CrossSection) -> Float64Array:
    """Return the offsets of a section's points and of the lines along the channel."""
    nodes = np.arange(len(section.nodes), dtype=float)
    apart = np.abs(nodes[:, None] - offsets).min(axis=1)
    return np.unique(np.concatenate([offsets, nodes[apart > _NEAR]]))


def _match(first: Float64Array, last: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Return the offsets of lines at two sections, which begin at the points of both."""
    at = np.clip(np.searchsorted(last, first), 1, len(last) - 1)
    near = np.where(first - last[at - 1] < last[at] - first, at - 1, at)
    is_same = np.abs(last[near] - first) <= _NEAR
    partner = np.where(is_same, last[near], first)
    alone = last[~np.isin(last, partner[is_same])]
    pairs = np.column_stack([np.concatenate([first, alone]), np.concatenate([partner, alone])])
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    return pairs[order, 0], np.maximum.accumulate(pairs[order, 1])


def _cluster(every: Float64Array, points: Float64Array) -> Float64Array:
    """Return offsets, each as that of the point that it is as good as at, else the first such."""
    at = np.clip(np.searchsorted(points, every), 1, len(points) - 1)
    near = np.where(every - points[at - 1] < points[at] - every, at - 1, at)
    joined = np.where(np.abs(points[near] - every) <= _NEAR, points[near], every)
    for k in range(1, len(joined)):
        if joined[k] - joined[k - 1] <= _NEAR and joined[k] not in points:
            joined[k] = joined[k - 1]
    return np.maximum.accumulate(joined)


def _fill(
    channel: Channel, number: int, steps: int, ends: tuple[Float64Array, Float64Array]
) -> Strip:
    """Make the lines of one strip: with the channel in the plane, and even in elevation.

    They are straight in stations and offsets of the channel. Banks and the thalweg lie on their own
    lines, what is between them is shifted by as much in proportion.
    """
    a, b = channel.sections[number : number + 2]
    first, last = ends
    share = np.linspace(0.0, 1.0, steps + 1)
    is_kept = _find_distinct(a.places_at(first), b.places_at(last), first)
    first, last = first[is_kept], last[is_kept]
    begin, end = a.places_at(first), b.places_at(last)
    low, high = (
        measure_channel(channel.centreline, places, one.station, one.name)[:, None]
        for places, one in ((begin, a), (end, b))
    )
    stations, offsets = np.moveaxis(low + share[:, None] * (high - low), 2, 0)
    places = np.empty((len(first), steps + 1, 3))
    flat = channel.centreline.place(stations.ravel(), offsets.ravel())
    places[:, :, :2] = flat.reshape(len(first), steps + 1, 2)
    rise = begin[:, 2:] + share * (end[:, 2:] - begin[:, 2:])
    low = np.minimum(begin[:, 2:], end[:, 2:])
    places[:, :, 2] = np.clip(rise, low, np.maximum(begin[:, 2:], end[:, 2:]))
    shares = first[:, None] + share * (last - first)[:, None]
    names = ["string"] * len(first)
    if channel.lines:
        _shift(channel, number, share, offsets=shares, places=places)
        for k, line in enumerate(channel.lines, 1):
            names[int(np.abs(shares[:, 0] - k).argmin())] = line.name
    places[:, 0], places[:, -1] = begin, end
    _require_unfolded(places, a.name, b.name)
    return Strip(first, last, places, names)


def _find_distinct(begin: Float64Array, end: Float64Array, shares: Float64Array) -> BoolArray:
    """Mark lines that are apart; of those at one place, beside a bank, the one of the bank."""
    is_new = np.append(True, ((begin[1:] != begin[:-1]) | (end[1:] != end[:-1])).any(axis=1))
    group = np.cumsum(is_new) - 1
    rank = np.where((shares == np.round(shares)) & (shares > 0) & (shares < shares[-1]), 0, 1)
    order = np.lexsort((rank, group))
    chosen = order[np.append(True, np.diff(group[order]) > 0)]
    is_kept = np.zeros(len(shares), np.bool_)
    is_kept[chosen] = True
    return is_kept


def _shift(
    channel: Channel,
    number: int,
    share: Float64Array,
    *,
    offsets: Float64Array,
    places: Float64Array,
) -> None:
    """Shift places so that banks and thalweg lie on their lines."""
    import shapely

    nodes = np.arange(len(channel.lines) + 2, dtype=float)
    moves = np.zeros((len(share), len(nodes), 2))
    for k, line in enumerate(channel.lines, 1):
        begin, end = line.stations[number : number + 2]
        on_line = shapely.line_interpolate_point(line.line, begin + share * (end - begin))
        row = int(np.abs(offsets[:, 0] - k).argmin())
        moves[:, k] = shapely.get_coordinates(on_line) - places[row, :, :2]
    for step in range(len(share)):
        for axis in range(2):
            places[:, step, axis] += np.interp(offsets[:, step], nodes, moves[step, :, axis])


def _require_unfolded(places: Float64Array, first: str, last: str) -> None:
    """Refuse lines along a channel that cross one another between two sections.

    Of the corners of each face the triangles by one diagonal or the other must be turned alike.
    """
    a, b = places[:-1, :-1, :2], places[:-1, 1:, :2]  # from left to right, along the channel
    d, c = places[1:, :-1, :2], places[1:, 1:, :2]
    turns = [_turn(*three) for three in ((a, b, c), (a, c, d), (a, b, d), (b, c, d))]
    sign = np.sign(sum(float(one.sum()) for one in turns)) or 1.0
    abc, acd, abd, bcd = (sign * one for one in turns)
    is_sound = ((abc >= 0) & (acd >= 0) & (abc + acd > 0)) | (
        (abd >= 0) & (bcd >= 0) & (abd + bcd > 0)
    )
    if not is_sound.all():
        x, y = a[np.nonzero(~is_sound)[0][0], np.nonzero(~is_sound)[1][0]].tolist()
        raise LinesError(
            f"Between {first[:1].lower()}{first[1:]} and {last[:1].lower()}{last[1:]} lines along "
            f"the channel cross one another at {coordinate(x)} {coordinate(y)}: the centreline "
            "turns more sharply there than the channel is wide, or the sections do not lie across "
            "it; another centreline, or a section between, is needed."
        )


def _turn(a: Float64Array, b: Float64Array, c: Float64Array) -> Float64Array:
    """Return twice the signed areas of triangles."""
    one, other = b - a, c - a
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])
