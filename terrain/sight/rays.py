"""Rays: straight lines between places above a surface, and where the ground is above them."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import as_flag, as_number
from ...base.errors import CrsError, OptionError
from ..surface import Segments, trace_breaks

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...tin import TIN
    from ..surface import Breaks, Reference

EARTH_RADIUS = 6_371_000.0
"""Metres; the mean radius of the earth."""
REFRACTION = 0.13
"""Usual coefficient of refraction, Gauss's, if it is asked for without a number."""

_ROUNDING = 32 * 2.0**-53
"""Relative error of a height above a ray, as doubles have it."""


class Rays(NamedTuple):
    """Rays from eyes to targets, (k, 3) each, apart in the plane."""

    eyes: Float64Array
    targets: Float64Array


class Blocks(NamedTuple):
    """What stands in the way of rays."""

    is_blocked: BoolArray
    """(k,)."""
    ratios: Float64Array
    """(k,), share of the way after which the ray first goes into the ground; NaN if it does not."""
    clearances: Float64Array
    """(k,), least height of the ray above ground between its ends, at edges and vertices; negative
    if it is blocked, NaN where it crosses none.
    """
    leaves: BoolArray
    """(k,), whether it passes over places without surface."""


def find_curvature(reference: Reference, curvature: Any, refraction: Any) -> float:
    """Return by how much the earth falls away at a distance of 1, in the unit of elevations.

    Raises CrsError if curvature is asked for and the lengths of units are not known.
    """
    if not as_flag("curvature", curvature):
        if refraction is not None:
            raise OptionError("refraction", refraction, allowed="None without curvature")
        return 0.0
    coefficient = REFRACTION if refraction is None else refraction
    coefficient = as_number("refraction", coefficient, "a coefficient", least=-1, most=1)
    metres = None if reference.crs is None else reference.crs.horizontal_unit.metres
    if metres is None:
        raise CrsError(
            "The curvature of the earth needs lengths in a known unit: give the CRS of the TIN.",
            crs=reference.crs,
        )
    return (1.0 - float(coefficient)) * metres / (2.0 * EARTH_RADIUS) / reference.up


def find_blocks(tin: TIN, rays: Rays, fall: float) -> Blocks:
    """Find where the ground is above rays.

    ``fall`` is that of the earth at a distance of 1, 0 for a plane. Between two edges the ground is
    straight, and so is the ray: it is enough to compare them where it crosses edges and vertices.
    Where doubles cannot tell, fractions do; what only touches the ray does not block it. Over a
    curved earth the ground bulges between edges, too: the highest place of each bulge is found in
    closed form, in doubles.
    """
    starts, ends = (np.ascontiguousarray(end[:, :2]) for end in rays)
    lengths = np.hypot(*(ends - starts).T)
    segments = Segments(starts, ends, np.zeros(len(starts)), lengths, np.arange(len(starts)))
    breaks = trace_breaks(tin, segments)
    owner = breaks.segments
    heights = _measure_heights(breaks, rays, fall)
    if fall == 0.0:
        heights = _make_sure(tin, breaks, rays, heights)
    inner = (breaks.ratios > 0.0) & (breaks.ratios < 1.0) & ~np.isnan(heights)
    above = inner & (heights > 0.0)
    entries = _find_entries(breaks, heights, above)
    if fall != 0.0:
        entries = np.fmin(entries, _find_bulges(breaks, rays, heights, fall))
    count = len(rays.eyes)
    ratios, clearances = np.full(count, np.inf), np.full(count, np.inf)
    np.fmin.at(ratios, owner, entries)
    np.fmin.at(clearances, owner, np.where(inner, -heights, np.inf))
    is_gap = (breaks.triangles < 0) & (breaks.ratios < 1.0)
    return Blocks(
        np.isfinite(ratios),
        np.where(np.isfinite(ratios), ratios, np.nan),
        np.where(np.isfinite(clearances), clearances, np.nan),
        np.bincount(owner, is_gap, minlength=count) > 0,
    )


def _measure_heights(breaks: Breaks, rays: Rays, fall: float) -> Float64Array:
    """Return the height of the ground above the ray at each break, rounded."""
    eye, target = (end[breaks.segments] for end in rays)
    square = ((target - eye)[:, :2] ** 2).sum(axis=1)
    share = breaks.ratios
    level = eye[:, 2] + share * (target[:, 2] - eye[:, 2])
    # The earth falls as the square of the distance; a straight line from end to end, by chords.
    bulge: Float64Array = fall * square * share * (1.0 - share)
    heights: Float64Array = breaks.elevations - level + bulge
    at_end = (share <= 0.0) | (share >= 1.0)  # on or above the ground, but for rounding
    return np.where(at_end, np.minimum(heights, 0.0), heights)


def _make_sure(tin: TIN, breaks: Breaks, rays: Rays, heights: Float64Array) -> Float64Array:
    """Return heights with the exact sign, and 0 where the ray touches."""
    eye, target = (end[breaks.segments, 2] for end in rays)
    size = np.maximum(np.maximum(np.abs(eye), np.abs(target)), np.abs(breaks.elevations))
    known = (breaks.vertices >= 0) | (breaks.edges >= 0)
    for row in np.flatnonzero((np.abs(heights) <= _ROUNDING * size) & known).tolist():
        heights[row] = float(_measure_exactly(tin, breaks, rays, row))
    return heights


def _measure_exactly(tin: TIN, breaks: Breaks, rays: Rays, row: int) -> Fraction:
    """Return the height of the ground above the ray where it crosses an edge or a vertex."""
    number = int(breaks.segments[row])
    eye, target = ([Fraction(value) for value in end[number].tolist()] for end in rays)
    if breaks.vertices[row] >= 0:
        place = [Fraction(value) for value in tin.points[breaks.vertices[row]].tolist()]
        axis = 0 if eye[0] != target[0] else 1
        share = (place[axis] - eye[axis]) / (target[axis] - eye[axis])
        ground = place[2]
    else:
        triangle, corner = divmod(int(breaks.edges[row]), 3)
        ends = (tin.triangles[triangle, (corner + turn) % 3] for turn in (1, 2))
        p, q = ([Fraction(value) for value in tin.points[end].tolist()] for end in ends)
        share = _divide(p, q, eye, target)
        ground = p[2] + _divide(eye, target, p, q) * (q[2] - p[2])
    return ground - (eye[2] + share * (target[2] - eye[2]))


def _divide(a: list[Fraction], b: list[Fraction], p: list[Fraction], q: list[Fraction]) -> Fraction:
    """Return the share of the way from p to q where it crosses the line through a and b."""
    at_p, at_q = (
        (b[0] - a[0]) * (end[1] - a[1]) - (b[1] - a[1]) * (end[0] - a[0]) for end in (p, q)
    )
    return at_p / (at_p - at_q) if at_p != at_q else Fraction(0)


# ---------------------------------------------------------------- where a ray goes in


def _find_entries(breaks: Breaks, heights: Float64Array, above: BoolArray) -> Float64Array:
    """Return for breaks above the ray the share of the way at which it goes in before them."""
    entries = np.full(len(heights), np.inf)
    rows = np.flatnonzero(above)
    low, high = np.minimum(heights[rows - 1], 0.0), heights[rows]
    before, after = breaks.ratios[rows - 1], breaks.ratios[rows]
    found = before + (after - before) * (-low / (high - low))
    entries[rows] = np.where(np.isnan(found), after, found)
    return entries


def _find_bulges(breaks: Breaks, rays: Rays, heights: Float64Array, fall: float) -> Float64Array:
    """Return where rays go into ground that bulges between two breaks, both of them below."""
    entries = np.full(len(heights), np.inf)
    same = (np.diff(breaks.segments) == 0) & (breaks.triangles[:-1] >= 0)
    rows = np.flatnonzero(same & (heights[:-1] <= 0.0) & (heights[1:] <= 0.0))
    low, high = heights[rows], heights[rows + 1]
    eye, target = (end[breaks.segments[rows], :2] for end in rays)
    step = breaks.ratios[rows + 1] - breaks.ratios[rows]
    bend = fall * ((target - eye) ** 2).sum(axis=1) * step**2
    with np.errstate(divide="ignore", invalid="ignore"):
        top = 0.5 + (high - low) / (2.0 * bend)
        highest = low + top * (high - low) + bend * top * (1.0 - top)
        half = np.sqrt(highest / bend)
    pierced = (top > 0.0) & (top < 1.0) & (highest > 0.0)
    entries[rows[pierced]] = (breaks.ratios[rows] + step * (top - half))[pierced]
    return entries
