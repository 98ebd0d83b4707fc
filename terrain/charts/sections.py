"""Sheet of cross sections: each with its station, by offsets from the centreline."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_count
from ...base.crs import CRS
from ...base.errors import OptionError
from ...base.results import Table
from ..drawing import choose_ticks, parse_title, round_down
from . import curves
from .figures import INK, picture, start_figure, write_caption, write_title

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...base.crs import CrsLike

_PURPOSE = "A picture of cross sections"
_MOST = 60
"""Sections on a sheet."""

# Inches.
_WIDTH, _LEFT, _RIGHT, _GAP = 11.2, 0.85, 0.3, 0.8
_TOP, _BOTTOM, _HEAD = 0.9, 0.65, 0.52
_LEAST_HEIGHT, _MOST_HEIGHT = 0.9, 2.4
_TALLEST = 80.0


@dataclass(frozen=True, slots=True, eq=False)
class _Section:
    """One section: its station, and the surfaces along it."""

    station: float
    surfaces: list[curves.Curve]
    marks: Float64Array

    @property
    def range(self) -> tuple[float, float]:
        """Lowest and highest elevation; NaN twice if no surface is there."""
        heights = np.concatenate([curve.elevations for curve in self.surfaces])
        known = heights[np.isfinite(heights)]
        return (float(known.min()), float(known.max())) if len(known) else (math.nan, math.nan)


@dataclass(frozen=True, slots=True)
class _Sheet:
    """How all sections are measured."""

    offsets: tuple[float, float]
    span: float
    """Of elevations in each section."""
    step: float
    """Between lines of the grid of elevations."""
    exaggeration: float
    width: float
    height: float
    """Width and height of a section, inches."""
    columns: int
    rows: int


@picture
def section_picture(
    table: Table,
    *,
    line: int = 0,
    columns: int = 2,
    exaggeration: float | None = None,
    title: str | None = None,
    crs: CrsLike | None = None,
) -> Any:
    """Draw cross sections on a sheet, from the lowest station on.

    Parameters
    ----------
    table : Table
        Of :func:`tinsmith.cross_sections`.
    line : int
        Number of the centreline, if the table has several.
    columns : int
        Sections side by side, 1 to 6.
    exaggeration : float, optional
        How many times elevations are drawn larger than offsets; default a round number that fills
        the sheet.
    title : str, optional
        Default "Cross sections".
    crs
        As of :func:`tinsmith.profile_picture`.

    Returns
    -------
    matplotlib.figure.Figure
        Drawn without a screen; ``savefig`` writes it. All sections have one scale, left is left of
        the centreline. Above each stand its station and the elevations on the centreline. Between
        two surfaces cut (the second below the first) and fill are shaded.

    Raises
    ------
    OptionError
        If the table has no cross sections, no such line or more than 60 of them, a number is out
        of range, or the title is no text.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [9, 0, 4], [9, 9, 8], [0, 9, 4]])
    >>> table = ts.cross_sections(tin, [[1, 4], [8, 4]], interval=3, width=4)
    >>> len(ts.section_picture(table).axes)
    4
    """
    heading = parse_title(title, "Cross sections")
    sections = _choose_sections(table, line)
    system = CRS.of(crs)
    along, up = curves.read_units(table, system)
    require_count("columns", columns, most=6)
    sheet = _plan_sheet(sections, curves.find_ratio(along, up), exaggeration, int(columns))
    height = _TOP + sheet.rows * (sheet.height + _HEAD) + _BOTTOM
    figure = start_figure(_PURPOSE, _WIDTH, height)
    write_title(figure, heading, left=_LEFT)
    caption = curves.describe_drawing(system, sheet.exaggeration)
    write_caption(figure, f"{caption}; left is left of the centreline", left=_LEFT)
    for number, section in enumerate(sections):
        axes = figure.add_axes(_find_box(figure, sheet, number))
        _draw_section(axes, section, sheet, station=along.unit.symbol if along.unit else "")
        is_lowest = number + sheet.columns >= len(sections)
        axes.set_xlabel(along.caption("offset") if is_lowest else "", color=INK, fontsize=9)
        axes.set_ylabel(
            up.caption("elevation") if number % sheet.columns == 0 else "", color=INK, fontsize=9
        )
    _write_legend(figure, sections)
    return figure


# ---------------------------------------------------------------- what is drawn


def _choose_sections(table: Any, line: Any) -> list[_Section]:
    names = set(table.columns) if isinstance(table, Table) else set()
    if not {"line", "section", "station", "offset"} <= names:
        raise OptionError("sections", table, allowed="a table that cross_sections returned")
    numbers = np.unique(table["section"][curves.find_rows(table, line)])
    if len(numbers) > _MOST:
        allowed = f"at most {_MOST} on a sheet"
        raise OptionError("sections", len(numbers), allowed=allowed, what="number of sections")
    found = [_find_section(table, table["section"] == number) for number in numbers]
    if not any(np.isfinite(one.range[0]) for one in found):
        raise OptionError("line", int(line), allowed="one whose sections meet a surface")
    return found


def _find_section(table: Table, rows: BoolArray) -> _Section:
    surfaces = curves.find(table, rows, "offset")
    marks = curves.find_marks(table, rows, surfaces[0])
    return _Section(float(table["station"][rows][0]), surfaces, marks)


def _plan_sheet(sections: list[_Section], ratio: float, wanted: Any, most: int) -> _Sheet:
    """Choose one scale for all sections, for the tallest of them."""
    columns = min(most, len(sections))
    width = (_WIDTH - _LEFT - _RIGHT - (columns - 1) * _GAP) / columns
    offsets = np.concatenate([one.surfaces[0].stations for one in sections])
    left, right = float(offsets.min()), float(offsets.max())
    across = right - left
    ranges = np.array([one.range for one in sections])
    relief = max(float(np.nanmax(ranges[:, 1] - ranges[:, 0])), 1e-3 * across / ratio)
    inches = width * relief * ratio / across
    factor = curves.choose_exaggeration(wanted, usual=0.8 * _MOST_HEIGHT / inches)
    height = max(1.25 * inches * factor, _LEAST_HEIGHT)
    rows = -(-len(sections) // columns)
    if rows * (height + _HEAD) > _TALLEST * columns:
        least = (_TALLEST * columns / rows - _HEAD) / (1.25 * inches)
        raise OptionError("exaggeration", factor, allowed=f"{least:.3g} or less here")
    span = height / factor * across / (width * ratio)
    step = round_down(span / max(2.0, 2.0 * height))
    return _Sheet((left, right), span, step, factor, width, height, columns, rows)


# ---------------------------------------------------------------- drawing


def _find_box(figure: Any, sheet: _Sheet, number: int) -> tuple[float, float, float, float]:
    """Return where a section is drawn: row by row, as one reads."""
    width, height = figure.get_size_inches()
    row, column = divmod(number, sheet.columns)
    left = _LEFT + column * (sheet.width + _GAP)
    low = height - _TOP - (row + 1) * (sheet.height + _HEAD) + 0.08
    return left / width, low / height, sheet.width / width, sheet.height / height


def _draw_section(axes: Any, section: _Section, sheet: _Sheet, *, station: str) -> None:
    low = _find_datum(section, sheet)
    curves.draw(axes, section.surfaces, section.marks, low)
    axes.axvline(0.0, color=INK, linewidth=0.8, linestyle=(0, (8, 2, 1.5, 2)), zorder=3)
    axes.set_xlim(*sheet.offsets)
    axes.set_ylim(low, low + sheet.span)
    first, last = math.ceil(low / sheet.step), math.floor((low + sheet.span) / sheet.step)
    places = [k * sheet.step for k in range(first, last + 1)]
    curves.draw_grid(axes, places, sheet.step)
    axes.set_xticks(choose_ticks(*sheet.offsets, count=6))
    axes.tick_params(labelsize=7.5)
    how = {"fontsize": 9, "color": INK, "parse_math": False, "pad": 4}
    axes.set_title(f"Station {section.station:,.2f} {station}".rstrip(), loc="left", **how)
    axes.set_title(_describe_middle(section), loc="right", **how | {"fontsize": 8})


def _find_datum(section: _Section, sheet: _Sheet) -> float:
    """Return the elevation at the foot of a section, a line of the grid."""
    low, high = section.range
    if math.isnan(low):
        return 0.0
    foot = 0.5 * low + 0.5 * high - 0.5 * sheet.span
    rounded = math.ceil(foot / sheet.step) * sheet.step
    return rounded if rounded <= low and high <= rounded + sheet.span else foot


def _describe_middle(section: _Section) -> str:
    """Return the elevations on the centreline, of two surfaces the difference, too."""
    middle = [float(curve.at(np.zeros(1))[0]) for curve in section.surfaces]
    texts = [
        f"{curve.name} {curves.write_elevation(value)}".strip()
        for curve, value in zip(section.surfaces, middle, strict=True)
    ]
    if len(middle) == 2 and np.isfinite(middle).all():
        texts[1] += f" ({curves.write_elevation(middle[1] - middle[0], sign='+')})"
    return ", ".join(texts)


def _write_legend(figure: Any, sections: list[_Section]) -> None:
    """Name lines and shades once for the sheet."""
    found = {
        label: handle
        for axes in figure.axes
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if len(sections[0].surfaces) == 1 and not sections[0].surfaces[0].name:
        found.pop("surface", None)
    if found:
        width, height = figure.get_size_inches()
        figure.legend(
            list(found.values()),
            list(found),
            loc="upper left",
            bbox_to_anchor=(_LEFT / width, 1 - 0.71 / height),
            borderaxespad=0.0,
            borderpad=0.0,
            ncols=6,
            frameon=False,
            fontsize=9,
        )
