"""Figures: what all pictures share: how they begin, their title, and the colour of words."""

from __future__ import annotations

from typing import Any

from ... import _optional

__all__ = ["INK", "color_frame", "start_figure", "start_panels", "write_title"]

INK = "#333333"
_TITLE = {"fontsize": 15, "color": INK, "parse_math": False}
"""How a title is written."""


def start_figure(purpose: str, width: float, height: float, **how: Any) -> Any:
    """Return an empty figure, sides in inches; ``purpose`` is what matplotlib is needed for."""
    return _optional.load("matplotlib.figure", purpose).Figure(figsize=(width, height), **how)


def start_panels(purpose: str, width: float, height: float, *, title: str) -> Any:
    """Return a figure with a title whose axes are laid out by matplotlib."""
    figure = start_figure(purpose, width, height, layout="constrained")
    figure.suptitle(title, **_TITLE)
    return figure


def write_title(figure: Any, title: str, *, left: float, drop: float, **how: Any) -> None:
    """Write a title, inches from the left and below the upper edge."""
    width, height = figure.get_size_inches()
    figure.text(left / width, 1.0 - drop / height, title, **_TITLE, **how)


def color_frame(axes: Any) -> None:
    """Draw the frame of axes, its ticks and their words in ink."""
    axes.tick_params(colors=INK)
    for spine in axes.spines.values():
        spine.set_color(INK)
