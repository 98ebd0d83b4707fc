"""Palette: the colours of words and shapes around a picture, readable on its background."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .tints import compute_lightness

__all__ = ["Color", "Palette", "choose_palette"]

Color = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""

_LIGHT_INK: Color = (240, 242, 244)
_LEAST_OF_LIGHT = 0.62
"""Oklab lightness of a background from which on dark words are easier to read on it."""

_GREY_SHARE = 0.34
"""Share of the background in the colour of less important words."""


class Palette(NamedTuple):
    """Colours of annotations."""

    ink: Color = (28, 34, 40)
    grey: Color = (96, 106, 114)
    """Of words and shapes, and of those that matter less."""
    paper: Color = (255, 255, 255)
    """The background."""
    warning: Color = (150, 58, 34)
    """Of what a reader must not miss."""


def choose_palette(background: Color) -> Palette:
    """Return the colours that can be read on a background.

    Examples
    --------
    >>> choose_palette((255, 255, 255)) == Palette()
    True
    >>> choose_palette((0, 0, 0)).ink
    (240, 242, 244)
    """
    usual = Palette()
    if background == usual.paper:
        return usual
    is_light = float(compute_lightness(np.array([background], np.uint8))[0]) >= _LEAST_OF_LIGHT
    ink = usual.ink if is_light else _LIGHT_INK
    warning = usual.warning if is_light else (255, 170, 130)
    return Palette(ink, _mix(ink, background), background, warning)


def _mix(ink: Color, paper: Color) -> Color:
    red, green, blue = (
        round(one + _GREY_SHARE * (other - one)) for one, other in zip(ink, paper, strict=True)
    )
    return red, green, blue
