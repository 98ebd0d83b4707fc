"""Alignments and points that are scaled about a point."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_floats
from ....base.errors import OptionError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import Float64Array
    from ....base.crs import CRS
    from ..alignments import Alignment, Element, VerticalAlignment


def require_places(places: Any) -> Float64Array:
    """Return points as an array of two or three columns, or refuse them."""
    found = as_floats(places)
    if found is None or found.ndim != 2 or found.shape[1] not in (2, 3):
        allowed = "an (n, 2) or (n, 3) array, a TIN, a Survey, Features or an Alignment"
        raise OptionError("places", places, allowed)
    return found


def scale_alignment(
    road: Alignment,
    factor: float,
    base: Float64Array,
    *,
    crs: CRS | None,
    notes: Sequence[str],
) -> Alignment:
    """Return an alignment whose places and lengths are scaled about a point.

    Its first station and those that are written behind equations stay; elevations stay.
    """
    start = road.start

    def move(station: float) -> float:
        return start + (station - start) * factor

    return replace(
        road,
        elements=[_scale_element(one, factor, base) for one in road.elements],
        equations=[replace(one, station=move(one.station)) for one in road.equations],
        verticals=[_scale_vertical(one, factor, move) for one in road.verticals],
        crs=crs,
        elevation_unit=road.elevation_unit,
        notes=notes,
    )


def _scale_element(one: Element, factor: float, base: Float64Array) -> Element:
    x, y = (base + (np.array(one.start) - base) * factor).tolist()
    return replace(
        one,
        start=(x, y),
        length=one.length * factor,
        start_curvature=one.start_curvature / factor,
        end_curvature=one.end_curvature / factor,
    )


def _scale_vertical(one: VerticalAlignment, factor: float, move: Any) -> VerticalAlignment:
    if one.has_arcs:
        allowed = "one without arcs, which are none any more where lengths alone are scaled"
        raise OptionError("vertical", one.name, allowed)
    points = [
        replace(
            point,
            station=move(point.station),
            length_in=point.length_in * factor,
            length_out=point.length_out * factor,
        )
        for point in one.points
    ]
    return replace(one, points=points)
