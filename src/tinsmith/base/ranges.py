"""Ranges of coordinates: longitudes and latitudes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .crs import measure_angular_unit
from .errors import PointsError
from .sentences import counted, inflect

if TYPE_CHECKING:
    from .arrays import AnyArray
    from .crs import CRS

_LONGITUDES = (-180.0, 360.0)
"""Degrees: from the antimeridian, or from Greenwich eastwards."""

_LATITUDES = (-90.0, 90.0)
_ROUNDING = 1e-12
"""Of a limit: an angle of another unit is rounded when it is made and when it is converted."""

_HALF_TURN = 180.0
_SHOWN = 5


def require_degrees(xy: AnyArray, crs: CRS | None, what: str) -> None:
    """Refuse what is no longitude and latitude where a CRS says so; NaN passes.

    Longitudes are from -180 to 360 degrees, so counted from the antimeridian or from Greenwich.
    ``what`` is in the plural: the sentence begins with it. Raises PointsError with the first row.
    """
    degrees = measure_angular_unit(crs)
    if crs is None or degrees is None or len(xy) == 0:
        return
    limits = np.array([_LONGITUDES, _LATITUDES]) / degrees
    slack = np.abs(limits) * _ROUNDING
    low, high = limits[:, 0] - slack[:, 0], limits[:, 1] + slack[:, 1]
    rows = np.flatnonzero(((xy[:, :2] < low) | (xy[:, :2] > high)).any(axis=1))
    if len(rows) == 0:
        return
    x, y = xy[rows[0], :2].tolist()
    (west, east), (south, north) = limits.tolist()
    raise PointsError(
        f"{what} have {counted(len(rows), 'row')} that {inflect('[is|are]', len(rows))} no "
        f"longitude and latitude, which {crs.label} says they are (first: row {rows[0]}, longitude "
        f"{x:.10g}, latitude {y:.10g}): longitudes from {west:.10g} to {east:.10g} and latitudes "
        f"from {south:.10g} to {north:.10g} are allowed; for eastings and northings another CRS is "
        "needed.",
        rows=rows[:_SHOWN],
    )


def describe_span(xy: AnyArray, crs: CRS | None, what: str) -> list[str]:
    """Refuse points that lie on both sides of the antimeridian; tell of more than a half turn.

    If some meridian interval of more than 180 degrees between the westernmost and the easternmost
    point is empty, then the points all lie within less than 180 degrees across the antimeridian,
    and triangles would join them the long way round. If none is that wide, they may go round the
    globe, and only the caller knows.
    """
    degrees = measure_angular_unit(crs)
    if crs is None or degrees is None or len(xy) == 0:
        return []
    longitudes = xy[:, 0][np.isfinite(xy[:, 0])] * degrees
    width = float(np.ptp(longitudes)) if len(longitudes) else 0.0
    if width <= _HALF_TURN:
        return []
    ordered = np.sort(longitudes)
    widest = int(np.argmax(np.diff(ordered)))
    west, east = ordered[widest] / degrees, ordered[widest + 1] / degrees
    if ordered[widest + 1] - ordered[widest] > _HALF_TURN:
        raise PointsError(
            f"{what} lie on both sides of the antimeridian: none has a longitude between "
            f"{west:.10g} and {east:.10g}, and triangles would span these. Add "
            f"{360.0 / degrees:.10g} to the longitudes below, or reproject them to a CRS of the "
            "region."
        )
    return [
        f"{what} span {width:.10g} degrees of longitude: triangles join them from west to east, "
        "not across the antimeridian."
    ]
