"""Arrangement: which ground each sheet shows: one sheet, rows of sheets, strips along an axis."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.errors import OptionError
from ...base.sentences import counted
from ...tin import Bounds
from .scales import Scale
from .strips import cut_strips
from .windows import MatchLine, Window

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import AnyArray, BoolArray, Float64Array
    from ...base.crs import Unit
    from .footprint import Footprint
    from .paper import Layout

MOST_SHEETS = 500
OVERLAP = 8.0
"""Millimetres that a sheet shows beyond a match line."""
_MOST_PLACES = 100_000
"""Of which most have no ground, where rows are laid over a long surface."""
_AIR = 2.0
"""Millimetres between a surface and the frame."""


class ShownArea(NamedTuple):
    """What is to be shown."""

    bounds: Bounds
    footprint: Footprint
    unit: Unit
    """Of the coordinates."""


def choose_single(
    ground: ShownArea, layouts: Sequence[Layout], scale: Scale | None
) -> tuple[Layout, Scale, Window]:
    """Return the window that shows all of the ground, north up.

    Of the layouts the one with the largest scale is taken, and of several the first; the scale is
    by default the largest of the usual ones that fits, with air between the ground and the frame.
    Raises OptionError if the scale is too large.
    """
    fits = [find_fitting(ground.bounds, one, ground.unit) for one in layouts]
    best = int(np.argmin([fit.denominator for fit in fits]))
    layout, largest = layouts[best], fits[best]
    if scale is None:
        scale = largest
    elif not _fits(ground.bounds, layout, scale.measure_unit(ground.unit)):
        raise _describe_too_large(ground, layout, scale, largest)
    length = scale.measure_unit(ground.unit)
    return layout, scale, Window(ground.bounds.center, 0.0, length, layout.frame)


def find_fitting(bounds: Bounds, layout: Layout, unit: Unit) -> Scale:
    """Return the largest usual scale at which a rectangle fits the frame.

    Raises OptionError if there is none.
    """
    for scale in Scale.usual(unit):
        if _fits(bounds, layout, scale.measure_unit(unit)):
            return scale
    raise OptionError(
        "tin", f"{bounds.width:g} x {bounds.height:g} {unit.symbol}", "small enough for a sheet"
    )


def _fits(bounds: Bounds, layout: Layout, length: float) -> bool:
    room = layout.frame.width - 2 * _AIR, layout.frame.height - 2 * _AIR
    return bounds.width * length <= room[0] and bounds.height * length <= room[1]


def _describe_too_large(
    ground: ShownArea, layout: Layout, scale: Scale, largest: Scale
) -> OptionError:
    length = scale.measure_unit(ground.unit)
    across, up = ground.bounds.width * length, ground.bounds.height * length
    frame = layout.frame
    return OptionError(
        "scale",
        scale.text,
        f"{largest.text} or smaller on {layout.paper.name}, whose map has {frame.width:.0f} x "
        f"{frame.height:.0f} mm, for the surface would take {across:.0f} x {up:.0f} mm; or the "
        "paper larger; or the layout 'rows' or 'strips', which cut it into several sheets",
    )


# ---------------------------------------------------------------- rows


def cut_rows(ground: ShownArea, layout: Layout, scale: Scale) -> list[Window]:
    """Return windows in rows from north to south, each from west to east, where there is ground.

    Raises OptionError if there would be too many.
    """
    shapely = optional.load("shapely")
    length = scale.measure_unit(ground.unit)
    width, height = _find_step(layout, length)
    bounds = ground.bounds
    columns = max(1, math.ceil(bounds.width / width))
    rows = max(1, math.ceil(bounds.height / height))
    if columns * rows > _MOST_PLACES:
        require_few(columns * rows, scale, layout)
    west, north = bounds.center[0] - columns * width / 2, bounds.center[1] + rows * height / 2
    row, column = (axis.ravel() for axis in np.indices((rows, columns)))
    x, y = west + column * width, north - row * height
    is_kept = _find_ground(ground.footprint, shapely.box(x, y - height, x + width, y))
    places = list(zip(row[is_kept].tolist(), column[is_kept].tolist(), strict=True))
    require_few(len(places), scale, layout)
    number = {place: k for k, place in enumerate(places)}
    boxes = [
        Bounds(left, top - height, left + width, top)
        for left, top in zip(x[is_kept].tolist(), y[is_kept].tolist(), strict=True)
    ]
    return [
        Window(box.center, 0.0, length, layout.frame, tuple(_match_neighbors(place, box, number)))
        for place, box in zip(places, boxes, strict=True)
    ]


def _find_step(layout: Layout, length: float) -> tuple[float, float]:
    """Return width and height of the ground that a sheet shows alone, CRS units."""
    frame = layout.frame
    return (frame.width - 2 * OVERLAP) / length, (frame.height - 2 * OVERLAP) / length


def _find_room(layout: Layout, length: float) -> tuple[float, float]:
    """Return width and height of the ground that a frame has room for, CRS units."""
    frame = layout.frame
    return (frame.width - 2 * _AIR) / length, (frame.height - 2 * _AIR) / length


def _find_ground(footprint: Footprint, boxes: AnyArray) -> BoolArray:
    """Tell which rectangles hold some of a footprint."""
    shapely = optional.load("shapely")
    shapely.prepare(footprint.faces)
    is_kept = np.zeros(len(boxes), np.bool_)
    for face in footprint.faces:
        is_kept |= shapely.intersects(face, boxes)
    return is_kept


def _match_neighbors(
    place: tuple[int, int], box: Bounds, number: dict[tuple[int, int], int]
) -> list[MatchLine]:
    row, column = place
    west, south, east, north = box.xmin, box.ymin, box.xmax, box.ymax
    sides = {
        (row - 1, column): ((west, north), (east, north)),
        (row, column - 1): ((west, south), (west, north)),
        (row, column + 1): ((east, south), (east, north)),
        (row + 1, column): ((west, south), (east, south)),
    }
    return [MatchLine(np.array(sides[one]), number[one]) for one in sides if one in number]


def require_few(n_sheets: float, scale: Scale, layout: Layout) -> None:
    """Refuse more sheets than anybody prints."""
    if n_sheets > MOST_SHEETS:
        raise OptionError(
            "scale",
            scale.text,
            f"smaller: there would be {counted(int(n_sheets), 'sheet')} of {layout.paper.name}, "
            f"and at most {MOST_SHEETS} are drawn",
        )


# ---------------------------------------------------------------- strips


def cut_strip_windows(
    ground: ShownArea, layout: Layout, scale: Scale, axis: Float64Array | None
) -> list[Window]:
    """Return windows one after the other along an axis, the way on to the right of each.

    Raises OptionError if a strip is too narrow for the ground, or there would be too many.
    """
    shapely = optional.load("shapely")
    length = scale.measure_unit(ground.unit)
    width, height = _find_step(layout, length)
    area = float(shapely.area(ground.footprint.faces).sum())
    require_few(area / (width * height), scale, layout)
    strips = cut_strips(ground.footprint, width, _find_room(layout, length), axis)
    if strips is None:
        raise OptionError("scale", scale.text, _describe_too_wide(ground, layout, scale, axis))
    require_few(len(strips), scale, layout)
    return [_as_window(k, strips, layout, length) for k in range(len(strips))]


def _as_window(number: int, strips: Sequence[Any], layout: Layout, length: float) -> Window:
    strip = strips[number]
    plain = Window(strip.center, strip.angle, length, layout.frame)
    joints = [(strips[number - 1].end, number - 1)] if number else []
    joints += [(strip.end, number + 1)] if number + 1 < len(strips) else []
    matches = tuple(MatchLine(_reach(plain, joint), other) for joint, other in joints)
    return Window(plain.center, plain.angle, length, layout.frame, matches)


def _reach(window: Window, joint: Any) -> Float64Array:
    """Return the ends of a match line so long that it crosses all of the frame."""
    reach = (window.frame.width + window.frame.height) / window.mm_per_unit
    across = np.array([-math.sin(joint.angle), math.cos(joint.angle)])
    return np.array([joint.place - reach * across, joint.place + reach * across])


def _describe_too_wide(
    ground: ShownArea, layout: Layout, given: Scale, axis: Float64Array | None
) -> str:
    """Say at which smaller scale strips would be wide enough."""
    of = f"strips of {layout.paper.name} along {'its own' if axis is None else 'the given'} axis"
    for scale in Scale.usual(ground.unit):
        if scale.denominator <= given.denominator:
            continue
        length = scale.measure_unit(ground.unit)
        room = _find_room(layout, length)
        if cut_strips(ground.footprint, _find_step(layout, length)[0], room, axis) is not None:
            return (
                f"{scale.text} or smaller, for the surface is too wide for {of}; or the layout "
                "'rows'"
            )
    return f"smaller, for the surface is too wide for {of}"
