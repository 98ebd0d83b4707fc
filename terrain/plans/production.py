"""Production: the sheets of a plan, from a surface to files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.checks import require_tin, require_type
from ...base.crs import assume_elevation_unit
from ...base.errors import OptionError, PointsError, choice
from ...base.georeference import DrawnCRS, undo_north_up
from ...base.policies import ContourLabeling, GridStyle, SheetLayout
from ...base.products import product
from ...base.sentences import counted
from ...tin import Bounds, Survey
from ..drawing import UNTITLED, draw_north_up
from .arrangement import ShownArea, choose_single, cut_rows, cut_strip_windows
from .contents import describe_count, gather_contents
from .footprint import find_footprint
from .index_sheet import draw_index
from .mapping import Map
from .paper import (
    PLAN_SUFFIXES,
    PURPOSE,
    Document,
    Drawable,
    Model,
    NoRoom,
)
from .point_labels import Marking
from .scales import Scale, describe_factor, find_ground_unit, measure_scale_factor
from .stations import as_stationed, cut_band, require_shown
from .title_block import (
    arrange_sheets,
    begin_caption,
    describe_crs,
    describe_factor_here,
    describe_missing_letters,
    draw_title_block,
)

if TYPE_CHECKING:
    import datetime as dt
    from collections.abc import Iterator, Sequence

    from ...base.arrays import Float64Array
    from ...base.crs import Unit, UnitLike
    from ...tin import TIN
    from .contents import Contents
    from .paper import Caption, Layout, PaperLike
    from .stations import Stationed
    from .windows import Window


_LAYERS = {
    "": "SHEET",
    "contours": "CONTOURS",
    "index-contours": "INDEX_CONTOURS",
    "contour-label": "CONTOUR_LABELS",
    "hard-lines": "BREAKLINES",
    "soft-lines": "SOFT_BREAKLINES",
    "boundary-lines": "BOUNDARY",
    "hole-lines": "HOLES",
    "water-lines": "WATER",
    "water": "WATER",
    "outline": "OUTLINE",
    "axis-lines": "AXIS",
    "station-ticks": "AXIS",
    "station-label": "STATIONS",
    "points": "POINTS",
    "point-number": "POINT_NUMBERS",
    "point-elevation": "POINT_ELEVATIONS",
    "point-code": "POINT_CODES",
    "spots": "SPOT_HEIGHTS",
    "spot-elevation": "SPOT_HEIGHTS",
    "grid-lines": "GRID",
    "grid-crosses": "GRID",
    "grid-ticks": "GRID",
    "grid-label": "GRID",
    "match-lines": "MATCH_LINES",
    "match-label": "MATCH_LINES",
    "sheets": "MATCH_LINES",
    "sheet-number": "MATCH_LINES",
}
"""Layers of a drawing by what is drawn."""


class _Sheet(NamedTuple):
    """One page: a window, and of which scale it is; the index sheet shows all windows."""

    window: Window
    scale: Scale
    layout: Layout
    is_index: bool = False


@dataclass(frozen=True)
class _Style:
    """How sheets are drawn: options of :func:`tinsmith.plan` that change no geometry."""

    labels: str
    grid: str

    def __post_init__(self) -> None:
        choice("labels", self.labels, ContourLabeling)
        choice("grid", self.grid, GridStyle)


class Plan(Document):
    """A surface on sheets of paper, ready to be written; made by :func:`tinsmith.plan`.

    Attributes
    ----------
    scale : float
        Denominator: 500 of 1:500.
    scale_text : str
        As it stands on the sheets.
    paper : tuple of float
        Width and height of a sheet, millimetres.
    paper_name : str
    interval : float
        Between contours.
    notes : tuple of str
        What was chosen or assumed, and after :meth:`save` what had no room, in sentences.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
    >>> made = ts.plan(tin, paper="A4")
    >>> made
    <Plan: 1 sheet, A4 landscape, 1:250>
    """

    _suffixes = PLAN_SUFFIXES
    _what = "a plan"

    def __init__(
        self,
        sheets: Sequence[_Sheet],
        contents: Contents,
        style: _Style,
        caption: Caption,
        notes: Sequence[str],
    ) -> None:
        self._sheets = tuple(sheets)
        last = self._sheets[-1]
        super().__init__(last.layout.paper, caption.title, notes)
        self._contents = contents
        self._style = style
        self._caption = caption
        self.scale = last.scale.denominator
        self.scale_text = last.scale.text
        self.interval = contents.interval

    def __len__(self) -> int:
        return len(self._sheets)

    def __repr__(self) -> str:
        sheets = counted(len(self), "sheet")
        return f"<Plan: {sheets}, {self.paper_name}, {self.scale_text}>"

    @property
    def frames(self) -> Float64Array:
        """Corners on the ground of the map on each sheet, (n, 4, 2), from the lower left one."""
        corners = np.array([sheet.window.corners for sheet in self._sheets])
        frames: Float64Array = undo_north_up(corners, self._contents.contours.crs)
        return frames

    def _find_model(self) -> Model:
        """Return where the sheets lie: one, with north up, at its own coordinates."""
        sheet = self._sheets[-1]
        model = Model(
            self._caption.unit,
            sheet.window.mm_per_unit,
            _LAYERS,
            {"Title": self._caption.title, "Scale": self.scale_text},
        )
        if len(self) > 1 or sheet.window.angle or isinstance(self._contents.contours.crs, DrawnCRS):
            return model
        corner = sheet.window.to_ground(np.zeros(2))
        return model._replace(origin=(float(corner[0]), float(corner[1])))

    def _draw_sheet(self, number: int, canvas: Drawable) -> NoRoom:
        sheet, grid = self._sheets[number], self._style.grid
        maps = {k: one.window for k, one in enumerate(self._sheets, 1) if not one.is_index}
        caption = self._caption._replace(
            scale=sheet.scale.text, sheet=f"Sheet {number + 1} of {len(self)}"
        )
        if sheet.is_index:
            caption = caption._replace(title=f"{caption.title}: index of sheets")
            drawn = draw_index(canvas, sheet.window, self._contents, maps, grid=grid)
        else:
            drawing = Map(canvas, sheet.window, self._contents)
            drawn = drawing.draw(labeling=self._style.labels, grid=grid, numbers=tuple(maps))
        kinds = [*drawn.kinds, *(["grid"] if grid != "none" else [])]
        no_room = draw_title_block(canvas, sheet.layout, sheet.window, caption, kinds)
        return no_room._replace(left_out=drawn.crowded)


@product
def plan(
    tin: TIN,
    *,
    scale: float | str | None = None,
    paper: PaperLike = "A3",
    orientation: str | None = None,
    layout: str = "single",
    axis: Any = None,
    station_interval: float | None = None,
    station_range: tuple[float, float] | None = None,
    interval: float | None = None,
    smooth: float | None = None,
    labels: str = "index",
    points: str = "none",
    label_size: float = 1.1,
    decimals: int | None = None,
    spots: Any = None,
    grid: str = "crosses",
    survey: Survey | None = None,
    title: str | None = None,
    date: dt.date | str | None = None,
    title_block: Any = None,
    ground_unit: UnitLike | None = None,
) -> Plan:
    """Draw a plan true to scale: contours, lines and points with a coordinate grid, on paper.

    Parameters
    ----------
    tin : TIN
        In a projected CRS, or in one that is not known, with a ``ground_unit``.
    scale : float or str, optional
        500 or "1:500"; '1" = 20 ft'. Default, on a single sheet, the largest that fits of 1:100,
        1:200, 1:250, 1:500, ... and of 1" = 10', 20', ... where eastings are in feet.
    paper : str or (float, float)
        "A4" to "A0", "Letter", "Legal", "Tabloid", "ANSI A" to "ANSI E", "ARCH A" to "ARCH E", or
        width and height, millimetres.
    orientation : {"landscape", "portrait"}, optional
        Default the one with the larger scale, of several sheets landscape.
    layout : {"single", "rows", "strips"}
        All on one sheet; rows of sheets, north up; or strips along the axis of a long surface, each
        turned so that the axis goes on to the right. Several sheets have match lines, and an index
        sheet goes before them.
    axis : Alignment, (k, 2) array, Breakline, Features or geometry, optional
        One line, which is drawn, and which strips follow. Their default is one along the surface,
        from west to east.
    station_interval : float, optional
        Mark the stations of the axis at multiples of it and at both ends, CRS units.
    station_range : (float, float), optional
        Of strips: only the ground along this part of the axis, from one station to another.
    interval : float, optional
        Between contours, in the unit of elevations; every fifth is an index contour. Default a
        round number with twelve contours or more.
    smooth : float, optional
        Round contours within this much of their level, as :func:`tinsmith.contours` does.
    labels : {"index", "all", "none"}
        Which contours have their elevation written on them.
    points : str
        What is drawn at the points of the survey, or at the vertices if there is none: "none",
        "marks", or what labels say, some of "numbers", "elevations" and "codes" with commas between
        them; "both" is "numbers,elevations".
    label_size : float
        Height of the digits at points and spot heights, millimetres on paper.
    decimals : int, optional
        Of elevations at points and spot heights. Default as many as points need, up to three, and
        two at spot heights.
    spots : float, "peaks", (k, 2) array, Features or geometry, optional
        Spot heights: at the nodes of a grid of this spacing, CRS units; at the vertices that are
        higher or lower than all of their neighbours; or at points.
    grid : {"crosses", "lines", "none"}
    survey : Survey, optional
        In the CRS of the TIN, and in its unit of elevations.
    title : str, optional
        Default "Terrain surface".
    date : datetime.date or str, optional
        Written as it is; default that of the title block, if it has one.
    title_block : path or mapping, optional
        TOML file with what the office writes in its title block: ``company``, ``client``,
        ``project``, ``drawing_number``, ``drawn_by``, ``checked_by``, ``date``, ``logo`` (a PNG
        beside the file), ``rows`` (a table of further names and texts) and ``revisions`` (tables
        with ``mark``, ``date``, ``text`` and ``by``); or a mapping with the same.
    ground_unit : Unit or str, optional
        Of eastings and northings ("m", "ft", "US survey foot"), where the CRS is not known.

    Returns
    -------
    Plan
        ``save`` writes it as PDF, SVG, PNG or DXF.

    Raises
    ------
    PointsError
        If the TIN is none, or has no triangle.
    CrsError
        If eastings are angles, their unit is not known, or the CRS's own scale is more than 1 %
        wrong here, as that of Web Mercator is; or if the survey or axis has another CRS.
    OptionError
        If an option is outside what is allowed, or the surface does not fit the paper: the sentence
        names the scale that does; or a field of the title block is unknown, too long or no text.
    ReadError
        If the file of the title block, or its logo, cannot be read.
    LinesError
        If the axis is not one line, or has no surface along it.
    MissingExtraError
        If matplotlib is not installed.

    Notes
    -----
    One millimetre on paper is exactly ``scale`` millimetres of the CRS's own lengths; the title
    block tells the CRS's scale factor at the middle. Paper must be printed at 100 %: the scale bar
    tells.

    Every place of the surface is within the frame of one sheet at least, and 8 mm or more from its
    sides where a match line parts it from the next one. Contours are interrupted where their
    elevation is written, which reads upright on every sheet. The same surface and options give the
    same bytes.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
    >>> ts.plan(tin, scale=250, paper="A4", title="Yard", date="2026-11-22")
    <Plan: 1 sheet, A4 landscape, 1:250>
    """
    require_tin(tin)
    require_type("survey", survey, Survey, or_none=True)
    optional.load("matplotlib", PURPOSE)
    choice("layout", layout, SheetLayout)
    style = _Style(labels, grid)
    unit = find_ground_unit(tin.crs, ground_unit)
    caption = begin_caption(title, date, title_block, untitled=UNTITLED, unit=unit)
    layouts = arrange_sheets(paper, orientation, caption)
    along = as_stationed(axis, tin, station_interval, station_range)
    if station_range is not None and layout != "strips":
        raise OptionError("layout", layout, "'strips' where a range of stations is given")
    marking = Marking.of(tin, points, spots, decimals, label_size)
    tin, survey = draw_north_up(tin), draw_north_up(survey)
    shapely = optional.load("shapely")
    if len(tin.triangles) == 0:
        raise PointsError("The TIN has no triangle: there is nothing to draw.")
    footprint = find_footprint(tin)
    ground = ShownArea(Bounds.of(shapely.get_coordinates(footprint.faces)), footprint, unit)
    factor = measure_scale_factor(tin.crs, *undo_north_up(ground.bounds.center, tin.crs))
    chosen = None if scale is None else Scale.of(scale, ground.unit)
    contents = gather_contents(
        tin,
        ground.footprint,
        interval=interval,
        smooth=smooth,
        marking=marking,
        survey=survey,
        axis=along,
    )  # fmt: skip
    sheets = _arrange(ground, layouts, chosen, layout, along)
    require_shown(along, [sheet.window for sheet in sheets])
    facts = _list_facts(tin, survey, contents, ground.unit, factor, sheets[-1])
    caption = caption._replace(facts=tuple(facts))
    notes = list(_list_notes(contents, sheets, factor, interval, caption))
    return Plan(sheets, contents, style, caption, notes)


def _arrange(
    ground: ShownArea,
    layouts: Sequence[Layout],
    scale: Scale | None,
    layout: str,
    axis: Stationed | None,
) -> list[_Sheet]:
    """Return the sheets; where there are several, the index sheet before them."""
    if layout == "single":
        chosen, scale, window = choose_single(ground, layouts, scale)
        return [_Sheet(window, scale, chosen)]
    if scale is None:
        raise OptionError("scale", scale, f"given for the layout '{layout}', such as 500 for 1:500")
    paper = layouts[0]
    if layout == "rows":
        windows = cut_rows(ground, paper, scale)
    else:
        band = ground
        if axis is not None and axis.is_part:
            height = paper.frame.height / scale.measure_unit(ground.unit)
            band = ground._replace(footprint=cut_band(ground.footprint, axis, height))
        line = None if axis is None else axis.line
        windows = cut_strip_windows(band, paper, scale, line)
    sheets = [_Sheet(window, scale, paper) for window in windows]
    if len(sheets) == 1:
        return sheets
    corners = np.concatenate([window.corners for window in windows])
    whole = ground._replace(bounds=Bounds.of(corners))
    _, small, overview = choose_single(whole, [paper], None)
    return [_Sheet(overview, small, paper, is_index=True), *sheets]


# ---------------------------------------------------------------- what is said


def _list_facts(
    tin: TIN,
    survey: Survey | None,
    contents: Contents,
    unit: Unit,
    factor: float | None,
    sheet: _Sheet,
) -> Iterator[str]:
    """Yield what the title block says, a line each."""
    yield describe_crs(tin.crs, unit)
    yield _describe_elevations(tin)
    yield _describe_contours(tin, contents)
    yield describe_count(tin, survey)
    if contents.axis is not None:
        yield "Axis from station {} to {}".format(*contents.axis.ends)
    yield from describe_factor_here(factor)
    paper = sheet.layout.paper
    yield f"Printed true to scale on {paper.name}"


def _find_elevation_symbol(tin: TIN) -> str:
    unit = assume_elevation_unit(tin.crs, tin.elevation_unit)
    return "" if unit is None else unit.symbol


def _describe_elevations(tin: TIN) -> str:
    symbol = _find_elevation_symbol(tin)
    if not symbol:
        return "Elevations in an unknown unit"
    return f"Elevations in {symbol}{' (assumed)' if tin.elevation_unit is None else ''}"


def _describe_contours(tin: TIN, contents: Contents) -> str:
    if len(contents.contours) == 0:
        return "No contours: no level lies within the elevations"
    symbol = _find_elevation_symbol(tin)
    return f"Contour interval {contents.interval:.12g}{' ' if symbol else ''}{symbol}"


def _list_notes(
    contents: Contents,
    sheets: Sequence[_Sheet],
    factor: float | None,
    interval: float | None,
    caption: Caption,
) -> Iterator[str]:
    yield from contents.notes
    if interval is None and len(contents.contours):
        yield f"The contour interval {contents.interval:.12g} was chosen for the relief."
    yield from describe_factor(factor, sheets[-1].scale)
    yield from describe_missing_letters(caption)
    yield from _describe_marks_outside(contents, sheets)


def _describe_marks_outside(contents: Contents, sheets: Sequence[_Sheet]) -> Iterator[str]:
    """Say how many points lie on no sheet: those far outside the surface."""
    for marks in contents.marks:
        is_shown = np.zeros(len(marks.places), np.bool_)
        for sheet in sheets:
            frame, places = sheet.window.frame, sheet.window.to_paper(marks.places)
            low, high = (frame.xmin, frame.ymin), (frame.xmax, frame.ymax)
            is_shown |= ((places >= low) & (places <= high)).all(axis=1) & (not sheet.is_index)
        if not is_shown.all():
            many = counted(int((~is_shown).sum()), marks.kind)
            yield f"{many} outside the surface are on no sheet."
