"""Corridors: surfaces much longer than wide, seen from their side and cut into strips."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array
    from ...base.georeference import Ground
    from ...tin import TIN, Bounds
    from .camera import View

_LEAST_ELONGATION = 10.0
"""Length over width from which on a surface is a corridor."""

STRIP_GAP = 34.0
"""Design pixels above each strip, for its label."""

_LEAST_PITCH = 1.5 * STRIP_GAP
"""Design pixels from strip to strip, at least on the mean."""


class Corridor(NamedTuple):
    """A surface within a long and narrow rectangle."""

    azimuth: float
    """Of its axis, degrees clockwise from north, 0 to 180."""
    length: float
    width: float
    """Length and width of the rectangle, on the ground."""

    def find_side(self, azimuth: float) -> float:
        """Return the azimuth to look from at its long side, the nearer one to an azimuth."""
        across = (self.azimuth + 90.0) % 360.0
        turn = (azimuth - across + 180.0) % 360.0 - 180.0
        return across if abs(turn) <= 90.0 else (across + 180.0) % 360.0


class Strips(NamedTuple):
    """Pieces of a picture, from left to right, that are drawn one below the other."""

    edges: Float64Array
    """(k + 1,), where they begin and end along the picture's first axis, lengths of the scene."""
    lows: Float64Array
    highs: Float64Array
    """Both (k,), their range along the second axis."""
    scale: float
    """Design pixels for a length of 1."""

    @property
    def length(self) -> float:
        """Of each strip."""
        return float(self.edges[1] - self.edges[0])


def find_corridor(tin: TIN, ground: Ground) -> Corridor | None:
    """Return the corridor that a surface is, None if it is none.

    The rectangle of least width around the convex hull is found by comparing directions, ever
    nearer to the best.
    """
    hull = tin.points[tin.hull, :2] * ground.scale[:2]
    hull = hull - hull.mean(axis=0)
    best, reach = 0.0, 90.0
    for _ in range(4):
        azimuths = best + np.linspace(-reach, reach, 181)
        turns = np.radians(azimuths)
        widths = np.ptp(hull @ np.array([np.cos(turns), -np.sin(turns)]), axis=0)
        best, reach = float(azimuths[widths.argmin()]), reach / 45.0
    turn = math.radians(best)
    length = float(np.ptp(hull @ (math.sin(turn), math.cos(turn))))
    width = float(widths.min())
    if length < _LEAST_ELONGATION * width:
        return None
    return Corridor(best % 180.0, length, width)


def measure_mean_width(tin: TIN, ground: Ground) -> float:
    """Return how wide the ground is within its boundary: its area over half its perimeter."""
    scale = np.array(ground.scale[:2])
    rings = [tin.points[ring, :2] * scale for ring in tin.rings]
    sides = [np.hypot(*(np.roll(ring, -1, axis=0) - ring).T).sum() for ring in rings]
    return 2.0 * tin.triangulation.area * float(scale.prod()) / float(sum(sides))


def cut_into_strips(points: Float64Array, edges: Int32Array, view: View, frame: Bounds) -> Strips:
    """Cut a picture into as many strips as make it largest; one alone if more would not.

    ``points`` are vertices as drawn, (n, 3), and ``edges`` all edges of the surface, (k, 2);
    ``frame`` is the room for the terrain in design pixels.
    """
    right, up, _ = view.axes
    across, along = points @ right, points @ up
    none = edges[:0]
    most = max(int(frame.height / _LEAST_PITCH), 1)
    tried = [_plan(count, across, along, none, frame) for count in range(1, most + 1)]
    best = max(tried, key=lambda plan: plan.scale)
    return _plan(len(best.lows), across, along, edges, frame)


def _plan(
    count: int,
    across: Float64Array,
    along: Float64Array,
    edges: Int32Array,
    frame: Bounds,
) -> Strips:
    """Measure what is within each strip, where edges are cut too, and how large all can be."""
    cuts = np.linspace(across.min(), across.max(), count + 1)
    strip = np.clip(np.searchsorted(cuts, across, side="right") - 1, 0, count - 1)
    lows, highs = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(lows, strip, along)
    np.maximum.at(highs, strip, along)
    for k, cut in enumerate(cuts[1:-1], start=1):
        met = _meet(cut, across[edges], along[edges])
        for one in (k - 1, k):
            lows[one] = min(lows[one], met.min(initial=np.inf))
            highs[one] = max(highs[one], met.max(initial=-np.inf))
    kept = np.isfinite(lows)  # where there is no ground, a strip stays empty
    lows, highs = np.where(kept, lows, 0.0), np.where(kept, highs, 0.0)
    room = frame.height - STRIP_GAP * count
    scale = frame.width / (cuts[1] - cuts[0])
    total = float((highs - lows).sum())
    return Strips(cuts, lows, highs, min(scale, room / total) if total > 0 else scale)


def _meet(cut: float, across: Float64Array, along: Float64Array) -> Float64Array:
    """Return where edges, (k, 2) ends, cross a line up the picture."""
    is_cut = (across.min(axis=1) < cut) & (across.max(axis=1) > cut)
    (a, b), (low, high) = across[is_cut].T, along[is_cut].T
    met: Float64Array = low + (cut - a) / (b - a) * (high - low)
    return met
