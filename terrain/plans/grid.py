"""Coordinate grid: crosses or lines at round eastings and northings, labelled at the frame."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.georeference import label_axes
from ..drawing import palette, round_down
from .clipping import clip_paths, join_paths
from .paper import Drawable, Pen, measure_text
from .windows import turn

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...base.georeference import Label as AxisLabel
    from ...tin import Bounds
    from .windows import Window

    Axes = tuple[AxisLabel, AxisLabel]

PEN = Pen(palette.GRID_PLAN, 0.13)
_TICK = Pen(palette.INK_PLAN, 0.18)
_WIDEST = 100.0
"""Millimetres between lines of the grid at most."""
_ARM = 2.5
"""Of a cross, millimetres."""
_TICK_LENGTH = 1.5
_SIZE = 2.0
_GAP = 2.0
"""Between labels, millimetres."""


class Label(NamedTuple):
    """What is written where a line of the grid meets the frame."""

    place: tuple[float, float]
    """On the frame."""
    side: str
    """Of the map: "bottom", "right", "top" or "left"."""
    text: str


def find_spacing(mm_per_unit: float) -> float:
    """Return the round distance between lines of the grid, in units of the coordinates.

    Examples
    --------
    >>> find_spacing(2.0), find_spacing(1000 / 240 * 0.3048)  # 1:500 in metres, 1" = 20' in feet
    (50.0, 50.0)
    """
    return round_down(_WIDEST / mm_per_unit)


def find_cross_places(window: Window) -> Float64Array:
    """Return where lines of the grid cross on paper, within the frame."""
    spacing = find_spacing(window.mm_per_unit)
    eastings, northings = (_list_multiples(window, axis, spacing) for axis in (0, 1))
    places = np.array([(e, n) for n in northings for e in eastings]).reshape(-1, 2)
    on_paper = window.to_paper(places)
    return on_paper[_is_inside(on_paper, window.frame)]


def _list_multiples(window: Window, axis: int, spacing: float) -> list[float]:
    along = window.corners[:, axis]
    first, last = math.ceil(along.min() / spacing), math.floor(along.max() / spacing)
    return [round(k * spacing, 9) for k in range(first, last + 1)]


def _is_inside(places: Float64Array, box: Bounds) -> BoolArray:
    x, y = places[:, 0], places[:, 1]
    return (x >= box.xmin) & (x <= box.xmax) & (y >= box.ymin) & (y <= box.ymax)


def _list_lines(window: Window, axes: Axes) -> list[tuple[str, Float64Array]]:
    """Return each line of the grid on paper, with what is written at it, clipped to the frame."""
    spacing = find_spacing(window.mm_per_unit)
    decimals = max(0, -math.floor(math.log10(spacing)))
    low, high = window.corners.min(axis=0), window.corners.max(axis=0)
    lines = []
    for axis, label in enumerate(axes):
        letter = label.name[0].upper()
        for value in _list_multiples(window, axis, spacing):
            ends = np.array([low, high])
            ends[:, axis] = value
            for part in clip_paths(join_paths([window.to_paper(ends)]), window.frame).parts():
                lines.append((f"{label.of(value):.{decimals}f} {letter}", part[[0, -1]]))
    return lines


# ---------------------------------------------------------------- labels


def find_labels(window: Window, axes: Axes | None = None) -> list[Label]:
    """Return the labels around the frame; of two that would meet, one is left out.

    ``axes`` tell how coordinates across and up the map are written, by default as eastings and
    northings.
    """
    on_sides: dict[str, list[Label]] = {}
    for text, ends in _list_lines(window, axes or label_axes(None)):
        for x, y in ends.tolist():
            side = _find_side(x, y, window.frame)
            if side:
                on_sides.setdefault(side, []).append(Label((x, y), side, text))
    return [label for labels in on_sides.values() for label in _part(labels, window.frame)]


def _find_side(x: float, y: float, box: Bounds) -> str:
    distances = {
        "bottom": y - box.ymin,
        "top": box.ymax - y,
        "left": x - box.xmin,
        "right": box.xmax - x,
    }
    side = min(distances, key=lambda name: abs(distances[name]))
    return side if abs(distances[side]) < 1e-6 else ""


def _part(labels: list[Label], box: Bounds) -> list[Label]:
    """Leave labels out that would meet the one before them on a side."""
    kept: list[Label] = []
    reached = -math.inf
    for label in sorted(labels, key=lambda one: _find_middle(one, box)):
        half = measure_text(label.text, _SIZE) / 2
        middle = _find_middle(label, box)
        if middle - half >= reached:
            kept.append(label)
            reached = middle + half + _GAP
    return kept


def _find_middle(label: Label, box: Bounds) -> float:
    """Return where the middle of a label is along its side: not beyond the corners."""
    half = measure_text(label.text, _SIZE) / 2
    if label.side in ("bottom", "top"):
        return min(max(label.place[0], box.xmin + half), box.xmax - half)
    return min(max(label.place[1], box.ymin + half), box.ymax - half)


# ---------------------------------------------------------------- drawing


def draw_grid(canvas: Drawable, window: Window, style: str, axes: Axes) -> None:
    """Draw the grid within the frame, ticks and labels around it."""
    if style == "none":
        return
    if style == "lines":
        canvas.draw_paths([ends for _, ends in _list_lines(window, axes)], PEN, "grid-lines")
    else:
        canvas.draw_paths(_list_arms(window), PEN, "grid-crosses")
    labels = find_labels(window, axes)
    canvas.draw_paths([_make_tick(label) for label in labels], _TICK, "grid-ticks")
    for label in labels:
        _write_label(canvas, label, window.frame)


def _list_arms(window: Window) -> list[Float64Array]:
    """Return both arms of every cross, along the lines of the grid."""
    arms = []
    for place in find_cross_places(window):
        for arm in ((_ARM, 0.0), (0.0, _ARM)):
            along = turn(np.array(arm), -window.angle)
            arms.append(np.array([place - along, place + along]))
    return clip_paths(join_paths(arms), window.frame).parts()


_OUTWARD = {"bottom": (0, -1), "top": (0, 1), "left": (-1, 0), "right": (1, 0)}


def _make_tick(label: Label) -> Float64Array:
    outward = np.array(_OUTWARD[label.side])
    return np.array([label.place, label.place + _TICK_LENGTH * outward])


def _write_label(canvas: Drawable, label: Label, box: Bounds) -> None:
    middle, beside = _find_middle(label, box), _TICK_LENGTH + 0.6
    is_level = label.side in ("bottom", "top")
    place = {
        "bottom": (middle, box.ymin - beside),
        "top": (middle, box.ymax + beside),
        "left": (box.xmin - beside, middle),
        "right": (box.xmax + beside, middle),
    }[label.side]
    canvas.write(
        place,
        label.text,
        size=_SIZE,
        rotation=0.0 if is_level else 90.0,
        across="center",
        up="top" if label.side in ("bottom", "right") else "bottom",
        name="grid-label",
    )
