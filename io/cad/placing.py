"""Points and lines of a drawing in the CRS wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import ReadError
from ...base.sentences import FILE
from ...tin.topology import find_offsets
from ..reprojection.placement import place

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array
    from ...base.crs import CRS, Unit
    from .reference import Declared, Measures

__all__ = ["Placing", "place_rows"]


class Placing(NamedTuple):
    """Coordinates where they are wanted."""

    rows: list[Float64Array]
    """Each (k, 2) or (k, 3)."""
    crs: CRS | None
    elevation_unit: Unit | None
    notes: list[str]


def place_rows(
    parts: Sequence[Float64Array],
    measures: Measures,
    declared: Declared,
    *,
    names_axes: bool = False,
) -> Placing:
    """Bring easting, northing and elevation of a file into the CRS wanted, all at once.

    Parameters
    ----------
    parts : sequence of (k, 2) or (k, 3) float64 arrays
        As in the file.
    measures : Measures
    declared : Declared
    names_axes : bool
        Whether the format says which coordinate is the northing.

    Raises
    ------
    ReadError
        If a coordinate is not finite, or would be in degrees.
    CrsError
        If they cannot be transformed.
    """
    offsets = find_offsets(len(one) for one in parts)
    together = np.zeros((int(offsets[-1]), 3))
    for one, start in zip(parts, offsets.tolist(), strict=False):
        together[start : start + len(one), : one.shape[1]] = one
    if not np.isfinite(together).all():
        row = together[np.argmin(np.isfinite(together).all(axis=1))]
        raise ReadError(f"{FILE} has coordinates that are not finite (first: {row.tolist()}).")
    placed = place(
        measures.apply(together),
        source=measures.source,
        target=declared.crs,
        unit=measures.elevation_unit,
        looks_at_area=False,
        looks_at_order=not names_axes,
    )
    rows = [
        placed.points[start : start + len(one), : one.shape[1]]
        for one, start in zip(parts, offsets.tolist(), strict=False)
    ]
    return Placing(rows, placed.crs, placed.elevation_unit, [*measures.notes, *placed.notes])
