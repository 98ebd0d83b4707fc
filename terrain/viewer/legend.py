"""Legend: the range of elevations that a picture shows, and what its colours tell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..drawing import choose_ramp
from ..surface import compute_normals, measure_aspects, measure_slopes

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, UInt8Array
    from ...base.policies import Tint
    from ...tin import TIN

_LEAST_POINTS = 20
"""Of fewer points none is said to be far off the others."""

_MOST_SHARE = 0.01
"""Share of the points, at either end, that may be far off."""

_GAP = 4.0
"""Ranges of the others that a point lies beyond them, at least, to be far off."""

STEEPEST = 60.0
"""Slope, degrees, from which on the colour is the same."""


class ElevationRange(NamedTuple):
    """The range of elevations that a picture shows."""

    low: float
    high: float
    """Lowest and highest elevation but for those far off."""
    is_far_off: BoolArray
    """(n,), which points are left out."""


def find_elevation_range(elevations: Float64Array, extent: float) -> ElevationRange:
    """Find the range of elevations, without a blunder that would hide all relief.

    Left out are at most one point in a hundred at either end (one of 20 to 100 points), if they lie
    further beyond the next one than four times the range of all between the ends. ``extent`` is the
    greatest in the plane, in the unit of the elevations: how far off a point is if all others are
    level.

    Examples
    --------
    >>> range_ = find_elevation_range(np.append(np.linspace(310.0, 320.0, 99), 9999.0), 250.0)
    >>> range_.low, range_.high, range_.is_far_off.sum()
    (310.0, 320.0, np.int64(1))
    """
    count = len(elevations)
    ordered = np.sort(elevations)
    first, last = 0, count - 1
    if count >= _LEAST_POINTS:
        tail = max(1, int(_MOST_SHARE * count))
        core = float(ordered[-1 - tail] - ordered[tail])
        gap = _GAP * core if core > 0 else extent
        last = count - 1 - _count_beyond(np.diff(ordered[-1 - tail :]), gap)
        first = _count_beyond(np.diff(ordered[: tail + 1])[::-1], gap)
    low, high = float(ordered[first]), float(ordered[last])
    return ElevationRange(low, high, (elevations < low) | (elevations > high))


def _count_beyond(steps: Float64Array, gap: float) -> int:
    """Return how many of the outermost points lie beyond the first step outwards above a gap."""
    is_wide = steps > gap
    return len(steps) - int(is_wide.argmax()) if is_wide.any() else 0


class Legend(NamedTuple):
    """What a ramp of colours tells."""

    name: str
    colors: UInt8Array
    """(k, 3)."""
    ends: tuple[float, float]
    """Values of the first and the last colour."""
    ticks: tuple[tuple[float, str], ...] = ()
    """Values and words below the ramp; none for round numbers."""


def measure_tint(
    tin: TIN, tint: Tint, elevations: tuple[float, float], unit: str
) -> tuple[Float64Array | None, Legend | None]:
    """Return what is to be coloured, and its legend; None both for a plain surface.

    Coloured are elevations of vertices, (n,), or slopes or aspects of triangles, (m,), in degrees,
    NaN where level. ``elevations`` are those of the lowest and the highest tint; ``unit`` is
    theirs, as it stands behind their name, "" if it is not known.
    """
    if tint == "plain":
        return None, None
    ramp = choose_ramp(tint, 100)
    if tint == "slope":
        ticks: Any = ((0.0, "0"), (15.0, "15"), (30.0, "30"), (45.0, "45"), (STEEPEST, "60+"))
        return measure_slopes(compute_normals(tin), "degrees"), Legend(
            "Slope (degrees)", ramp, (0.0, STEEPEST), ticks
        )
    if tint == "aspect":
        ticks = tuple(zip((0.0, 90.0, 180.0, 270.0, 360.0), "NESWN", strict=True))
        return measure_aspects(compute_normals(tin)), Legend(
            "Aspect: facing", ramp, (0.0, 360.0), ticks
        )
    name = f"Elevation ({unit or 'unit not known'})"
    return tin.points[:, 2], Legend(name, ramp, elevations)
