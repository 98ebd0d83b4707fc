"""Segments along the boundary of a surface, which rounding has put beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...tin.topology import NO_NEIGHBOR
from ..surface import Breaks, Segments, find_rounding, find_written_rounding, trace_breaks

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array, Int64Array
    from ...tin import TIN

_ASIDE = 2.0
"""Roundings: that of the boundary and that of the segment."""
_FINEST = 1e-5
"""Share of the extent that a rounding may be: else surfaces and roundings are of one size."""
_GAINED = 100.0
"""Roundings: a segment that crosses the boundary at an angle gains less."""


def trace_to_rim(tin: TIN, segments: Segments, *, is_computed: bool = False) -> Breaks:
    """Follow segments over a TIN as :func:`trace_breaks`, but along its boundary within rounding.

    A segment that was meant to lie on the boundary runs in and out of the surface, as coordinates
    are rounded. So a segment that has gaps is followed to the left and to the right of itself, by
    twice the rounding of the coordinates of the boundary; where it then has much more of the
    surface, it gets what was found there. An end within four times the rounding of the boundary has
    the elevation there. Segments that are ``is_computed`` have been rounded themselves; of others
    nothing is assumed where the boundary has no decimals that tell its rounding.
    """
    breaks = trace_breaks(tin, segments)
    is_gap = _find_gaps(breaks)
    if not is_gap.any() or len(tin.triangles) == 0:
        return breaks
    rim = tin.points[np.concatenate(tin.rings), :2]
    rounding = find_rounding(rim) if is_computed else find_written_rounding(rim)
    if not _is_fine(rounding, rim):
        return breaks
    chosen = np.unique(breaks.segments[is_gap])
    lengths = np.hypot(*(segments.ends - segments.starts)[chosen].T)
    chosen = chosen[lengths > _GAINED * rounding]
    breaks = _take_better(tin, segments, breaks, chosen, rounding)
    return _close_short_gaps(breaks, 2.0 * _ASIDE * rounding)


def _is_fine(rounding: float, rim: Float64Array) -> bool:
    return 0.0 < rounding <= _FINEST * float(np.ptp(rim, axis=0).max())


def move_aside(segments: Segments, rim: Float64Array) -> list[Segments]:
    """Return segments where :func:`trace_to_rim` may follow them beside a boundary, (k, 2)."""
    moved = []
    for rounding in {find_rounding(rim), find_written_rounding(rim)}:
        if _is_fine(rounding, rim):
            side = _find_side(segments, rounding)
            moved += [
                segments._replace(starts=segments.starts + shift, ends=segments.ends + shift)
                for shift in (side, -side)
            ]
    return moved


def _find_side(segments: Segments, rounding: float) -> Float64Array:
    """Return how far segments are moved to be followed beside themselves, the one way."""
    side: Float64Array = segments.directions[:, ::-1] * (-1.0, 1.0) * (_ASIDE * rounding)
    is_back = (side[:, 0] < 0.0) | ((side[:, 0] == 0.0) & (side[:, 1] < 0.0))
    side[is_back] *= -1.0  # the same for the segment in reverse
    return side


def _find_gaps(breaks: Breaks) -> BoolArray:
    """Tell from which breaks to the next one there is no surface."""
    goes_on = np.append(breaks.segments[1:] == breaks.segments[:-1], False)
    is_gap: BoolArray = goes_on & (breaks.triangles == NO_NEIGHBOR)
    return is_gap


def _take_better(
    tin: TIN, segments: Segments, breaks: Breaks, chosen: Int64Array, rounding: float
) -> Breaks:
    """Replace breaks of chosen segments where there is much more surface beside them."""
    own = Segments._make(array[chosen] for array in segments)
    side = _find_side(own, rounding)
    most = _measure_covered(breaks, segments)[chosen] + _GAINED * rounding
    for shift in (side, -side):
        moved = own._replace(starts=own.starts + shift, ends=own.ends + shift)
        found = trace_breaks(tin, moved)
        covered = _measure_covered(found, own)
        better = np.flatnonzero(covered > most)
        if len(better):
            most[better] = covered[better]
            found = _thin(_move_back(found, own, shift), _ASIDE * rounding)
            breaks = _replace(breaks, found, chosen, better)
    return breaks


def _measure_covered(breaks: Breaks, segments: Segments) -> Float64Array:
    """Return the length of each segment over the surface."""
    lengths = np.hypot(*(segments.ends - segments.starts).T)
    steps = np.append(np.diff(breaks.ratios), 0.0) * lengths[breaks.segments]
    goes_on = np.append(breaks.segments[1:] == breaks.segments[:-1], False)
    counted = goes_on & (breaks.triangles != NO_NEIGHBOR)
    covered: Float64Array = np.zeros(len(lengths))
    np.add.at(covered, breaks.segments[counted], steps[counted])
    return covered


def _move_back(found: Breaks, own: Segments, shift: Float64Array) -> Breaks:
    """Put breaks from beside segments on them, those at the ends exactly."""
    at = found.segments
    xy = found.xy - shift[at]
    xy = np.where((found.ratios == 0.0)[:, None], own.starts[at], xy)
    xy = np.where((found.ratios == 1.0)[:, None], own.ends[at], xy)
    return found._replace(xy=xy)


def _thin(found: Breaks, least: float) -> Breaks:
    """Make one of the breaks that follow each other closely: at a vertex all its edges meet."""
    begins = np.append(True, found.segments[1:] != found.segments[:-1])
    ends = np.append(begins[1:], True)
    steps = np.hypot(*np.diff(found.xy, axis=0, prepend=found.xy[:1]).T)
    has = ~np.isnan(found.elevations)
    near = ~begins & (steps <= least) & has & np.append(False, has[:-1])
    keep = ~near | ends
    keep[:-1] &= ~(ends[1:] & near[1:]) | begins[:-1]  # the end stays in place of those before it
    last = np.append(np.flatnonzero(keep)[1:], len(keep)) - 1
    triangles = found.triangles[last]
    kept = Breaks._make(array[keep] for array in found)
    return kept._replace(triangles=triangles.astype(np.int32))


def _replace(breaks: Breaks, found: Breaks, chosen: Int64Array, better: Int64Array) -> Breaks:
    """Return breaks with those of some segments taken from others, numbered within ``chosen``."""
    stays = ~np.isin(breaks.segments, chosen[better])
    comes = np.isin(found.segments, better)
    found = found._replace(segments=chosen[found.segments])
    both: Any = zip(breaks, found, strict=True)
    joined = [np.concatenate([old[stays], new[comes]]) for old, new in both]
    order = np.argsort(
        np.concatenate([breaks.segments[stays], found.segments[comes]]), kind="stable"
    )
    return Breaks._make(array[order] for array in joined)


def _close_short_gaps(breaks: Breaks, longest: float) -> Breaks:
    """Give the ends of segments that lie close to the boundary its elevation."""
    steps = np.append(np.hypot(*np.diff(breaks.xy, axis=0).T), 0.0)
    short = np.flatnonzero(_find_gaps(breaks) & (steps <= longest))
    elevations, triangles = breaks.elevations.copy(), breaks.triangles.copy()
    has = ~np.isnan(elevations)
    for at in short.tolist():
        if (
            has[at]
            and not has[at + 1]
            and at > 0
            and breaks.segments[at - 1] == breaks.segments[at]
        ):
            elevations[at + 1], triangles[at] = elevations[at], triangles[at - 1]
        elif has[at + 1] and not has[at] and triangles[at + 1] != NO_NEIGHBOR:
            elevations[at], triangles[at] = elevations[at + 1], triangles[at + 1]
    return breaks._replace(elevations=elevations, triangles=triangles)
