"""Places on a surface, from what a caller gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import PointsError
from ...base.georeference import require_same_crs
from ...base.results import Features
from ...base.sentences import counted
from ...tin import validation
from ...tin.building import find_crs

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...tin import TIN


def as_places(tin: TIN, points: Any, what: str) -> tuple[Float64Array, tuple[str, ...]]:
    """Return places on a surface, (k, 2), and what was assumed of them.

    They are one place or several, as arrays, shapes, data frames or Features.

    Raises CrsError if their CRS is another one. Raises PointsError if there is none, or one lies
    outside the surface.
    """
    is_named = isinstance(points, Features)
    if is_named and points.kind != "points":
        raise PointsError(f"Points are needed for {what}, and there are {points.kind}.")
    notes = require_same_crs(find_crs(points), tin.crs, what, is_plain=not is_named)
    if is_named:
        notes += tuple(points.notes)
        points = points.coordinates[:, :2]
    xy = validation.as_places(points)[0] + 0.0
    if len(xy) == 0:
        raise PointsError(f"There is no point for {what}: at least one is needed.")
    outside = np.flatnonzero(tin.locate(xy) < 0)
    if len(outside):
        first = int(outside[0])
        raise PointsError(
            f"{len(outside):,} of {counted(len(xy), 'point')} for {what} "
            f"{'lies' if len(outside) == 1 else 'lie'} outside the surface (first: number {first}, "
            f"at {tuple(xy[first].tolist())}).",
            rows=outside[:5],
        )
    return xy, notes
