"""Statistics of a surface's elevations, weighted by area."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _kernel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array, Int64Array
    from ..surface import Surface

_FAN_OUT = 32
"""Elevations compared with the share wanted at a time."""


def percentiles(surface: Surface, shares: Sequence[float]) -> Float64Array:
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
    wanted = _measure_below(surface, np.array([np.inf]))[0] * np.asarray(shares) / 100.0
    low, high = _enclose(surface, values, wanted)
    pairs = zip(values[low].tolist(), values[high].tolist(), wanted.tolist(), strict=True)
    return np.array([_solve_between(surface, *one) for one in pairs])


def _enclose(
    surface: Surface, values: Float64Array, wanted: Float64Array
) -> tuple[Int64Array, Int64Array]:
    """Find the two of ascending elevations between which areas wanted are reached."""
    low = np.zeros(len(wanted), np.int64)
    high = np.full(len(wanted), len(values) - 1)
    while (high - low > 1).any():
        steps = [
            np.linspace(a, b, _FAN_OUT + 2).astype(np.int64) for a, b in zip(low, high, strict=True)
        ]
        trial = np.unique(np.concatenate([low, high, *steps]))
        below = _measure_below(surface, np.nextafter(values[trial], np.inf))
        for k, area in enumerate(wanted):
            inner = trial[(trial > low[k]) & (trial < high[k])]
            reached = below[np.searchsorted(trial, inner)] >= area
            low[k] = inner[~reached].max(initial=low[k])
            high[k] = inner[reached].min(initial=high[k])
    return low, high


def _measure_below(surface: Surface, levels: Float64Array) -> Float64Array:
    finite = np.minimum(levels, np.finfo(float).max)
    return _kernel.stage_sums(surface.points, surface.triangles, finite, 1.0)[:, 0]


def _solve_between(surface: Surface, low: float, high: float, area: float) -> float:
    """Solve for the elevation between two between which there is no vertex."""
    after = float(np.nextafter(low, np.inf))
    if after >= high:
        return high if _measure_below(surface, np.array([after]))[0] < area else low
    middle = low + 0.5 * (high - low)
    at_low, at_middle, at_high = _measure_below(surface, np.array([after, middle, high])).tolist()
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
