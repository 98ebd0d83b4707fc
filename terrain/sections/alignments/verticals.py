"""Vertical alignments: elevations by station, of tangents, parabolas and arcs."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ....base.checks import as_length, as_number
from ....base.errors import OptionError, choice
from ....base.sentences import coordinate
from .arguments import as_numbers

if TYPE_CHECKING:
    from ....base.arrays import Float64Array

_MOST_CHORDS = 1_000_000

CurveKind = Literal["parabola", "arc"]


@dataclass(frozen=True, slots=True)
class VerticalPoint:
    """A point of vertical intersection (PVI), with the curve that rounds it off, if there is one.

    Attributes
    ----------
    station, elevation : float
        Where the tangents meet: length along the alignment, CRS units, and elevation, in the unit
        of those of the alignment.
    kind : {"parabola", "arc"}, optional
        Of the vertical curve.
    length_in, length_out : float
        Of a parabola, before and behind the point, in stations; half of its length each if it is
        symmetric.
    radius : float
        Of an arc, CRS units.

    Raises
    ------
    OptionError
        If one is no such number, or a curve has none of its lengths.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ts.VerticalPoint(100.0, 320.0, "parabola", 30.0, 30.0).station
    100.0
    """

    station: float
    elevation: float
    kind: CurveKind | None = None
    length_in: float = 0.0
    length_out: float = 0.0
    radius: float = 0.0

    def __post_init__(self) -> None:
        for name in ("station", "elevation"):
            object.__setattr__(self, name, as_number(name, getattr(self, name)))
        if self.kind is None:
            return
        choice("kind", self.kind, CurveKind)
        for name in ("length_in", "length_out") if self.kind == "parabola" else ("radius",):
            object.__setattr__(self, name, as_length(name, getattr(self, name)))


@dataclass(frozen=True, eq=False, repr=False)
class VerticalAlignment:
    """Elevations along an alignment: tangents between points of intersection, with curves.

    Attributes
    ----------
    points : tuple of VerticalPoint
        In ascending order of stations; the first and the last have no curve.
    name : str

    Raises
    ------
    OptionError
        If there are fewer than two points, they are not in order, or curves overlap.

    Examples
    --------
    >>> import tinsmith as ts
    >>> crest = ts.VerticalAlignment(
    ...     [
    ...         ts.VerticalPoint(0.0, 100.0),
    ...         ts.VerticalPoint(100.0, 105.0, "parabola", 50.0, 50.0),
    ...         ts.VerticalPoint(200.0, 100.0),
    ...     ]
    ... )
    >>> crest.elevations_at([0.0, 100.0, 150.0])
    array([100.  , 103.75, 102.5 ])
    """

    points: Sequence[VerticalPoint]
    name: str = ""
    _parts: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        points = tuple(self.points)
        object.__setattr__(self, "points", points)
        if len(points) < 2:
            raise OptionError("points", len(points), "2 or more", what="number of points")
        stations = [one.station for one in points]
        for before, after in itertools.pairwise(stations):
            if not before < after:
                allowed = f"above {coordinate(before)}, that of the point before"
                raise OptionError("station", after, allowed=allowed)
        if points[0].kind is not None or points[-1].kind is not None:
            allowed = "None at the first and the last point, where only one tangent is"
            raise OptionError("kind", points[0].kind or points[-1].kind, allowed=allowed)
        object.__setattr__(self, "_parts", _lay_out(points))

    @property
    def start(self) -> float:
        """Station where it begins, CRS units."""
        return self.points[0].station

    @property
    def end(self) -> float:
        """Station where it ends, CRS units."""
        return self.points[-1].station

    @property
    def has_arcs(self) -> bool:
        """Whether a curve is an arc: stations and elevations have to be in one unit."""
        return any(one.kind == "arc" for one in self.points)

    @property
    def curve_lengths(self) -> tuple[float, ...]:
        """Length of the curve of each point, CRS units: of a parabola in stations, along an arc."""
        lengths = [0.0] * len(self.points)
        for k in range(1, len(self.points) - 1):
            before, point, after = self.points[k - 1 : k + 2]
            if point.kind == "parabola":
                lengths[k] = point.length_in + point.length_out
            elif point.kind == "arc":
                angles = [
                    math.atan(_find_grade(*pair)) for pair in ((before, point), (point, after))
                ]
                lengths[k] = point.radius * abs(angles[1] - angles[0])
        return tuple(lengths)

    def elevations_at(self, stations: Any) -> Float64Array:
        """Return elevations at stations.

        Parameters
        ----------
        stations : (n,) array
            Lengths along the alignment, station equations not counted, CRS units.

        Returns
        -------
        (n,) float64 array
            CRS units; NaN before its start and beyond its end.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.VerticalAlignment(
        ...     [ts.VerticalPoint(0.0, 5.0), ts.VerticalPoint(10.0, 6.0)]
        ... ).elevations_at([5.0, 11.0])
        array([5.5, nan])
        """
        return self._measure(stations, 0)

    def grades_at(self, stations: Any) -> Float64Array:
        """Return grades at stations, rise over run; at a break of grade that of what follows.

        Parameters
        ----------
        stations : (n,) array
            As of :meth:`elevations_at`.

        Returns
        -------
        (n,) float64 array
            Of no unit; NaN before its start and beyond its end.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.VerticalAlignment(
        ...     [ts.VerticalPoint(0.0, 5.0), ts.VerticalPoint(10.0, 6.0)]
        ... ).grades_at([5.0])
        array([0.1])
        """
        return self._measure(stations, 1)

    def cut_into_chords(self, tolerance: float) -> Float64Array:
        """Return stations between which it lies within a tolerance of its chords.

        Parameters
        ----------
        tolerance : float
            CRS units.

        Returns
        -------
        (n,) float64 array
            In ascending order, its ends and those of curves among them.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.VerticalAlignment(
        ...     [ts.VerticalPoint(0.0, 5.0), ts.VerticalPoint(10.0, 6.0)]
        ... ).cut_into_chords(0.01)
        array([ 0., 10.])
        """
        tolerance = as_length("tolerance", tolerance)
        ends = [*(part.begin for part in self._parts[1:]), self.end]
        steps = [
            np.linspace(part.begin, end, part.count_chords(end, tolerance) + 1)
            for part, end in zip(self._parts, ends, strict=True)
        ]
        return np.unique(np.concatenate(steps))

    def _measure(self, stations: Any, which: int) -> Float64Array:
        at = as_numbers("stations", stations)
        begins = np.array([part.begin for part in self._parts])
        owner = np.clip(np.searchsorted(begins, at, side="right") - 1, 0, None)
        found = np.full(len(at), np.nan)
        for k in np.unique(owner).tolist():
            own = (owner == k) & (at >= self.start) & (at <= self.end)
            found[own] = self._parts[k].measure(at[own])[which]
        return found

    def __repr__(self) -> str:
        title = f" {self.name}" if self.name else ""
        return (
            f"<VerticalAlignment{title}: {len(self.points)} points, from {coordinate(self.start)} "
            f"to {coordinate(self.end)}>"
        )


@dataclass(frozen=True, slots=True)
class _Part:
    """A tangent, a parabola or an arc from a station on."""

    begin: float
    elevation: float
    grade: float
    """Both where it begins."""
    rate: float = 0.0
    """Change of grade by length, of a parabola."""
    radius: float = 0.0
    """Of an arc, above 0 where it is a sag."""

    def count_chords(self, end: float, tolerance: float) -> int:
        """Return how many chords lie within a tolerance of it up to a station."""
        ends = self.measure(np.array([self.begin, end]))[1]
        steepest = max(1.0, math.hypot(1.0, float(np.abs(ends).max())))
        bent = abs(self.rate) if self.radius == 0.0 else steepest**3 / abs(self.radius)
        count = math.ceil((end - self.begin) * math.sqrt(bent / (8.0 * tolerance)))
        return min(max(1, count), _MOST_CHORDS)

    def measure(self, stations: Float64Array) -> tuple[Float64Array, Float64Array]:
        """Return elevations and grades."""
        along = stations - self.begin
        if self.radius == 0.0:
            grade = self.grade + self.rate * along
            return self.elevation + along * (self.grade + 0.5 * self.rate * along), grade
        # The sine of the angle of the tangent grows evenly along an arc.
        sine = self.grade / math.hypot(1.0, self.grade) + along / self.radius
        cosine = np.sqrt((1.0 - sine) * (1.0 + sine))
        first = 1.0 / math.hypot(1.0, self.grade)
        change = along * (self.grade / math.hypot(1.0, self.grade) + sine) / (first + cosine)
        return self.elevation + change, sine / cosine


def _find_grade(before: VerticalPoint, after: VerticalPoint) -> float:
    return (after.elevation - before.elevation) / (after.station - before.station)


def _lay_out(points: Sequence[VerticalPoint]) -> list[_Part]:
    """Return tangents and curves in order."""
    parts = []
    grades = [_find_grade(before, after) for before, after in itertools.pairwise(points)]
    free = points[0].station
    parts.append(_Part(free, points[0].elevation, grades[0]))
    for k in range(1, len(points) - 1):
        point, before, after = points[k], grades[k - 1], grades[k]
        reach = _find_reach(point, before, after)
        begin, end = point.station - reach[0], point.station + reach[1]
        near = 1e-9 * max(abs(begin), abs(end), 1.0)
        if begin < free - near or end > points[k + 1].station + near:
            raise OptionError(
                "length of a vertical curve",
                reach[0] + reach[1],
                allowed=f"such that the curve at {coordinate(point.station)} ends before the next "
                "point or curve",
            )
        if point.kind is not None and before != after:
            foot = point.elevation - before * reach[0]
            parts += _lay_curve(point, reach, (begin, foot, before, after))
        top = point.elevation + after * reach[1]
        parts.append(_Part(end, top, after))
        free = end
    return parts


def _find_reach(point: VerticalPoint, before: float, after: float) -> tuple[float, float]:
    """Return how far a curve reaches before and behind its point, in stations."""
    if point.kind is None or before == after:
        return 0.0, 0.0
    if point.kind == "parabola":
        return point.length_in, point.length_out
    angles = math.atan(before), math.atan(after)
    tangent = point.radius * math.tan(abs(angles[1] - angles[0]) / 2.0)
    return tangent * math.cos(angles[0]), tangent * math.cos(angles[1])


def _lay_curve(
    point: VerticalPoint, reach: tuple[float, float], start: tuple[float, float, float, float]
) -> list[_Part]:
    """Return an arc, or the two parabolas that meet at the station of the point."""
    begin, foot, before, after = start
    if point.kind == "arc":
        return [_Part(begin, foot, before, radius=math.copysign(point.radius, after - before))]
    length_in, length_out = reach
    # The middle tangent has the mean grade by the other lengths, so that both parabolas meet it.
    middle = (before * length_in + after * length_out) / (length_in + length_out)
    first = _Part(begin, foot, before, (middle - before) / length_in)
    height = foot + length_in * 0.5 * (before + middle)
    return [first, _Part(point.station, height, middle, (after - middle) / length_out)]
