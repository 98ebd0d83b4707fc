"""What templates, transitions and superelevation make of a cross section at each station."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.checks import as_floats, as_number
from ....base.errors import LinesError, OptionError
from .templates import STEEPEST, STEEPNESS, Template

if TYPE_CHECKING:
    from ....base.arrays import Float64Array
    from .axis import Axis
    from .templates import Side

SIDES = {-1: "left", 1: "right"}
KINDS = ("cut", "fill")
_ROUNDING = 1e-9
"""Offsets and rises that differ by less are the same."""


class SideLines(NamedTuple):
    """Lines of a side at stations, from the axis outwards."""

    offsets: Float64Array
    """(n, k), 0 or more."""
    rises: Float64Array
    """(n, k), above the axis, in the unit of elevations."""


class Design:
    """Cross sections by station.

    Raises OptionError, and LinesError if the axis closes, and the section does not.
    """

    def __init__(self, templates: Any, superelevation: Any, road: Axis) -> None:
        given = templates if isinstance(templates, Mapping) else {0.0: templates}
        if not given or not all(isinstance(one, Template) for one in given.values()):
            raise OptionError("template", templates, "a Template, or templates by their stations")
        at = sorted((as_number("station", station), one) for station, one in given.items())
        self.stations = np.array([station for station, _ in at])
        self._templates = [one for _, one in at]
        for one in self._templates[1:]:
            if _list_names(one) != _list_names(self._templates[0]):
                allowed = f"the parts of the first one: {_list_names(self._templates[0])}"
                raise OptionError("parts of a template", _list_names(one), allowed)
        self._up, self._road = road.up, road
        self._turn = _read_superelevation(superelevation)
        self._require_ditches()
        parts = [part for side in SIDES for one in self._list_sides(side) for part in one.parts]
        if len(self._turn) and not any(part.turns for part in parts):
            allowed = "left out where no part of the template turns"
            raise OptionError("superelevation", superelevation, allowed)
        if road.lap is not None:
            self._require_closed(np.array(road.lap))

    def list_names(self, side: int, *, ditch: bool = False) -> list[str]:
        """Return the names of the parts of a side."""
        own = self._list_sides(side)[0]
        return [one.name for one in (own.ditch if ditch else own.parts)]

    @property
    def changes(self) -> Float64Array:
        """Stations where something begins to change, or ends to."""
        given = np.union1d(self.stations, self._turn[:, 0])
        lap = self._road.lap
        return given if lap is None else np.unique(lap.repeat(np.union1d(given, lap)))

    def find_bed(self, side: int, stations: Float64Array) -> SideLines:
        """Return the lines of the parts, the axis among them."""
        return self._add_up(*self._measure(side, self._road.wrap(stations), "parts"))

    def find_ditch(self, side: int, stations: Float64Array) -> SideLines:
        """Return the lines of the ditch from the last part on."""
        return self._add_up(*self._measure(side, self._road.wrap(stations), "ditch"))

    def find_rates(self, side: int, stations: Float64Array, kind: str) -> Float64Array:
        """Return the rise of a side slope, "cut" or "fill", for a unit along."""
        ratios = [getattr(one, f"{kind}_slope") for one in self._list_sides(side)]
        sign = 1.0 if kind == "cut" else -1.0
        ratio = np.interp(self._road.wrap(stations), self.stations, ratios)
        return np.asarray(sign / (ratio * self._up))

    def count_steps(self, tolerance: float, far: float) -> list[tuple[float, float, int]]:
        """Return intervals of stations with the number of parts they are cut into.

        So that what rises between straight lines lies within the tolerance, CRS units, side slopes
        as far as they go among it.
        """
        at = self.changes
        found = []
        for begin, end in zip(at[:-1].tolist(), at[1:].tolist(), strict=True):
            most, ends = 1.0, self._road.wrap(np.array([begin, end]))
            for side in SIDES:
                for what in ("parts", "ditch"):
                    widths, slopes, _ = self._measure(side, ends, what)
                    turned = np.abs(np.diff(slopes, axis=0))[0]
                    bent = float((np.abs(np.diff(widths, axis=0))[0] * turned).sum())
                    twist = float((widths.max(axis=0) * turned).sum())
                    most = max(most, np.sqrt(bent / (2.0 * tolerance)), twist / (2.0 * tolerance))
                for kind in ("cut", "fill"):
                    rates = self.find_rates(side, ends, kind) * self._up
                    most = max(most, far * abs(float(rates[1] - rates[0])) / (2.0 * tolerance))
            found.append((begin, end, int(np.ceil(most))))
        return found

    def find_widening(self) -> float:
        """Return by how much offsets change at most for a unit along."""
        at = self.stations
        most = 0.0
        for side in SIDES:
            if len(at) > 1:
                for what in ("parts", "ditch"):
                    widths = self._measure(side, at, what)[0]
                    steps = np.abs(np.diff(widths, axis=0)).sum(axis=1) / np.diff(at)
                    most = max(most, float(steps.max()))
        return 2.0 * most

    def _list_sides(self, side: int) -> list[Side]:
        return [getattr(one, SIDES[side]) for one in self._templates]

    def _measure(
        self, side: int, stations: Float64Array, what: str
    ) -> tuple[Float64Array, Float64Array, Float64Array]:
        rows = [getattr(one, what) for one in self._list_sides(side)]
        count = len(rows[0])
        shape = (3, len(stations), count)
        found = np.zeros(shape)
        for k in range(count):
            for which, name in enumerate(("reach", "slope", "rise")):
                values = [getattr(row[k], name) for row in rows]
                found[which, :, k] = np.interp(stations, self.stations, values)
            if rows[0][k].turns and len(self._turn):
                column = self._turn[:, 1 if side < 0 else 2]
                found[1, :, k] = np.interp(stations, self._turn[:, 0], column)
        return found[0], found[1], found[2]

    def _add_up(self, widths: Float64Array, slopes: Float64Array, rises: Float64Array) -> SideLines:
        rows = len(widths)
        start = np.zeros((rows, 1))
        offsets = np.cumsum(np.hstack([start, widths]), axis=1)
        heights = np.cumsum(np.hstack([start, widths * slopes / self._up + rises]), axis=1)
        return SideLines(offsets, heights)

    def _require_closed(self, ends: Float64Array) -> None:
        """Refuse a section that is another at the first than at the last station."""
        found = [self.find_rates(side, ends, kind)[:, None] for side in SIDES for kind in KINDS]
        for side in SIDES:
            found += [*self.find_bed(side, ends), *self.find_ditch(side, ends)]
        if any(np.ptp(one, axis=0).max(initial=0.0) > _ROUNDING for one in found):
            raise LinesError(
                "The axis closes, but its cross section at the first station is another than at "
                "the last one: they must be the same."
            )

    def _require_ditches(self) -> None:
        """Refuse ditches that fall more steeply than a fill: below both would be the ground."""
        for side in SIDES:
            for one in self._list_sides(side):
                for part in one.ditch:
                    falls = -part.rise * self._up - part.slope * part.reach
                    if falls * one.fill_slope > part.reach * (1.0 + 1e-9):
                        allowed = (
                            f"at most as steep as the side slope of a fill, {one.fill_slope:g}:1"
                        )
                        raise OptionError(
                            f"fall of '{part.name}'", f"{falls:g} over {part.reach:g}", allowed
                        )


def _list_names(template: Template) -> list[str]:
    sides = (template.left, template.right)
    return [part.name for one in sides for part in (*one.parts, *one.ditch)]


def _read_superelevation(given: Any) -> Float64Array:
    """Return rows of station, slope of the left and of the right side."""
    if given is None:
        return np.zeros((0, 3))
    table = as_floats(given)
    if table is None or table.ndim != 2 or table.shape[1] != 3 or not np.isfinite(table).all():
        allowed = "rows of three numbers: station, slope of the left and of the right side"
        raise OptionError("superelevation", given, allowed)
    steep = np.abs(table[:, 1:]) > STEEPEST
    if steep.any():
        raise OptionError("slope of superelevation", float(table[:, 1:][steep][0]), STEEPNESS)
    if not (np.diff(table[:, 0]) > 0).all():
        stations = table[:, 0].tolist()
        raise OptionError("stations of superelevation", stations, "in ascending order")
    return table
