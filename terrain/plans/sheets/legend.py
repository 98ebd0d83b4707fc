"""Legend: what the lines and areas of section sheets are, and how large they are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....tin import Bounds
from ..paper import GREY, fit_text
from ..title_block import draw_scale_bar
from ..windows import outline
from .cells import ANGLES, AXIS_PEN, DATUM_PEN, GRID_PEN, HATCH_PENS, KINDS, TINTS, find_pen

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ....base.crs import Unit
    from ..paper import Drawable, Layout, Pen

_WIDEST, _SAMPLE = 46.0, 9.5
"""Millimetres on A4: of a column, and of a sample of a line."""
_SIZE, _LEAST = 2.2, 1.2


def draw_legend(canvas: Drawable, layout: Layout, names: Sequence[str]) -> bool:
    """Explain lines and areas, in columns from left to right; tell whether all had room."""
    listed: list[tuple[str, Pen | None]] = [
        *((name, find_pen(number)) for number, name in enumerate(names)),
        *((kind, None) for kind in (KINDS if len(names) > 1 else ())),
        ("centreline", AXIS_PEN),
        ("datum", DATUM_PEN),
        ("grid", GRID_PEN),
    ]
    return draw_samples(canvas, layout, listed)


def draw_samples(
    canvas: Drawable,
    layout: Layout,
    listed: Sequence[tuple[str, Pen | None]],
    *,
    is_plain: bool = False,
) -> bool:
    """Draw samples of lines, and of cut and fill, which have no pen; tell whether all had room.

    ``is_plain`` leaves out hatches.
    """
    cell, factor = layout.legend, layout.factor
    step, head = 4.6 * factor, 5.4 * factor
    rows = int((cell.height - head - factor) // step)
    columns = -(-len(listed) // rows)
    width = min(_WIDEST * factor, (cell.width - 2.5 * factor) / columns)
    sample = min(_SAMPLE * factor, 0.3 * width)
    left, top = cell.xmin + 2.5 * factor, cell.ymax - head
    heading = (left, cell.ymax - 3.8 * factor)
    canvas.write(heading, "Legend", size=_SIZE * factor, color=GREY)
    have_room = True
    for number, (name, pen) in enumerate(listed):
        x, y = left + (number // rows) * width, top - (number % rows + 0.5) * step
        if pen is None:
            box = Bounds(x, y - 1.6 * factor, x + sample, y + 1.6 * factor)
            canvas.fill([outline(box)], TINTS[name], "legend-sample")
            if not is_plain:
                canvas.hatch(outline(box), HATCH_PENS[name], ANGLES[name], "legend-sample")
        else:
            canvas.draw_paths([np.array([(x, y), (x + sample, y)])], pen, "legend-sample")
        room = width - sample - 3.0 * factor
        fitted = fit_text(name, room, size=_SIZE * factor, least=_LEAST * factor)
        place = (x + sample + 2.0 * factor, y)
        canvas.write(place, fitted.lines[0], size=fitted.size, up="center_baseline", name="legend")
        have_room &= not fitted.is_cut
    return have_room


def draw_scales(
    canvas: Drawable, layout: Layout, mm_per_unit: float, scales: Mapping[str, str], unit: Unit
) -> bool:
    """Write scales, each with what is drawn at it, above a bar; tell whether all had room."""
    cell, factor = layout.scales, layout.factor
    draw_scale_bar(canvas, layout, mm_per_unit, unit)
    y = cell.ymax - 3.8 * factor
    left, width = cell.xmin + 2.5 * factor, cell.width - 4.0 * factor
    have_room = True
    for head, text in scales.items():
        canvas.write((left, y), head, size=_SIZE * factor, color=GREY)
        y -= 4.4 * factor
        fitted = fit_text(text, width, size=3.0 * factor, least=_LEAST * factor)
        canvas.write((left, y), fitted.lines[0], size=fitted.size, name="scale-of-sections")
        y -= 5.0 * factor
        have_room &= not fitted.is_cut
    return have_room
