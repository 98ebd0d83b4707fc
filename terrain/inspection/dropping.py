"""Leave points out that look like blunders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import LinesError, PointsError
from ...tin.screening.suspects import DROPPED

if TYPE_CHECKING:
    from ...base.arrays import Int32Array, Int64Array
    from ...base.results import Table
    from ...tin import TIN


def list_wrong_rows(table: Table) -> Int64Array:
    """Return the rows that are wrong by themselves, but for those of low certainty, ascending."""
    is_wrong = np.isin(table["reason"].astype(str), DROPPED)
    is_wrong &= table["certainty"].astype(str) != "low"
    rows: Int64Array = np.unique(table["row"][is_wrong])
    return rows


def drop_blunders(tin: TIN, table: Table) -> tuple[TIN, Int64Array]:
    """Remove the points from a TIN, in place, that look like blunders.

    ``table`` is one of :func:`tinsmith.blunders`. Those of low certainty stay, and those that only
    say that another row has the same number or place; a vertex that stands for other rows, too; and
    one without which a line would vanish. Returns the TIN, whose report gives the reason, and the
    rows that were left out, ascending.
    """
    rows = list_wrong_rows(table)
    vertex_of = tin.vertex_of
    vertices = np.unique(vertex_of[rows])
    shared = np.setdiff1d(np.flatnonzero(np.isin(vertex_of, vertices)), rows)
    vertices = np.setdiff1d(vertices, vertex_of[shared])
    if not _remove(tin, vertices):
        for vertex in vertices[::-1]:  # those behind a removed one move up
            _remove(tin, vertex[None])
    gone: Int64Array = rows[tin.vertex_of[rows] < 0]
    return tin.with_reason(gone, "looks like a blunder"), gone


def _remove(tin: TIN, vertices: Int32Array) -> bool:
    try:
        tin.remove(vertices)
    except (PointsError, LinesError):
        return False
    return True
