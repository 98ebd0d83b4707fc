"""Production: reports of volumes, from surfaces to a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Self

from ....base import optional
from ....base.checks import require_tin
from ....base.products import product
from ....base.sentences import counted
from ....tin import Bounds
from ...earthwork import difference, level_surface
from ..paper import (
    PURPOSE,
    REPORT_SUFFIXES,
    Document,
    Drawable,
    NoRoom,
    join_no_room,
)
from ..scales import describe_factor, find_ground_unit, measure_scale_factor
from ..sheets import Units, describe_elevations, draw_legend, draw_scales
from ..title_block import (
    arrange_sheets,
    begin_caption,
    describe_crs,
    describe_factor_here,
    describe_missing_letters,
    draw_border,
    draw_title,
)
from . import texts
from .drawings import cut_profiles, draw_map, draw_map_legend, draw_profiles, make_map

if TYPE_CHECKING:
    import datetime as dt
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike

    from ....base.crs import UnitLike
    from ....tin import TIN
    from ...earthwork import Difference, ErrorModel
    from ..paper import Caption, Layout, PaperLike
    from .drawings import Map, Profiles

_UNTITLED = "Report of volumes"
_AIR = 4.0
"""Millimetres within a frame, around what is written."""


class _Contents(NamedTuple):
    """What is on the pages."""

    layout: Layout
    lines: tuple[texts.Line, ...]
    """Of text, but for the notes."""
    difference: Difference
    map: Map
    profiles: Profiles


class VolumeReport(Document):
    """What was measured between two surfaces, on paper to sign; of :func:`tinsmith.volume_report`.

    Attributes
    ----------
    difference : Difference
        Of the surfaces, with the volumes that the report tells.
    notes : tuple of str
        What was assumed or converted, and after :meth:`save` what had no room, in sentences.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ground = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
    >>> ts.volume_report(ground, base=6.0)
    <VolumeReport: 3 pages, A4 portrait>
    """

    _suffixes = REPORT_SUFFIXES
    _what = "a report"

    def __init__(self, contents: _Contents, caption: Caption, notes: Sequence[str]) -> None:
        super().__init__(contents.layout.paper, caption.title, notes)
        self._caption = caption
        self._frame = _find_room(contents.layout)
        self._lay_out(contents)

    def _lay_out(self, contents: _Contents) -> None:
        """Divide the text into pages, the notes at its end."""
        self._contents = contents
        self.difference = contents.difference
        told = texts.list_notes(self._notes, self._frame.width)
        noted = [texts.head("Notes"), *told] if self._notes else []
        self._pages = texts.divide(
            [*contents.lines, *noted], self._frame.height, texts.measure_signatures()
        )

    def __len__(self) -> int:
        return len(self._pages) + 2

    def __repr__(self) -> str:
        return f"<VolumeReport: {counted(len(self), 'page')}, {self.paper_name}>"

    def with_notes(self, notes: Sequence[str]) -> Self:
        """Return the same with further notes in front of its own, on its pages too.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ground = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> ts.volume_report(ground, base=6.0).with_notes(["One row was left out."]).notes[0]
        'One row was left out.'
        """
        made = super().with_notes(notes)
        made._lay_out(self._contents._replace(difference=self.difference.with_notes(notes)))
        return made

    def _draw_sheet(self, number: int, canvas: Drawable) -> NoRoom:
        layout = self._contents.layout
        draw_border(canvas, layout)
        caption = self._caption._replace(sheet=f"Page {number + 1} of {len(self)}")
        if number == len(self._pages):
            return self._draw_map(canvas, caption)
        if number > len(self._pages):
            return self._draw_profiles(canvas, caption)
        have_room = texts.draw_lines(canvas, self._pages[number], self._frame)
        if number == len(self._pages) - 1:
            texts.draw_signatures(canvas, self._frame)
        return join_no_room([draw_title(canvas, layout, caption), NoRoom(not have_room)])

    def _draw_map(self, canvas: Drawable, caption: Caption) -> NoRoom:
        drawn, layout = self._contents.map, self._contents.layout
        draw_map(canvas, drawn, self._contents.difference)
        have_room = [
            draw_map_legend(canvas, layout),
            draw_scales(
                canvas, layout, drawn.window.mm_per_unit, {"Map": drawn.scale.text}, caption.unit
            ),
        ]
        titled = draw_title(canvas, layout, caption._replace(scale=drawn.scale.text))
        return join_no_room([titled, NoRoom(not all(have_room))])

    def _draw_profiles(self, canvas: Drawable, caption: Caption) -> NoRoom:
        drawn, layout = self._contents.profiles, self._contents.layout
        scales = {"Offsets": drawn.scale.text, "Elevations": drawn.elevation_scale}
        have_room = [
            draw_profiles(canvas, drawn, self._frame),
            draw_legend(canvas, layout, drawn.measures[0].names),
            draw_scales(canvas, layout, drawn.measures[0].along, scales, caption.unit),
        ]
        titled = draw_title(canvas, layout, caption._replace(scale=drawn.scale.text))
        return join_no_room([titled, NoRoom(not all(have_room))])


@product
def volume_report(
    tin: TIN,
    other: TIN | None = None,
    *,
    base: float | ArrayLike | None = None,
    regions: Any = None,
    standard_error: float | str | ErrorModel | None = None,
    other_standard_error: float | str | ErrorModel | None = None,
    level_of_detection: float | None = None,
    confidence: float | None = None,
    files: Any = None,
    paper: PaperLike = "A4",
    title: str | None = None,
    date: dt.date | str | None = None,
    title_block: Any = None,
    ground_unit: UnitLike | None = None,
    progress: Callable[[float], None] | None = None,
) -> VolumeReport:
    """Report cut and fill between two surfaces on paper: figures, map, sections, lines to sign.

    Parameters
    ----------
    tin, other, base, regions, standard_error, other_standard_error, level_of_detection, confidence
        As of :func:`tinsmith.difference`.
    files : path or sequence of path, optional
        The file of each surface, whose name and SHA-256 are written.
    paper, title, date, title_block, ground_unit
        As of :func:`tinsmith.plan`; of a named paper in portrait. The default title is "Report of
        volumes".
    progress : callable, optional
        As of :func:`tinsmith.difference`.

    Returns
    -------
    VolumeReport
        ``save`` writes it as PDF.

    Raises
    ------
    OptionError, PointsError, CrsError, LinesError
        As :func:`tinsmith.difference` and :func:`tinsmith.plan`; if there are not as many files as
        surfaces.
    ReadError
        If a file cannot be read.
    MissingExtraError
        If matplotlib is not installed.

    Notes
    -----
    The pages have what was compared (files with their SHA-256, CRS, units, points), the volumes
    region by region as of :func:`tinsmith.volume`, with their standard errors and what is beyond a
    level of detection if that is asked for, the notes, and lines to sign; a map of cut and fill
    true to scale; and two sections through the place where the surfaces differ most, from west to
    east and from south to north. Where there is no room, text goes on on further pages.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ground = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
    >>> report = ts.volume_report(ground, base=6.0, standard_error=0.02, date="2026-11-27")
    >>> report.difference.volumes["cut"].round(2)
    array([266.67])
    """
    optional.load("matplotlib", PURPOSE)
    require_tin(tin)
    unit = find_ground_unit(tin.crs, ground_unit)
    caption = begin_caption(title, date, title_block, untitled=_UNTITLED, unit=unit)
    orientation = "portrait" if isinstance(paper, str) else None
    (layout,) = arrange_sheets(paper, orientation, caption)
    found = difference(
        tin, other, base=base, regions=regions, standard_error=standard_error,
        other_standard_error=other_standard_error, level_of_detection=level_of_detection,
        confidence=confidence, progress=progress,
    )  # fmt: skip
    compared = [tin] if other is None else [tin, other]
    paths = texts.as_files(files, len(compared))
    units = Units.of(unit, found.tin.crs, found.tin.elevation_unit)
    drawn = make_map(found, [layout], unit)
    surfaces = (tin, level_surface(tin, base) if other is None else other)
    frame = _find_room(layout)
    contents = _Contents(
        layout=layout,
        lines=tuple(_list_lines(compared, paths, found, base)),
        difference=found,
        map=drawn,
        profiles=cut_profiles(surfaces, drawn.lines, frame, units),
    )
    own = measure_scale_factor(tin.crs, *tin.bounds.center)
    facts = (
        describe_crs(tin.crs, unit),
        describe_elevations(units, found.tin.elevation_unit is not None),
        *describe_factor_here(own),
        _describe_program(),
    )
    caption = caption._replace(facts=facts)
    notes = [
        *found.notes,
        *describe_factor(own, drawn.scale),
        *describe_missing_letters(caption),
    ]
    return VolumeReport(contents, caption, notes)


def _find_room(layout: Layout) -> Bounds:
    """Return the room for text and sections on a page."""
    box = layout.frame
    return Bounds(box.xmin + _AIR, box.ymin, box.xmax - _AIR, box.ymax)


def _describe_program() -> str:
    from .... import __version__

    return f"Computed by tinsmith {__version__}"


def _list_lines(
    compared: Sequence[TIN], paths: Sequence[Path | None], found: Difference, base: Any
) -> Iterator[texts.Line]:
    """Yield the lines of the first page, but for the notes."""
    yield texts.head("What was compared")
    roles = ("Ground", "Design")
    for role, tin, path in zip(roles, compared, paths, strict=False):
        unit = texts.find_symbol(tin.elevation_unit)
        yield from texts.describe_surface(role, tin, path, unit)
    if len(compared) == 1:
        yield texts.describe_base(base, texts.find_symbol(found.tin.elevation_unit))
    yield texts.head("Volumes")
    yield from texts.list_volumes(found.volumes)
    yield texts.Line(
        ("Fill is where the design is above the ground, cut where it is below; net is fill less "
         "cut.",), size=texts.SMALL, before=1.5,
    )  # fmt: skip
    yield texts.Line(
        ("Both triangulations are overlaid, and volumes integrated without a grid.",),
        size=texts.SMALL,
    )
