"""Arrangement: the scale of section sheets, and where each section has its place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from ....base.errors import OptionError
from ..scales import Scale
from .cells import choose_measures

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.crs import Unit
    from ....tin import Bounds
    from ..paper import Layout
    from .cells import Measures, Section

_GAP = 6.0
"""Millimetres between cells."""
_AT_ONCE = 4
"""So many sections have room on a sheet of a scale that is chosen, where there are as many."""
_ROUNDING = 1e-9


class Request(NamedTuple):
    """What is to be arranged."""

    sections: tuple[Section, ...]
    names: tuple[str, ...]
    """Of the surfaces."""
    reaches: tuple[float, float]
    """First and last offset."""
    unit: Unit
    """Of offsets."""
    ratio: float
    """Of the length on paper of a unit of elevations to that of a unit of offsets."""


class Spot(NamedTuple):
    """Where a section is drawn."""

    section: int
    place: tuple[float, float]
    """Lower left corner of its cell, millimetres."""


class Drawing(NamedTuple):
    """Sections, how they are measured, and where each has its place."""

    sections: tuple[Section, ...]
    measures: Measures
    sheets: tuple[tuple[Spot, ...], ...]
    layout: Layout
    scale: Scale


def arrange(request: Request, layouts: Sequence[Layout], scale: Scale | None) -> Drawing:
    """Choose paper and scale, and place each section.

    Of several papers the one with most sections is taken. Raises OptionError if a section is larger
    than a sheet at the scale, or at any.
    """
    if scale is None:
        wanted = min(_AT_ONCE, len(request.sections))
        scale = _find_largest(request, layouts, wanted) or _find_largest(request, layouts, 1)
        if scale is None:
            allowed = "larger, or surfaces fewer: a section has no room on it at any scale"
            raise OptionError("paper", layouts[0].paper.name, allowed)
    measures = _measure(request, scale)
    heights = [measures.measure_height(one) for one in request.sections]
    counts = [_count_cells(measures.width, max(heights), one.frame) for one in layouts]
    if not max(counts):
        fitting = _find_largest(request, layouts, 1)
        where = f"for the largest section to have room on {layouts[0].paper.name}"
        if fitting is None or fitting.denominator <= scale.denominator:
            raise OptionError("scale", scale.text, f"one {where}: larger paper is needed")
        raise OptionError("scale", scale.text, f"{fitting.text} or smaller, {where}")
    layout = layouts[counts.index(max(counts))]
    sheets = _lay_out(heights, measures.width, layout.frame)
    return Drawing(request.sections, measures, sheets, layout, scale)


def _measure(request: Request, scale: Scale) -> Measures:
    """Return how sections are drawn at a scale."""
    known = [one.ends for one in request.sections if not math.isnan(one.ends[0])]
    ends = min(low for low, _ in known), max(high for _, high in known)
    along = scale.measure_unit(request.unit)
    factors = (along, along * request.ratio)
    return choose_measures(ends, request.names, request.reaches, factors, scale)


def _find_largest(request: Request, layouts: Sequence[Layout], wanted: int) -> Scale | None:
    """Return the largest usual scale with which so many sections have room on a sheet."""
    for scale in Scale.usual(request.unit):
        try:
            measures = _measure(request, scale)
        except OptionError:  # elevations are not known so finely
            continue
        frames = [one.frame for one in layouts if _count_columns(measures.width, one.frame)]
        if not frames:
            continue
        tallest = max(map(measures.measure_height, request.sections))
        if any(_count_cells(measures.width, tallest, one) >= wanted for one in frames):
            return scale
    return None


def _count_columns(width: float, frame: Bounds) -> int:
    return int((frame.width + _GAP + _ROUNDING) // (width + _GAP))


def _count_cells(width: float, height: float, frame: Bounds) -> int:
    """Return how many cells of a size have room in a frame."""
    rows = int((frame.height + _GAP + _ROUNDING) // (height + _GAP))
    return rows * _count_columns(width, frame)


def _lay_out(heights: Sequence[float], width: float, frame: Bounds) -> tuple[tuple[Spot, ...], ...]:
    """Return the sections of each sheet: columns from left to right, each from the bottom up.

    All fit: no height is above the frame's, and at least one column has room.
    """
    columns = _count_columns(width, frame)
    pitch = frame.width / columns
    sheets: list[list[Spot]] = [[]]
    column, y = 0, frame.ymin
    for number, height in enumerate(heights):
        if y + height > frame.ymax + _ROUNDING:
            column, y = column + 1, frame.ymin
        if column == columns:
            sheets.append([])
            column = 0
        x = frame.xmin + column * pitch + (pitch - width) / 2.0
        sheets[-1].append(Spot(number, (x, y)))
        y += height + _GAP
    return tuple(map(tuple, sheets))
