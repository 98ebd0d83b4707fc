"""Stations at which a template is put: so near that lines lie within a tolerance of chords."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import OptionError

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from .axis import Axis
    from .designs import Design

_MOST = 100_000

_EVEN = 4.0
"""By how much a transition's curvature may change faster than if it changed evenly, at most."""


def choose_stations(
    road: Axis,
    design: Design,
    *,
    widest: float,
    far: float,
    tolerance: tuple[float, float],
    interval: float | None,
) -> Float64Array:
    """Return stations between which what is at most as wide lies within tolerances of chords.

    ``far`` is how far side slopes go, ``tolerance`` that in the plane, and that of elevations in
    their unit. The second derivative of a line at an
    offset o along an axis of curvature k is at most k (1 + |o| k) + 2 |o'| k + |o| |k'|, and a
    chord of length s within s² / 8 of it.

    Raises OptionError if these are too many.
    """
    axis, span = road.alignment, road.span
    heights = road.repeat(road.profile.cut_into_chords(tolerance[1] / 2.0))
    parts = [np.array(span), design.changes, heights]
    ends = [*axis.tabulate()["station"].tolist(), axis.end]
    widening = design.find_widening()
    count = 0
    for element, begin, end in zip(axis.elements, ends[:-1], ends[1:], strict=True):
        bent = element.largest_curvature
        rate = _EVEN * abs(element.end_curvature - element.start_curvature) / element.length
        most = bent * (1.0 + widest * bent) + 2.0 * widening * bent + widest * rate
        steps = max(1, math.ceil(element.length * math.sqrt(most / (8.0 * tolerance[0]))))
        count += steps
        _require_few(count, tolerance[0])
        parts.append(np.linspace(begin, end, steps + 1))
    for begin, end, steps in design.count_steps(tolerance[0], far):
        count += steps
        _require_few(count, tolerance[0])
        parts.append(np.linspace(begin, end, steps + 1))
    if interval is not None:
        if (span[1] - span[0]) / interval > _MOST:
            raise OptionError("interval", interval, f"one that makes at most {_MOST:,} sections")
        low, high = road.lap or span
        first, last = math.ceil(low / interval), math.floor(high / interval)
        multiples = np.asarray(np.arange(first, last + 1) * interval, np.float64)
        parts.append(road.repeat(multiples))
    return _join_near(np.unique(np.concatenate(parts)), ends, span, axis.rounding)


def _require_few(count: int, tolerance: float) -> None:
    if count > _MOST:
        allowed = f"one for which at most {_MOST:,} sections are made"
        raise OptionError("tolerance", tolerance, allowed)


def _join_near(
    stations: Float64Array, joints: list[float], span: tuple[float, float], near: float
) -> Float64Array:
    """Leave out stations beyond the span, and those that roundings set apart from a joint."""
    fixed = np.array([*span, *(one for one in joints if span[0] < one < span[1])])
    within = stations[(stations > span[0]) & (stations < span[1])]
    apart = np.abs(within[:, None] - fixed).min(axis=1) > near
    joined = np.union1d(fixed, within[apart])
    kept: Float64Array = joined[np.append(True, np.diff(joined) > near)]
    return kept
