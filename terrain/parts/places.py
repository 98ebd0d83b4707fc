"""Elevations of a surface at places, tile by tile.

A tile takes the places in its box: the triangles that hold them meet it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import OptionError
from .surfaces import are_owned, as_surface

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...base.arrays import Float64Array, Int64Array
    from ...base.types import Bounds
    from ...tin.tiling import LocalTriangulation


class PlacePart(NamedTuple):
    """Elevations at places: ``rows`` (k,) among all, ``elevations`` (k,), NaN off the surface."""

    rows: Int64Array
    elevations: Float64Array


def compute_part(
    part: LocalTriangulation, box: Bounds, places: Float64Array, rows: Int64Array | None = None
) -> PlacePart:
    """Interpolate at the places in a box, without its east and north sides.

    Parameters
    ----------
    part : LocalTriangulation
        All triangles that meet the box.
    box : Bounds
    places : (k, 2 or more) float64 array
        All places, or those near the box.
    rows : (k,) int64 array, optional
        Their numbers among all; default from 0 on.
    """
    chosen = np.flatnonzero(are_owned(places, box))
    elevations = np.full(len(chosen), np.nan)
    if len(part.triangles) and len(chosen):
        xy = np.ascontiguousarray(places[chosen, :2])
        elevations = as_surface(part).interpolate(xy, threads=1)
    return PlacePart(chosen if rows is None else rows[chosen], elevations)


def join(parts: Iterable[PlacePart], count: int, *, known: int | None = None) -> Float64Array:
    """Return the elevations at all places, of the parts of all tiles in any order.

    Parameters
    ----------
    parts : iterable of PlacePart
    count : int
        Of all places.
    known : int, optional
        How many of them lie anywhere; default all. The others, which are NaN, are in no tile.

    Raises
    ------
    OptionError
        If places are missing, or in two tiles.
    """
    found = np.full(count, np.nan)
    n_found = 0
    for part in parts:
        found[part.rows] = part.elevations
        n_found += len(part.rows)
    wanted = count if known is None else known
    if n_found != wanted:
        raise OptionError("places", n_found, f"all {wanted:,} places, once each")
    return found
