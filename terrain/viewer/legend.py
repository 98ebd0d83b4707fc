"""Legend: the quantity that colours show in a 3D picture, and what is written beside its ramp."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from ..drawing import choose_ramp
from ..surface import compute_normals, measure_aspects, measure_slopes

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, UInt8Array
    from ...base.policies import Tint
    from ...tin import TIN

STEEPEST = 60.0
"""Slope, degrees, from which on the colour is the same."""


class Legend(NamedTuple):
    """What a ramp of colours tells."""

    name: str
    colors: UInt8Array
    """(k, 3)."""
    ends: tuple[float, float]
    """Values of the first and the last colour."""
    ticks: tuple[tuple[float, str], ...] = ()
    """Values and words below the ramp; none for round numbers."""


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
        return measure_slopes(compute_normals(tin), "degrees"), Legend(
            "Slope (degrees)", ramp, (0.0, STEEPEST), ticks
        )
    if tint == "aspect":
        ticks = tuple(zip((0.0, 90.0, 180.0, 270.0, 360.0), "NESWN", strict=True))
        return measure_aspects(compute_normals(tin)), Legend(
            "Aspect: facing", ramp, (0.0, 360.0), ticks
        )
    name = f"Elevation ({unit or 'unit not known'})"
    return tin.points[:, 2], Legend(name, ramp, elevations)
