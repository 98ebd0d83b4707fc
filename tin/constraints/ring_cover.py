"""Which rings hold the regions between them, told by crossing one edge of a ring after another."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Int64Array


class Crossing(NamedTuple):
    """An edge along rings by which a region is left."""

    region: int
    """The one beyond."""
    key: int
    """Of the edge."""


def gather_odd(keys: Int64Array, rings: Int64Array) -> dict[int, list[int]]:
    """Return the rings on other sides of each edge: those that run along it an odd number of times.

    ``keys`` are edges along rings, and ``rings`` the number of the ring of each.
    """
    pairs, counts = np.unique(np.stack([keys, rings], axis=1), axis=0, return_counts=True)
    found: dict[int, list[int]] = {}
    for key, ring in pairs[counts % 2 == 1].tolist():
        found.setdefault(key, []).append(ring)
    return found


def find_crossings(here: AnyArray, there: AnyArray, keys: Int64Array) -> dict[int, list[Crossing]]:
    """Return the ways out of each region: one edge to each of those beside it."""
    _, first = np.unique(np.stack([here, there], axis=1), axis=0, return_index=True)
    ways: dict[int, list[Crossing]] = {}
    for start, end, key in zip(
        here[first].tolist(), there[first].tolist(), keys[first].tolist(), strict=True
    ):
        ways.setdefault(start, []).append(Crossing(end, key))
    return ways


def walk_regions(
    start: int,
    cover: set[int],
    ways: Mapping[int, Sequence[Crossing]],
    toggles: Mapping[int, Sequence[int]],
    enters: Callable[[int], bool],
) -> Iterator[int]:
    """Yield regions from one on across rings, with ``cover`` the rings that hold each.

    ``cover`` is changed along the way, depth first and back: the walk takes time in proportion to
    the edges that it crosses, however many rings hold a region. ``enters`` tells whether a region
    is walked into; of the regions that it has let in it must say no from then on.
    """
    if not enters(start):
        return
    yield start
    path: list[tuple[Iterator[Crossing], Sequence[int]]] = [(iter(ways.get(start, ())), ())]
    while path:
        way = next((one for one in path[-1][0] if enters(one.region)), None)
        if way is None:
            cover.symmetric_difference_update(path.pop()[1])
            continue
        crossed = toggles.get(way.key, ())
        cover.symmetric_difference_update(crossed)
        yield way.region
        path.append((iter(ways.get(way.region, ())), crossed))
