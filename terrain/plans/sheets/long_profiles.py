"""Long profiles: surfaces and a gradient line along an axis on sheets, with figures below."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ....base.checks import as_number
from ....base.errors import LinesError, OptionError
from ....base.products import product
from ....base.sentences import counted
from ...sections import Alignment, VerticalAlignment, as_surfaces, profile
from ..paper import PURPOSE, clean_text
from ..scales import (
    Scale,
    describe_factor,
    find_ground_unit,
    measure_scale_factor,
)
from ..title_block import (
    arrange_sheets,
    begin_caption,
    describe_crs,
    describe_factor_here,
    describe_missing_letters,
)
from .cells import DATUM_PEN, GRID_PEN, Measures, Section, choose_measures, find_pen
from .cross_sections import MOST_EXAGGERATED, ScaledSheets
from .gathering import Units, describe_elevations, describe_points, name_surfaces
from .legend import draw_samples
from .profile_cells import Gradient, ProfileCell, list_gradients

if TYPE_CHECKING:
    import datetime as dt
    from collections.abc import Iterator, Mapping, Sequence

    from ....base.arrays import Float64Array
    from ....base.crs import Unit, UnitLike
    from ....base.results import Table
    from ....tin import TIN
    from ...sections import Surfaces
    from ..paper import Drawable, Layout, PaperLike

_UNTITLED = "Long profile"
_CHORD = 1e-4
"""Of the elevations of vertical curves, which are drawn by chords."""
_MOST_SHEETS = 500


class _Course(NamedTuple):
    """What is drawn along the axis."""

    stations: Float64Array
    """(n,)."""
    elevations: Float64Array
    """(k, n)."""
    names: tuple[str, ...]
    gradients: tuple[Gradient, ...]
    alignment: Alignment | None

    def write(self, station: float) -> str:
        """Return what is written at a station."""
        if self.alignment is not None and self.alignment.equations:
            station = float(self.alignment.written_stations([station])[0])
        return f"{station:.3f}".rstrip("0").rstrip(".")

    def cut(self, begin: float, end: float) -> Section:
        """Return the part between two stations."""
        own = (self.stations > begin) & (self.stations < end)
        at = np.concatenate([[begin], self.stations[own], [end]])
        elevations = np.array(
            [
                np.insert(np.interp([begin, end], self.stations, row), 1, row[own])
                for row in self.elevations
            ]
        )
        known = elevations[np.isfinite(elevations)]
        ends = (float(known.min()), float(known.max())) if len(known) else (math.nan, math.nan)
        text = f"Station {self.write(begin)} to {self.write(end)}"
        return Section(text, at, elevations, None, ends)


class _Request(NamedTuple):
    """What is to be divided into sheets."""

    course: _Course
    layout: Layout
    unit: Unit
    """Of stations."""
    ratio: float
    """Of the length on paper of a unit of elevations to that of a unit of stations."""


class _Drawing(NamedTuple):
    course: _Course
    measures: Measures
    sheets: tuple[tuple[Section, Measures], ...]
    layout: Layout
    scale: Scale


class ProfileSheets(ScaledSheets):
    """A long profile on sheets of paper, ready to be written; of :func:`tinsmith.profile_sheets`.

    Attributes
    ----------
    scale : float
        Denominator: 1000 of 1:1000.
    scale_text : str
        As it stands on the sheets.
    exaggeration : float
        How many times elevations are drawn larger than stations.
    paper : tuple of float
        Width and height of a sheet, millimetres.
    paper_name : str
    notes : tuple of str
        What was chosen or assumed, and after :meth:`save` what had no room, in sentences.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [400, 0, 6], [0, 300, 8]], crs="EPSG:32616")
    >>> ts.profile_sheets(tin, [[5, 5], [205, 5]], scale=1000)
    <ProfileSheets: 1 sheet, A3 landscape, 1:1000>
    """

    _what = "a long profile"
    _along = "Stations"
    _drawing: _Drawing

    def __repr__(self) -> str:
        sheets = counted(len(self), "sheet")
        return f"<ProfileSheets: {sheets}, {self.paper_name}, {self.scale_text}>"

    def _draw_legend(self, canvas: Drawable) -> bool:
        drawn = self._drawing
        lines = [(name, find_pen(k)) for k, name in enumerate(drawn.measures.names)]
        lines += [("datum", DATUM_PEN), ("grid", GRID_PEN)]
        return draw_samples(canvas, drawn.layout, lines)

    def _draw_cells(self, number: int, canvas: Drawable) -> Iterator[bool]:
        course, frame = self._drawing.course, self._drawing.layout.frame
        section, measures = self._drawing.sheets[number]
        cell = ProfileCell(canvas, measures, section, course.gradients, course.write)
        air = max(0.0, frame.height - measures.measure_height(section)) / 2
        yield cell.draw((frame.xmin, frame.ymin + air))


@product
def profile_sheets(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    line: Any,
    *,
    vertical: VerticalAlignment | str | None = None,
    start: float = 0.0,
    scale: float | str | None = None,
    exaggeration: float = 10.0,
    paper: PaperLike = "A3",
    orientation: str | None = None,
    title: str | None = None,
    date: dt.date | str | None = None,
    title_block: Any = None,
    ground_unit: UnitLike | None = None,
) -> ProfileSheets:
    """Draw a long profile on sheets true to scale, with a band of figures below it.

    Parameters
    ----------
    tin, line, start
        As of :func:`tinsmith.profile`; the line is one.
    vertical : VerticalAlignment or str, optional
        Gradient line to draw as the last surface, or its name in an alignment. Default that of the
        alignment, if it has one.
    scale : float or str, optional
        Of stations, 1000 or "1:1000", as of :func:`tinsmith.plan`. Default the largest usual one
        with which all of it is on one sheet.
    exaggeration : float
        How many times elevations are drawn larger than stations.
    paper, orientation, title, date, title_block, ground_unit
        As of :func:`tinsmith.plan`; of a named paper in landscape. The default title is "Long
        profile".

    Returns
    -------
    ProfileSheets
        ``save`` writes it as PDF, SVG or DXF.

    Raises
    ------
    OptionError
        As :func:`tinsmith.profile` and :func:`tinsmith.plan`; if the profile is too high for the
        paper, or the gradient line has its elevations in another unit than the surfaces.
    LinesError
        If there is more than one line, and as :func:`tinsmith.profile`.
    CrsError
        As :func:`tinsmith.profile` and :func:`tinsmith.plan`.
    MissingExtraError
        If matplotlib is not installed.

    Notes
    -----
    A profile longer than a sheet goes on on the next one, from a line of the grid. Below the grid
    are, at round stations, the elevations of every surface, and what the second is above the first;
    of a gradient line the grade and the length of every tangent, and of every vertical curve its
    point of intersection and its length. Stations are written as station equations have them.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [400, 0, 6], [0, 300, 8]], crs="EPSG:32616")
    >>> rise = ts.VerticalAlignment([ts.VerticalPoint(0, 5.5), ts.VerticalPoint(200, 6.5)])
    >>> ts.profile_sheets({"ground": tin}, [[5, 5], [205, 5]], vertical=rise)
    <ProfileSheets: 1 sheet, A3 landscape, 1:1000>
    """
    optional.load("matplotlib", PURPOSE)
    factor = as_number("exaggeration", exaggeration, above=0.0, most=MOST_EXAGGERATED)
    surfaces = as_surfaces(tin)
    unit = find_ground_unit(surfaces.crs, ground_unit)
    caption = begin_caption(title, date, title_block, untitled=_UNTITLED, unit=unit)
    usual = "landscape" if isinstance(paper, str) else None
    layouts = arrange_sheets(paper, orientation or usual, caption)
    units = Units.of(unit, surfaces.crs, surfaces.elevation_unit)
    asked = None if scale is None else Scale.of(scale, unit)
    table = profile(tin, line, start=start)
    gradient = _find_vertical(vertical, line, surfaces)
    course = _follow(table, surfaces, line, gradient)
    if gradient is not None:
        gradients = list_gradients(gradient, course.write, units.factor)
        course = course._replace(gradients=gradients)
    drawing = _arrange(_Request(course, layouts[0], unit, units.factor * factor), asked)
    own = measure_scale_factor(surfaces.crs, *(float(table[name].mean()) for name in ("x", "y")))
    first, last = (course.write(float(one)) for one in course.stations[[0, -1]])
    facts = (
        describe_crs(surfaces.crs, unit),
        describe_elevations(units, surfaces.elevation_unit is not None),
        f"Stations {first} to {last} {unit.symbol}",
        describe_points(surfaces),
        *describe_factor_here(own),
        f"True to scale on {drawing.layout.paper.name}",
    )
    caption = caption._replace(facts=facts, scale=drawing.scale.text)
    notes = [
        *table.notes,
        *describe_factor(own, drawing.scale),
        *describe_missing_letters(caption, course.names),
    ]
    return ProfileSheets(drawing, factor, caption, notes)


def _find_vertical(given: Any, line: Any, surfaces: Surfaces) -> VerticalAlignment | None:
    """Return the gradient line; OptionError if it is none, or in another unit."""
    alignment = line if isinstance(line, Alignment) else None
    if isinstance(given, VerticalAlignment):
        return given
    if given is not None and not isinstance(given, str):
        raise OptionError("vertical", given, "a VerticalAlignment or a name", or_none=True)
    if alignment is None or (given is None and not alignment.verticals):
        if given is not None:
            raise OptionError("vertical", given, "a name in an alignment, and there is none")
        return None
    found = alignment.find_vertical(given)
    known, own = alignment.elevation_unit, surfaces.elevation_unit
    if None not in (known, own) and known != own:
        allowed = f"one with elevations in {own}, as those of the surface"
        raise OptionError("vertical", f"with elevations in {known}", allowed)
    return found


def _follow(
    table: Table, surfaces: Surfaces, line: Any, vertical: VerticalAlignment | None
) -> _Course:
    """Return the profile, with rows wherever the gradient line is not straight."""
    if table["line"].max() > 0:
        raise LinesError(
            f"A long profile runs along one line, and there are {table['line'].max() + 1}."
        )
    stations = table["station"]
    rows = [table[surfaces.column("elevation", k)] for k in range(len(surfaces.tins))]
    alignment = line if isinstance(line, Alignment) else None
    course = _Course(stations, np.array(rows), name_surfaces(surfaces.names), (), alignment)
    if vertical is None:
        return course
    cuts = vertical.cut_into_chords(_CHORD)
    more = cuts[(cuts > stations[0]) & (cuts < stations[-1]) & ~np.isin(cuts, stations)]
    places = np.searchsorted(stations, more)
    rows = [np.insert(row, places, np.interp(more, stations, row)) for row in rows]
    stations = np.insert(stations, places, more)
    name = clean_text(vertical.name) or "design"
    return course._replace(
        stations=stations,
        elevations=np.array([*rows, vertical.elevations_at(stations)]),
        names=(*course.names, name),
    )


def _arrange(request: _Request, scale: Scale | None) -> _Drawing:
    """Choose the scale, and cut the profile into what each sheet shows."""
    if scale is not None:
        return _divide(request, scale)
    for usual in Scale.usual(request.unit):
        try:
            return _divide(request, usual, most=1)
        except OptionError:  # too large, or elevations are not known so finely
            continue
    allowed = "larger: the profile has no room on it at any scale"
    raise OptionError("paper", request.layout.paper.name, allowed)


def _divide(request: _Request, scale: Scale, *, most: int = _MOST_SHEETS) -> _Drawing:
    """Cut the profile into what each sheet shows at a scale.

    Raises OptionError if there are too many, or one has no room.
    """
    course, layout, unit, ratio = request
    first, last = (float(one) for one in course.stations[[0, -1]])
    along = scale.measure_unit(unit)
    whole = course.cut(first, last)
    rows = (len(course.names) > 1) + 2 * bool(course.gradients)
    heads = (*course.names, "difference")
    measures = choose_measures(whole.ends, heads, (first, last), (along, along * ratio), scale)
    measures = measures._replace(names=course.names, rows=rows)
    step, frame = measures.steps[0], layout.frame
    length = (frame.width - measures.width + (last - first) * along) / along
    if last - first > length:
        length = max(step, math.floor(length / step) * step)
    count = (last - first) / length
    if count > most:
        allowed = f"smaller: there would be {count:,.0f} sheets, and at most {most} are drawn"
        raise OptionError("scale", scale.text, allowed)
    begin = first if count <= 1.0 else math.floor(first / step) * step
    cuts = [first, *(c for k in range(1, math.ceil(count) + 2)
                     if first < (c := begin + k * length) < last), last]  # fmt: skip
    sections = [course.cut(*ends) for ends in pairwise(cuts)]
    highest = max(map(measures.measure_height, sections))
    if highest > frame.height:
        allowed = (
            f"smaller, or the exaggeration less: the profile would take {highest:.0f} mm of the "
            f"height, and {layout.paper.name} has {frame.height:.0f}"
        )
        raise OptionError("scale", scale.text, allowed)
    parts = [
        (section, measures._replace(reaches=ends))
        for section, ends in zip(sections, pairwise(cuts), strict=True)
    ]
    return _Drawing(course, measures, tuple(parts), layout, scale)
