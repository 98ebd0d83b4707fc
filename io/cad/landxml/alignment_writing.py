"""Write an alignment as LandXML 1.2 does: elements, station equations, vertical alignments."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

from ....base.errors import FormatError
from ....base.georeference import find_axes
from ....base.sentences import FILE
from ....terrain import Element
from .content import SPIRALS, quote

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....terrain import Alignment, VerticalPoint

_STRAIGHT = 1e-12
"""Radians of a turn that rounding leaves where a spiral is straight."""

_TYPES = {kind: name for name, kind in reversed(SPIRALS.items())}


def format_alignment(alignment: Alignment, name: str, factor: float) -> str:
    """Return the elements ``Alignments`` of a file.

    Parameters
    ----------
    alignment : Alignment
    name : str
    factor : float
        From its elevations to the unit of the file.
    """
    is_mirrored = find_axes(alignment.crs).are_mirrored
    lines = [
        "<Alignments>",
        f"<Alignment name={quote(name)} length={_number(alignment.length)} "
        f"staStart={_number(alignment.start)}>",
        "<CoordGeom>",
    ]
    for element in alignment.elements:
        for part in _split(element):
            lines += _format_element(part, is_mirrored=is_mirrored)
    lines += ["</CoordGeom>", *_format_equations(alignment)]
    for vertical in alignment.verticals:
        title = quote(vertical.name or "design")
        lines += [f"<Profile name={title}>", f"<ProfAlign name={quote(vertical.name)}>"]
        lines += [
            _format_vertical(point, reach, factor)
            for point, reach in zip(vertical.points, vertical.curve_lengths, strict=True)
        ]
        lines += ["</ProfAlign>", "</Profile>"]
    return "\n".join([*lines, "</Alignment>", "</Alignments>", ""])


def _split(element: Element) -> list[Element]:
    """Return what LandXML has of an element: arcs of half a turn, spirals that turn to one side."""
    first, last = element.start_curvature, element.end_curvature
    if element.kind == "arc":
        count = max(1, math.ceil(element.turn / math.pi))
        ends = [element.length * k / count for k in range(count + 1)]
    elif first * last < 0.0:
        if element.kind != "clothoid":
            raise FormatError(
                f"Cannot write {FILE}: LandXML has no {element.kind} that turns to both sides, as "
                f"the one that begins at {element.start} does."
            )
        ends = [0.0, element.length * first / (first - last), element.length]
    else:
        return [element]
    parts = []
    for begin, end in itertools.pairwise(ends):
        ((x, y),) = element.places([begin]).tolist()
        bent = [
            0.0 if abs(value) * element.length < _STRAIGHT else float(value)
            for value in element.curvatures([begin, end])
        ]
        direction = float(element.directions([begin])[0])
        parts.append(Element(element.kind, (x, y), direction, end - begin, *bent))
    return parts


def _format_element(element: Element, *, is_mirrored: bool) -> Iterator[str]:
    bent = element.start_curvature or element.end_curvature
    rot = "ccw" if (bent > 0.0) != is_mirrored else "cw"
    length = f"length={_number(element.length)}"
    inner = ""
    if element.kind == "line":
        tag, head = "Line", f"<Line {length}>"
    elif element.kind == "arc":
        radius = 1.0 / bent
        x, y = element.start
        center = x - radius * math.sin(element.direction), y + radius * math.cos(element.direction)
        tag, inner = "Curve", f"<Center>{_place(center)}</Center>"
        head = f'<Curve rot="{rot}" crvType="arc" radius={_number(abs(radius))} {length}>'
    else:
        tag, inner = "Spiral", f"<PI>{_place(_find_meeting(element))}</PI>"
        radii = [
            f"{name}={_number(abs(1.0 / value)) if value else quote('INF')}"
            for name, value in (
                ("radiusStart", element.start_curvature),
                ("radiusEnd", element.end_curvature),
            )
        ]
        head = f'<Spiral {length} {" ".join(radii)} rot="{rot}" spiType="{_TYPES[element.kind]}">'
    yield head
    yield f"<Start>{_place(element.start)}</Start>{inner}<End>{_place(element.end)}</End>"
    yield f"</{tag}>"


def _find_meeting(element: Element) -> tuple[float, float]:
    """Return where the tangents of both ends meet."""
    (x, y), (x_end, y_end) = element.start, element.end
    first, last = element.direction, element.end_direction
    cross = math.sin(last - first)
    if cross == 0.0:
        return (x + x_end) / 2.0, (y + y_end) / 2.0
    along = ((x_end - x) * math.sin(last) - (y_end - y) * math.cos(last)) / cross
    return x + along * math.cos(first), y + along * math.sin(first)


def _format_equations(alignment: Alignment) -> Iterator[str]:
    begin, written, sign = alignment.start, alignment.start, 1.0
    for one in alignment.equations:
        back = written + sign * (one.station - begin)
        begin, written, sign = one.station, one.ahead, 1.0 if one.is_increasing else -1.0
        word = "increasing" if one.is_increasing else "decreasing"
        yield (
            f"<StaEquation staAhead={_number(one.ahead)} staBack={_number(back)} "
            f'staInternal={_number(one.station)} staIncrement="{word}"/>'
        )


def _format_vertical(point: VerticalPoint, length: float, factor: float) -> str:
    place = f"{point.station!r} {point.elevation * factor!r}"
    if point.kind is None:
        return f"<PVI>{place}</PVI>"
    if point.kind == "arc":
        radius = _number(point.radius)
        return f"<CircCurve length={_number(length)} radius={radius}>{place}</CircCurve>"
    if point.length_in == point.length_out:
        return f"<ParaCurve length={_number(2.0 * point.length_in)}>{place}</ParaCurve>"
    return (
        f"<UnsymParaCurve lengthIn={_number(point.length_in)} "
        f"lengthOut={_number(point.length_out)}>{place}</UnsymParaCurve>"
    )


def _number(value: float) -> str:
    return f'"{value!r}"'


def _place(place: tuple[float, float]) -> str:
    return f"{place[1]!r} {place[0]!r}"
