"""Figures: what all pictures share: how they begin, title, colour of words, notes and files."""

from __future__ import annotations

import textwrap
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar, cast

from ...base import optional
from ...base.atomic import replacing
from ...base.products import notes_of_surfaces, product
from ...tin.surface import Surface
from ..drawing import draw_north_up, palette

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

F = TypeVar("F", bound="Callable[..., Any]")

INK = palette.INK
_TITLE = {"fontsize": 15, "color": INK, "parse_math": False}
_CAPTION = {**_TITLE, "fontsize": 9}
"""How titles and captions are written."""


def start_figure(purpose: str, width: float, height: float, **how: Any) -> Any:
    """Return an empty figure, sides in inches; ``purpose`` is what matplotlib is needed for."""
    return optional.load("matplotlib.figure", purpose).Figure(figsize=(width, height), **how)


def start_panels(purpose: str, width: float, height: float, *, title: str) -> Any:
    """Return a figure with a title whose axes are laid out by matplotlib."""
    figure = start_figure(purpose, width, height, layout="constrained")
    figure.suptitle(title, **_TITLE)
    return figure


def write_title(figure: Any, title: str, *, left: float) -> None:
    """Write a title at the upper edge, so many inches from the left."""
    width, height = figure.get_size_inches()
    figure.text(left / width, 1.0 - 0.18 / height, title, va="top", **_TITLE)


def write_caption(figure: Any, caption: str, *, left: float) -> None:
    """Write a line below the title."""
    width, height = figure.get_size_inches()
    figure.text(left / width, 1.0 - 0.52 / height, caption, va="top", **_CAPTION)


def color_frame(axes: Any) -> None:
    """Draw the frame of axes, its ticks and their words in ink."""
    axes.tick_params(colors=INK)
    for spine in axes.spines.values():
        spine.set_color(INK)


# ---------------------------------------------------------------- notes

_NOTE = {"fontsize": 7, "color": INK, "parse_math": False, "linespacing": 1.25}
_LINE = 0.125
"""Of a note, inches."""
_LETTER = 0.052
"""Of a note, inches on the average."""
_NOTE_EDGE = 0.15
_MOST_NOTES = 8


def picture(function: F) -> F:
    """Make a function that draws a figure a product, with the notes of all that it shows below.

    It gets what it draws with eastings and northings, whatever the axes of the CRS are.
    """

    @wraps(function)
    def draw(*given: Any, **options: Any) -> Any:
        turned = [draw_north_up(one) for one in given]
        figure = function(*turned, **{name: draw_north_up(one) for name, one in options.items()})
        shown = [*given, *options.values()]
        surfaces = [one for one in shown if isinstance(one, Surface)]
        results = [one for one in shown if not isinstance(one, Surface)]
        noted = [note for one in results for note in getattr(one, "notes", ())]
        of_surfaces = notes_of_surfaces(surfaces) if surfaces else ()
        lacking = [note for note in of_surfaces if not any(one.endswith(note) for one in noted)]
        write_notes(figure, list(dict.fromkeys([*lacking, *noted])))
        return figure

    return product(cast("F", draw))


def write_notes(figure: Any, notes: Sequence[str]) -> None:
    """Write notes below a figure, which becomes taller by as much; the rest stays as large."""
    if not notes:
        return
    width, height = figure.get_size_inches()
    letters = int((width - 2 * _NOTE_EDGE) / _LETTER)
    noted = [*notes[:_MOST_NOTES]]
    if len(notes) > _MOST_NOTES:
        noted.append(f"{len(notes) - _MOST_NOTES:,} more notes.")
    lines = [line for note in noted for line in textwrap.wrap(note, letters)]
    strip = _LINE * len(lines) + 2 * _NOTE_EDGE
    _add_below(figure, strip / (height + strip))
    figure.set_size_inches(width, height + strip)
    at = (_NOTE_EDGE / width, _NOTE_EDGE / (height + strip))
    figure.text(*at, "\n".join(lines), ha="left", va="bottom", **_NOTE)


def _add_below(figure: Any, share: float) -> None:
    """Move all that a figure has up, so that a share of its height is free at the bottom."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.set(rect=(0.0, share, 1.0, 1.0 - share))
        return
    for axes in figure.axes:
        box = axes.get_position(original=True)
        low = share + box.y0 * (1.0 - share)
        axes.set_position((box.x0, low, box.width, box.height * (1.0 - share)))
    for text in figure.texts:
        x, y = text.get_position()
        text.set_position((x, share + y * (1.0 - share)))


# ---------------------------------------------------------------- files


def save_figure(figure: Any, path: Path, *, dpi: int) -> None:
    """Write a figure of matplotlib, whole or not at all, with no version in its bytes."""
    with replacing(path) as file:
        figure.savefig(file, format="png", dpi=dpi, metadata={"Software": None})
