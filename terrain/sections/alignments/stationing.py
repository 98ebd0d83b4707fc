"""Station equations: where the numbers that are written along an alignment jump."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ....base.checks import as_number
from ....base.errors import OptionError
from ....base.sentences import coordinate

if TYPE_CHECKING:
    from ....base.arrays import Float64Array


@dataclass(frozen=True, slots=True)
class StationEquation:
    """A place where stations jump: one ends with ``back``, the next begins with ``ahead``.

    Attributes
    ----------
    station : float
        Where, by the length from the first station of the alignment on, without equations.
    ahead : float
        Station that is written behind it.
    is_increasing : bool
        Whether stations that are written increase behind it, along the alignment.

    Raises
    ------
    OptionError
        If one is no number.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ts.StationEquation(100.0, ahead=500.0).ahead
    500.0
    """

    station: float
    ahead: float
    is_increasing: bool = True

    def __post_init__(self) -> None:
        for name in ("station", "ahead"):
            object.__setattr__(self, name, as_number(name, getattr(self, name)))


@dataclass(frozen=True, slots=True)
class Stationing:
    """The zones of stations along an alignment."""

    start: float
    end: float
    equations: tuple[StationEquation, ...] = ()

    def __post_init__(self) -> None:
        places = [one.station for one in self.equations]
        if places != sorted(set(places)):
            allowed = "in ascending order, at different stations"
            raise OptionError("station equations", places, allowed=allowed)
        outside = [one for one in places if not self.start <= one <= self.end]
        if outside:
            allowed = f"from {coordinate(self.start)} to {coordinate(self.end)}, on the alignment"
            raise OptionError("station of an equation", outside[0], allowed=allowed)

    @property
    def zones(self) -> list[tuple[float, float, float, float]]:
        """Of each zone its first and last station, what is written at its first, and 1 or -1."""
        begins = [self.start, *(one.station for one in self.equations)]
        ends = [*begins[1:], self.end]
        written = [self.start, *(one.ahead for one in self.equations)]
        signs = [1.0, *(1.0 if one.is_increasing else -1.0 for one in self.equations)]
        return list(zip(begins, ends, written, signs, strict=True))

    def write(self, stations: Float64Array) -> Float64Array:
        """Return what is written at stations; at an equation what is ahead."""
        begins, _, written, signs = (np.array(column) for column in zip(*self.zones, strict=True))
        zone = np.clip(np.searchsorted(begins, stations, side="right") - 1, 0, None)
        found: Float64Array = written[zone] + signs[zone] * (stations - begins[zone])
        return found

    def find(self, values: Float64Array, zone: int | None, near: float) -> Float64Array:
        """Return the stations at which numbers are written.

        Raises OptionError if one is written nowhere, or at several places and no zone is chosen.
        """
        zones = self.zones
        if zone is not None and not 1 <= zone <= len(zones):
            raise OptionError("zone", zone, allowed=f"a number from 1 to {len(zones)}")
        numbered = list(enumerate(zones, 1))
        chosen = numbered if zone is None else numbered[zone - 1 : zone]
        found = np.full(len(values), np.nan)
        for number, (begin, end, first, sign) in chosen:
            along = sign * (values - first)
            at = begin + np.clip(along, 0.0, end - begin)
            is_in = (along >= -near) & (along <= end - begin + near)
            is_other = is_in & np.isfinite(found) & (np.abs(found - at) > near)
            if is_other.any():
                k = int(np.argmax(is_other))
                raise OptionError(
                    "station",
                    float(values[k]),
                    allowed=f"given with its zone: it is written at the lengths "
                    f"{coordinate(found[k] - self.start)} and {coordinate(at[k] - self.start)} "
                    f"from the start, the latter in zone {number}",
                )
            found = np.where(is_in, at, found)
        missing = np.isnan(found)
        if missing.any():
            ranges = " or ".join(
                f"from {coordinate(first)} to {coordinate(first + sign * (end - begin))}"
                for _, (begin, end, first, sign) in chosen
            )
            value = float(values[np.argmax(missing)])
            raise OptionError("station", value, allowed=f"on the alignment, {ranges}")
        return found
