"""Axes of commands: alignments of LandXML and drawings, or lines of a vector file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...base.errors import ReadError
from ...base.sentences import counted
from ..parameters import file_option

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...terrain import Alignment
    from ...tin import TIN


def alignment_option(where: str) -> Callable[[Any], Any]:
    """Return the option that chooses an alignment of a file."""
    words = f"Name of the alignment in {where}, or its number from 1."
    return click.option("--alignment", metavar="NAME", help=words)


def axis_options(help: str) -> Callable[[Any], Any]:  # noqa: A002 - click's name
    """Add the options of a file of lines, and of which alignment in it is meant."""

    def decorate(function: Any) -> Any:
        named = alignment_option("the file of --line")(function)
        return file_option("--line", help, name="line_file")(named)

    return decorate


def read_axis(
    path: Path, name: str | None, *, crs: Any = None, unit: str | None = None
) -> Alignment:
    """Return the alignment of a file, ``FILE:LAYER``.

    A CRS is that of a file that names none; a line of a vector file is reprojected to it.
    """
    from ...io import read_alignment

    file, layer = _split(path)
    return read_alignment(file, name, layer=layer, crs=crs, unit=unit)


def holds_alignments(path: Path) -> bool:
    """Whether the format of a file has alignments, and not lines alone."""
    from ...io.alignments import holds_alignments as holds

    return holds(_split(path)[0])


def read_line(path: Path, tin: TIN, elevation_unit: Any, notes: list[str]) -> Any:
    """Return the one line in space of a vector file, ``FILE:LAYER``, in the CRS of a surface.

    Raises ReadError if there are more, or none.
    """
    from ...io import read_lines

    file, layer = _split(path)
    found = read_lines(
        file,
        crs=tin.crs,
        target_unit=tin.elevation_unit,
        elevation_unit=elevation_unit,
        layer=layer,
        notes=notes,
    )
    if len(found) != 1:
        raise ReadError(f"'{file}' has {counted(len(found), 'line')}: an axis is one.")
    return found[0]


def _split(path: Path) -> tuple[Path, str | None]:
    from ...io.vector import split_layer

    return split_layer(path)
