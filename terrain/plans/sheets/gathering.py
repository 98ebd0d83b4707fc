"""Gathering: what is drawn of cross sections, with the texts that stand at each."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.crs import assume_elevation_unit
from ....base.errors import OptionError
from ....base.sentences import counted
from ...sections import Surfaces, measure_section_areas
from ..paper import clean_text
from .cells import Section

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import Float64Array, Int64Array
    from ....base.crs import CRS, Unit
    from ....base.results import Table

_MOST = 5000
"""Sections that are drawn; more are a slip of the interval."""
_UNNAMED = "surface"
_MOST_DECIMALS = 9


class Units(NamedTuple):
    """Of lengths along and up, and how many of the first make one of the second."""

    along: Unit
    up: Unit | None
    factor: float

    @classmethod
    def of(cls, along: Unit, crs: CRS | None, up: Unit | None) -> Units:
        """Return the units; elevations whose unit nothing tells are taken to be as lengths."""
        known = assume_elevation_unit(crs, up)
        if known is None or known.metres is None or along.metres is None or known == along:
            return cls(along, known, 1.0)
        return cls(along, known, known.metres / along.metres)


def name_surfaces(names: tuple[str, ...]) -> tuple[str, ...]:
    """Return what surfaces are called on paper; one alone has no name of its own."""
    return tuple(clean_text(name) or _UNNAMED for name in names)


def list_sections(table: Table, names: tuple[str, ...], units: Units) -> list[Section]:
    """Return the sections of a table of :func:`tinsmith.cross_sections`, in its order.

    Raises OptionError if they are too many.
    """
    numbers: Int64Array = table["section"]
    firsts = np.flatnonzero(np.append(True, np.diff(numbers) != 0))
    if len(firsts) > _MOST:
        allowed = f"at most {_MOST:,}"
        raise OptionError("sections", len(firsts), allowed, what="number of sections")
    elevations = [table[f"elevation_{name}" if name else "elevation"] for name in names]
    stations = _write_stations(table, firsts, units.along)
    areas = _write_areas(table, len(firsts), names, units)
    found = []
    lasts = np.append(firsts[1:], len(numbers))
    for number, (begin, end) in enumerate(zip(firsts.tolist(), lasts.tolist(), strict=True)):
        own = np.array([one[begin:end] for one in elevations])
        known = own[np.isfinite(own)]
        ends = (float(known.min()), float(known.max())) if len(known) else (math.nan, math.nan)
        section = Section(
            stations[number],
            table["offset"][begin:end],
            own,
            areas[number] if areas else None,
            ends,
        )
        found.append(section)
    return found


def _write_stations(table: Table, firsts: Int64Array, unit: Unit) -> list[str]:
    """Return what is written above sections: no two alike that are not at one station."""
    at: Float64Array = table["station"][firsts]
    lines: Int64Array = table["line"][firsts]
    has_lines = lines.min() != lines.max()
    shown = table.columns.get("written_station", table["station"])[firsts]
    decimals = next(
        (one for one in range(2, _MOST_DECIMALS) if _are_distinct(at, lines, one)), _MOST_DECIMALS
    )
    texts = []
    for line, station, written in zip(lines.tolist(), at.tolist(), shown.tolist(), strict=True):
        text = f"Station {written:.{decimals}f} {unit.symbol}"
        if "written_station" in table.columns:
            text += f"  (length {station:.{decimals}f})"
        texts.append(f"Line {line}: {text}" if has_lines else text)
    return texts


def _are_distinct(stations: Float64Array, lines: Int64Array, decimals: int) -> bool:
    rounded = np.round(stations, decimals)
    return bool(((np.diff(rounded) != 0.0) | (np.diff(lines) != 0)).all())


def _write_areas(
    table: Table, count: int, names: tuple[str, ...], units: Units
) -> list[tuple[str, str]]:
    """Return cut and fill from the first surface to the second, if there are two."""
    if len(names) < 2:
        return []
    areas = measure_section_areas(table, count, f"difference_{names[1]}") * units.factor
    symbol = f"{units.along.symbol}\N{SUPERSCRIPT TWO}"
    return [(f"{cut:,.2f} {symbol}", f"{fill:,.2f} {symbol}") for cut, fill in areas.tolist()]


def describe_elevations(units: Units, is_known: bool) -> str:
    """Return what a title block says of the unit of elevations."""
    if units.up is None:
        return f"Elevations taken to be in {units.along.symbol}"
    return f"Elevations in {units.up.symbol}{'' if is_known else ' (assumed)'}"


def describe_sections(table: Table, names: tuple[str, ...], unit: Unit) -> Iterator[str]:
    """Yield what a title block says of sections."""
    at = table["station"]
    count = len(np.unique(table["section"]))
    ends = f"{at.min():.2f} to {at.max():.2f} {unit.symbol}"
    yield f"{counted(count, 'section')}, stations {ends}"
    if len(names) > 1:
        yield f"Cut and fill from {names[0]} to {names[1]}"


def describe_points(surfaces: Surfaces) -> str:
    """Return what a title block says of the points of surfaces."""
    counts = [counted(len(tin.points), "point") for tin in surfaces.tins]
    named = zip(surfaces.names, counts, strict=True)
    return "; ".join(f"{clean_text(name)}: {count}" if name else count for name, count in named)
