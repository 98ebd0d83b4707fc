"""Production: reports of volumes, from surfaces to a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from ....base import optional
from ....base.checks import require_tin
from ....base.notes import join_notes
from ....base.products import product
from ....base.sentences import counted
from ....tin import Bounds
from ...earthwork import difference, level_surface
from ..canvas import Canvas
from ..files import REPORT_SUFFIXES, list_files, write_sheets
from ..lettering import PURPOSE
from ..papers import Paper, arrange_sheet
from ..scales import describe_factor, find_ground_unit, measure_scale_factor
from ..sheets import Units, describe_elevations, draw_legend, draw_scales
from ..title_block import (
    Caption,
    describe_cut_texts,
    describe_missing_letters,
    draw_border,
    draw_title,
    read_words,
)
from . import texts
from .drawings import cut_profiles, draw_map, draw_map_legend, draw_profiles, make_map

if TYPE_CHECKING:
    import datetime as dt
    import os
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike

    from ....base.crs import UnitLike
    from ....tin import TIN
    from ...earthwork import Difference, ErrorModel
    from ..papers import Layout, PaperLike
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


class VolumeReport:
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

    def __init__(self, contents: _Contents, caption: Caption, notes: Sequence[str]) -> None:
        self._contents = contents
        self._caption = caption
        self.difference = contents.difference
        self._notes = tuple(notes)
        self._is_cut = False
        self._frame = _find_room(contents.layout)
        told = texts.list_notes(self._notes, self._frame.width)
        noted = [texts.head("Notes"), *told] if self._notes else []
        self._pages = texts.divide(
            [*contents.lines, *noted], self._frame.height, texts.measure_signatures()
        )

    def __len__(self) -> int:
        return len(self._pages) + 2

    def __repr__(self) -> str:
        paper = self._contents.layout.paper.name
        return f"<VolumeReport: {counted(len(self), 'page')}, {paper}>"

    @property
    def notes(self) -> tuple[str, ...]:
        """What was assumed or converted, and after :meth:`save` what had no room, in sentences."""
        return (*self._notes, *describe_cut_texts(self._is_cut))

    def with_notes(self, notes: Sequence[str]) -> VolumeReport:
        """Return the same with further notes in front of its own, on its pages too.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ground = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> ts.volume_report(ground, base=6.0).with_notes(["One row was left out."]).notes[0]
        'One row was left out.'
        """
        joined = join_notes(notes, self._notes)
        contents = self._contents._replace(difference=self.difference.with_notes(notes))
        return VolumeReport(contents, self._caption, joined)

    def list_files(self, path: str | os.PathLike[str]) -> list[Path]:
        """Return the name of the file that :meth:`save` writes, in a list.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ground = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> [file.name for file in ts.volume_report(ground, base=6.0).list_files("yard.pdf")]
        ['yard.pdf']
        """
        return list_files(path, len(self), REPORT_SUFFIXES, "a report")

    def save(self, path: str | os.PathLike[str]) -> list[Path]:
        """Write the report as a PDF.

        Parameters
        ----------
        path : path
            Ends in .pdf.

        Returns
        -------
        list of pathlib.Path
            The file, which is written whole, or the old one is left as it was.

        Raises
        ------
        OptionError
            If the path is none.
        RenderError
            If the suffix is another.
        WriteError
            If the file cannot be written.
        MissingExtraError
            If matplotlib is not installed.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from tempfile import TemporaryDirectory
        >>> ground = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> with TemporaryDirectory() as folder:
        ...     [one.name for one in ts.volume_report(ground, base=6.0).save(f"{folder}/yard.pdf")]
        ['yard.pdf']
        """
        files = self.list_files(path)
        self._is_cut = False
        paper = self._contents.layout.paper
        size = (paper.width, paper.height)
        return write_sheets(files, self._draw(), size, 100, self._caption.title)

    def _draw(self) -> Iterator[Canvas]:
        """Draw page after page, each when the one before is written."""
        for number in range(len(self)):
            canvas = Canvas(self._contents.layout.paper)
            if not self._draw_page(canvas, number):
                self._is_cut = True
            yield canvas

    def _draw_page(self, canvas: Canvas, number: int) -> bool:
        """Draw a page, by its number from 0; tell whether all texts had room."""
        layout = self._contents.layout
        draw_border(canvas, layout)
        caption = self._caption._replace(sheet=f"Page {number + 1} of {len(self)}")
        if number < len(self._pages):
            have_room = texts.draw_lines(canvas, self._pages[number], self._frame)
            if number == len(self._pages) - 1:
                texts.draw_signatures(canvas, self._frame)
            return draw_title(canvas, layout, caption) and have_room
        if number == len(self._pages):
            return self._draw_map(canvas, caption)
        return self._draw_profiles(canvas, caption)

    def _draw_map(self, canvas: Canvas, caption: Caption) -> bool:
        drawn, layout = self._contents.map, self._contents.layout
        draw_map(canvas, drawn, self._contents.difference)
        have_room = [
            draw_map_legend(canvas, layout),
            draw_scales(
                canvas, layout, drawn.window.mm_per_unit, {"Map": drawn.scale.text}, caption.unit
            ),
            draw_title(canvas, layout, caption._replace(scale=drawn.scale.text)),
        ]
        return all(have_room)

    def _draw_profiles(self, canvas: Canvas, caption: Caption) -> bool:
        drawn, layout = self._contents.profiles, self._contents.layout
        scales = {"Offsets": drawn.scale.text, "Elevations": drawn.elevation_scale}
        have_room = [
            draw_profiles(canvas, drawn, self._frame),
            draw_legend(canvas, layout, drawn.measures[0].names),
            draw_scales(canvas, layout, drawn.measures[0].along, scales, caption.unit),
            draw_title(canvas, layout, caption._replace(scale=drawn.scale.text)),
        ]
        return all(have_room)


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
    paper, title, date, ground_unit
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
    words = read_words(title, date, _UNTITLED)
    require_tin(tin)
    (layout,) = map(
        arrange_sheet, Paper.choices(paper, "portrait" if isinstance(paper, str) else None)
    )
    unit = find_ground_unit(tin.crs, ground_unit)
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
        f"CRS unknown, coordinates in {unit.symbol}" if tin.crs is None else tin.crs.caption,
        describe_elevations(units, found.tin.elevation_unit is not None),
        *(() if own is None else (f"Scale factor of the CRS here {own:.6f}",)),
        _describe_program(),
    )
    caption = Caption(words[0], facts, "", "", words[1], unit)
    notes = [
        *found.notes,
        *describe_factor(own, drawn.scale),
        *describe_missing_letters([*words, *facts]),
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
