"""Title block: title, what the drawing says of itself, north arrow, scale bar and legend."""

from __future__ import annotations

import datetime as dt
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import OptionError
from ...tin import Bounds
from ..drawing import NORTH_ARROW, make_scale_bar, palette, parse_text, parse_title
from .grid import PEN as GRID_PEN
from .mapping import ARMS, AXIS_PEN, CONTOUR_PENS, LINE_PENS, MATCH_PEN, OUTLINE_PEN
from .office_block import draw_office, measure_office
from .paper import (
    INK,
    Caption,
    NoRoom,
    Paper,
    Pen,
    arrange_sheet,
    clean_text,
    find_missing_letters,
    fit_text,
)
from .template import read_template
from .windows import outline, turn

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ...base.crs import CRS, Unit
    from .paper import Drawable, Layout, PaperLike
    from .windows import Window

_BORDER = Pen(INK, 0.5)
_RULE = Pen(INK, 0.25)
_THIN = Pen(INK, 0.13)
_LETTERS_SHOWN = 10
_LEAST_FRAME = 50.0
"""Height left for what is drawn, millimetres."""
_CROSS = np.array([[(-1, 0), (1, 0)], [(0, -1), (0, 1)]])
_LEGEND = {
    "contour": "contour",
    "index contour": "index contour",
    "hard": "breakline",
    "soft": "soft breakline",
    "boundary": "boundary",
    "hole": "hole",
    "water": "water's edge",
    "water area": "water",
    "outline": "edge of the surface",
    "axis": "axis",
    "point": "survey point",
    "spot height": "spot height",
    "sheet": "sheet",
    "match line": "match line",
    "grid": "coordinate grid",
}
_PENS = {
    "contour": CONTOUR_PENS[False],
    "index contour": CONTOUR_PENS[True],
    **LINE_PENS,
    "outline": OUTLINE_PEN,
    "axis": AXIS_PEN,
    "match line": MATCH_PEN,
    "sheet": MATCH_PEN._replace(dashes=()),
}


def begin_caption(
    title: str | None, date: dt.date | str | None, template: Any, *, untitled: str, unit: Unit
) -> Caption:
    """Return what a title block says before anything is drawn.

    Raises OptionError if a text is none, or for what :func:`read_template` refuses.
    """
    heading = clean_text(parse_title(title, untitled))
    day = date.isoformat()[:10] if isinstance(date, dt.date) else date
    office = read_template(template)
    written = clean_text(parse_text("date", day, or_none=True)) or office.date
    return Caption(heading, (), "", "", written, unit, office)


def arrange_sheets(paper: PaperLike, orientation: str | None, caption: Caption) -> list[Layout]:
    """Return the layouts of the sheets that a paper stands for, with room for the caption.

    Raises OptionError if the caption leaves too little of every one.
    """
    measure = partial(measure_office, caption.office)
    layouts = [arrange_sheet(one, measure) for one in Paper.choices(paper, orientation)]
    usable = [one for one in layouts if one.frame.height >= _LEAST_FRAME]
    if not usable:
        left = max(0.0, max(one.frame.height for one in layouts))
        allowed = f"larger: its title block leaves {left:.0f} mm of the height"
        raise OptionError("paper", layouts[0].paper.name, allowed)
    return usable


def describe_crs(crs: CRS | None, unit: Unit) -> str:
    """Return what a title block says of a CRS."""
    return f"CRS unknown, coordinates in {unit.symbol}" if crs is None else crs.caption


def describe_factor_here(factor: float | None) -> Iterator[str]:
    """Yield what a title block says of the scale factor of a CRS, if it is known."""
    if factor is not None:
        yield f"Scale factor of the CRS here {factor:.6f}"


def describe_missing_letters(caption: Caption, more: Iterable[str] = ()) -> Iterator[str]:
    """Tell which letters of a caption, and of more texts, the font does not have."""
    missing = find_missing_letters("".join([*caption.list_texts(), *more]))
    if missing:
        yield (
            f"The font has no {', '.join(repr(one) for one in missing[:_LETTERS_SHOWN])}: boxes "
            "stand in their place."
        )


def draw_title_block(
    canvas: Drawable, layout: Layout, window: Window, caption: Caption, kinds: Sequence[str]
) -> NoRoom:
    """Draw border and title block; return what had no room.

    The legend explains ``kinds``.
    """
    draw_border(canvas, layout)
    _draw_legend(canvas, layout, kinds)
    _draw_north_arrow(canvas, layout, window.angle)
    draw_scale_bar(canvas, layout, window.mm_per_unit, caption.unit)
    return draw_title(canvas, layout, caption)


def draw_border(canvas: Drawable, layout: Layout) -> None:
    """Draw the border of a sheet, and rules around the cells of the title block."""
    canvas.draw_paths([outline(layout.border)], _BORDER, "border")
    top = layout.title.ymax
    rules = [np.array([(layout.border.xmin, top), (layout.border.xmax, top)])]
    for cell in (layout.scales, layout.title):
        rules.append(np.array([(cell.xmin, cell.ymin), (cell.xmin, cell.ymax)]))
    canvas.draw_paths(rules, _RULE, "rules")


# ---------------------------------------------------------------- title


def draw_title(canvas: Drawable, layout: Layout, caption: Caption) -> NoRoom:
    """Write title, facts, scale, date and sheet, and what the office says."""
    cell, factor = layout.title, layout.factor
    pad, foot = 2.0 * factor, 9.5 * factor
    width = cell.width - 2 * pad
    fitted = fit_text(caption.title, width, size=4.2 * factor, least=2.0 * factor, lines=2)
    line = 1.3 * fitted.size
    y = cell.ymax - pad
    for text in fitted.lines:
        canvas.write(
            (cell.xmin + pad, y - 0.8 * fitted.size),
            text,
            size=fitted.size,
            name="title",
        )
        y -= line
    facts = Bounds(cell.xmin + pad, cell.ymin + foot, cell.xmax - pad, y - 0.6 * factor)
    is_cut = _write_facts(canvas, facts, caption.facts, factor)
    is_cut |= _draw_foot(canvas, layout, caption, foot) | fitted.is_cut
    have_room, has_logo = draw_office(canvas, layout, caption.office)
    return NoRoom(is_cut or not have_room, has_logo=has_logo)


def _write_facts(canvas: Drawable, room: Bounds, facts: Sequence[str], factor: float) -> bool:
    """Write a line for each fact, smaller where there are many; tell whether one was cut."""
    step = min(3.6 * factor, room.height / max(1, len(facts)))
    size = min(2.2 * factor, 0.72 * step)
    is_cut = False
    for number, fact in enumerate(facts):
        fitted = fit_text(fact, room.width, size=size, least=0.72 * size)
        place = (room.xmin, room.ymax - number * step - 0.75 * step)
        canvas.write(place, fitted.lines[0], size=fitted.size, name="fact")
        is_cut |= fitted.is_cut
    return is_cut


def _draw_foot(canvas: Drawable, layout: Layout, caption: Caption, height: float) -> bool:
    cell, factor = layout.title, layout.factor
    top = cell.ymin + height
    shares = np.cumsum([0.0, 0.4, 0.3, 0.3]) * cell.width + cell.xmin
    rules = [np.array([(cell.xmin, top), (cell.xmax, top)])]
    rules += [np.array([(x, cell.ymin), (x, top)]) for x in shares[1:-1]]
    canvas.draw_paths(rules, _THIN, "rules")
    is_cut = False
    for number, (head, text) in enumerate(
        (("Scale", caption.scale), ("Date", caption.date), ("", caption.sheet))
    ):
        left, width = float(shares[number]) + factor, float(np.diff(shares)[number]) - 2 * factor
        if head:
            canvas.write(
                (left, top - 2.4 * factor), head, size=1.6 * factor, color=palette.GREY_PLAN
            )
        fitted = fit_text(text, width, size=3.0 * factor, least=1.5 * factor)
        canvas.write(
            (left, cell.ymin + 2.0 * factor), fitted.lines[0], size=fitted.size, name="fact"
        )
        is_cut |= fitted.is_cut
    return is_cut


# ---------------------------------------------------------------- north and scale


def _draw_north_arrow(canvas: Drawable, layout: Layout, angle: float) -> None:
    """Draw an arrow to grid north, turned against the sheet."""
    cell, factor = layout.scales, layout.factor
    middle = np.array([cell.xmin + cell.width / 2, cell.ymin + 0.66 * cell.height])
    shape = turn(7.0 * factor * NORTH_ARROW, -angle) + middle
    canvas.fill([shape[[0, 1, 2, 0]]], INK, "north-arrow")
    canvas.draw_paths([shape[[0, 1, 2, 3, 0]]], _RULE, "north-arrow-outline")
    beside = turn(np.array([4.6 * factor, 5.4 * factor]), -angle) + middle
    canvas.write(
        tuple(beside.tolist()),
        "N",
        size=3.2 * factor,
        rotation=-angle,
        across="center",
        up="center_baseline",
        name="north",
    )


def draw_scale_bar(canvas: Drawable, layout: Layout, mm_per_unit: float, unit: Unit) -> None:
    """Draw a bar of four parts, black and white, with its ends and middle labelled."""
    cell, factor = layout.scales, layout.factor
    bar = make_scale_bar(unit, (cell.width - 12.0 * factor) / mm_per_unit)
    width, height = bar.length * mm_per_unit, 1.5 * factor
    left, low = cell.xmin + (cell.width - width) / 2, cell.ymin + 3.4 * factor
    for part in range(4):
        box = Bounds(left + part * width / 4, low, left + (part + 1) * width / 4, low + height)
        canvas.fill([outline(box)], INK if part % 2 == 0 else "white", "scale-bar-part")
    whole = outline(Bounds(left, low, left + width, low + height))
    canvas.draw_paths([whole], _THIN, "scale-bar")
    for share, text in bar.labels:
        canvas.write(
            (left + share * width, low + height + 0.8 * factor),
            text,
            size=1.9 * factor,
            across="center",
            name="scale-bar-label",
        )
    canvas.write(
        (left + width / 2, low - 0.7 * factor),
        bar.symbol or unit.name,
        size=1.9 * factor,
        across="center",
        up="top",
        name="scale-bar-unit",
    )


# ---------------------------------------------------------------- legend


def _draw_legend(canvas: Drawable, layout: Layout, kinds: Sequence[str]) -> None:
    """Explain what is drawn, in columns from left to right."""
    cell, factor = layout.legend, layout.factor
    listed = [kind for kind in _LEGEND if kind in kinds]
    step, head = 4.6 * factor, 5.4 * factor
    rows = int((cell.height - head - factor) // step)
    columns = max(1, -(-len(listed) // rows))
    width = min(46.0 * factor, (cell.width - 2 * factor) / columns)
    left, top = cell.xmin + 2.5 * factor, cell.ymax - head
    canvas.write(
        (left, cell.ymax - 3.8 * factor), "Legend", size=2.2 * factor, color=palette.GREY_PLAN
    )
    for number, kind in enumerate(listed):
        x = left + (number // rows) * width
        y = top - (number % rows + 0.5) * step
        _draw_sample(canvas, kind, x, y, factor)
        room = width - 13.0 * factor
        fitted = fit_text(_LEGEND[kind], room, size=2.2 * factor, least=1.2 * factor)
        canvas.write((x + 11.5 * factor, y), fitted.lines[0], size=fitted.size,
                     up="center_baseline", name="legend")  # fmt: skip


def _draw_sample(canvas: Drawable, kind: str, x: float, y: float, factor: float) -> None:
    width = 9.5 * factor
    if kind == "water area":
        box = Bounds(x, y - 1.3 * factor, x + width, y + 1.3 * factor)
        canvas.fill([outline(box)], palette.WATER, "legend-sample")
        return
    if kind in ARMS or kind == "grid":
        arms, pen = (ARMS[kind], _THIN) if kind in ARMS else (2.0 * _CROSS, GRID_PEN)
        canvas.draw_paths(list(arms + np.array([x + width / 2, y])), pen, "legend-sample")
        return
    canvas.draw_paths([np.array([(x, y), (x + width, y)])], _PENS[kind], "legend-sample")
