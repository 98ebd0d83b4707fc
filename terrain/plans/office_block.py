"""Office's block: company, client, numbers, names and revisions, below the title block."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...tin import Bounds
from .paper import GREY, INK, Pen, fit_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import AnyArray, Float64Array
    from .paper import Drawable, Layout, Office

_COMPANY, _REVISIONS = 50.0, 84.0
"""Widths on A4; that of the revisions is that of the title above them."""
_NARROWEST = 28.0
"""Of a field."""
_ROW, _LINE = 8.5, 4.0
"""Heights of a field, and of a line of revisions."""
_LEAST, _WITH_LOGO = 12.0, 17.0
"""Heights of all of it at least."""
_HEAD, _SIZE, _SMALLEST = 1.6, 2.4, 1.3
_SHARES = (0.0, 0.1, 0.32, 0.84, 1.0)
_HEADS = ("Rev.", "Date", "Revision", "By")
_THIN = Pen(INK, 0.13)
_RULE = Pen(INK, 0.25)


def measure_office(office: Office, width: float) -> float:
    """Return the height of what an office says, in a width, millimetres; 0 if it says nothing."""
    if not office.has_band:
        return 0.0
    _, room, _ = _divide(office, width)
    _, rows = _count_cells(office, room)
    lines = 1 + len(office.revisions) if office.revisions else 0
    least = _LEAST if office.logo is None else _WITH_LOGO
    return max(least, rows * _ROW, lines * _LINE)


def _divide(office: Office, width: float) -> tuple[float, float, float]:
    """Return the widths for the company, the fields and the revisions."""
    company = _COMPANY if office.company or office.logo is not None else 0.0
    revisions = _REVISIONS if office.revisions else 0.0
    return company, width - company - revisions, revisions


def _count_cells(office: Office, width: float) -> tuple[int, int]:
    """Return how many columns and rows of fields there are."""
    count = len(office.fields)
    rows = math.ceil(count / max(1, int(width / _NARROWEST)))
    return math.ceil(count / max(1, rows)), rows


def draw_office(canvas: Drawable, layout: Layout, office: Office) -> tuple[bool, bool]:
    """Draw what an office says; tell whether all had room, and whether the logo could be drawn."""
    box, factor = layout.office, layout.factor
    if not office.has_band:
        return True, True
    company, fields, _ = _divide(office, box.width / factor)
    left, right = box.xmin + factor * company, box.xmin + factor * (company + fields)
    rules = [np.array([(box.xmin, box.ymax), (box.xmax, box.ymax)])]
    sides = {left} if company else set()
    sides |= {right} if office.revisions else set()
    rules += [np.array([(x, box.ymin), (x, box.ymax)]) for x in sorted(sides)]
    canvas.draw_paths(rules, _RULE, "rules")
    have_room, has_logo = _draw_company(
        canvas, Bounds(box.xmin, box.ymin, left, box.ymax), office, factor
    )
    have_room &= _draw_fields(canvas, Bounds(left, box.ymin, right, box.ymax), office, factor)
    revisions = Bounds(right, box.ymin, box.xmax, box.ymax)
    return have_room & _draw_revisions(canvas, revisions, office, factor), has_logo


def _draw_company(
    canvas: Drawable, box: Bounds, office: Office, factor: float
) -> tuple[bool, bool]:
    """Draw the logo above the company's name; tell whether both could be."""
    pad, top, has_logo = 2.0 * factor, box.ymax, True
    if office.logo is not None:
        low = box.ymin + pad + (5.0 * factor if office.company else 0.0)
        room = Bounds(box.xmin + pad, low, box.xmax - pad, box.ymax - pad)
        has_logo = canvas.draw_picture(_fit_picture(office.logo, room), office.logo)
        top = low - 0.2 * factor if has_logo else top
    if not office.company:
        return True, has_logo
    fitted = fit_text(office.company, box.width - 2 * pad, size=3.2 * factor,
                      least=_SMALLEST * factor, lines=1 if top < box.ymax else 2)  # fmt: skip
    middle = (box.ymin + top) / 2 if top == box.ymax else box.ymin + 3.4 * factor
    _write_lines(canvas, (box.xmin + pad, middle), fitted.lines, fitted.size, "company")
    return not fitted.is_cut, has_logo


def _fit_picture(picture: AnyArray, room: Bounds) -> Bounds:
    """Return the largest box of a picture's shape, in the middle of a room."""
    rows, columns = picture.shape[:2]
    side = min(room.width / columns, room.height / rows)
    (x, y), width, height = room.center, side * columns / 2, side * rows / 2
    return Bounds(x - width, y - height, x + width, y + height)


def _write_lines(
    canvas: Drawable, place: tuple[float, float], lines: Sequence[str], size: float, name: str
) -> None:
    """Write lines around a height."""
    x, y = place
    top = y + 0.6 * size * (len(lines) - 1)
    for number, text in enumerate(lines):
        at = (x, top - 1.2 * size * number)
        canvas.write(at, text, size=size, up="center_baseline", name=name)


def _draw_fields(canvas: Drawable, box: Bounds, office: Office, factor: float) -> bool:
    """Write fields row by row, each below its head."""
    if not office.fields:
        return True
    columns, rows = _count_cells(office, box.width / factor)
    width, height = box.width / columns, box.height / rows
    pad, have_room = factor, True
    rules = [np.array([(box.xmin, y), (box.xmax, y)])
             for y in (box.ymax - height * np.arange(1, rows)).tolist()]  # fmt: skip
    rules += [np.array([(x, box.ymin), (x, box.ymax)])
              for x in (box.xmin + width * np.arange(1, columns)).tolist()]  # fmt: skip
    canvas.draw_paths(rules, _THIN, "rules")
    for number, (head, text) in enumerate(office.fields):
        left = box.xmin + number % columns * width + pad
        top = box.ymax - number // columns * height
        room = width - 2 * pad
        named = fit_text(head, room, size=_HEAD * factor, least=0.7 * _HEAD * factor)
        canvas.write((left, top - 2.3 * factor), named.lines[0], size=named.size, color=GREY,
                     name="field-name")  # fmt: skip
        size = {"size": _SIZE * factor, "least": _SMALLEST * factor}
        fitted = fit_text(text, room, lines=1, **size)
        if fitted.size < 0.8 * _SIZE * factor:
            fitted = fit_text(text, room, lines=2, **size)
        middle = (top - height + top - 2.6 * factor) / 2
        _write_lines(canvas, (left, middle), fitted.lines, fitted.size, "field")
        have_room &= not (fitted.is_cut or named.is_cut)
    return have_room


def _draw_revisions(canvas: Drawable, box: Bounds, office: Office, factor: float) -> bool:
    """Write revisions in the order in which they are given, from the top down."""
    if not office.revisions:
        return True
    height = _LINE * factor
    rows: list[Sequence[str]] = [_HEADS, *office.revisions]
    at = box.xmin + box.width * np.array(_SHARES)
    lines: list[Float64Array] = [
        np.array([(box.xmin, y), (box.xmax, y)])
        for y in (box.ymax - height * np.arange(1, len(rows) + 1)).tolist()
        if y > box.ymin + 1e-6
    ]
    bottom = box.ymax - height * len(rows)
    lines += [np.array([(x, bottom), (x, box.ymax)]) for x in at[1:-1].tolist()]
    canvas.draw_paths(lines, _THIN, "rules")
    have_room = True
    for number, row in enumerate(rows):
        y = box.ymax - (number + 0.5) * height
        for left, width, text in zip(at.tolist(), np.diff(at).tolist(), row, strict=False):
            size = (_SIZE if number else _HEAD) * factor
            fitted = fit_text(text, width - 1.6 * factor, size=size, least=0.5 * size)
            canvas.write((left + 0.8 * factor, y), fitted.lines[0], size=fitted.size,
                         color=INK if number else GREY, up="center_baseline",
                         name="revision" if number else "field-name")  # fmt: skip
            have_room &= not fitted.is_cut
    return have_room
