"""Whether a corridor is what was designed: each face against the section of its station."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import LinesError
from ....base.sentences import coordinate, height

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from ....tin import TIN
    from .axis import Axis
    from .designs import Design
    from .layouts import Layout

_FACE = 2e-3
"""CRS units: how near a line of the template the vertical face of a kerb may be."""
_ROUNDING = 1e-6


def require_as_designed(
    patch: TIN, layout: Layout, road: Axis, design: Design, tolerance: float
) -> None:
    """Refuse a corridor whose faces are not those of the template at the nearest station.

    In the middle of each face its elevation is that of the bed, or of a side slope, within what
    chords and the folds that are told allow.

    Raises
    ------
    LinesError
        If one is not: at a bend that is too sharp for the template.
    """
    middles = patch.points[patch.triangles].mean(axis=1)
    table = road.alignment.stations_of(middles[:, :2])
    station, offset = table["station"], table["offset"]
    surfaces = (layout.bed, *layout.skirts)
    step = max(float(one.fold.steps.max(initial=0.0)) for one in surfaces)
    low, high = road.span
    for side in (-1, 1):
        own = np.flatnonzero((station > low) & (station < high) & ((offset < 0.0) == (side < 0)))
        at, away = station[own], np.abs(offset[own])
        sections = _Sections(design, side, at, road.elevations_at(at))
        errors = sections.measure_errors(away, middles[own, 2], 2.0 * tolerance + _FACE)
        allowed = 2.0 * tolerance / road.up * (1.0 + 2.0 * sections.steepest * road.up)
        excess = errors - (allowed + step + _ROUNDING)
        if (excess > 0.0).any():
            worst = int(np.argmax(excess))
            where = coordinate(float(road.wrap(at)[worst]))
            raise LinesError(
                f"The corridor cannot be laid out near station {where}: the "
                "bend is too sharp for the template, or turns without a curve (faces would be off "
                f"by {height(float(errors[worst]))}). Give the axis a wider curve there."
            )


class _Sections:
    """The cross sections of one side at stations."""

    def __init__(
        self, design: Design, side: int, stations: Float64Array, axis: Float64Array
    ) -> None:
        self._bed = design.find_bed(side, stations)
        self._ditch = design.find_ditch(side, stations)
        self._rates = [design.find_rates(side, stations, kind) for kind in ("cut", "fill")]
        self._axis = axis

    @property
    def steepest(self) -> float:
        """The greatest rise of a side slope for a unit along."""
        return max(float(np.abs(one).max(initial=0.0)) for one in self._rates)

    def measure_errors(
        self, away: Float64Array, elevations: Float64Array, near: float
    ) -> Float64Array:
        """Return by how much elevations differ from those designed; 0 near lines of the template.

        ``away`` are the distances from the axis.
        """
        errors = np.zeros(len(away))
        for k in range(len(away)):
            lines, rises = self._bed.offsets[k], self._bed.rises[k]
            beyond = away[k] - lines[-1]
            edges = np.concatenate([lines, lines[-1] + self._ditch.offsets[k]])
            if np.abs(edges - away[k]).min() <= near:
                continue
            if beyond <= 0.0:
                found = [float(np.interp(away[k], lines, rises))]
            else:
                foot = np.interp(beyond, self._ditch.offsets[k], self._ditch.rises[k])
                slope = max(beyond - self._ditch.offsets[k][-1], 0.0)
                found = [rises[-1] + foot + slope * self._rates[0][k]]
                found.append(rises[-1] + beyond * self._rates[1][k])
            errors[k] = min(abs(elevations[k] - self._axis[k] - one) for one in found)
        return errors
