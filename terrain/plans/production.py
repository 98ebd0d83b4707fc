"""Production: the sheets of a plan, from a surface to files."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.checks import require_tin, require_type
from ...base.crs import assume_elevation_unit
from ...base.errors import LinesError, OptionError, PointsError, choice
from ...base.georeference import find_axes, require_same_crs, undo_north_up
from ...base.notes import join_notes
from ...base.policies import ContourLabeling, GridStyle, PointMarking, SheetLayout
from ...base.products import product
from ...base.sentences import counted
from ...tin import Bounds, Survey
from ..drawing import UNTITLED, draw_north_up
from ..surface import as_features, as_segments
from .arrangement import Ground, choose_single, cut_rows, cut_strip_windows
from .canvas import Canvas
from .contents import describe_count, gather_contents
from .files import list_files, write_sheets
from .footprint import find_footprint
from .index_sheet import draw_index
from .lettering import PURPOSE
from .mapping import Map
from .papers import Paper, arrange_sheet
from .scales import Scale, describe_factor, find_ground_unit, measure_scale_factor
from .title_block import Caption, describe_missing_letters, draw_title_block, read_words

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ...base.crs import Unit, UnitLike
    from ...tin import TIN
    from .contents import Contents
    from .mapping import Drawn
    from .papers import Layout, PaperLike
    from .windows import Window


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
    points: str
    grid: str

    def __post_init__(self) -> None:
        choice("labels", self.labels, ContourLabeling)
        choice("points", self.points, PointMarking)
        choice("grid", self.grid, GridStyle)


class Plan:
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

    def __init__(
        self,
        sheets: Sequence[_Sheet],
        contents: Contents,
        style: _Style,
        caption: Caption,
        notes: Sequence[str],
    ) -> None:
        self._sheets = tuple(sheets)
        self._contents = contents
        self._style = style
        self._caption = caption
        last = self._sheets[-1]
        self.scale = last.scale.denominator
        self.scale_text = last.scale.text
        self.paper = (last.layout.paper.width, last.layout.paper.height)
        self.paper_name = last.layout.paper.name
        self.interval = contents.interval
        self._notes = tuple(notes)
        self._notes_of_drawing: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self._sheets)

    def __repr__(self) -> str:
        sheets = counted(len(self), "sheet")
        return f"<Plan: {sheets}, {self.paper_name}, {self.scale_text}>"

    @property
    def notes(self) -> tuple[str, ...]:
        """What was chosen or assumed, and after :meth:`save` what had no room, in sentences."""
        return (*self._notes, *self._notes_of_drawing)

    def with_notes(self, notes: Sequence[str]) -> Plan:
        """Return the same with further notes in front of its own.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> ts.plan(tin).with_notes(["One row was left out."]).notes[0]
        'One row was left out.'
        """
        joined = join_notes(notes, self._notes)
        return Plan(self._sheets, self._contents, self._style, self._caption, joined)

    @property
    def frames(self) -> Float64Array:
        """Corners on the ground of the map on each sheet, (n, 4, 2), from the lower left one."""
        corners = np.array([sheet.window.corners for sheet in self._sheets])
        frames: Float64Array = undo_north_up(corners, self._contents.contours.crs)
        return frames

    def list_files(self, path: str | os.PathLike[str]) -> list[Path]:
        """Return the names of the files that :meth:`save` writes.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> [file.name for file in ts.plan(tin).list_files("yard.pdf")]
        ['yard.pdf']
        """
        return list_files(path, len(self))

    def save(self, path: str | os.PathLike[str], *, dpi: int = 200) -> list[Path]:
        """Write the sheets: as pages of a PDF, or each as a file of its own (.svg, .png).

        Parameters
        ----------
        path : path
            Of several SVGs or PNGs the names end in their numbers: plan-1.svg, plan-2.svg.
        dpi : int
            Pixels to an inch of a PNG, 50 to 1200.

        Returns
        -------
        list of pathlib.Path
            The files written: all of them whole, or the old ones are left as they were.

        Raises
        ------
        OptionError
            If the path or dpi is none, or a picture would have too many pixels.
        RenderError
            If the suffix is another.
        WriteError
            If a file cannot be written.
        MissingExtraError
            If matplotlib is not installed.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from tempfile import TemporaryDirectory
        >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> with TemporaryDirectory() as folder:
        ...     [file.name for file in ts.plan(tin, title="Yard").save(f"{folder}/yard.pdf")]
        ['yard.pdf']
        """
        files = list_files(path, len(self))
        return write_sheets(files, self._draw(), self.paper, dpi, self._caption.title)

    def _draw(self) -> Iterator[Canvas]:
        """Draw sheet after sheet, each when the one before is written."""
        crowded, is_cut = 0, False
        for number, sheet in enumerate(self._sheets, 1):
            canvas, drawn, has_room = self._draw_sheet(number, sheet)
            crowded, is_cut = crowded + drawn.crowded, is_cut or not has_room
            yield canvas
        self._notes_of_drawing = tuple(_describe_no_room(crowded, is_cut))

    def _draw_sheet(self, number: int, sheet: _Sheet) -> tuple[Canvas, Drawn, bool]:
        canvas, grid = Canvas(sheet.layout.paper), self._style.grid
        maps = {k: one.window for k, one in enumerate(self._sheets, 1) if not one.is_index}
        caption = self._caption._replace(
            scale=sheet.scale.text, sheet=f"Sheet {number} of {len(self)}"
        )
        if sheet.is_index:
            caption = caption._replace(title=f"{caption.title}: index of sheets")
            drawn = draw_index(canvas, sheet.window, self._contents, maps, grid=grid)
        else:
            drawing = Map(canvas, sheet.window, self._contents)
            drawn = drawing.draw(labeling=self._style.labels, grid=grid, numbers=tuple(maps))
        kinds = [*drawn.kinds, *(["grid"] if grid != "none" else [])]
        has_room = draw_title_block(canvas, sheet.layout, sheet.window, caption, kinds)
        return canvas, drawn, has_room


def _describe_no_room(crowded: int, is_cut: bool) -> Iterator[str]:
    if crowded:
        yield (
            f"{counted(crowded, 'label')} of points were left out, where they would have met "
            "others: a larger scale has room."
        )
    if is_cut:
        yield "A text in the title block was cut, for it had no room: give a shorter title."


@product
def plan(
    tin: TIN,
    *,
    scale: float | str | None = None,
    paper: PaperLike = "A3",
    orientation: str | None = None,
    layout: str = "single",
    axis: Any = None,
    interval: float | None = None,
    smooth: float | None = None,
    labels: str = "index",
    points: str = "none",
    grid: str = "crosses",
    survey: Survey | None = None,
    title: str | None = None,
    date: dt.date | str | None = None,
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
    axis : (k, 2) array, Breakline, Features or geometry, optional
        Of strips: a line that they follow. Default one along the surface, from west to east.
    interval : float, optional
        Between contours, in the unit of elevations; every fifth is an index contour. Default a
        round number with twelve contours or more.
    smooth : float, optional
        Round contours within this much of their level, as :func:`tinsmith.contours` does.
    labels : {"index", "all", "none"}
        Which contours have their elevation written on them.
    points : {"none", "marks", "numbers", "elevations", "both"}
        What is drawn at the points of the survey, or at the vertices if there is none.
    grid : {"crosses", "lines", "none"}
    survey : Survey, optional
        In the CRS of the TIN, and in its unit of elevations.
    title : str, optional
        Default "Terrain surface".
    date : datetime.date or str, optional
        Written as it is; by default there is none.
    ground_unit : Unit or str, optional
        Of eastings and northings ("m", "ft", "US survey foot"), where the CRS is not known.

    Returns
    -------
    Plan
        ``save`` writes it as PDF, SVG or PNG.

    Raises
    ------
    PointsError
        If the TIN is none, or has no triangle.
    CrsError
        If eastings are angles, their unit is not known, or the CRS's own scale is more than 1 %
        wrong here, as that of Web Mercator is; or if the survey or axis has another CRS.
    OptionError
        If an option is outside what is allowed, or the surface does not fit the paper: the sentence
        names the scale that does.
    LinesError
        If the axis is not one line.
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
    style = _Style(labels, points, grid)
    heading, day = read_words(title, date, UNTITLED)
    layouts = [arrange_sheet(one) for one in Paper.choices(paper, orientation)]
    unit = find_ground_unit(tin.crs, ground_unit)
    line, notes = _as_axis(axis, tin, layout)
    tin, survey = draw_north_up(tin), draw_north_up(survey)
    shapely = optional.load("shapely")
    if len(tin.triangles) == 0:
        raise PointsError("The TIN has no triangle: there is nothing to draw.")
    footprint = find_footprint(tin)
    ground = Ground(Bounds.of(shapely.get_coordinates(footprint.faces)), footprint, unit)
    factor = measure_scale_factor(tin.crs, *undo_north_up(ground.bounds.center, tin.crs))
    chosen = None if scale is None else Scale.of(scale, ground.unit)
    contents = gather_contents(
        tin, ground.footprint, interval=interval, smooth=smooth, points=points, survey=survey
    )
    sheets = _arrange(ground, layouts, chosen, layout, line)
    caption = Caption(
        title=heading,
        facts=tuple(_list_facts(tin, survey, contents, ground.unit, factor, sheets[-1])),
        scale="",
        sheet="",
        date=day,
        unit=ground.unit,
    )
    notes += _list_notes(contents, sheets, factor, interval, caption)
    return Plan(sheets, contents, style, caption, notes)


def _as_axis(axis: Any, tin: TIN, layout: str) -> tuple[Float64Array | None, list[str]]:
    """Return the vertices of the line that strips follow, and notes on it."""
    if axis is None:
        return None, []
    if layout != "strips":
        raise OptionError("layout", layout, "'strips' where an axis is given")
    features = as_features(axis, "axis")
    if features.kind != "lines" or len(features.offsets[0]) != 2:
        raise LinesError(
            f"The axis of strips is one line, and there are {len(features)} {features.kind}."
        )
    notes = require_same_crs(features.crs, tin.crs, "the axis", is_plain=features.crs is None)
    xy = np.ascontiguousarray(features.coordinates[:, :2])
    segments = as_segments(xy, features.offsets[0], what="axis")
    vertices = np.concatenate([segments.starts, segments.ends[-1:]])
    return find_axes(tin.crs).turn(vertices), list(notes)


def _arrange(
    ground: Ground,
    layouts: Sequence[Layout],
    scale: Scale | None,
    layout: str,
    axis: Float64Array | None,
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
        windows = cut_strip_windows(ground, paper, scale, axis)
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
    yield f"CRS unknown, coordinates in {unit.symbol}" if tin.crs is None else tin.crs.caption
    yield _describe_elevations(tin)
    yield _describe_contours(tin, contents)
    yield describe_count(tin, survey)
    if factor is not None:
        yield f"Scale factor of the CRS here {factor:.6f}"
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
    yield from describe_missing_letters([caption.title, caption.date, *caption.facts])
    yield from _describe_marks_outside(contents, sheets)


def _describe_marks_outside(contents: Contents, sheets: Sequence[_Sheet]) -> Iterator[str]:
    """Say how many points lie on no sheet: those far outside the surface."""
    if contents.marks is None:
        return
    is_shown = np.zeros(len(contents.marks.places), np.bool_)
    for sheet in sheets:
        frame, places = sheet.window.frame, sheet.window.to_paper(contents.marks.places)
        low, high = (frame.xmin, frame.ymin), (frame.xmax, frame.ymax)
        is_shown |= ((places >= low) & (places <= high)).all(axis=1) & (not sheet.is_index)
    if not is_shown.all():
        yield f"{counted(int((~is_shown).sum()), 'point')} outside the surface are on no sheet."
