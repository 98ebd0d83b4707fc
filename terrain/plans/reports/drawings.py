"""Drawings of a report: the map of cut and fill, and two sections through both surfaces."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import OptionError
from ....base.georeference import label_axes, undo_north_up
from ....tin import Bounds
from ...drawing import draw_north_up
from ...sections import cross_sections
from ..arrangement import ShownArea, choose_single
from ..footprint import Footprint, find_footprint
from ..grid import draw_grid
from ..mapping import OUTLINE_PEN
from ..paper import INK, Pen
from ..scales import Scale, describe_elevation_scale
from ..sheets import TINTS, Cell, Section, choose_measures, draw_samples, list_sections
from ..windows import outline

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import Float64Array
    from ....base.crs import Unit
    from ....tin import TIN
    from ...earthwork import Difference
    from ..paper import Drawable, Layout
    from ..sheets import Measures, Units
    from ..windows import Window

_ZERO = Pen(INK, 0.18)
_LINE = Pen(INK, 0.25, (6.0, 1.5, 1.0, 1.5))
_FRAME = Pen(INK, 0.25)
_LETTER = 3.0
_GAP = 8.0
_EXAGGERATIONS = (10.0, 5.0, 2.0, 1.0)
_NAMES = ("ground", "design")


class Map(NamedTuple):
    """Cut and fill in the plane."""

    window: Window
    layout: Layout
    scale: Scale
    footprint: Footprint
    lines: tuple[Float64Array, Float64Array]
    """Both sections, each (2, 2), as drawings have coordinates."""


class Profiles(NamedTuple):
    """Both sections, and how each is measured on paper."""

    sections: tuple[Section, Section]
    measures: tuple[Measures, Measures]
    scale: Scale
    exaggeration: float

    @property
    def elevation_scale(self) -> str:
        """Scale of elevations, as it is written."""
        return describe_elevation_scale(self.scale, self.exaggeration)


# ---------------------------------------------------------------- map


def make_map(difference: Difference, layouts: Sequence[Layout], unit: Unit) -> Map:
    """Return the map at the largest usual scale, with sections where the difference is largest."""
    shown = draw_north_up(difference.tin)
    footprint = find_footprint(shown)
    bounds = Bounds.of(shown.points[np.unique(shown.triangles)][:, :2])
    ground = ShownArea(bounds, footprint, unit)
    layout, scale, window = choose_single(ground, layouts, None)
    corners = shown.points[shown.triangles]
    place = corners[np.argmax(np.abs(corners[:, :, 2].mean(axis=1)))].mean(axis=0)[:2]
    west_east = np.array([(bounds.xmin, place[1]), (bounds.xmax, place[1])])
    south_north = np.array([(place[0], bounds.ymin), (place[0], bounds.ymax)])
    return Map(window, layout, scale, footprint, (west_east, south_north))


def draw_map(canvas: Drawable, drawn: Map, difference: Difference) -> None:
    """Draw what is cut and filled, the lines between, and where the sections are."""
    window = drawn.window
    zones, zero = draw_north_up(difference.zones), draw_north_up(difference.zero_line)
    shapes: dict[str, list[Float64Array]] = {"cut": [], "fill": []}
    rings = _split(window.to_paper(zones.coordinates), zones.offsets[0])
    ends = zones.offsets[1] if len(zones.offsets) == 2 else zones.offsets[1][zones.offsets[2]]
    for number, kind in enumerate(zones.columns["kind"].tolist()):
        shapes.get(kind, []).extend(rings[ends[number] : ends[number + 1]])
    for kind, own in shapes.items():
        if own:
            canvas.fill(own, TINTS[kind], kind)
    draw_grid(canvas, window, "crosses", label_axes(difference.tin.crs))
    edges = [
        window.to_paper(np.array(ring.coords))
        for face in drawn.footprint.faces
        for ring in (face.exterior, *face.interiors)
    ]
    canvas.draw_paths(edges, OUTLINE_PEN, "edge")
    canvas.draw_paths(
        _split(window.to_paper(zero.coordinates), zero.offsets[0]), _ZERO, "zero-line"
    )
    for letter, line in zip("AB", drawn.lines, strict=True):
        placed = window.to_paper(line)
        canvas.draw_paths([placed], _LINE, "section-line")
        for (x, y), (dx, dy) in zip(placed.tolist(), _find_sides(placed), strict=True):
            place = (x + dx * _LETTER, y + dy * _LETTER)
            canvas.write(
                place,
                letter,
                size=_LETTER,
                across="center",
                up="center_baseline",
                name="section-letter",
            )
    canvas.draw_paths([outline(window.frame)], _FRAME, "frame")


def draw_map_legend(canvas: Drawable, layout: Layout) -> bool:
    """Explain the colours and lines of a map; tell whether all had room."""
    lines = {
        "edge of cut and fill": _ZERO,
        "edge of what was compared": OUTLINE_PEN,
        "section": _LINE,
    }
    return draw_samples(
        canvas, layout, [("cut", None), ("fill", None), *lines.items()], is_plain=True
    )


def _find_sides(placed: Float64Array) -> list[tuple[float, float]]:
    """Return which way from both ends of a line there is room: beside it, inward a little."""
    if abs(placed[1, 0] - placed[0, 0]) > abs(placed[1, 1] - placed[0, 1]):
        return [(0.4, 0.7), (-0.4, 0.7)]
    return [(0.7, 0.4), (0.7, -0.4)]


def _split(coordinates: Float64Array, offsets: object) -> list[Float64Array]:
    return np.split(coordinates, np.asarray(offsets)[1:-1])


# ---------------------------------------------------------------- sections


def cut_profiles(
    surfaces: tuple[TIN, TIN], lines: Sequence[Float64Array], frame: Bounds, units: Units
) -> Profiles:
    """Cut both surfaces along two lines, at the largest usual scale with room for both."""
    sections = tuple(
        _cut(surfaces, lines[number], lines[1 - number], letter=letter, units=units)
        for number, letter in enumerate("AB")
    )
    for scale in Scale.usual(units.along):
        for exaggeration in _EXAGGERATIONS:
            measures = _measure(sections, scale, exaggeration, units)
            if measures is None:
                continue
            heights = [one.measure_height(own) for one, own in zip(measures, sections, strict=True)]
            if sum(heights) + _GAP <= frame.height and all(
                one.width <= frame.width for one in measures
            ):
                return Profiles((sections[0], sections[1]), measures, scale, exaggeration)
    raise OptionError("paper", "this one", "larger: sections through the surfaces have no room")


def _cut(
    surfaces: tuple[TIN, TIN],
    line: Float64Array,
    across: Float64Array,
    *,
    letter: str,
    units: Units,
) -> Section:
    """Return the section along a line, square to the other one where both meet."""
    axis = across[::-1] if letter == "B" else across  # so that offsets go east, and north
    at = abs(float(line[0] @ _ahead(axis)) - float(axis[0] @ _ahead(axis)))
    middle = axis[0] + at * _ahead(axis)
    left, right = (float(np.hypot(*(end - middle))) for end in line)
    named = dict(zip(_NAMES, surfaces, strict=True))
    centreline = undo_north_up(axis, surfaces[0].crs)
    table = cross_sections(named, centreline, stations=[at], left=left, right=right)
    (section,) = list_sections(table, _NAMES, units)
    words = {"A": "A: from west to east", "B": "B: from south to north"}
    return replace(section, station=f"Section {words[letter]}")


def _ahead(axis: Float64Array) -> Float64Array:
    along: Float64Array = (axis[1] - axis[0]) / np.hypot(*(axis[1] - axis[0]))
    return along


def _measure(
    sections: Sequence[Section], scale: Scale, exaggeration: float, units: Units
) -> tuple[Measures, Measures] | None:
    along = scale.measure_unit(units.along)
    factors = (along, along * units.factor * exaggeration)
    try:
        first, second = (
            choose_measures(
                one.ends, _NAMES, (float(one.offsets[0]), float(one.offsets[-1])), factors, scale
            )
            for one in sections
        )
    except OptionError:  # elevations are not known so finely
        return None
    return first, second


def draw_profiles(canvas: Drawable, drawn: Profiles, frame: Bounds) -> bool:
    """Draw both sections, the first above the second; tell whether all texts had room."""
    y, have_room = frame.ymin, True
    pairs = list(zip(drawn.sections, drawn.measures, strict=True))
    for section, measures in reversed(pairs):
        x = frame.xmin + (frame.width - measures.width) / 2.0
        have_room &= Cell(canvas, measures, section).draw((x, y))
        y += measures.measure_height(section) + _GAP
    return have_room
