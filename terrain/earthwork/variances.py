"""Variance of a weighted sum of errors that are correlated over a distance."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import Float64Array, Int64Array
    from .error_models import ErrorModel

_PAIRS_AT_A_TIME = 1 << 19
"""Pairs of vertices in memory, some 100 bytes each."""
_FEW_PAIRS = 20_000_000
"""So many are summed one by one in a few seconds, whatever else it would take."""
_NODES_A_PAIR = 4.0
"""A node of the lattice takes as long as so many pairs."""
_NODES_A_RANGE = 24
"""Of the lattice within the range, each way."""
_LEAST_BLOCK = 256
"""Nodes each way that are transformed at a time, beside those within reach around them."""
_FINEST = 2.0**-30
"""Of the extent: cells are no smaller, so that they can be numbered."""


def measure_variances(xy: Float64Array, loads: Float64Array, model: ErrorModel) -> Float64Array:
    """Return the variances of sums of correlated errors.

    ``xy``, (n, 2), are the places of the errors; ``loads``, (n, k), their standard errors times
    their weights in each of k sums. Returns (k,).

    Notes
    -----
    The sum of load times load times correlation over all pairs within reach, in blocks of bounded
    memory. Where these are so many that it pays, loads are spread linearly over a lattice of 24
    nodes to the range, and are convolved there by Fourier transforms, block by block: that changes
    a standard error by less than 0.5 %.
    """
    squares: Float64Array = (loads * loads).sum(axis=0)
    if model.reach <= 0.0 or len(xy) < 2 or model.nugget == 1.0:
        return squares
    near = _find_near(xy, model.reach)
    width, height = np.ptp(xy, axis=0)
    step = model.correlation_range / _NODES_A_RANGE
    border = 2.0 * model.reach
    nodes = (width + border) / step * ((height + border) / step)
    is_many = near.pair_count > max(_FEW_PAIRS, _NODES_A_PAIR * nodes)
    sum_pairs = _sum_on_lattice if is_many else _sum_one_by_one
    correlated = sum_pairs(xy, loads, model)
    return model.nugget * squares + (1.0 - model.nugget) * (squares + correlated)


class _Near(NamedTuple):
    """Places in the order of square cells, and the ranges of those that may be near behind each."""

    order: Int64Array
    starts: Int64Array
    """(n, 2)."""
    ends: Int64Array

    @property
    def pair_count(self) -> int:
        """Number of pairs."""
        return int((self.ends - self.starts).sum())


def _find_near(xy: Float64Array, reach: float) -> _Near:
    """Sort places by cells as large as the reach: those near are in it or beside it.

    Of each pair the one behind is near the one before: in the same cell or the next of its row, or
    in three of the row above.
    """
    side = max(reach, float(np.ptp(xy, axis=0).max()) * _FINEST)
    column, row = np.floor((xy - xy.min(axis=0)) / side).astype(np.int64).T
    across = int(column.max()) + 3
    key = row * across + column + 1
    order = np.argsort(key, kind="stable")
    key = key[order]
    own = np.arange(1, len(key) + 1)
    starts = np.stack([own, np.searchsorted(key, key + across - 1)], axis=1)
    ends = [np.searchsorted(key, key + ahead, "right") for ahead in (1, across + 1)]
    return _Near(order, starts, np.stack(ends, axis=1))


def _sum_one_by_one(xy: Float64Array, loads: Float64Array, model: ErrorModel) -> Float64Array:
    """Return the sum over all pairs of different places, (k,)."""
    near = _find_near(xy, model.reach)
    places, sorted_loads = xy[near.order], loads[near.order]
    total = np.zeros(loads.shape[1])
    for one, other in _list_pairs(near):
        distances = np.hypot(*(places[other] - places[one]).T)
        is_near = distances < model.reach
        rho = model.correlate(distances[is_near])
        products = sorted_loads[one[is_near]] * sorted_loads[other[is_near]]
        total += rho @ products
    return 2.0 * total


def _list_pairs(near: _Near) -> Iterator[tuple[Int64Array, Int64Array]]:
    for side in range(2):
        starts, counts = near.starts[:, side], (near.ends - near.starts)[:, side]
        reached = np.cumsum(counts)
        first = 0
        while first < len(counts):
            before = int(reached[first - 1]) if first else 0
            last = int(np.searchsorted(reached, before + _PAIRS_AT_A_TIME, "right"))
            last = max(last, first + 1)
            own = counts[first:last]
            one = np.repeat(np.arange(first, last), own)
            within = np.arange(len(one)) - np.repeat(np.cumsum(own) - own, own)
            yield one, starts[one] + within
            first = last


# ---------------------------------------------------------------- on a lattice


class _Spread(NamedTuple):
    """Places on a lattice: the node to their south-west, and the shares of its corners."""

    node: Int64Array
    """(n, 2)."""
    shares: Float64Array
    """(n, 2, 2), by column and row."""

    def gather(
        self, chosen: Int64Array, loads: Float64Array, corner: Int64Array, size: int
    ) -> Float64Array:
        """Return the loads of chosen places at the nodes of a square, (size, size)."""
        nodes = np.zeros(size * size)
        for i in range(2):
            for j in range(2):
                column, row = (self.node[chosen] + (i, j) - corner).T
                inside = (column >= 0) & (column < size) & (row >= 0) & (row < size)
                weights = (self.shares[chosen, i, j] * loads[chosen])[inside]
                at = column[inside] * size + row[inside]
                nodes += np.bincount(at, weights, minlength=size * size)
        return nodes.reshape(size, size)


def _sum_on_lattice(xy: Float64Array, loads: Float64Array, model: ErrorModel) -> Float64Array:
    """Return the sum over all pairs of different places nearly, (k,)."""
    step = model.correlation_range / _NODES_A_RANGE
    spread = _spread(xy, step)
    halo = int(np.ceil(model.reach / step)) + 1
    block = max(_LEAST_BLOCK, halo)
    size = block + 2 * halo
    away = np.minimum(np.arange(size), size - np.arange(size)) * step
    apart = np.hypot(away[:, None], away[None, :])
    kernel = np.fft.rfft2(np.where(apart < model.reach, model.correlate(apart), 0.0))
    total = -_sum_own(spread.shares, loads, model, step)
    across = int(spread.node[:, 0].max()) // block + 4
    key = _number(spread.node, block, across)
    corners = [_number(spread.node + corner, block, across) for corner in np.ndindex(2, 2)]
    order = np.argsort(key, kind="stable")
    key = key[order]
    for own in np.unique(np.concatenate(corners)).tolist():
        # The nodes of a block, those within reach around them, and one more for the spreading.
        beside = [
            order[slice(*np.searchsorted(key, [own + up * across - 1, own + up * across + 2]))]
            for up in (-1, 0, 1)
        ]
        corner = np.array([own % across - 1, own // across]) * block - halo
        near = np.concatenate(beside)
        for k in range(loads.shape[1]):
            nodes = spread.gather(near, loads[:, k], corner, size)
            around = np.fft.irfft2(np.fft.rfft2(nodes) * kernel, s=(size, size))
            inner = slice(halo, halo + block)
            total[k] += float((nodes[inner, inner] * around[inner, inner]).sum())
    return total


def _number(node: Int64Array, block: int, across: int) -> Int64Array:
    """Return the number of the block that each node, (n, 2), is in."""
    column, row = (node // block).T
    return np.asarray(row * across + column + 1)


def _spread(xy: Float64Array, step: float) -> _Spread:
    place = (xy - xy.min(axis=0)) / step
    node = np.floor(place)
    beyond = place - node
    shares = np.stack([1.0 - beyond, beyond], axis=2)
    return _Spread(node.astype(np.int64), shares[:, 0, :, None] * shares[:, 1, None, :])


def _sum_own(
    shares: Float64Array, loads: Float64Array, model: ErrorModel, step: float
) -> Float64Array:
    """Return what the lattice makes of each place with itself, which is no pair, (k,)."""
    corners = shares.reshape(-1, 4)
    steps = np.array([[0, 0], [0, 1], [1, 0], [1, 1]]) * step
    apart = np.hypot(*(steps[:, None] - steps[None]).transpose(2, 0, 1))
    own = np.einsum("ni,ij,nj->n", corners, model.correlate(apart), corners)
    sums: Float64Array = own @ (loads * loads)
    return sums
