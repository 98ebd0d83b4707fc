"""Files: sheets as pages of a PDF, or as SVGs and PNGs, all of them whole or none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base import optional
from ...base.atomic import as_path, replacing, replacing_files, require_writable
from ...base.checks import require_count
from ...base.errors import OptionError, RenderError
from .canvas import METADATA, drawing_rules
from .lettering import PURPOSE
from .papers import MM_PER_INCH

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from .canvas import Canvas

PLAN_SUFFIXES = (".pdf", ".svg", ".png")
SHEET_SUFFIXES = (".pdf", ".svg", ".dxf")
REPORT_SUFFIXES = (".pdf",)
"""File name endings of what can be written: of plans, of sheets of sections, and of reports."""
_IN_ONE = (".pdf", ".dxf")

_DPI = (50, 1200)
_MOST_PIXELS = 150_000_000
"""A0 at 260 dpi; 600 MB while it is drawn."""


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
