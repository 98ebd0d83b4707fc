"""Levels of flowing water: what falls downstream, and follows the banks."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import OptionError

if TYPE_CHECKING:
    from ....base.arrays import BoolArray, Float64Array, Int64Array
    from ....base.policies import FlowDirection, WaterFit

_CLEAR = 0.5
"""Squares that are left of the better of two directions, over those of the other: where it is more
the banks do not tell which way the water flows."""


class BankSamples(NamedTuple):
    """Elevations along the shores."""

    vertices: Int64Array
    """(n,), where each is among those of the shores."""
    cells: Int64Array
    """(n,), the last node at or before each."""
    is_at_node: BoolArray
    """(n,), whether it is at that node."""
    nearest: Int64Array
    """(n,), the node that is nearest to each."""
    heights: Float64Array
    weights: Float64Array
    """(n,), length of the shore that each stands for."""


def fall_by_squares(values: Float64Array, weights: Float64Array) -> Float64Array:
    """Return the sequence that never rises and is nearest to values in weighted least squares.

    Neighbours that rise are pooled to their mean (pool adjacent violators). A value of weight 0
    has no say: it gets that of the pool it is in, or of the one before.
    """
    means: list[float] = []
    sums: list[float] = []
    counts: list[int] = []
    for value, weight in zip(values.tolist(), weights.tolist(), strict=True):
        if weight == 0.0 and means:
            counts[-1] += 1
            continue
        means.append(value)
        sums.append(weight)
        counts.append(1)
        while len(means) > 1 and (means[-2] < means[-1] or sums[-2] == 0.0):
            both = sums[-2] + sums[-1]
            mean = (means[-2] * sums[-2] + means[-1] * sums[-1]) / both
            means[-2:], sums[-2:] = [mean], [both]
            counts[-2:] = [counts[-2] + counts[-1]]
    return np.repeat(means, counts)


def fit_levels(
    samples: BankSamples, groups: Int64Array, fit: WaterFit, *, is_along: bool
) -> Float64Array:
    """Return the level at each node, which does not rise downstream.

    ``groups``, (n_nodes,), ascending, are of nodes that have one level. The lowest is the largest
    function that is nowhere above a sample, if levels between nodes are linear; isotonic the
    nearest to the samples, each at its nearest node.
    """
    count = int(groups[-1]) + 1
    last = len(groups) - 1
    if fit == "lowest":
        upper = np.minimum(samples.cells + 1, last)
        at = samples.cells if is_along else np.where(samples.is_at_node, samples.cells, upper)
        lows = np.full(count, np.inf)
        np.minimum.at(lows, groups[at], samples.heights)
        lows = lows if is_along else lows[::-1]
        first = int(np.isfinite(lows).argmax())
        lows[:first] = lows[first]
        fallen = np.minimum.accumulate(lows)
    else:
        means, weights = _pool(samples, groups, count)
        if not is_along:
            means, weights = means[::-1], weights[::-1]
        fallen = fall_by_squares(means, weights)
    levels = fallen if is_along else fallen[::-1]
    return np.asarray(levels[groups])


def _pool(
    samples: BankSamples, groups: Int64Array, count: int
) -> tuple[Float64Array, Float64Array]:
    """Return the mean elevation of each group of nodes, and its weight."""
    at = groups[samples.nearest]
    weights: Float64Array = np.bincount(at, samples.weights, count).astype(np.float64)
    sums = np.bincount(at, samples.weights * samples.heights, count)
    return np.divide(sums, weights, out=np.zeros(count), where=weights > 0), weights


def find_direction(
    samples: BankSamples, groups: Int64Array, downstream: FlowDirection
) -> tuple[bool, float]:
    """Tell whether water flows along the centreline, and by how much the banks fall so.

    Guessed, it is the direction in which a function that never rises leaves at most half of the
    squares that one in the other direction leaves. Raises OptionError if neither does.
    """
    means, weights = _pool(samples, groups, int(groups[-1]) + 1)
    down = fall_by_squares(means, weights)
    up = fall_by_squares(means[::-1], weights[::-1])[::-1]
    drop = float(down[0] - down[-1]), float(up[-1] - up[0])
    if downstream != "guess":
        is_along = downstream == "along"
        return is_along, drop[0] if is_along else drop[1]
    left = [float((weights * (means - one) ** 2).sum()) for one in (down, up)]
    rounding = 1e-24 * float((weights * (means**2 + 1.0)).sum())
    if min(left) > _CLEAR * max(left) or max(left) <= rounding:
        allowed = (
            '"along" or "against" the centreline here, since the banks do not tell which way the '
            f"water flows: they fall by {drop[0]:.3g} one way and by {drop[1]:.3g} the other"
        )
        raise OptionError("downstream", downstream, allowed)
    return left[0] < left[1], drop[0] if left[0] < left[1] else drop[1]
