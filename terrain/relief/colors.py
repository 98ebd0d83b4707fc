"""Colours of classes, as a legend names them."""

from __future__ import annotations

import numpy as np

__all__ = ["compass_colors", "ramp_colors"]

_RAMP = ("#1a9850", "#91cf60", "#d9ef8b", "#fee08b", "#fc8d59", "#d73027", "#7f0000")
"""From gentle to steep: ColorBrewer's RdYlGn with 6 classes, turned round, and a dark red."""

_COMPASS = (
    *("#3b6fb6", "#4fb0c6", "#5fbf7f", "#b8d05a", "#f2d24b", "#ee9b43", "#d9604c", "#9a5fa8"),
    "#d9d9d9",
)
"""A wheel of hues from north on, opposite directions far apart; grey for level ground."""


def ramp_colors(count: int) -> list[str]:
    """Return so many colours from green to dark red.

    Examples
    --------
    >>> ramp_colors(2)
    ['#1a9850', '#7f0000']
    """
    anchors = np.array([[int(text[k : k + 2], 16) for k in (1, 3, 5)] for text in _RAMP], float)
    places = np.linspace(0.0, len(anchors) - 1.0, count)
    channels = [np.interp(places, np.arange(len(anchors)), axis) for axis in anchors.T]
    return [
        "#" + "".join(f"{round(value):02x}" for value in row) for row in zip(*channels, strict=True)
    ]


def compass_colors() -> tuple[str, ...]:
    """Return the colours of eight directions from north on, and of level ground."""
    return _COMPASS
