"""Relief: the range of elevations that a picture shows, and how much it is exaggerated."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...base.georeference import Ground
    from ...tin import TIN

_LEAST_POINTS = 20
"""Of fewer points none is said to be far off the others."""

_MOST_SHARE = 0.01
"""Share of the points, at either end, that may be far off."""

_GAP = 4.0
"""Ranges of the others that a point lies beyond them, at least, to be far off."""

RELIEF_SHARE = 0.1
"""Least share of the extent that the relief takes in a picture; below, heights are exaggerated."""

_EXAGGERATIONS = (1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0)


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


def choose_exaggeration(tin: TIN, ground: Ground, shown: ElevationRange) -> float:
    """Choose a round vertical exaggeration that shows the relief.

    It is the smallest of 1, 1.5, 2, 3, 5, 10, 15, ... 100 that lifts the relief to a tenth of the
    extent (and so to at most a fifth, if 1 is not enough); 1 for level ground. Elevations far off
    the others do not count.
    """
    relief = (shown.high - shown.low) * ground.scale[2]
    return round_exaggeration(RELIEF_SHARE * measure_extent(tin, ground), relief)


def round_exaggeration(wanted: float, relief: float) -> float:
    """Return the smallest round exaggeration that makes a relief as high as is wanted."""
    if relief == 0:
        return 1.0
    factors = (factor for factor in _EXAGGERATIONS if factor * relief >= wanted)
    return next(factors, _EXAGGERATIONS[-1])


def measure_relief(tin: TIN, ground: Ground) -> ElevationRange:
    """Return the range of a TIN's elevations, without those that are far off the others."""
    extent = measure_extent(tin, ground) / ground.scale[2]
    return find_elevation_range(tin.points[:, 2], extent)


def measure_extent(tin: TIN, ground: Ground) -> float:
    """Return the greater of a TIN's extents to the east and to the north, on the ground."""
    return float((np.ptp(tin.points[:, :2], axis=0) * ground.scale[:2]).max())
