"""Rows at one place become one vertex, and every one of them is accounted for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import PointsError
from ...base.policies import DuplicatePolicy
from ...base.sentences import height, inflect
from ..validation import SHOWN

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array


class Merged(NamedTuple):
    """Vertices, the vertex of every row, and the report's fields about merges."""

    points: Float64Array
    vertex_of: Int32Array
    account: dict[str, Any]


def merge_rows(
    xyz: Float64Array,
    kept_row: Int32Array | None,
    policy: DuplicatePolicy,
    rows_of: Int64Array | None = None,
) -> Merged:
    """Merge rows that share a kept row.

    ``kept_row``, (n,), is for each row the row whose place it takes (its own for a kept one); None
    if all are kept. The policy ``"mean"`` adds in order of elevation, so that it does not depend on
    the order of the rows; ``"error"`` raises PointsError, whose sentence calls rows by ``rows_of``,
    (n,), their numbers in the caller's input.
    """
    n = len(xyz)
    if kept_row is None:
        return Merged(xyz, np.arange(n, dtype=np.int32), {})
    is_kept = kept_row == np.arange(n, dtype=np.int32)
    vertex_at = np.cumsum(is_kept, dtype=np.int32) - np.int32(1)
    vertex_of = vertex_at[kept_row]
    # rows of merged vertices, group after group and ascending within, with offsets
    is_shared = np.zeros(len(kept_row), np.bool_)
    is_shared[kept_row[~is_kept]] = True
    rows = np.flatnonzero(is_shared[kept_row]).astype(np.int32)
    rows = rows[np.argsort(vertex_of[rows], kind="stable")]
    vertices, counts = np.unique(vertex_of[rows], return_counts=True)
    offsets = np.zeros(len(vertices) + 1, np.int32)
    np.cumsum(counts, out=offsets[1:])
    if policy == "error" and len(rows):
        _refuse(xyz, rows, offsets, rows_of)
    points = xyz[is_kept]
    elevations = choose_elevations(xyz[rows, 2], offsets, policy)
    points[vertices, 2] = elevations
    account = {
        "merged_vertices": vertices,
        "merged_offsets": offsets,
        "merged_rows": rows,
        "merged_elevations": xyz[rows, 2],
        "merged_shifts": np.hypot(*(xyz[rows, :2] - xyz[kept_row[rows], :2]).T),
        "vertex_elevations": elevations,
    }
    return Merged(points, vertex_of, account)


def choose_elevations(
    elevations: Float64Array, offsets: Int32Array | Int64Array, policy: DuplicatePolicy
) -> Float64Array:
    """Return the elevation for each group of rows; ``offsets`` tell where groups begin and end."""
    starts, ends = offsets[:-1], offsets[1:]
    if policy == "first":
        return elevations[starts]
    if policy == "last":
        return elevations[ends - 1]
    if policy == "lowest":
        return np.minimum.reduceat(elevations, starts)
    if policy == "highest":
        return np.maximum.reduceat(elevations, starts)
    # average what lies above the lowest of each group, all made small enough not to overflow
    counts = ends - starts
    group = np.repeat(np.arange(len(counts)), counts)
    ascending = elevations[np.lexsort((elevations, group))]
    # how often to halve so that differences and their sums stay finite
    _, size = np.frexp(np.abs(elevations).max(initial=0.0))
    _, most = np.frexp(float(counts.max(initial=1)))
    halvings = max(0, int(size) + int(most) + 1 - np.finfo(np.float64).maxexp)
    ascending = np.ldexp(ascending, -halvings)
    lowest = ascending[starts]
    excess = np.add.reduceat(ascending - lowest[group], starts) / counts
    return np.asarray(np.ldexp(lowest + excess, halvings), np.float64)


def _refuse(
    xyz: Float64Array,
    rows: Int32Array,
    offsets: Int32Array,
    rows_of: Int64Array | None,
) -> None:
    surplus = len(rows) - (len(offsets) - 1)
    group = rows[offsets[0] : offsets[1]]
    numbers = group if rows_of is None else rows_of[group]
    x, y, _ = xyz[group[0]].tolist()
    elevations = ", ".join(f"{height(z)}" for z in xyz[group[:SHOWN], 2])
    shown = ", ".join(str(row) for row in numbers[:SHOWN])
    repeat = inflect(f"{surplus} of {len(xyz)} rows [repeats|repeat]", surplus)
    raise PointsError(
        f"{repeat} the place of another "
        f"(first: rows {shown} at x {x}, y {y} with "
        f'elevations {elevations}): `duplicates="error"` allows none.',
        rows=numbers[:SHOWN],
    )
