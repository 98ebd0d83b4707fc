"""Colours of classes, as a legend names them."""

from __future__ import annotations

import numpy as np

__all__ = ["compass_colors", "ramp_colors"]

_RAMP = (
    *("#4575b4", "#74add1", "#abd9e9", "#e0f3f8", "#fee090"),
    *("#fdae61", "#f46d43", "#d73027", "#a50026"),
)
"""From gentle to steep: ColorBrewer's RdYlBu, turned round, which people who confuse red and green
tell apart as well (8 classes differ by 11 units of CIELAB at least, on a hillshade too)."""

_COMPASS = (
    *("#3b6fb6", "#4fb0c6", "#5fbf7f", "#b8d05a", "#f2d24b", "#ee9b43", "#d9604c", "#9a5fa8"),
    "#d9d9d9",
)
"""A wheel of hues from north on, opposite directions far apart; grey for level ground."""


def ramp_colors(count: int) -> list[str]:
    """Return so many colours from blue over pale yellow to dark red.

    Examples
    --------
    >>> ramp_colors(2)
    ['#4575b4', '#a50026']
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
