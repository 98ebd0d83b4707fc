"""Elements from points of intersection: tangents, arcs, and clothoids between them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.errors import LinesError, OptionError
from ....base.sentences import coordinate
from .arguments import as_numbers, as_places
from .elements import Element

if TYPE_CHECKING:
    from ....base.arrays import Float64Array

_ROUNDING = 1e-12


def lay_elements(points: Any, radii: Any, transitions: Any) -> list[Element]:
    """Return the elements of an alignment by its points of intersection.

    Raises LinesError and OptionError as :meth:`Alignment.from_points`.
    """
    xy = as_places(points) + 0.0
    if len(xy) < 2:
        raise LinesError("An alignment has fewer than two points.")
    steps = np.diff(xy, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    if not lengths.all():
        k = int(np.argmin(lengths))
        raise LinesError(f"Points {k} and {k + 1} of an alignment are the same: they must differ.")
    radius = _as_values("radii", radii, len(xy) - 2)
    spiral = _as_values("transitions", transitions, len(xy) - 2)
    bare = (radius == 0.0) & (spiral > 0.0)
    if bare.any():
        k = int(np.argmax(bare))
        raise OptionError("transitions", float(spiral[k]), allowed="0 where the radius is 0")
    directions = np.arctan2(steps[:, 1], steps[:, 0])
    turns = np.remainder(np.diff(directions) + np.pi, 2.0 * np.pi) - np.pi
    curves = [
        _Curve(*one) for one in zip(turns.tolist(), radius.tolist(), spiral.tolist(), strict=True)
    ]
    tangents = np.array([0.0, *(one.tangent for one in curves), 0.0])
    left = lengths - tangents[:-1] - tangents[1:]
    if (left < -_ROUNDING * lengths).any():
        k = int(np.argmin(left))
        raise LinesError(
            f"There is no room for the curves between the points {k} and {k + 1} of an alignment: "
            f"they need {coordinate(tangents[k] + tangents[k + 1])} of {coordinate(lengths[k])}."
        )
    elements: list[Element] = []
    for k, direction in enumerate(directions.tolist()):
        begin = xy[k] + steps[k] / lengths[k] * tangents[k]
        if left[k] > _ROUNDING * lengths[k]:
            elements.append(Element("line", tuple(begin), direction, float(left[k])))
        if k < len(curves):
            start = xy[k + 1] - steps[k] / lengths[k] * tangents[k + 1]
            elements += curves[k].lay(tuple(start.tolist()), direction)
    return elements


class _Curve:
    """The arc at a point of intersection, with a clothoid on either side."""

    def __init__(self, turn: float, radius: float, spiral: float) -> None:
        self.turn, self.radius, self.spiral = turn, radius, spiral
        self.tangent = 0.0
        if radius == 0.0 or turn == 0.0:
            self.radius = 0.0
            return
        half = abs(turn) / 2.0
        if half > math.pi / 2.0 - 1e-9:
            raise LinesError("An alignment turns back on itself, where no arc fits.")
        angle = spiral / (2.0 * radius)
        if angle > half:
            allowed = f"at most {coordinate(2.0 * radius * half)} for this radius and turn"
            raise OptionError("transitions", spiral, allowed=allowed)
        self.arc = (abs(turn) - 2.0 * angle) * radius
        across, aside = 0.0, 0.0
        if spiral > 0.0:
            end = Element("clothoid", (0.0, 0.0), 0.0, spiral, 0.0, 1.0 / radius).end
            across, aside = end[0] - radius * math.sin(angle), end[1]
            aside -= radius * (1.0 - math.cos(angle))
        self.tangent = (radius + aside) * math.tan(half) + across

    def lay(self, start: tuple[float, float], direction: float) -> list[Element]:
        """Return its elements from a place on."""
        if self.radius == 0.0:
            return []
        bent = math.copysign(1.0 / self.radius, self.turn)
        shapes = [
            ("clothoid", self.spiral, 0.0, bent),
            ("arc", self.arc, bent, bent),
            ("clothoid", self.spiral, bent, 0.0),
        ]
        elements: list[Element] = []
        for kind, length, first, last in shapes:
            if length <= _ROUNDING * self.radius:
                continue
            elements.append(Element(kind, start, direction, length, first, last))  # type: ignore[arg-type]
            start, direction = elements[-1].end, elements[-1].end_direction
        return elements


def _as_values(name: str, given: Any, count: int) -> Float64Array:
    """Return a number from 0 on for each point of intersection."""
    values = np.zeros(count) if given is None else as_numbers(name, given, count)
    if (values < 0.0).any():
        raise OptionError(name, float(values.min()), allowed="0 or more")
    return values
