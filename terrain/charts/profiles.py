"""Profile picture: surfaces along a line, drawn to a vertical exaggeration, with their figures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import CRS
from ...base.errors import OptionError
from ...base.results import Table
from ..drawing import choose_ticks, format_number, parse_title
from . import curves
from .figures import INK, color_frame, picture, start_figure, write_caption, write_title

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.crs import CrsLike

_PURPOSE = "A picture of a profile"
_NAME_LETTERS = 20
_LABELS = 8
"""About so many stations are labelled, twice as many at most."""

# Inches.
_PLOT_WIDTH, _LEFT, _RIGHT = 9.4, 1.5, 0.35
_LEAST_HEIGHT, _MOST_HEIGHT = 2.2, 4.4
_BELOW, _ABOVE, _BAND = 0.25, 1.15, 0.26


@dataclass(frozen=True, slots=True)
class _BandLine:
    """A row of figures below the surfaces."""

    name: str
    texts: list[str]
    color: str


@dataclass(frozen=True, slots=True)
class _Scale:
    """How the picture is measured: ends of both axes, and how much taller than wide it is drawn."""

    stations: tuple[float, float]
    elevations: tuple[float, float]
    exaggeration: float
    height: float  # inches


@picture
def profile_picture(
    table: Table,
    *,
    line: int = 0,
    exaggeration: float | None = None,
    title: str | None = None,
    crs: CrsLike | None = None,
) -> Any:
    """Draw a profile of one surface or several.

    Parameters
    ----------
    table : Table
        Of :func:`tinsmith.profile`.
    line : int
        Number of the line to draw, if the table has several.
    exaggeration : float, optional
        How many times elevations are drawn larger than stations; default a round number that fills
        the picture.
    title : str, optional
        Default "Profile".
    crs : CRS, str, int or pyproj.CRS, optional
        For the caption, and for the unit of elevations where it is not known.

    Returns
    -------
    matplotlib.figure.Figure
        Drawn without a screen; ``savefig`` writes it. Below the surfaces stand stations and
        elevations at round stations, of two surfaces their difference too. Between two surfaces
        cut (the second below the first) and fill are shaded. Ticks mark breaklines crossed.

    Raises
    ------
    OptionError
        If the table is no profile, has no such line, the exaggeration is no number above 0, or
        the title is no text.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> square = [[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]]
    >>> tin = ts.TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
    >>> len(ts.profile_picture(ts.profile(tin, [[1, 2], [5, 2]])).axes)
    2
    """
    heading = parse_title(title, "Profile")
    surfaces, marks = _choose_curves(table, line)
    system = CRS.of(crs)
    along, up = curves.read_units(table, system)
    scale = _choose_scale(surfaces, curves.find_ratio(along, up), exaggeration)
    rows = len(surfaces) + 1 + (len(surfaces) == 2)
    figure, axes, band = _start_figure(scale, rows)
    write_title(figure, heading, left=_LEFT)
    write_caption(figure, curves.describe_drawing(system, scale.exaggeration), left=_LEFT)
    curves.draw(axes, surfaces, marks, scale.elevations[0])
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=6, frameon=False, fontsize=9)
    _dress(axes, scale, up.caption("elevation"))
    _fill_band(band, _list_band_lines(surfaces, scale, along.caption("station")), scale)
    return figure


# ---------------------------------------------------------------- what is drawn


def _choose_curves(table: Any, line: Any) -> tuple[list[curves.Curve], Float64Array]:
    """Return the surfaces along one line, and the stations where breaklines are crossed."""
    names = set(table.columns) if isinstance(table, Table) else set()
    if not {"line", "station"} <= names or "offset" in names:
        raise OptionError("profile", table, allowed="a table that profile returned")
    own = curves.find_rows(table, line)
    surfaces = curves.find(table, own, "station")
    if not any(np.isfinite(curve.elevations).any() for curve in surfaces):
        raise OptionError("line", int(line), allowed="one that meets a surface")
    return surfaces, curves.find_marks(table, own, surfaces[0])


def _choose_scale(surfaces: list[curves.Curve], ratio: float, wanted: float | None) -> _Scale:
    stations = surfaces[0].stations
    first, last = float(stations[0]), float(stations[-1])
    heights = np.concatenate([curve.elevations for curve in surfaces])
    low, high = float(np.nanmin(heights)), float(np.nanmax(heights))
    length = (last - first) or 1.0
    room = max(high - low, 1e-3 * length / ratio, 1e-9 * abs(high))
    inches = _PLOT_WIDTH * room * ratio / length
    factor = curves.choose_exaggeration(wanted, usual=0.8 * _MOST_HEIGHT / inches)
    height = min(max(1.3 * inches * factor, _LEAST_HEIGHT), _MOST_HEIGHT)
    if wanted is not None:
        height = max(1.15 * inches * factor, _LEAST_HEIGHT)
        if height > 40.0:
            least = 40.0 / (1.15 * inches)
            raise OptionError("exaggeration", wanted, allowed=f"{least:.3g} or less here")
    span = height / factor * length / (_PLOT_WIDTH * ratio)
    middle = 0.5 * low + 0.5 * high
    return _Scale((first, last), (middle - 0.5 * span, middle + 0.5 * span), factor, height)


# ---------------------------------------------------------------- drawing


def _start_figure(scale: _Scale, rows: int) -> tuple[Any, Any, Any]:
    """Return a figure of the size that the scale asks for, the surfaces above, figures below."""
    width = _LEFT + _PLOT_WIDTH + _RIGHT
    band = rows * _BAND
    height = _ABOVE + scale.height + band + _BELOW
    figure = start_figure(_PURPOSE, width, height)
    left, across = _LEFT / width, _PLOT_WIDTH / width
    axes = figure.add_axes((left, (_BELOW + band) / height, across, scale.height / height))
    below = figure.add_axes((left, _BELOW / height, across, band / height), sharex=axes)
    return figure, axes, below


def _dress(axes: Any, scale: _Scale, label: str) -> None:
    axes.set_xlim(*scale.stations)
    axes.set_ylim(*scale.elevations)
    places = choose_ticks(*scale.elevations, count=max(3, round(scale.height * 2)))
    step = places[1] - places[0] if len(places) > 1 else 1.0
    curves.draw_grid(axes, places, step)
    axes.set_ylabel(label, color=INK)
    axes.tick_params(axis="x", length=0, labelbottom=False)


def _list_band_lines(surfaces: list[curves.Curve], scale: _Scale, station: str) -> list[_BandLine]:
    """Return what stands below the surfaces: stations, elevations, of two their difference."""
    places = choose_ticks(*scale.stations, count=_LABELS) or [scale.stations[0]]
    step = places[1] - places[0] if len(places) > 1 else 1.0
    at = np.array(places)
    lines = [_BandLine(station, [format_number(place, step=step) for place in places], INK)]
    for curve in surfaces:
        texts = [curves.write_elevation(value) for value in curve.at(at).tolist()]
        lines.append(_BandLine(curve.name or "elevation", texts, curve.color))
    if len(surfaces) == 2:
        differences = (surfaces[1].at(at) - surfaces[0].at(at)).tolist()
        texts = [curves.write_elevation(value, sign="+") for value in differences]
        lines.append(_BandLine("difference", texts, INK))
    return lines


def _fill_band(band: Any, lines: list[_BandLine], scale: _Scale) -> None:
    """Write figures below the surfaces, a column at each round station."""
    places = choose_ticks(*scale.stations, count=_LABELS) or [scale.stations[0]]
    band.set_xticks(places)
    band.set_ylim(len(lines), 0)
    band.set_yticks([])
    band.tick_params(labelbottom=False, length=0)
    how = {"va": "center", "parse_math": False}
    for row, line in enumerate(lines):
        middle = row + 0.5
        if row:
            band.axhline(row, color=curves.FAINT, linewidth=0.6)
        band.annotate(
            line.name[:_NAME_LETTERS],
            (0, middle),
            xycoords=("axes fraction", "data"),
            xytext=(-8, 0),
            textcoords="offset points",
            ha="right",
            fontsize=9,
            color=line.color,
            **how,
        )
        for place, text in zip(places, line.texts, strict=True):
            at, side, shift = _find_side(place, scale)
            band.annotate(
                text,
                (at, middle),
                xytext=(shift, 0),
                textcoords="offset points",
                ha=side,
                fontsize=8.5,
                color=line.color,
                **how,
            )
    color_frame(band)


def _find_side(place: float, scale: _Scale) -> tuple[float, str, int]:
    """Return where figures of a place stand, and how: those at the ends of the band inside it."""
    first, last = scale.stations
    share = (place - first) / ((last - first) or 1.0)
    if share < 0.025:
        return first, "left", 2
    return (last, "right", -2) if share > 0.975 else (place, "center", 0)
