"""Numbers of vertices in the whole surface, in memory for one range of rows at a time.

In memory vertices are numbered in the order of the rows that they stand for. A tile knows these
rows, and which vertices lie in it; how many come before a row is counted over all tiles, range of
rows by range of rows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import CheckError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ..base.arrays import Int64Array

NUMBER = np.dtype("<i8")
"""Of a vertex, in a file of nothing else."""


def number_vertices(
    own: Sequence[Path], used: Sequence[Path], made: Sequence[Path], firsts: Int64Array
) -> int:
    """Write the number of each vertex that a tile uses; return how many there are.

    Parameters
    ----------
    own : sequence of Path
        Of each tile a file of the rows, ascending, of the vertices in it: each vertex of the whole
        is in one.
    used : sequence of Path
        Of each tile a file of the rows, ascending, of the vertices that its triangles have.
    made : sequence of Path
        Files to be written, of the numbers of these.
    firsts : (k,) int64 array
        Rows at which ranges begin that fit in memory, each to the next.

    Raises
    ------
    CheckError
        If a vertex is in two tiles, or in none.
    """
    edges = np.unique(firsts)
    owned, wanted = ([_find_ranges(path, edges) for path in paths] for paths in (own, used))
    for path in made:
        path.write_bytes(b"")
    total = 0
    for k in range(len(edges)):
        parts = [_read(path, ends, k) for path, ends in zip(own, owned, strict=True)]
        rows = np.sort(np.concatenate(parts))
        if (rows[1:] == rows[:-1]).any():
            raise CheckError("A vertex lies in two tiles.")
        for path, ends, target in zip(used, wanted, made, strict=True):
            asked = _read(path, ends, k)
            at = np.searchsorted(rows, asked)
            if not np.array_equal(np.append(rows, -1)[at], asked):
                raise CheckError("A vertex of a triangle lies in no tile.")
            with target.open("ab") as file:
                file.write((total + at).astype(NUMBER).data)
        total += len(rows)
    return total


def _find_ranges(path: Path, edges: Int64Array) -> Int64Array:
    """Return where the rows of each range begin in a file, and where the last one ends."""
    rows = np.fromfile(path, NUMBER)
    return np.append(np.searchsorted(rows, edges), len(rows))


def _read(path: Path, ends: Int64Array, k: int) -> Int64Array:
    """Return the rows of one range."""
    start, stop = int(ends[k]), int(ends[k + 1])
    if start == stop:
        return np.empty(0, NUMBER)
    return np.fromfile(path, NUMBER, count=stop - start, offset=start * NUMBER.itemsize)
