"""What is odd of elevations that come block by block, without keeping all of them."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from .nodata import describe_elevations, describe_suspects, find_suspect_elevations

if TYPE_CHECKING:
    from ...base.arrays import Float64Array

_SOME = 65_536
"""Elevations of each block that are kept, spread over it."""

_MOST = 1 << 20
"""Elevations of all blocks that are kept; of more every other one is."""

_EXTREMES = 4
"""Lowest and highest values of each block that are kept, and counted."""

_REPEATS = 3
"""How often an extreme value counts among those that are kept."""


class ElevationSummary:
    """Elevations of blocks, of which the extremes and some others are kept.

    ``what`` has the elevations is said in sentences; all of them are kept where memory holds them
    anyway (``keeps_all``). One block is described by all of its elevations. Of several, an
    elevation that may stand for no data is found among those kept, and counted in the blocks where
    it is one of the four lowest or highest values.
    """

    def __init__(self, what: str, *, keeps_all: bool = False) -> None:
        self._what, self._keeps_all = what, keeps_all
        self._kept: list[Float64Array] = []
        self._share = 1
        self._counts: Counter[float] = Counter()
        self._n_blocks = 0
        self._n = 0

    def add(self, z: Float64Array) -> None:
        """Add finite elevations of a block."""
        if len(z) == 0:
            return
        self._n_blocks += 1
        self._n += len(z)
        if self._keeps_all or self._n_blocks == 1:
            self._kept.append(z)
            return
        if self._n_blocks == 2:
            self._kept = [self._thin(self._kept[0])]
        self._kept.append(self._thin(z))
        if sum(map(len, self._kept)) > _MOST:
            self._kept = [np.concatenate(self._kept)[::2].copy()]
            self._share *= 2

    def _thin(self, z: Float64Array) -> Float64Array:
        self._counts.update(_count_extremes(z, 1.0) | _count_extremes(z, -1.0))
        return z[:: max(1, len(z) * self._share // _SOME)].copy()

    def describe(self) -> list[str]:
        """Say which elevations may stand for no data, as :func:`describe_elevations`."""
        if not self._kept:
            return []
        kept = np.concatenate(self._kept)
        if self._keeps_all or self._n_blocks == 1:
            return describe_elevations(kept, self._what)
        repeats = [min(count, _REPEATS) for count in self._counts.values()]
        kept = np.concatenate([kept, np.repeat([*self._counts], repeats)])
        if bool((kept == kept[0]).all()):
            return describe_elevations(np.broadcast_to(kept[0], (self._n,)), self._what)
        suspects = find_suspect_elevations(kept)
        told = [replace(one, count=self._counts.get(one.value, one.count)) for one in suspects]
        return describe_suspects(told, self._what)


def _count_extremes(z: Float64Array, sign: float) -> dict[float, int]:
    """Return the lowest values (sign 1), or the highest (-1), and how often they are there."""
    found: dict[float, int] = {}
    last = -np.inf
    for _ in range(_EXTREMES):
        rest = (sign * z)[sign * z > last]
        if len(rest) == 0:
            break
        last = float(rest.min())
        found[sign * last] = int((rest == last).sum())
    return found
