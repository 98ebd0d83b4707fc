"""Places at which points differ in elevation: of a merge, and of points that were not merged."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..report import measure_spread

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from ...base.arrays import Float64Array, Int64Array


def list_differing(vertices: Float64Array, account: Mapping[str, Any]) -> Float64Array:
    """Return the places at which merged rows differ in elevation, and by how much, (k, 3).

    ``account`` is that of a merge, see :func:`tinsmith.tin.building.merge_rows`.
    """
    if not account:
        return np.empty((0, 3))
    places, starts = vertices[account["merged_vertices"], :2], account["merged_offsets"][:-1]
    return _measure(places, account["merged_elevations"], starts)


def find_differing(points: Float64Array) -> Float64Array:
    """Return the places at which points, (n, 3), differ in elevation, and by how much, (k, 3)."""
    ordered = points[np.lexsort(points[:, :2].T)]
    is_other = (ordered[1:, :2] != ordered[:-1, :2]).any(axis=1)
    starts = np.flatnonzero(np.append(True, is_other)[: len(ordered)])
    return _measure(ordered[starts, :2], ordered[:, 2], starts)


def _measure(places: Float64Array, elevations: Float64Array, starts: Int64Array) -> Float64Array:
    """Return places and the spread of their elevations, those from each start on."""
    if not len(starts):
        return np.empty((0, 3))
    spread = measure_spread(elevations, starts)
    found: Float64Array = np.column_stack([places, spread])[spread != 0.0]
    return found
