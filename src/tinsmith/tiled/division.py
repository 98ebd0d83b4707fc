"""The plane divided into tiles that hold about equally many points."""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..base.types import Bounds

if TYPE_CHECKING:
    from ..base.arrays import Int64Array


@dataclass(frozen=True)
class Tile:
    """A part of the plane.

    Attributes
    ----------
    key : str
        Its name: a number, and those of the quarters that lead to it.
    box : Bounds
        Half-open: its western and southern edges belong to it. Those at the rim have no end.
    count : int
        About how many points lie in it.
    """

    key: str
    box: Bounds
    count: int


class _Part(NamedTuple):
    """Cells of the lattice of counts: rows and columns from and to, and the points in them."""

    south: int
    north: int
    west: int
    east: int
    total: int


def divide(counts: Int64Array, bounds: Bounds, *, most: int, fewest_tiles: int = 1) -> list[Tile]:
    """Halve the plane again and again, until no tile has too many points.

    Parameters
    ----------
    counts : (side, side) int64 array
        Points in the cells of a lattice over the bounds; rows from the south.
    bounds : Bounds
    most : int
        Points of a tile, as far as the lattice is fine enough.
    fewest_tiles : int

    Returns
    -------
    list of Tile
        From the south-west on. Together they are the whole plane, without overlap.
    """
    side = len(counts)
    sums = np.zeros((side + 1, side + 1), np.int64)
    sums[1:, 1:] = counts.cumsum(axis=0).cumsum(axis=1)
    aspect = bounds.width / bounds.height if bounds.height > 0 else np.inf
    parts = [(-int(sums[-1, -1]), _Part(0, side, 0, side, int(sums[-1, -1])))]
    heapify(parts)
    done: list[_Part] = []
    while parts:
        part = heappop(parts)[1]
        is_enough = part.total <= most and len(parts) + len(done) + 1 >= fewest_tiles
        halves = [] if is_enough else _halve(part, sums, aspect)
        if not halves:
            done.append(part)
        for half in halves:
            heappush(parts, (-half.total, half))
    done.sort()
    xs, ys = (
        [-np.inf, *(low + np.arange(1, side) * ((high - low) / side)).tolist(), np.inf]
        for low, high in ((bounds.xmin, bounds.xmax), (bounds.ymin, bounds.ymax))
    )
    return [
        Tile(str(k), Bounds(xs[one.west], ys[one.south], xs[one.east], ys[one.north]), one.total)
        for k, one in enumerate(done)
    ]


def _halve(part: _Part, sums: Int64Array, aspect: float) -> list[_Part]:
    """Cut a part across its longer side, where half of its points lie on each side."""
    south, north, west, east, _ = part
    is_wide = (east - west) * aspect >= north - south
    if east - west == 1 or (not is_wide and north - south > 1):
        if north - south == 1:
            return []
        low, high, rows = south, north, sums[:, east] - sums[:, west]
        cut = _find_middle(rows[low : high + 1]) + low
        pieces = [(low, cut, west, east), (cut, high, west, east)]
    else:
        low, high, columns = west, east, sums[north] - sums[south]
        cut = _find_middle(columns[low : high + 1]) + low
        pieces = [(south, north, low, cut), (south, north, cut, high)]
    return [
        _Part(s, n, w, e, int(sums[n, e] - sums[s, e] - sums[n, w] + sums[s, w]))
        for s, n, w, e in pieces
    ]


def _find_middle(sums: Int64Array) -> int:
    """Return the inner place where about half of the points are on each side."""
    inner = sums[1:-1]
    return 1 + int(np.argmin(np.abs(2 * inner - sums[0] - sums[-1])))


def quarter(tile: Tile, bounds: Bounds) -> list[Tile]:
    """Return the four parts of a tile that was too large for the memory of a worker."""
    box = tile.box
    x, y = (
        (max(low, inner_low) + min(high, inner_high)) / 2
        for low, high, inner_low, inner_high in (
            (box.xmin, box.xmax, bounds.xmin, bounds.xmax),
            (box.ymin, box.ymax, bounds.ymin, bounds.ymax),
        )
    )
    boxes = [
        Bounds(box.xmin, box.ymin, x, y),
        Bounds(x, box.ymin, box.xmax, y),
        Bounds(box.xmin, y, x, box.ymax),
        Bounds(x, y, box.xmax, box.ymax),
    ]
    return [Tile(f"{tile.key}.{k}", one, tile.count // 4) for k, one in enumerate(boxes)]
