"""Ramps: the colours of elevations, slopes and directions, the same in pages and pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from ..relief.gradients import aspect, slope
from .tints import interpolate_tints, mix_tints

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, UInt8Array
    from ...base.policies import Tint
    from ...tin import TIN

__all__ = ["PLAIN", "STEEPEST", "Legend", "choose_ramp", "measure_tint"]

PLAIN = (185, 179, 166)
STEEPEST = 60.0
"""Slope, degrees, from which on the colour is the same."""

_SLOPE = ((0.93, 0.02, 110.0), (0.83, 0.12, 95.0), (0.66, 0.17, 55.0), (0.42, 0.15, 25.0))
_CIRCLE = tuple((0.72, 0.11, float(hue)) for hue in range(250, 250 + 361, 20))
"""Rungs of ramps in Oklch: lightness, chroma, hue in degrees."""


class Legend(NamedTuple):
    """What a ramp of colours tells."""

    name: str
    colors: UInt8Array
    """(k, 3)."""
    ends: tuple[float, float]
    """Values of the first and the last colour."""
    ticks: tuple[tuple[float, str], ...] = ()
    """Values and words below the ramp; none for round numbers."""


def choose_ramp(tint: Tint, count: int) -> UInt8Array:
    """Return a ramp of two colours or more, (count, 3)."""
    if tint == "slope":
        return mix_tints(_SLOPE, count)
    return mix_tints(_CIRCLE, count) if tint == "aspect" else interpolate_tints(count)


def measure_tint(
    tin: TIN, tint: Tint, elevations: tuple[float, float], unit: str
) -> tuple[Float64Array | None, Legend | None]:
    """Return what is to be coloured, and its legend; None both for a plain surface.

    Coloured are elevations of vertices, (n,), or slopes or aspects of triangles, (m,), in degrees,
    NaN where level. ``elevations`` are those of the lowest and the highest tint; ``unit`` is
    theirs, as it stands behind their name, "" if it is not known.
    """
    if tint == "plain":
        return None, None
    ramp = choose_ramp(tint, 100)
    if tint == "slope":
        ticks: Any = ((0.0, "0"), (15.0, "15"), (30.0, "30"), (45.0, "45"), (STEEPEST, "60+"))
        return slope(tin), Legend("Slope (degrees)", ramp, (0.0, STEEPEST), ticks)
    if tint == "aspect":
        ticks = tuple(zip((0.0, 90.0, 180.0, 270.0, 360.0), "NESWN", strict=True))
        return aspect(tin), Legend("Aspect: facing", ramp, (0.0, 360.0), ticks)
    name = f"Elevation ({unit or 'unit not known'})"
    return tin.points[:, 2], Legend(name, ramp, elevations)
