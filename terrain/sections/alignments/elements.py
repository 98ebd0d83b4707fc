"""Elements of a horizontal alignment: lines, arcs and transition curves, by their lengths."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from ....base.checks import as_length, as_number
from ....base.errors import OptionError, choice
from .transitions import CURVATURES, SHAPES, Law, Ordinate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import Float64Array, Int64Array

ElementKind = Literal["line", "arc", Law, Ordinate]

_TURN = 0.25
"""Radians that the direction changes within a piece, at most."""

_MOST_TURNS = 50.0
"""Full turns of an element; more are a slip of a radius or a length."""

_ABSCISSAS, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_STEPS = 60
_EVEN = 1e-10
"""Of its length: a step of Newton's behind one that was so short is as exact as numbers are."""


@dataclass(frozen=True, slots=True)
class Element:
    """A line, an arc or a transition curve of an alignment.

    Attributes
    ----------
    kind : str
        "line", "arc"; a transition by its curvature along its length, "clothoid", "bloss",
        "cosine", "sinusoid", "biquadratic"; one by its ordinate over the tangent where it is
        straight, "cubic parabola", "sine half-wave".
    start : (float, float)
        Where it begins, CRS units.
    direction : float
        Of its tangent there, in radians, from the first axis towards the second.
    length : float
        CRS units.
    start_curvature, end_curvature : float
        1 / radius at its ends, positive where it turns from the first axis towards the second,
        0 where it is straight. Of a transition by its ordinate the one that is not 0 is that of
        its formula: 1 / R in y = x³ / (6 R X).

    Raises
    ------
    OptionError
        If it has no length, curvatures do not fit its kind, or it makes more than 50 turns.

    Notes
    -----
    Places on transitions are integrals of their direction by Gauss and Legendre's rule of 16
    points in pieces of at most a quarter of a radian, right to some roundings.

    Examples
    --------
    >>> import tinsmith as ts
    >>> arc = ts.Element("arc", (0.0, 0.0), 0.0, 10.0, 0.1, 0.1)
    >>> arc.places([10.0]).round(3)
    array([[8.415, 4.597]])
    """

    kind: ElementKind
    start: tuple[float, float]
    direction: float
    length: float
    start_curvature: float = 0.0
    end_curvature: float = 0.0
    _form: Any = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        keep = object.__setattr__
        choice("kind", self.kind, ElementKind)
        x, y = (as_number(f"start[{k}]", self.start[k]) for k in range(2))
        keep(self, "start", (x, y))
        for name in ("direction", "start_curvature", "end_curvature"):
            keep(self, name, as_number(name, getattr(self, name)))
        keep(self, "length", as_length("length", self.length))
        self._require_fitting()
        keep(self, "_form", _FORMS.get(self.kind, _Integrated)(self))

    def _require_fitting(self) -> None:
        ends = self.start_curvature, self.end_curvature
        if self.kind == "line" and ends != (0.0, 0.0):
            raise OptionError("curvature", ends, allowed="0 at both ends of a line")
        if self.kind == "arc" and (ends[0] != ends[1] or ends[0] == 0.0):
            raise OptionError("curvature", ends, allowed="the same at both ends of an arc, not 0")
        if self.kind in SHAPES and (ends[0] == 0.0) == (ends[1] == 0.0):
            allowed = f"0 at one end of a {self.kind}, not at the other"
            raise OptionError("curvature", ends, allowed=allowed)
        if self.turn > _MOST_TURNS * 2.0 * math.pi:
            allowed = f"at most {_MOST_TURNS:.0f} full turns at that curvature"
            raise OptionError("length", self.length, allowed=allowed)

    def __reduce__(self) -> tuple[Any, ...]:
        ends = self.start_curvature, self.end_curvature
        return Element, (self.kind, self.start, self.direction, self.length, *ends)

    @property
    def end(self) -> tuple[float, float]:
        """Where it ends, CRS units."""
        x, y = self.places([self.length])[0].tolist()
        return x, y

    @property
    def end_direction(self) -> float:
        """Of its tangent where it ends, in radians."""
        return float(self.directions([self.length])[0])

    @property
    def largest_curvature(self) -> float:
        """1 / the smallest radius of its ends, 0 of a line; 1 / CRS units."""
        return max(abs(self.start_curvature), abs(self.end_curvature))

    @property
    def turn(self) -> float:
        """Radians by which its direction changes, at most, on the way."""
        return self.largest_curvature * self.length

    def places(self, distances: Any) -> Float64Array:
        """Return where it is after some of its length.

        Parameters
        ----------
        distances : (n,) array
            From its start, CRS units.

        Returns
        -------
        (n, 2) float64 array
            CRS units.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Element("line", (1.0, 2.0), 0.0, 5.0).places([3.0])
        array([[4., 2.]])
        """
        local = self._form.places(np.asarray(distances, np.float64))
        cos, sin = math.cos(self.direction), math.sin(self.direction)
        x, y = local[:, 0], local[:, 1]
        return np.column_stack(
            [self.start[0] + (x * cos - y * sin), self.start[1] + (x * sin + y * cos)]
        )

    def directions(self, distances: Any) -> Float64Array:
        """Return the directions of its tangents after some of its length.

        Parameters
        ----------
        distances : (n,) array
            From its start, CRS units.

        Returns
        -------
        (n,) float64 array
            Radians, as ``direction``.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Element("clothoid", (0.0, 0.0), 0.0, 50.0, 0.0, 0.01).directions([50.0])
        array([0.25])
        """
        turned: Float64Array = self._form.turned(np.asarray(distances, np.float64))
        return self.direction + turned

    def curvatures(self, distances: Any) -> Float64Array:
        """Return its curvatures after some of its length.

        Parameters
        ----------
        distances : (n,) array
            From its start, CRS units.

        Returns
        -------
        (n,) float64 array
            1 / CRS units, positive where it turns from the first axis towards the second.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Element("clothoid", (0.0, 0.0), 0.0, 50.0, 0.0, 0.01).curvatures([25.0])
        array([0.005])
        """
        found: Float64Array = self._form.curvatures(np.asarray(distances, np.float64))
        return found

    def cut(self) -> Float64Array:
        """Return distances between which it turns by at most a quarter of a radian.

        Returns
        -------
        (n,) float64 array
            From 0 to its length, CRS units.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Element("arc", (0.0, 0.0), 0.0, 10.0, 0.05, 0.05).cut()
        array([ 0.,  5., 10.])
        """
        count = max(1, math.ceil(self.turn / _TURN))
        if self.kind not in ("line", "arc"):
            count = max(4, 2 * math.ceil(count / 2))
        return np.linspace(0.0, self.length, count + 1)


def measure_elements(
    elements: Sequence[Element], owner: Int64Array, at: Float64Array
) -> tuple[Float64Array, Float64Array]:
    """Return places and unit tangents, both (n, 2), at distances along elements.

    Parameters
    ----------
    elements : sequence of Element
    owner : (n,) int64 array
        Number of the element of each.
    at : (n,) float64 array
        Distances from its start, CRS units.
    """
    places, tangents = np.empty((len(at), 2)), np.empty((len(at), 2))
    for k in np.unique(owner).tolist():
        own = owner == k
        places[own] = elements[k].places(at[own])
        angle = elements[k].directions(at[own])
        tangents[own] = np.column_stack([np.cos(angle), np.sin(angle)])
    return places, tangents


# ---------------------------------------------------------------- from the origin along the x axis


class _Line:
    def __init__(self, element: Element) -> None:
        del element

    def places(self, s: Float64Array) -> Float64Array:
        return np.column_stack([s, np.zeros_like(s)])

    def turned(self, s: Float64Array) -> Float64Array:
        return np.zeros_like(s)

    def curvatures(self, s: Float64Array) -> Float64Array:
        return np.zeros_like(s)


class _Arc:
    def __init__(self, element: Element) -> None:
        self._curvature = element.start_curvature

    def places(self, s: Float64Array) -> Float64Array:
        half = 0.5 * self._curvature * s
        chord = s * np.sinc(half / np.pi)  # which is right for the flattest arcs, too
        return np.column_stack([chord * np.cos(half), chord * np.sin(half)])

    def turned(self, s: Float64Array) -> Float64Array:
        return self._curvature * s

    def curvatures(self, s: Float64Array) -> Float64Array:
        return np.full_like(s, self._curvature)


class _Integrated:
    """A transition by its curvature."""

    def __init__(self, element: Element) -> None:
        self._law = CURVATURES[element.kind]
        self._length = element.length
        self._first = element.start_curvature
        self._change = element.end_curvature - element.start_curvature
        self._knots = element.cut()
        steps = self._integrate(self._knots[:-1], self._knots[1:])
        self._places = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])

    def places(self, s: Float64Array) -> Float64Array:
        knot = np.searchsorted(self._knots, s, side="right") - 1
        knot = np.clip(knot, 0, len(self._knots) - 2)
        return self._places[knot] + self._integrate(self._knots[knot], s)

    def _integrate(self, begin: Float64Array, end: Float64Array) -> Float64Array:
        half = 0.5 * (end - begin)
        at = 0.5 * (begin + end)[:, None] + half[:, None] * _ABSCISSAS
        angle = self.turned(at)
        return np.column_stack(
            [half * (np.cos(angle) @ _WEIGHTS), half * (np.sin(angle) @ _WEIGHTS)]
        )

    def turned(self, s: Float64Array) -> Float64Array:
        grown = self._law.integral(s / self._length)
        turned: Float64Array = self._first * s + self._change * self._length * grown
        return turned

    def curvatures(self, s: Float64Array) -> Float64Array:
        return self._first + self._change * self._law.share(s / self._length)


class _Ordinate:
    """A transition by its ordinate, seen from its straight end; or from its other one."""

    def __init__(self, element: Element) -> None:
        self._shape = SHAPES[element.kind]
        self._length = element.length
        self._is_reversed = element.end_curvature == 0.0
        # Seen from the end, it turns the other way.
        self._curvature = -element.start_curvature if self._is_reversed else element.end_curvature
        self._tangent = self._find_tangent()
        far = np.array([self._length])
        self._far = self._forward(far)[0]
        self._far_turn = float(self._turned_forward(far)[0])

    def _find_tangent(self) -> float:
        """Return the length of the tangent over which the curve has its length."""
        high = low = self._length
        while self._arc_length(low, 1.0) > self._length:
            low *= 0.5
        for _ in range(_STEPS):
            middle = 0.5 * (low + high)
            if self._arc_length(middle, 1.0) > self._length:
                high = middle
            else:
                low = middle
        return 0.5 * (low + high)

    def _arc_length(self, tangent: float, share: Any) -> Any:
        ends = np.linspace(0.0, 1.0, 9) * np.asarray(share)[..., None]
        half = 0.5 * np.diff(ends, axis=-1)
        at = 0.5 * (ends[..., 1:] + ends[..., :-1])[..., None] + half[..., None] * _ABSCISSAS
        slope = self._curvature * tangent * self._shape.slope(at)
        return tangent * (half * (np.sqrt(1.0 + slope * slope) @ _WEIGHTS)).sum(axis=-1)

    def _shares(self, s: Float64Array) -> Float64Array:
        """Return the shares of the tangent above which a length of the curve ends."""
        share = np.clip(s / self._length, 0.0, 1.0)
        for _ in range(12):
            slope = self._curvature * self._tangent * self._shape.slope(share)
            off = self._arc_length(self._tangent, share) - s
            share = np.clip(share - off / (self._tangent * np.sqrt(1.0 + slope * slope)), 0.0, 1.0)
            if np.abs(off).max(initial=0.0) <= _EVEN * self._length:
                break
        return share

    def _forward(self, s: Float64Array) -> Float64Array:
        share = self._shares(s)
        height = self._curvature * self._tangent**2 * self._shape.ordinate(share)
        return np.column_stack([share * self._tangent, height])

    def _turned_forward(self, s: Float64Array) -> Float64Array:
        slope = self._curvature * self._tangent * self._shape.slope(self._shares(s))
        turned: Float64Array = np.arctan(slope)
        return turned

    def places(self, s: Float64Array) -> Float64Array:
        if not self._is_reversed:
            return self._forward(s)
        back = self._forward(self._length - s) - self._far
        cos, sin = -math.cos(self._far_turn), math.sin(self._far_turn)
        return np.column_stack(
            [back[:, 0] * cos - back[:, 1] * sin, back[:, 0] * sin + back[:, 1] * cos]
        )

    def turned(self, s: Float64Array) -> Float64Array:
        if not self._is_reversed:
            return self._turned_forward(s)
        return self._turned_forward(self._length - s) - self._far_turn

    def curvatures(self, s: Float64Array) -> Float64Array:
        share = self._shares(self._length - s if self._is_reversed else s)
        slope = self._curvature * self._tangent * self._shape.slope(share)
        found: Float64Array = (
            self._curvature * self._shape.rate(share) / (1.0 + slope * slope) ** 1.5
        )
        return -found if self._is_reversed else found


_FORMS: dict[str, Any] = {
    "line": _Line,
    "arc": _Arc,
    **dict.fromkeys(get_args(Ordinate), _Ordinate),
}
