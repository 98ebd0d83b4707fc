"""Clipping: the parts of polylines within a rectangle of paper."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.topology import find_owners

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...tin import Bounds


class Paths(NamedTuple):
    """Polylines in the plane."""

    coordinates: Float64Array
    """(n, 2)."""
    offsets: Int64Array
    """(l + 1,), path k is ``coordinates[offsets[k]:offsets[k + 1]]``."""
    sources: Int64Array
    """(l,), the polyline that each path is a part of."""

    @classmethod
    def whole(cls, coordinates: Float64Array, offsets: Int64Array) -> Paths:
        """Return one path for each polyline."""
        return cls(coordinates, offsets, np.arange(len(offsets) - 1))

    def parts(self) -> list[Float64Array]:
        """Return the coordinates of each path."""
        return [self.coordinates[first:last] for first, last in pairwise(self.offsets.tolist())]

    def choose(self, is_chosen: BoolArray) -> list[Float64Array]:
        """Return the coordinates of some of the paths, by what is said of their sources."""
        parts = self.parts()
        return [parts[k] for k in np.flatnonzero(is_chosen[self.sources])]


def join_paths(parts: Sequence[Float64Array], sources: Iterable[int] | None = None) -> Paths:
    """Return polylines as paths."""
    lengths = [len(part) for part in parts]
    offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
    coordinates = np.concatenate([np.empty((0, 2)), *parts])
    numbers = range(len(parts)) if sources is None else sources
    return Paths(coordinates, offsets, np.fromiter(numbers, np.int64, len(parts)))


def clip_paths(paths: Paths, box: Bounds) -> Paths:
    """Return the parts of paths within a rectangle (Liang and Barsky 1984).

    Points inside stay as they are to the bit; those on the sides of the rectangle are exactly
    there in the one coordinate. A path that only touches it is left out.
    """
    xy = paths.coordinates
    owners = find_owners(paths.offsets)
    at = np.flatnonzero(owners[1:] == owners[:-1])
    start, step = xy[at], xy[at + 1] - xy[at]
    enter, leave = _find_ratios(start, step, box)
    is_seen = enter < leave
    at, start, step = at[is_seen], start[is_seen], step[is_seen]
    enter, leave = enter[is_seen], leave[is_seen]
    low, high = (box.xmin, box.ymin), (box.xmax, box.ymax)
    first = np.where((enter > 0)[:, None], (start + enter[:, None] * step).clip(low, high), start)
    last = np.where(
        (leave < 1)[:, None], (start + leave[:, None] * step).clip(low, high), xy[at + 1]
    )
    is_begin = np.ones(len(at), np.bool_)
    goes_on = (np.diff(at) == 1) & (owners[at[1:]] == owners[at[:-1]])
    is_begin[1:] = ~(goes_on & (leave[:-1] >= 1) & (enter[1:] <= 0))
    begins = np.flatnonzero(is_begin)
    number = np.cumsum(is_begin) - 1
    coordinates = np.empty((len(first) + len(begins), 2))
    coordinates[begins + np.arange(len(begins))] = first[begins]
    coordinates[np.arange(len(first)) + number + 1] = last
    offsets = np.append(begins + np.arange(len(begins)), len(coordinates)).astype(np.int64)
    return Paths(coordinates, offsets, paths.sources[owners[at]][begins])


def _find_ratios(
    start: Float64Array, step: Float64Array, box: Bounds
) -> tuple[Float64Array, Float64Array]:
    """Return the shares of each segment at which it enters and leaves the rectangle."""
    enter, leave = np.zeros(len(start)), np.ones(len(start))
    for axis, (low, high) in enumerate(((box.xmin, box.xmax), (box.ymin, box.ymax))):
        along, at = step[:, axis], start[:, axis]
        is_level = along == 0
        divisor = np.where(is_level, 1.0, along)
        one, other = (low - at) / divisor, (high - at) / divisor
        is_outside = is_level & ((at < low) | (at > high))
        near = np.where(is_level, 0.0, np.minimum(one, other))
        far = np.where(is_level, np.where(is_outside, -1.0, 1.0), np.maximum(one, other))
        enter, leave = np.maximum(enter, near), np.minimum(leave, far)
    is_point = (step == 0).all(axis=1)
    return enter, np.where(is_point, -1.0, leave)
