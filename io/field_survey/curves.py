"""Curves through shots: arcs that are densified until no chord leaves them by a tolerance.

The curve through three shots is their circle. Through more it is a chain of arcs that passes
through every shot and has no corner: the tangent at a shot is that of the circle through it and its
neighbours, and two arcs that meet in a common tangent (a biarc) join two shots. Where the shots lie
on one circle the chain is this circle. Between two shots alone the arc leaves the first one in the
direction of the leg before it, or reaches the second in that of the leg behind it.

References: K. M. Bolton, Biarc curves, Computer-Aided Design 7 (1975),
https://doi.org/10.1016/0010-4485(75)90086-X.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ...base.arrays import Float64Array

MOST_VERTICES = 10_000
"""Vertices of one arc that are made at most."""

_STRAIGHT = 1e-9
"""Radians between tangent and chord below which an arc is its chord: a rise of a quarter of a
nanometre in each metre of it."""


class Arc(NamedTuple):
    """An arc of a circle, or its chord."""

    start: Float64Array
    end: Float64Array
    """Both (2,)."""
    angle: float
    """From the tangent at the start to the chord, counter-clockwise; half of what the arc turns."""

    @property
    def length(self) -> float:
        """Length along the arc."""
        chord = float(np.hypot(*(self.end - self.start)))
        return chord if self.is_straight else chord * self.angle / math.sin(self.angle)

    @property
    def is_straight(self) -> bool:
        """Whether it is no more than its chord."""
        return abs(self.angle) < _STRAIGHT

    def count_chords(self, tolerance: float) -> int:
        """Return how many equal chords leave the arc by no more than the tolerance."""
        if self.is_straight:
            return 1
        chord = float(np.hypot(*(self.end - self.start)))
        radius = chord / (2.0 * abs(math.sin(self.angle)))
        if tolerance >= 2.0 * radius:
            step = math.pi
        else:  # the rise of a chord that turns by 2 a is r (1 - cos a) = 2 r sin^2 (a / 2)
            step = 2.0 * math.asin(math.sqrt(tolerance / (2.0 * radius)))
        return max(1, math.ceil(abs(self.angle) / step - 1e-9))

    def interpolate(self, shares: Float64Array) -> Float64Array:
        """Return points at shares of the length, (k, 2)."""
        chord = self.end - self.start
        if self.is_straight:
            straight: Float64Array = self.start + shares[:, None] * chord
            return straight
        turn = self.angle * (shares - 1.0)  # of the direction from the start, seen from the chord
        reach = np.sin(self.angle * shares) / math.sin(self.angle)
        cos, sin = reach * np.cos(turn), reach * np.sin(turn)
        bent: Float64Array = self.start + np.column_stack(
            [cos * chord[0] - sin * chord[1], sin * chord[0] + cos * chord[1]]
        )
        return bent


def fit_arcs(points: Float64Array) -> list[list[Arc]]:
    """Fit arcs to three or more points in the plane, none of them twice in succession.

    Parameters
    ----------
    points : (k, 2) float64 array

    Returns
    -------
    list of list of Arc
        Those from each point to the next: one or two.
    """
    steps = np.diff(points, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    chords = steps / lengths[:, None]
    inner = chords[:-1] / lengths[:-1, None] + chords[1:] / lengths[1:, None]
    norms = np.hypot(inner[:, 0], inner[:, 1])
    is_fold = norms == 0  # the line comes back on itself: there is no circle
    norms[is_fold] = 1.0
    inner = np.where(is_fold[:, None], chords[1:], inner / norms[:, None])
    first, last = _reflect(inner[0], chords[0]), _reflect(inner[-1], chords[-1])
    tangents = np.vstack([first, inner, last])
    return [
        _join_by_biarc(points[i], points[i + 1], tangents[i], tangents[i + 1])
        for i in range(len(steps))
    ]


def fit_tangent_arc(start: Float64Array, end: Float64Array, direction: Float64Array) -> Arc:
    """Fit the arc that leaves a point in a direction and reaches another one."""
    return Arc(start, end, measure_turn(direction, end - start))


def _reflect(tangent: Float64Array, chord: Float64Array) -> Float64Array:
    """Return the tangent at the other end of an arc."""
    mirrored: Float64Array = 2.0 * float(tangent @ chord) * chord - tangent
    return mirrored


def measure_turn(from_: Float64Array, to: Float64Array) -> float:
    """Return the angle from one direction to another, -pi to pi."""
    return math.atan2(from_[0] * to[1] - from_[1] * to[0], float(from_ @ to))


def _join_by_biarc(
    start: Float64Array,
    end: Float64Array,
    leaving: Float64Array,
    arriving: Float64Array,
) -> list[Arc]:
    """Join two points by two arcs of equal tangent lengths, or by one where one does."""
    chord = end - start
    both = leaving + arriving
    along, squared = float(chord @ both), float(chord @ chord)
    spread = 2.0 * (1.0 - float(leaving @ arriving))
    reach = along + math.sqrt(along * along + spread * squared)
    if reach <= 0.0:  # the tangents point away from each other
        return [Arc(start, end, 0.0)]
    length = squared / reach
    joint = (start + end + length * (leaving - arriving)) / 2.0
    one = Arc(start, joint, measure_turn(leaving, joint - start))
    other = Arc(joint, end, measure_turn(end - joint, arriving))
    return [one, other]


def densify(arcs: list[Arc], heights: tuple[float, float], tolerance: float) -> Float64Array:
    """Return the vertices between the ends of a chain of arcs.

    Parameters
    ----------
    arcs : list of Arc
        From one shot to the next.
    heights : tuple of float
        Elevations of both; between them they change evenly along the arcs.
    tolerance : float
        By which a chord may leave its arc.

    Returns
    -------
    (k, 3) float64 array
    """
    counts = [min(arc.count_chords(tolerance), MOST_VERTICES + 1) for arc in arcs]
    if max(counts) == 1 and _is_within(arcs, tolerance):
        return np.empty((0, 3))
    lengths = np.array([arc.length for arc in arcs])
    starts = np.append(0.0, np.cumsum(lengths))
    total = starts[-1]
    rows: list[Float64Array] = []
    for arc, begun, length, count in zip(arcs, starts[:-1], lengths, counts, strict=True):
        shares = np.arange(1, count + 1) / count
        share = (begun + shares * length) / total
        z = heights[0] + share * (heights[1] - heights[0])
        rows.append(np.column_stack([arc.interpolate(shares), z]))
    return np.vstack(rows)[:-1]


def _is_within(arcs: list[Arc], tolerance: float) -> bool:
    """Whether the place where two arcs meet lies on the chord over both, within the tolerance."""
    start, end = arcs[0].start, arcs[-1].end
    chord, to_joint = end - start, arcs[0].end - start
    return abs(float(chord[0] * to_joint[1] - chord[1] * to_joint[0])) <= tolerance * float(
        np.hypot(*chord)
    )
