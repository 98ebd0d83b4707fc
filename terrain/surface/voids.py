"""Voids of a raster: where its surface ends, as rings through the centres of its cells.

Four neighbouring cell centres make a square. Where all four have an elevation the square is
surface, where three have it half of the square is; elsewhere there is a void. The rings run along
the border of that, so no triangle reaches across a cell without an elevation.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Int64Array

_CORNERS = ((0, 0), (0, 1), (1, 0), (1, 1))
"""Of a square of cells: rows and columns from its northwest."""


def trace_rings(valid: BoolArray) -> list[Int64Array]:
    """Return the rings around the cells that have elevations, where ``valid`` is True.

    Each is (k,): numbers of cells among the valid ones, in the order of rows; no cell twice in a
    ring. A place is surface if an odd number of rings holds it.

    Examples
    --------
    >>> [ring.tolist() for ring in trace_rings(np.array([[True, True], [True, False]]))]
    [[0, 2, 1]]
    """
    start, end = find_border(valid)
    number = np.cumsum(valid.ravel()) - 1
    return [number[ring] for ring in trace_cycles(start, end)]


def find_surface(valid: BoolArray) -> BoolArray:
    """Tell which cells are corners of a square or of half a square of surface.

    Examples
    --------
    >>> find_surface(np.array([[True, True, False], [True, False, True]])).astype(int)
    array([[1, 1, 0],
           [1, 0, 0]])
    """
    squares = [valid[i : len(valid) - 1 + i, j : valid.shape[1] - 1 + j] for i, j in _CORNERS]
    is_part = sum(part.astype(np.int8) for part in squares) >= 3
    found = np.zeros_like(valid)
    for i, j in _CORNERS:
        found[i : len(valid) - 1 + i, j : valid.shape[1] - 1 + j] |= is_part
    return found & valid


def find_border(valid: BoolArray) -> tuple[Int64Array, Int64Array]:
    """Return the directed edges between cells that have surface on their left only.

    ``valid`` tells of each cell whether it has an elevation. Returns start and end, (k,) each:
    cells, row by row.
    """
    cells = np.arange(valid.size).reshape(valid.shape)
    a, b = cells[:-1, :-1], cells[:-1, 1:]  # northwest, northeast
    d, c = cells[1:, :-1], cells[1:, 1:]  # southwest, southeast
    has = {"a": valid[:-1, :-1], "b": valid[:-1, 1:], "c": valid[1:, 1:], "d": valid[1:, :-1]}
    count = sum(part.astype(np.int8) for part in has.values())
    is_part = np.asarray(count) >= 3
    north, south = is_part & has["a"] & has["b"], is_part & has["d"] & has["c"]
    west, east = is_part & has["a"] & has["d"], is_part & has["b"] & has["c"]
    edges = [
        (d, c, south & ~_shift_flags(north, rows=-1)),
        (b, a, north & ~_shift_flags(south, rows=1)),
        (a, d, west & ~_shift_flags(east, columns=1)),
        (c, b, east & ~_shift_flags(west, columns=-1)),
    ]
    for missing, (one, other) in {"a": (b, d), "b": (c, a), "c": (d, b), "d": (a, c)}.items():
        edges.append((one, other, is_part & ~has[missing]))
    start = np.concatenate([one[chosen] for one, _, chosen in edges])
    end = np.concatenate([other[chosen] for _, other, chosen in edges])
    return start, end


def _shift_flags(flags: BoolArray, *, rows: int = 0, columns: int = 0) -> BoolArray:
    """Return the flags of the squares one further up, down, left or right; False beyond."""
    moved = np.zeros_like(flags)
    if rows == 1:
        moved[1:] = flags[:-1]
    elif rows == -1:
        moved[:-1] = flags[1:]
    elif columns == 1:
        moved[:, 1:] = flags[:, :-1]
    else:
        moved[:, :-1] = flags[:, 1:]
    return moved


def trace_cycles(start: Int64Array, end: Int64Array) -> Iterator[Int64Array]:
    """Walk directed edges, as many into a cell as out of it, as cycles without a cell twice."""
    order = np.argsort(start, kind="stable")
    ends = end[order].tolist()
    cells, first, counts = np.unique(start[order], return_index=True, return_counts=True)
    bounds = zip(first.tolist(), (first + counts).tolist(), strict=True)
    slots = dict(zip(cells.tolist(), bounds, strict=True))
    following = {cell: ends[low:high] for cell, (low, high) in slots.items()}
    for begin in cells.tolist():
        while following[begin]:
            yield from _trace_from(begin, following)


def _trace_from(begin: int, following: dict[int, list[int]]) -> Iterator[Int64Array]:
    """Follow edges from a cell until there are none, cutting off a cycle at each cell met again."""
    path, place_of = [begin], {begin: 0}
    while following[path[-1]]:
        cell = following[path[-1]].pop()
        place = place_of.get(cell)
        if place is None:
            place_of[cell] = len(path)
            path.append(cell)
            continue
        yield np.array(path[place:], np.int64)
        for gone in path[place + 1 :]:
            del place_of[gone]
        del path[place + 1 :]
