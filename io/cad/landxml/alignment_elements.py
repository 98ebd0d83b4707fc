"""Elements of an alignment as LandXML describes them: places first, then what has to fit them."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.sentences import coordinate, shown
from ....terrain import Element
from .content import SPIRALS
from .numbers import fault, parse_list

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ....base.arrays import Float64Array
    from ..reference import Measures
    from .alignment_nodes import Node

LARGEST_MISFIT = 0.05
"""CRS units: how far an element may miss its own end, at most."""

_NOTED = 1e-3


class _Ends(NamedTuple):
    """Where an element begins and ends, in the plane of the CRS."""

    start: Float64Array
    end: Float64Array

    @property
    def length(self) -> float:
        return math.dist(self.start, self.end)

    @property
    def direction(self) -> float:
        step = self.end - self.start
        return math.atan2(step[1], step[0])


@dataclass(eq=False)
class ElementReader:
    """Makes elements of nodes, and keeps what they miss."""

    measures: Measures
    points: Mapping[str, Float64Array]
    """Survey points by name, northing and easting."""
    is_mirrored: bool
    """Whether left and right are exchanged in the plane of the CRS."""
    misfit: float = 0.0
    """The farthest that an element missed what the file says of it, CRS units."""
    n_polylines: int = 0
    elements: list[Element] = field(default_factory=list)

    def read(self, geometry: Node) -> list[Element]:
        """Return the elements of a CoordGeom, in order.

        Raises
        ------
        ReadError
            If one has no start or end, is of a kind that is not known, or what is said of it does
            not fit together.
        """
        makers = {
            "Line": self._add_line,
            "Curve": self._add_curve,
            "Spiral": self._add_spiral,
            "IrregularLine": self._add_polyline,
            "Chain": self._add_chain,
        }
        for node in geometry.children:
            if node.name in makers:
                makers[node.name](node)
        return self.elements

    # ------------------------------------------------------------------ kinds

    def _add_line(self, node: Node) -> None:
        ends = self._find_ends(node)
        self._require_fit(node, "length", ends.length)
        self._add_straight(node, ends.start, ends.end)

    def _add_straight(self, node: Node, start: Float64Array, end: Float64Array) -> None:
        ends = _Ends(start, end)
        if ends.length == 0.0:
            raise fault(node.line, f"a {node.name} has no length: it ends where it begins")
        self.elements.append(Element("line", _pair(start), ends.direction, ends.length))

    def _add_polyline(self, node: Node) -> None:
        inner = []
        for part in node.list_named("PntList2D", "PntList3D"):
            width = int(part.name[-2])
            rows = parse_list("".join(part.texts), part.line, width=width, what=part.name)
            inner += [self._place(row[:2]) for row in rows]
        ends = self._find_ends(node)
        places = [ends.start, *inner, ends.end]
        kept = places[:1] + [b for a, b in itertools.pairwise(places) if (a != b).any()]
        for before, after in itertools.pairwise(kept):
            self._add_straight(node, before, after)
        self.n_polylines += 1

    def _add_chain(self, node: Node) -> None:
        names = "".join(node.texts).split()
        places = [self._look_up(name, node) for name in names]
        for before, after in itertools.pairwise(places):
            self._add_straight(node, before, after)
        self.n_polylines += 1

    def _add_curve(self, node: Node) -> None:
        kind = node.attributes.get("crvType", "arc").strip()
        if kind not in ("arc", "chord"):  # how its length is divided, not what it is
            raise fault(node.line, f"a Curve is of the type {shown(kind)}, and arc is allowed")
        ends, center = self._find_ends(node), self._find(node, "Center")
        sign = self._find_sign(node)
        if center is None:
            radius = node.parse_radius("radius")
            if radius is None:
                raise fault(node.line, "a Curve has neither Center nor radius")
            radius *= self.measures.scale
            turn = self._find_turn(node, ends, radius)
        else:
            arms = ends.start - center, ends.end - center
            radius = math.hypot(*arms[0])
            if radius == 0.0:
                raise fault(node.line, "a Curve begins at its Center")
            self._require_near(node, "radius", radius, math.hypot(*arms[1]))
            self._require_fit(node, "radius", radius)
            angles = [math.atan2(arm[1], arm[0]) for arm in arms]
            turn = math.remainder(sign * (angles[1] - angles[0]), 2.0 * math.pi) % (2.0 * math.pi)
            said = node.parse_radius("radius")
            radius = radius if said is None else abs(said) * self.measures.scale
        if not turn > 0.0:
            raise fault(node.line, "a Curve has no length: it ends where it begins")
        self._require_fit(node, "length", turn * radius)
        self._close(node, ends, ("arc", turn * radius, sign / radius, sign / radius))

    def _find_turn(self, node: Node, ends: _Ends, radius: float) -> float:
        """Return by how much an arc without a centre turns, in radians."""
        length = node.parse("length")
        if length is not None:
            return length * self.measures.scale / radius
        if ends.length > 2.0 * radius:
            raise fault(node.line, "a Curve is too flat for its ends: they are 2 radii apart")
        return 2.0 * math.asin(ends.length / (2.0 * radius))

    def _add_spiral(self, node: Node) -> None:
        kind = node.attributes.get("spiType", "clothoid").strip()
        law = SPIRALS.get(kind)
        if law is None:
            known = ", ".join(SPIRALS)
            raise fault(
                node.line,
                f"a Spiral is of the type {shown(kind)}, whose form is not known here, and {known} "
                "are read",
            )
        sign, scale = self._find_sign(node), self.measures.scale
        radii = [node.parse_radius(name) for name in ("radiusStart", "radiusEnd")]
        first, last = (0.0 if one is None else sign / (abs(one) * scale) for one in radii)
        if first == last:
            raise fault(node.line, "a Spiral has the same radius at both ends")
        if law in ("cubic parabola", "sine half-wave") and first != 0.0 and last != 0.0:
            raise fault(node.line, f"a Spiral of the type {kind} is straight at neither end")
        length = node.require("length") * scale
        ends = self._find_ends(node)
        element = self._close(node, ends, (law, length, first, last))
        meeting = self._find(node, "PI")
        if meeting is not None and (meeting != ends.start).any():
            tangent = _Ends(ends.start, meeting)
            off = math.remainder(tangent.direction - element.direction, 2.0 * math.pi)
            # The tangent is as sure as the places that it is drawn through.
            self._require_near(node, "PI", abs(off) * min(length, tangent.length), 0.0)

    def _close(self, node: Node, ends: _Ends, shape: tuple[str, float, float, float]) -> Element:
        """Add a curve, turned about its start so that its end lies towards the file's."""
        kind, length, first, last = shape
        straight = Element(kind, (0.0, 0.0), 0.0, length, first, last)  # type: ignore[arg-type]
        chord = _Ends(np.zeros(2), np.array(straight.end))
        if ends.length == 0.0:
            raise fault(node.line, f"a {node.name} ends where it begins")
        self._require_near(node, "ends", chord.length, ends.length)
        direction = math.remainder(ends.direction - chord.direction, 2.0 * math.pi)
        element = Element(kind, _pair(ends.start), direction, length, first, last)  # type: ignore[arg-type]
        self.elements.append(element)
        return element

    # ------------------------------------------------------------------ what has to fit

    def _require_fit(self, node: Node, name: str, value: float) -> None:
        said = node.parse_radius(name)
        if said is not None:
            self._require_near(node, name, value, abs(said) * self.measures.scale)

    def _require_near(self, node: Node, what: str, value: float, other: float) -> None:
        """Refuse what does not fit together, and keep by how much it misses."""
        misfit = abs(value - other)
        if not misfit <= LARGEST_MISFIT:
            raise fault(
                node.line,
                f"a {node.name} does not fit together: by its {what} it is off by "
                f"{coordinate(misfit)}, and {LARGEST_MISFIT} is allowed",
            )
        self.misfit = max(self.misfit, misfit)

    def _find_sign(self, node: Node) -> float:
        """Return 1 where an element turns from the first axis of the CRS towards the second."""
        word = node.attributes.get("rot", "").strip().lower()
        if word not in ("cw", "ccw"):
            raise fault(node.line, f"a {node.name} has rot={shown(word)}, and cw or ccw is allowed")
        return -1.0 if (word == "cw") != self.is_mirrored else 1.0

    # ------------------------------------------------------------------ places

    def _find_ends(self, node: Node) -> _Ends:
        found = [self._find(node, name) for name in ("Start", "End")]
        if found[0] is None or found[1] is None:
            raise fault(node.line, f"a {node.name} has no {'Start' if found[0] is None else 'End'}")
        return _Ends(found[0], found[1])

    def _find(self, node: Node, name: str) -> Float64Array | None:
        child = node.find(name)
        if child is None:
            return None
        numbers = child.parse_text()
        if not numbers:
            return self._look_up(child.attributes.get("pntRef", "").strip(), child)
        if len(numbers) not in (2, 3):
            raise fault(child.line, f"a {name} has {len(numbers)} numbers, and 2 or 3 are needed")
        return self._place(np.array(numbers[:2]))

    def _look_up(self, name: str, node: Node) -> Float64Array:
        if name not in self.points:
            raise fault(node.line, f"a {node.name} is at the survey point {shown(name)}: not there")
        return self._place(self.points[name])

    def _place(self, northing_easting: Float64Array) -> Float64Array:
        placed: Float64Array = self.measures.apply(northing_easting[None, ::-1])[0] + 0.0
        return placed

    def describe(self) -> list[str]:
        """Tell what was assumed of the elements."""
        notes = []
        if self.misfit > _NOTED:
            notes.append(
                f"Elements miss what the file says of them by up to {self.misfit:.3g} (their "
                "lengths, radii, ends or tangents)."
            )
        if self.n_polylines:
            notes.append("Irregular lines and chains are polylines: their tangents break.")
        return notes


def _pair(place: Float64Array) -> tuple[float, float]:
    return float(place[0]), float(place[1])
