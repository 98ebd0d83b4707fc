"""Curves: surfaces along a line as they are drawn, in profiles and in cross sections."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import as_number, is_whole_number
from ...base.crs import CRS, Unit, assume_elevation_unit
from ...base.errors import OptionError
from ..drawing import format_number, palette, round_down
from .figures import INK, color_frame

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...base.results import Table

FAINT = palette.FAINT


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """A surface along the line; NaN where it is not."""

    name: str
    stations: Float64Array
    elevations: Float64Array
    color: str

    def at(self, stations: Float64Array) -> Float64Array:
        """Interpolate between rows; NaN beside a row without elevation."""
        return np.interp(stations, self.stations, self.elevations)


@dataclass(frozen=True, slots=True)
class Measure:
    """A unit, and whether it is known or the usual one of the CRS."""

    unit: Unit | None
    is_known: bool

    def caption(self, name: str) -> str:
        """Return a name with its unit: "station, m", "elevation, m assumed"."""
        if self.unit is None or not self.unit.symbol:
            return name
        return f"{name}, {self.unit.symbol}{'' if self.is_known else ' assumed'}"


def find_rows(table: Table, line: Any) -> BoolArray:
    """Return which rows of a table are of a line; refuse a line that it has not."""
    if not is_whole_number(line) or not (table["line"] == line).any():
        allowed = f"a whole number from 0 to {int(table['line'].max())}"
        raise OptionError("line", line, allowed=allowed)
    is_of_line: BoolArray = table["line"] == line
    return is_of_line


def find(table: Table, rows: BoolArray, along: str) -> list[Curve]:
    """Return the surfaces in some rows of a table, by a column that goes along the line."""
    measured = [name for name in table.columns if name.partition("_")[0] == "elevation"]
    places = table[along][rows]
    return [
        Curve(
            name.partition("_")[2],
            places,
            table[name][rows],
            palette.CURVES[k % len(palette.CURVES)],
        )
        for k, name in enumerate(measured)
    ]


def find_marks(table: Table, rows: BoolArray, curve: Curve) -> Float64Array:
    """Return where a surface has breaklines."""
    crossed = table[f"crossed_{curve.name}" if curve.name else "crossed"][rows]
    marks: Float64Array = curve.stations[crossed == "breakline"]
    return marks


def read_units(table: Table, crs: CRS | None) -> tuple[Measure, Measure]:
    """Return the units of stations and of elevations, those of the CRS where they are not known."""
    along = table.units.get("station")
    up = next((u for n, u in table.units.items() if n.partition("_")[0] == "elevation"), None)
    usual = None if crs is None else crs.horizontal_unit
    return (
        Measure(along if isinstance(along, Unit) else usual, isinstance(along, Unit)),
        Measure(
            assume_elevation_unit(crs, up if isinstance(up, Unit) else None), isinstance(up, Unit)
        ),
    )


def find_ratio(along: Measure, up: Measure) -> float:
    """Return how long a unit of elevations is in units of stations; 1 if that is not known."""
    lengths = [one.unit.metres if one.unit is not None else None for one in (up, along)]
    return 1.0 if lengths[0] is None or lengths[1] is None else lengths[0] / lengths[1]


def choose_exaggeration(wanted: Any, *, usual: float) -> float:
    """Return the exaggeration that is wanted, if it is one, or else the usual one rounded down."""
    if wanted is None:
        return round_down(usual)
    return as_number("exaggeration", wanted, above=0)


def describe_drawing(crs: CRS | None, exaggeration: float) -> str:
    """Return a caption: the CRS, and how much larger elevations are drawn."""
    where = "CRS not known" if crs is None else crs.caption
    return f"{where}; vertical exaggeration {exaggeration:g}"


def draw_grid(axes: Any, elevations: list[float], step: float) -> None:
    """Draw the axes, with a grid behind the surfaces and some elevations a step apart."""
    axes.set_yticks(elevations, [format_number(place, step=step) for place in elevations])
    axes.grid(color=FAINT, linewidth=0.6)
    axes.set_axisbelow(True)
    color_frame(axes)


def draw(axes: Any, curves: list[Curve], marks: Float64Array, floor: float) -> None:
    """Draw surfaces, the first one's breaklines, and what is cut and filled between two."""
    ground = curves[0]
    if len(curves) == 2:
        _shade(axes, *curves)
    else:
        how = {"color": palette.GROUND_BELOW, "linewidth": 0, "zorder": 1}
        axes.fill_between(ground.stations, ground.elevations, floor, **how)
    for curve in curves:
        how = {"color": curve.color, "linewidth": 1.6, "zorder": 4}
        axes.plot(curve.stations, curve.elevations, label=curve.name or "surface", **how)
    if len(marks):
        label = f"breakline of {ground.name}" if ground.name else "breakline"
        how = {"linestyle": "none", "marker": "|", "markersize": 9, "color": INK, "zorder": 5}
        axes.plot(marks, ground.at(marks), label=label, **how)


def _shade(axes: Any, first: Curve, second: Curve) -> None:
    """Shade what is to be dug off below the first surface, and filled above it."""
    stations, ground, design = _add_crossings(first, second)
    for words, color, limit in (
        ("cut", palette.CUT, np.minimum),
        ("fill", palette.FILL, np.maximum),
    ):
        bound = limit(ground, design)
        if (np.abs(bound - ground) > 0.0).any():
            how = {"color": color, "linewidth": 0, "label": words, "zorder": 2}
            axes.fill_between(stations, ground, bound, **how)


def _add_crossings(first: Curve, second: Curve) -> tuple[Float64Array, ...]:
    """Return stations and both elevations, those where one surface crosses the other included."""
    rise = second.elevations - first.elevations
    is_crossed = np.sign(rise[:-1]) * np.sign(rise[1:]) < 0  # not beside a row without elevation
    before = np.flatnonzero(is_crossed)
    share = rise[before] / (rise[before] - rise[before + 1])
    at, met = (
        values[before] + share * np.diff(values)[before]
        for values in (first.stations, first.elevations)
    )
    return (
        np.insert(first.stations, before + 1, at),
        np.insert(first.elevations, before + 1, met),
        np.insert(second.elevations, before + 1, met),
    )


def write_elevation(value: float, sign: str = "") -> str:
    """Write an elevation for people; a dash where there is none."""
    if not np.isfinite(value):
        return "\N{EN DASH}"
    text = f"{value:{sign},.2f}"
    return text.lstrip("+-") if float(text.replace(",", "")) == 0.0 else text
