"""Figures become polylines: shots joined by legs and curves, rings closed, corners added."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import LinesError
from .curves import MOST_VERTICES, Arc, densify, fit_arcs, fit_tangent_arc, measure_turn
from .figures import Curve, Fault, find_curves

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...base.arrays import Float64Array
    from .figures import Figure

_MOST_TURN = 0.75 * math.pi
"""Half of what an arc between two shots may turn at most: beyond, the leg points away from it."""
_KINK = math.radians(10.0)
"""A corner between a tangent curve and its leg, and one of a rectangle that is told."""
_SQUARE = math.radians(5.0)


def build_polyline(
    figure: Figure,
    points: Float64Array,
    tolerance: float,
    note: Callable[[Fault], None],
) -> Float64Array:
    """Return the vertices of a figure; those of a ring without the first one at its end.

    Parameters
    ----------
    figure : Figure
    points : (n, 3) float64 array
        All points of the survey.
    tolerance : float
        By which chords may leave arcs, CRS units.
    note : callable
        Is told what is odd.

    Raises
    ------
    LinesError
        If an arc would need too many vertices.
    """
    curves = find_curves(figure)
    kept = _drop_repeated(figure, points, curves, note)
    all_rows = figure.rows
    rows = [all_rows[i] for i in kept]
    shots = points[rows]
    line = _Line(figure, shots, rows, note)
    for curve in curves:
        line.bend(*_find_span(curve, kept), is_tangent=curve.is_tangent)
    vertices = line.join(tolerance)
    figure.n_added = len(vertices) - len(shots)
    if figure.is_rectangle:
        vertices = np.vstack([vertices, *_find_corner(figure, shots, note)])
    is_back = len(vertices) > 1 and (vertices[0] == vertices[-1]).all()
    return vertices[:-1] if figure.is_ring and is_back else vertices


def _drop_repeated(
    figure: Figure,
    points: Float64Array,
    curves: Sequence[Curve],
    note: Callable[[Fault], None],
) -> list[int]:
    """Return the shots of a figure but those at the place of the one before."""
    rows = figure.rows
    xy = points[rows, :2]
    if not (xy[1:] == xy[:-1]).all(axis=1).any():
        return list(range(len(rows)))
    kept: list[int] = []
    for i, row in enumerate(rows):
        if not kept:
            kept.append(i)
            continue
        is_in_curve = any(curve.first < i <= curve.last for curve in curves)
        before = points[rows[kept[-1]]]
        same = before[:2] == points[row, :2]
        if same.all() and (is_in_curve or before[2] == points[row, 2]):
            note(Fault("repeated point", figure.name, (rows[kept[-1]], row)))
        else:
            kept.append(i)
    return kept


def _find_span(curve: Curve, kept: Sequence[int]) -> tuple[int, int]:
    """Return the places of a curve's first and last shot among those kept."""
    last = len(kept) - 1
    first_place = sum(i <= curve.first for i in kept) - 1
    return first_place, min(sum(i <= curve.last for i in kept) - 1, last)


@dataclass(eq=False)
class _Line:
    """Shots, and the arcs between them."""

    figure: Figure
    shots: Float64Array
    rows: list[int]
    note: Callable[[Fault], None]

    def __post_init__(self) -> None:
        self.arcs: dict[int, list[Arc]] = {}

    def bend(self, first: int, last: int, *, is_tangent: bool) -> None:
        """Lay a curve through the shots from one to another."""
        xy = self.shots[:, :2]
        if last - first >= 2:
            fitted = fit_arcs(xy[first : last + 1])
            self.arcs.update({first + i: arcs for i, arcs in enumerate(fitted)})
            return
        if last - first == 1 and is_tangent:
            arc = self._find_tangent_arc(first, last)
            if arc is not None:
                self.arcs[first] = [arc]
            return
        self._note("curve of too few points", first, last)

    def _find_tangent_arc(self, first: int, last: int) -> Arc | None:
        """Return the arc between two shots that is tangent to the leg before, or behind it."""
        start, end = self.shots[first, :2], self.shots[last, :2]
        arriving, leaving = self._find_direction(first), self._find_leaving(last)
        if arriving is not None:
            arc = fit_tangent_arc(start, end, arriving)
            if (
                leaving is not None
                and abs(measure_turn(_rotate(end - start, arc.angle), leaving)) > _KINK
            ):
                self._note("curve not tangent to the leg behind it", first, last)
        elif leaving is not None:
            arc = Arc(start, end, measure_turn(end - start, leaving))
        else:
            self._note("curve without a leg", first, last)
            return None
        if abs(arc.angle) > _MOST_TURN:
            self._note("curve that turns back", first, last)
            return None
        return arc

    def _find_direction(self, shot: int) -> Float64Array | None:
        """Return the direction in which the line arrives at a shot."""
        if shot == 0:
            return None
        chord: Float64Array = self.shots[shot, :2] - self.shots[shot - 1, :2]
        arcs = self.arcs.get(shot - 1)
        if arcs:
            chord = _rotate(arcs[-1].end - arcs[-1].start, arcs[-1].angle)
        return chord if chord.any() else None

    def _find_leaving(self, shot: int) -> Float64Array | None:
        """Return the direction in which a straight leg leaves a shot."""
        if shot + 1 >= len(self.shots):
            return None
        chord: Float64Array = self.shots[shot + 1, :2] - self.shots[shot, :2]
        return chord if chord.any() else None

    def join(self, tolerance: float) -> Float64Array:
        """Return all vertices."""
        if not self.arcs:
            return self.shots
        parts = [self.shots[:1]]
        for i in range(len(self.shots) - 1):
            if i in self.arcs:
                self._require_few(self.arcs[i], tolerance)
                heights = (float(self.shots[i, 2]), float(self.shots[i + 1, 2]))
                parts.append(densify(self.arcs[i], heights, tolerance))
            parts.append(self.shots[i + 1 : i + 2])
        return np.vstack(parts)

    def _require_few(self, arcs: list[Arc], tolerance: float) -> None:
        if sum(arc.count_chords(tolerance) for arc in arcs) > MOST_VERTICES:
            raise LinesError(
                f"A curve of {self.figure.name} would need more than {MOST_VERTICES:,} vertices "
                f"between two shots for its chords to keep within {tolerance:g} of it: a larger "
                "`arc_tolerance` needs fewer."
            )

    def _note(self, kind: str, first: int, last: int) -> None:
        self.note(Fault(kind, self.figure.name, tuple(self.rows[first : last + 1])))


def _rotate(vector: Float64Array, angle: float) -> Float64Array:
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def _find_corner(
    figure: Figure, shots: Float64Array, note: Callable[[Fault], None]
) -> list[Float64Array]:
    """Return the last corner of a rectangle: where perpendiculars to both end legs meet."""
    rows = tuple(figure.rows)
    if len(shots) < 3:
        return []
    first, last = shots[1, :2] - shots[0, :2], shots[-1, :2] - shots[-2, :2]
    angle = abs(measure_turn(first, last))
    if min(angle, math.pi - angle) < _KINK:
        note(Fault("no rectangle", figure.name, rows))
        return []
    if len(shots) == 3 and abs(angle - math.pi / 2) > _SQUARE:
        note(Fault("rectangle out of square", figure.name, rows))
    across = shots[-1, :2] - shots[0, :2]
    move = np.linalg.solve(np.array([first, last]), np.array([0.0, float(across @ last)]))
    if len(shots) == 3:
        z = shots[0, 2] + shots[2, 2] - shots[1, 2]
    else:
        z = (shots[0, 2] + shots[-1, 2]) / 2
    return [np.array([*(shots[0, :2] + move), z])]
