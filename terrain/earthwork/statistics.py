"""Statistics of a surface's elevations, weighted by area."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .reference import Surface

__all__ = ["percentiles"]

_FAN_OUT = 32
"""Elevations compared with the share wanted at a time."""


def percentiles(surface: Surface, shares: Sequence[float]) -> NDArray[np.float64]:
    """Return the elevations under which given shares of the area lie.

    Parameters
    ----------
    surface : Surface
    shares : sequence of float
        From 0 to 100.

    Notes
    -----
    Between the elevations of two vertices next to each other the area below is a quadratic
    function of the elevation: those are found by the areas below vertices, then it is solved.
    """
    values = np.unique(surface.points[surface.triangles.ravel(), 2])
    whole = _areas_below(surface, np.array([np.inf]))[0]
    found = [_elevation_at(surface, values, whole * share / 100.0) for share in shares]
    return np.array(found)


def _areas_below(surface: Surface, levels: NDArray[np.float64]) -> NDArray[np.float64]:
    finite = np.minimum(levels, np.finfo(float).max)
    return _kernel.stage_sums(surface.points, surface.triangles, finite, 1.0)[:, 0]


def _elevation_at(surface: Surface, values: NDArray[np.float64], area: float) -> float:
    """Find the lowest elevation at and under which there is so much area."""
    low, high = 0, len(values) - 1
    while high - low > 1:
        trial = np.unique(np.linspace(low, high, _FAN_OUT + 2).astype(np.int64)[1:-1])
        trial = trial[(trial > low) & (trial < high)]
        is_enough = _areas_below(surface, np.nextafter(values[trial], np.inf)) >= area
        first = int(np.argmax(is_enough)) if is_enough.any() else len(trial)
        low = int(trial[first - 1]) if first > 0 else low
        high = int(trial[first]) if first < len(trial) else high
    return _between(surface, float(values[low]), float(values[high]), area)


def _between(surface: Surface, low: float, high: float, area: float) -> float:
    """Solve for the elevation between two between which there is no vertex."""
    after = float(np.nextafter(low, np.inf))
    if after >= high:
        return high if _areas_below(surface, np.array([after]))[0] < area else low
    middle = low + 0.5 * (high - low)
    at_low, at_middle, at_high = _areas_below(surface, np.array([after, middle, high])).tolist()
    if at_low >= area:
        return low
    if at_high <= area:
        return high
    # at_low + t (b + c t), t from 0 to 1
    b = 4.0 * (at_middle - at_low) - (at_high - at_low)
    c = 2.0 * (at_high - at_low) - 4.0 * (at_middle - at_low)
    rest = area - at_low
    t = 2.0 * rest / (b + np.sqrt(max(b * b + 4.0 * c * rest, 0.0)))
    return float(low + min(max(t, 0.0), 1.0) * (high - low))
