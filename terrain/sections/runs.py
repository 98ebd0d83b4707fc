"""Runs: the parts of lines along which a surface is there, as lines in space."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...tin.topology import find_offsets

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int64Array
    from .rows import Rows


class Runs(NamedTuple):
    """Lines without gaps."""

    coordinates: Float64Array
    """(n, 3)."""
    offsets: Int64Array
    """(r + 1,), run i is ``coordinates[offsets[i]:offsets[i + 1]]``."""
    first_rows: Int64Array
    """(r,), the row where each begins."""


def find_runs(rows: Rows, k: int = 0) -> Runs:
    """Return the runs of surface ``k``; where a line only touches it there is none."""
    goes_on = ~rows.is_gap[:, k] & ~rows.is_last
    comes_on = np.append(False, goes_on[:-1])
    chosen = np.flatnonzero(goes_on | comes_on)
    is_first = ~comes_on[chosen]
    firsts = np.flatnonzero(is_first)
    xyz = np.column_stack([rows.places.xy[chosen], rows.elevations[chosen, k]])
    return Runs(xyz, find_offsets(np.diff(np.append(firsts, len(chosen)))), chosen[firsts])
