"""Files: sheets as pages of a PDF, as SVGs, PNGs or a DXF drawing, all of them whole or none."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from copy import copy
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from ....base import optional
from ....base.atomic import as_path, replacing, replacing_files, require_writable
from ....base.checks import require_count
from ....base.errors import OptionError, RenderError
from ....base.notes import join_notes
from ....base.sentences import counted, inflect
from .canvas import METADATA, Canvas, drawing_rules
from .dxf import write_drawing
from .lettering import PURPOSE
from .papers import MM_PER_INCH

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence
    from pathlib import Path
    from typing import Self

    from .canvas import Drawable
    from .dxf import Model
    from .papers import Paper

PLAN_SUFFIXES = (".pdf", ".svg", ".png", ".dxf")
SHEET_SUFFIXES = (".pdf", ".svg", ".dxf")
REPORT_SUFFIXES = (".pdf",)
"""File name endings of what can be written: of plans, of sheets of sections, and of reports."""
_IN_ONE = (".pdf", ".dxf")

_DPI = (50, 1200)
_MOST_PIXELS = 150_000_000
"""A0 at 260 dpi; 600 MB while it is drawn."""


_LEFT_OUT = {
    "station": ("label of a station", "labels of stations"),
    "point": ("label of a point", "labels of points"),
    "spot height": ("spot height", "spot heights"),
}


class NoRoom(NamedTuple):
    """What sheets had no room for."""

    is_cut: bool = False
    """Whether a text was cut."""
    left_out: Counter[str] = Counter()  # noqa: RUF012 - never changed
    """Labels of points and of stations, and spot heights: by kinds."""
    has_logo: bool = True
    """Whether the logo was drawn, if there is one."""

    def describe(self) -> Iterator[str]:
        """Yield notes."""
        where = (
            "[was|were] left out, where [it|they] would have met others: a larger scale has room."
        )
        for kind, count in self.left_out.items():
            if count:
                many = counted(count, *_LEFT_OUT[kind])
                yield inflect(f"{many} {where}", count)
        if self.is_cut:
            yield "Texts were cut, for they had no room: give shorter ones, or larger paper."
        if not self.has_logo:
            yield "The logo is not drawn in DXF."


def join_no_room(each: Sequence[NoRoom]) -> NoRoom:
    """Return what all of them together had no room for."""
    return NoRoom(
        any(one.is_cut for one in each),
        sum((one.left_out for one in each), Counter()),
        all(one.has_logo for one in each),
    )


class Document(ABC):
    """Sheets of paper, ready to be written.

    Attributes
    ----------
    paper : tuple of float
        Width and height of a sheet, millimetres.
    paper_name : str
    notes : tuple of str
        What was chosen or assumed, and after :meth:`save` what had no room, in sentences.
    """

    _suffixes: ClassVar[Sequence[str]] = SHEET_SUFFIXES
    _what: ClassVar[str] = "sheets"

    def __init__(self, paper: Paper, title: str, notes: Sequence[str]) -> None:
        self.paper = (paper.width, paper.height)
        self.paper_name = paper.name
        self._paper = paper
        self._title = title
        self._notes = tuple(notes)
        self._no_room: list[NoRoom] = []

    @abstractmethod
    def __len__(self) -> int:
        """Return how many sheets there are."""

    @abstractmethod
    def _draw_sheet(self, number: int, canvas: Drawable) -> NoRoom:
        """Draw a sheet, by its number from 0."""

    def _find_model(self) -> Model:
        """Return how the sheets lie in a drawing."""
        raise NotImplementedError

    @property
    def notes(self) -> tuple[str, ...]:
        """What was chosen or assumed, and after :meth:`save` what had no room, in sentences."""
        return (*self._notes, *join_no_room(self._no_room).describe())

    def with_notes(self, notes: Sequence[str]) -> Self:
        """Return the same with further notes in front of its own.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> ts.plan(tin).with_notes(["One row was left out."]).notes[0]
        'One row was left out.'
        """
        made = copy(self)
        made._notes = join_notes(notes, self._notes)
        return made

    def list_files(self, path: str | os.PathLike[str]) -> list[Path]:
        """Return the names of the files that :meth:`save` writes.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> sheets = ts.section_sheets(tin, [[5, 5], [15, 5]], interval=1, width=4, scale=20)
        >>> [file.name for file in sheets.list_files("road.svg")]
        ['road-1.svg', 'road-2.svg']
        """
        return list_files(path, len(self), self._suffixes, self._what)

    def save(self, path: str | os.PathLike[str], *, dpi: int = 200) -> list[Path]:
        """Write the sheets: as pages of a PDF, each as a file of its own, or in one drawing.

        Parameters
        ----------
        path : path
            Of several SVGs or PNGs the names end in their numbers: plan-1.svg, plan-2.svg. A plan
            is written as PDF, SVG, PNG or DXF, other sheets as PDF, SVG or DXF, a report as PDF.
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
            If matplotlib, or ezdxf for a drawing, is not installed.

        Notes
        -----
        A drawing is in the CRS's own unit, so that a length in it is that on the ground. A plan on
        one sheet, north up, lies at its own coordinates; other sheets lie side by side.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from tempfile import TemporaryDirectory
        >>> tin = ts.triangulate([[0, 0, 5], [40, 0, 6], [0, 30, 8]], crs="EPSG:32616")
        >>> with TemporaryDirectory() as folder:
        ...     [file.name for file in ts.plan(tin, title="Yard").save(f"{folder}/yard.pdf")]
        ['yard.pdf']
        """
        files = self.list_files(path)
        self._no_room = []
        if files[0].suffix.lower() != ".dxf":
            return write_sheets(files, self._draw(), self.paper, dpi, self._title)
        drawers = [partial(self._draw_on, number) for number in range(len(self))]
        write_drawing(files[0], drawers, self.paper, self._find_model())
        return files

    def _draw(self) -> Iterator[Canvas]:
        """Draw sheet after sheet, each when the one before is written."""
        for number in range(len(self)):
            canvas = Canvas(self._paper)
            self._draw_on(number, canvas)
            yield canvas

    def _draw_on(self, number: int, canvas: Drawable) -> None:
        self._no_room.append(self._draw_sheet(number, canvas))


def list_files(
    path: str | os.PathLike[str],
    count: int,
    suffixes: Sequence[str] = PLAN_SUFFIXES,
    what: str = "a plan",
) -> list[Path]:
    """Return the names of the files of so many sheets, whose endings are among ``suffixes``.

    Raises OptionError if the path is none. Raises RenderError if its suffix is another.

    Examples
    --------
    >>> [file.name for file in list_files("plan.svg", 12)][::11]
    ['plan-01.svg', 'plan-12.svg']
    """
    file = as_path(path, "path")
    suffix = file.suffix.lower()
    if suffix not in suffixes:
        raise RenderError(
            f"Cannot write {what} to '{file}': its name must end in {', '.join(suffixes)}."
        )
    if suffix in _IN_ONE or count == 1:
        return [file]
    digits = len(str(count))
    return [
        file.with_name(f"{file.stem}-{number:0{digits}}{file.suffix}")
        for number in range(1, count + 1)
    ]


def write_sheets(
    files: list[Path],
    canvases: Iterator[Canvas],
    size: tuple[float, float],
    dpi: int,
    title: str,
) -> list[Path]:
    """Write sheets to files of :func:`list_files`; each is drawn when it is written."""
    kind = files[0].suffix.lower().lstrip(".")
    _require_pixels(dpi, size, kind)
    for file in files:
        require_writable(file)
    optional.load("matplotlib", PURPOSE)
    with drawing_rules():
        if kind == "pdf":
            pages = optional.load("matplotlib.backends.backend_pdf", PURPOSE).PdfPages
            with (
                replacing(files[0]) as stream,
                pages(stream, metadata={**METADATA["pdf"], "Title": title}) as document,
            ):
                for canvas in canvases:
                    document.savefig(canvas.figure)
        else:
            _write_each(files, canvases, kind, dpi)
    return files


def _write_each(files: list[Path], canvases: Iterator[Canvas], kind: str, dpi: int) -> None:
    with replacing_files(files[0]) as first:
        for file, canvas in zip(files, canvases, strict=True):
            with first.with_name(file.name).open("wb") as stream:
                canvas.save(stream, kind, dpi=dpi)


def _require_pixels(dpi: Any, size: tuple[float, float], kind: str) -> None:
    require_count("dpi", dpi, least=_DPI[0], most=_DPI[1])
    pixels = size[0] * size[1] * (dpi / MM_PER_INCH) ** 2
    if kind == "png" and pixels > _MOST_PIXELS:
        fitting = int(dpi * (_MOST_PIXELS / pixels) ** 0.5)
        raise OptionError(
            "dpi", dpi, f"at most {fitting} on this paper, or the picture has too many pixels"
        )
