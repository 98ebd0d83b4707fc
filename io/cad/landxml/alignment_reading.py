"""Read an alignment of LandXML: elements, station equations and vertical alignments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.crs import scale_elevations
from ....base.errors import CrsError, OptionError, ReadError, TinsmithError
from ....base.georeference import find_axes
from ....base.sentences import FILE, coordinate, counted, shown
from ....terrain import Alignment, StationEquation, VerticalAlignment, VerticalPoint
from ..reference import Declared, Measures, choose_measures, require_own_crs
from .alignment_elements import LARGEST_MISFIT, ElementReader
from .alignment_nodes import Node, parse_alignments
from .numbers import fault
from .units import find_stated

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.crs import CrsLike, UnitLike
    from .content import Content

_SHOWN = 20
_SHARE = 1e-3
"""Of an arc of a vertical alignment, by which its length may miss that by its radius."""


def read_alignment(
    path: Path,
    name: str | int | None = None,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    unit: UnitLike | None = None,
) -> Alignment:
    """Read an alignment as :func:`tinsmith.read_alignment` does."""
    declared = Declared.of(crs, unit, elevation_unit)
    nodes, content = parse_alignments(path)
    node = _choose(nodes, name)
    geometry = node.find("CoordGeom")
    if geometry is None:
        raise ReadError(f"{FILE} has the alignment {_label(node)} without a CoordGeom.")
    measures, notes = _choose_measures(geometry, content, declared)
    reader = ElementReader(
        measures,
        dict(zip(content.points.names, content.points.rows[:, :2], strict=True)),
        find_axes(measures.source).are_mirrored,
    )
    elements = reader.read(geometry)
    if not elements:
        raise ReadError(f"{FILE} has the alignment {_label(node)} without an element.")
    start = (node.parse("staStart") or 0.0) * measures.scale
    end = start + sum(one.length for one in elements)
    equations, said = _read_equations(node, (start, end), measures.scale)
    verticals, more = _read_verticals(node, measures)
    others = [one for one in nodes if one is not node]
    if others:
        rest = f"Not read: {counted(len(others), 'alignment')} ({_list_names(others)})."
        notes = [*notes, rest]
    if equations and verticals:
        more.append("Stations of vertical alignments are lengths, without the station equations.")
    try:
        return Alignment(
            elements,
            name=node.attributes.get("name", "").strip(),
            start=start,
            equations=equations,
            verticals=verticals,
            crs=measures.source,
            elevation_unit=measures.elevation_unit,
            notes=[*measures.notes, *notes, *reader.describe(), *said, *more],
        )
    except CrsError:
        raise
    except TinsmithError as error:
        raise ReadError(f"{FILE}, alignment {_label(node)}: {error}") from error


# ------------------------------------------------------------------ which one, and in what


def _choose(nodes: list[Node], wanted: str | int | None) -> Node:
    if not nodes:
        raise ReadError(f"{FILE} has no alignment.")
    if wanted is None:
        if len(nodes) > 1:
            raise ReadError(
                f"{FILE} has {len(nodes)} alignments ({_list_names(nodes)}): name the one to read."
            )
        return nodes[0]
    named = [one for one in nodes if one.attributes.get("name", "").strip() == str(wanted).strip()]
    if len(named) > 1:
        raise ReadError(
            f"{FILE} has {len(named)} alignments of the name {shown(wanted)}: choose one by its "
            "number, from 1."
        )
    numbered = [one for number, one in enumerate(nodes, 1) if str(number) == str(wanted)]
    if named or numbered:
        return (named or numbered)[0]
    raise OptionError("name", wanted, allowed=f"one of the alignments, {_list_names(nodes)}")


def _label(node: Node) -> str:
    return shown(node.attributes.get("name", "").strip()) or f"of line {node.line}"


def _list_names(nodes: list[Node]) -> str:
    names = ", ".join(_label(one) for one in nodes[:_SHOWN])
    return names + (", ..." if len(nodes) > _SHOWN else "")


def _choose_measures(
    geometry: Node, content: Content, declared: Declared
) -> tuple[Measures, list[str]]:
    """Decide what coordinates are measured in; an alignment is not reprojected."""
    rows = [
        child.parse_text()[:2]
        for node in geometry.children
        for child in node.list_named("Start", "End")
        if len(child.parse_text()) >= 2
    ]
    sample = np.array(rows).reshape(-1, 2)[:, ::-1]
    stated, said = find_stated(content, sample=sample, is_crs_declared=declared.crs is not None)
    require_own_crs(stated, declared)
    return choose_measures(stated, declared, sample=sample), said


# ------------------------------------------------------------------ stations and elevations


def _read_equations(
    node: Node, ends: tuple[float, float], scale: float
) -> tuple[list[StationEquation], list[str]]:
    """Return station equations in order, and what was assumed of them."""
    found, notes = [], []
    nodes = node.list_named("StaEquation")
    zone = (ends[0], ends[0], 1.0)  # where the zone before begins, what is written there, its sign
    for one in sorted(nodes, key=lambda item: item.require("staInternal")):
        at, ahead = one.require("staInternal") * scale, one.require("staAhead") * scale
        said = one.parse("staBack")
        if said is not None:
            back = said * scale
            readings = [
                place
                for place in (at, at + ends[0])
                if abs(zone[1] + zone[2] * (place - zone[0]) - back) <= LARGEST_MISFIT
            ]
            if not readings:
                raise fault(
                    one.line,
                    f"a StaEquation has staBack={said!r}, and the stations before it lead to "
                    f"{coordinate(zone[1] + zone[2] * (at - zone[0]))}",
                )
            if readings[0] != at:
                notes.append(
                    "Places of station equations are counted from the start: only so do their "
                    "stations back fit."
                )
            at = readings[0]
        word = one.attributes.get("staIncrement", "increasing").strip().lower()
        if word not in ("increasing", "decreasing", ""):
            allowed = "increasing or decreasing is allowed"
            raise fault(one.line, f"a StaEquation has staIncrement={shown(word)}, and {allowed}")
        found.append(StationEquation(at, ahead, word != "decreasing"))
        zone = (at, ahead, 1.0 if word != "decreasing" else -1.0)
    return found, list(dict.fromkeys(notes))


def _read_verticals(node: Node, measures: Measures) -> tuple[list[VerticalAlignment], list[str]]:
    verticals, notes, n_surfaces = [], [], 0
    for profile in node.list_named("Profile"):
        n_surfaces += len(profile.list_named("ProfSurf"))
        for one in profile.list_named("ProfAlign"):
            points = [_read_point(child, measures) for child in one.children]
            name = one.attributes.get("name", "").strip()
            if len(points) < 2:
                notes.append(f"Not read: a vertical alignment of {counted(len(points), 'point')}.")
                continue
            try:
                vertical = VerticalAlignment(points, name)
                _require_one_unit(one, vertical, measures)
                _require_lengths(one, vertical, measures.scale)
                verticals.append(vertical)
            except (OptionError, ReadError) as error:
                notes.append(f"Not read: the vertical alignment {shown(name)}. {error}")
    if n_surfaces:
        notes.append(f"Not read: {counted(n_surfaces, 'profile')} of surfaces (ProfSurf).")
    return verticals, notes


def _require_one_unit(node: Node, vertical: VerticalAlignment, measures: Measures) -> None:
    """Refuse arcs whose elevations are in another unit than stations: they are none there."""
    if vertical.has_arcs and scale_elevations(measures.source, measures.elevation_unit) != 1.0:
        raise fault(
            node.line, "a ProfAlign has arcs, and elevations are in another unit than stations"
        )


def _require_lengths(node: Node, vertical: VerticalAlignment, scale: float) -> None:
    """Refuse arcs whose length is another one than that by their radius."""
    for child, point, length in zip(
        node.children, vertical.points, vertical.curve_lengths, strict=True
    ):
        said = child.parse("length")
        if point.kind != "arc" or said is None:
            continue
        if not abs(said * scale - length) <= max(LARGEST_MISFIT, _SHARE * length):
            raise fault(
                child.line,
                f"a CircCurve has the length {said!r}, and by its radius it has "
                f"{coordinate(length / scale)}",
            )


def _read_point(node: Node, measures: Measures) -> VerticalPoint:
    """Return a point of vertical intersection with its curve."""
    numbers = node.parse_text()
    if len(numbers) != 2:
        raise fault(node.line, f"a {node.name} has {len(numbers)} numbers, and 2 are needed")
    station, elevation = numbers[0] * measures.scale, numbers[1] * measures.elevation_scale
    if node.name == "PVI":
        return VerticalPoint(station, elevation)
    if node.name == "CircCurve":
        radius = abs(node.require("radius")) * measures.scale
        return VerticalPoint(station, elevation, "arc", radius=radius)
    if node.name == "ParaCurve":
        half = node.require("length") * measures.scale / 2.0
        reach = (half, half)
    else:
        reach = tuple(node.require(name) * measures.scale for name in ("lengthIn", "lengthOut"))  # type: ignore[assignment]
    if reach == (0.0, 0.0):
        return VerticalPoint(station, elevation)
    return VerticalPoint(station, elevation, "parabola", *reach)
