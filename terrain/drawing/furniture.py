"""Furniture: what pictures, plans and windows say alike: scale bar, north arrow, legend."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .palette import choose_ramp
from .rounding import format_number, round_down

if TYPE_CHECKING:
    from ...base.arrays import UInt8Array
    from ...base.crs import Unit
    from ...base.policies import Tint

NORTH_ARROW = np.array([(0.0, 1.25), (-0.42, -0.7), (0.0, -0.4), (0.42, -0.7)])
"""Tip, left, notch and right of an arrow to the north, within a circle of radius 1."""

STEEPEST = 60.0
"""Slope, degrees, from which on the colour is the same."""


class ScaleBar(NamedTuple):
    """A bar of four parts, dark and light in turn."""

    length: float
    """In the unit of the ground."""
    symbol: str
    """Of the unit of the labels, "" if it is not known."""
    labels: tuple[tuple[float, str], ...]
    """Shares of the length, and the numbers there."""


def make_scale_bar(unit: Unit, longest: float) -> ScaleBar:
    """Return a bar of round length, at most the longest, in the unit of the ground.

    Examples
    --------
    >>> from tinsmith.base.crs import METRE
    >>> make_scale_bar(METRE, 2600.0)
    ScaleBar(length=2000.0, symbol='km', labels=((0.0, '0'), (0.5, '1'), (1.0, '2')))
    """
    length = round_down(longest)
    in_kilometres = unit.symbol == "m" and length >= 1000
    shown = length / 1000 if in_kilometres else length
    middle, end = (format_number(one, step=one) for one in (shown / 2, shown))
    symbol = "km" if in_kilometres else unit.symbol
    return ScaleBar(length, symbol, ((0.0, "0"), (0.5, middle), (1.0, end)))


class Legend(NamedTuple):
    """What a ramp of colours tells."""

    name: str
    colors: UInt8Array
    """(k, 3)."""
    ends: tuple[float, float]
    """Values of the first and the last colour."""
    ticks: tuple[tuple[float, str], ...] = ()
    """Values and words below the ramp; none for round numbers."""


def make_legend(tint: Tint, elevations: tuple[float, float], unit: str) -> Legend | None:
    """Return the legend of a tint; None of a plain surface.

    ``elevations`` are those of the lowest and the highest tint; ``unit`` is theirs, as it stands
    behind their name, "" if it is not known.
    """
    if tint == "plain":
        return None
    ramp = choose_ramp(tint, 100)
    ticks: tuple[tuple[float, str], ...]
    if tint == "slope":
        ticks = ((0.0, "0"), (15.0, "15"), (30.0, "30"), (45.0, "45"), (STEEPEST, "60+"))
        return Legend("Slope (degrees)", ramp, (0.0, STEEPEST), ticks)
    if tint == "aspect":
        ticks = tuple(zip((0.0, 90.0, 180.0, 270.0, 360.0), "NESWN", strict=True))
        return Legend("Aspect: facing", ramp, (0.0, 360.0), ticks)
    return Legend(f"Elevation ({unit or 'unit not known'})", ramp, elevations)
