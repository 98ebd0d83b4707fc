"""Sheets of cross sections, from surfaces to files."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

from ....base import optional
from ....base.checks import as_number
from ....base.products import product
from ....base.sentences import counted
from ...sections import as_reaches, as_surfaces, cross_sections
from ..paper import (
    PURPOSE,
    SHEET_SUFFIXES,
    Document,
    Model,
    NoRoom,
    join_no_room,
    name_layers,
)
from ..scales import (
    Scale,
    describe_elevation_scale,
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
    draw_border,
    draw_title,
)
from .arrangement import Request, arrange
from .cells import Cell
from .gathering import (
    Units,
    describe_elevations,
    describe_points,
    describe_sections,
    list_sections,
    name_surfaces,
)
from .legend import draw_legend, draw_scales

if TYPE_CHECKING:
    import datetime as dt
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import ArrayLike

    from ....base.crs import UnitLike
    from ....tin import TIN
    from ..paper import Caption, Drawable, PaperLike
    from .arrangement import Drawing

_UNTITLED = "Cross sections"
MOST_EXAGGERATED = 100.0
_LAYERS = {
    "": "SHEET",
    "grid": "GRID",
    "frame-of-section": "GRID",
    "datum": "DATUM",
    "centreline": "CENTRELINE",
    "cut": "CUT",
    "cut-hatch": "CUT",
    "fill": "FILL",
    "fill-hatch": "FILL",
    "elevation-label": "LABELS",
    "station-label": "LABELS",
    "areas-label": "LABELS",
    "figure-name": "LABELS",
    "figure": "LABELS",
    "gradient": "GRADIENT",
    "gradient-label": "GRADIENT",
}
"""Layers of a drawing by what is drawn; surfaces have their own."""


class ScaledSheets(Document):
    """What is drawn along lines, elevations exaggerated, on sheets of paper."""

    _suffixes = SHEET_SUFFIXES
    _along: ClassVar[str]
    """What the scale is of, beside that of elevations."""

    def __init__(
        self, drawing: Any, exaggeration: float, caption: Caption, notes: Sequence[str]
    ) -> None:
        super().__init__(drawing.layout.paper, caption.title, notes)
        self._drawing = drawing
        self._caption = caption
        self.scale: float = drawing.scale.denominator
        self.scale_text: str = drawing.scale.text
        self.exaggeration = exaggeration

    def __len__(self) -> int:
        return len(self._drawing.sheets)

    @abstractmethod
    def _draw_legend(self, canvas: Drawable) -> bool: ...

    @abstractmethod
    def _draw_cells(self, number: int, canvas: Drawable) -> Iterator[bool]: ...

    def _find_model(self) -> Model:
        """Return what drawings need to know: each surface has a layer of its own name."""
        measures = self._drawing.measures
        named = name_layers(measures.names, sorted(set(_LAYERS.values())))
        layers = {f"surface{number}": layer for number, layer in enumerate(named, 1)}
        properties = {"Title": self._caption.title, "Scale": self._caption.scale}
        return Model(self._caption.unit, measures.along, _LAYERS | layers, properties)

    def _draw_sheet(self, number: int, canvas: Drawable) -> NoRoom:
        drawn, layout = self._drawing, self._drawing.layout
        caption = self._caption._replace(sheet=f"Sheet {number + 1} of {len(self)}")
        draw_border(canvas, layout)
        up = describe_elevation_scale(drawn.scale, self.exaggeration)
        scales = {self._along: drawn.scale.text, "Elevations": up}
        have_room = [
            self._draw_legend(canvas),
            draw_scales(canvas, layout, drawn.measures.along, scales, caption.unit),
            *self._draw_cells(number, canvas),
        ]
        return join_no_room([draw_title(canvas, layout, caption), NoRoom(not all(have_room))])


class SectionSheets(ScaledSheets):
    """Cross sections on sheets of paper, ready to be written; of :func:`tinsmith.section_sheets`.

    Attributes
    ----------
    scale : float
        Denominator: 200 of 1:200.
    scale_text : str
        As it stands on the sheets.
    exaggeration : float
        How many times elevations are drawn larger than offsets.
    paper : tuple of float
        Width and height of a sheet, millimetres.
    paper_name : str
    sections : int
        How many are drawn, each on one sheet.
    notes : tuple of str
        What was chosen or assumed, and after :meth:`save` what had no room, in sentences.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ground = ts.triangulate(
    ...     [[0, 0, 5], [40, 0, 6], [40, 30, 8], [0, 30, 7]], crs="EPSG:32616"
    ... )
    >>> ts.section_sheets(ground, [[5, 15], [35, 15]], interval=10, width=20, scale=100)
    <SectionSheets: 4 sections on 1 sheet, A3 portrait, 1:100>
    """

    _what = "section sheets"
    _along = "Offsets"
    _drawing: Drawing

    def __init__(
        self, drawing: Drawing, exaggeration: float, caption: Caption, notes: Sequence[str]
    ) -> None:
        super().__init__(drawing, exaggeration, caption, notes)
        self.sections = len(drawing.sections)

    def __repr__(self) -> str:
        what = f"{counted(self.sections, 'section')} on {counted(len(self), 'sheet')}"
        return f"<SectionSheets: {what}, {self.paper_name}, {self.scale_text}>"

    def _draw_legend(self, canvas: Drawable) -> bool:
        return draw_legend(canvas, self._drawing.layout, self._drawing.measures.names)

    def _draw_cells(self, number: int, canvas: Drawable) -> Iterator[bool]:
        drawn = self._drawing
        for spot in drawn.sheets[number]:
            cell = Cell(canvas, drawn.measures, drawn.sections[spot.section])
            yield cell.draw(spot.place)


@product
def section_sheets(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    centreline: Any,
    *,
    interval: float | None = None,
    stations: ArrayLike | None = None,
    width: float | None = None,
    left: float | None = None,
    right: float | None = None,
    start: float = 0.0,
    scale: float | str | None = None,
    exaggeration: float = 1.0,
    paper: PaperLike = "A3",
    orientation: str | None = None,
    title: str | None = None,
    date: dt.date | str | None = None,
    title_block: Any = None,
    ground_unit: UnitLike | None = None,
) -> SectionSheets:
    """Draw cross sections on sheets true to scale, several to a sheet, with cut and fill.

    Parameters
    ----------
    tin, centreline, interval, stations, width, left, right, start
        As of :func:`tinsmith.cross_sections`; of several surfaces cut and fill are those from the
        first to the second, and names of a mapping stand in the legend.
    scale : float or str, optional
        Of offsets, 200 or "1:200", as of :func:`tinsmith.plan`. Default the largest usual one with
        which four sections have room on a sheet.
    exaggeration : float
        How many times elevations are drawn larger than offsets.
    paper, orientation, title, date, title_block, ground_unit
        As of :func:`tinsmith.plan`; the default title is "Cross sections".

    Returns
    -------
    SectionSheets
        ``save`` writes it as PDF, SVG or DXF.

    Raises
    ------
    OptionError
        As :func:`tinsmith.cross_sections` and :func:`tinsmith.plan`; if a section does not fit the
        paper: the sentence names the scale that does; or if there are more than 5,000 sections.
    LinesError, PointsError, CrsError
        As :func:`tinsmith.cross_sections` and :func:`tinsmith.plan`.
    MissingExtraError
        If matplotlib is not installed.

    Notes
    -----
    Sections follow each other from the bottom up, in columns from left to right; each is on one
    sheet, whole. One millimetre along a section is exactly ``scale`` millimetres of the CRS's own
    lengths. Each has a datum and a grid at round elevations and offsets, below it the elevations of
    every surface at these offsets, above it its station, as it is written where there are station
    equations, and the areas of cut and fill, in squares of the unit of eastings: those of
    :func:`tinsmith.section_volumes`. The same surfaces and options give the same bytes.

    Examples
    --------
    >>> import tinsmith as ts
    >>> corners = [[0, 0], [60, 0], [60, 40], [0, 40]]
    >>> site = {
    ...     name: ts.triangulate([[x, y, z + x / 30] for x, y in corners], crs="EPSG:32616")
    ...     for name, z in (("ground", 5.0), ("design", 6.0))
    ... }
    >>> sheets = ts.section_sheets(site, [[5, 20], [55, 20]], interval=10, width=24, scale=200)
    >>> sheets
    <SectionSheets: 6 sections on 1 sheet, A3 landscape, 1:200>
    """
    optional.load("matplotlib", PURPOSE)
    factor = as_number("exaggeration", exaggeration, above=0.0, most=MOST_EXAGGERATED)
    surfaces = as_surfaces(tin)
    unit = find_ground_unit(surfaces.crs, ground_unit)
    caption = begin_caption(title, date, title_block, untitled=_UNTITLED, unit=unit)
    layouts = arrange_sheets(paper, orientation, caption)
    units = Units.of(unit, surfaces.crs, surfaces.elevation_unit)
    asked = None if scale is None else Scale.of(scale, unit)
    reaches = as_reaches(width, left, right)
    table = cross_sections(
        tin, centreline, interval=interval, stations=stations, left=reaches[0], right=reaches[1],
        start=start,
    )  # fmt: skip
    request = Request(
        tuple(list_sections(table, surfaces.names, units)),
        name_surfaces(surfaces.names),
        (-reaches[0], reaches[1]),
        unit,
        units.factor * factor,
    )
    drawing = arrange(request, layouts, asked)
    own = measure_scale_factor(surfaces.crs, *(float(table[name].mean()) for name in ("x", "y")))
    facts = [
        describe_crs(surfaces.crs, unit),
        describe_elevations(units, surfaces.elevation_unit is not None),
        *describe_sections(table, drawing.measures.names, unit),
        describe_points(surfaces),
        *describe_factor_here(own),
        f"True to scale on {drawing.layout.paper.name}",
    ]
    caption = caption._replace(facts=tuple(facts), scale=drawing.scale.text)
    notes = [
        *table.notes,
        *describe_factor(own, drawing.scale),
        *describe_missing_letters(caption, drawing.measures.names),
    ]
    return SectionSheets(drawing, factor, caption, notes)
