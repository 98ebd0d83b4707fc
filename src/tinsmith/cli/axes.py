"""Axes of commands: alignments of LandXML and drawings, or lines of a vector file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .output.failures import Failure
from .parameters import file_option

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..terrain import Alignment

_HEAD = 4096


def axis_options(help: str) -> Callable[[Any], Any]:  # noqa: A002 - click's name
    """Add the options of a file of lines, and of which alignment in it is meant."""

    def decorate(function: Any) -> Any:
        named = click.option(
            "--alignment",
            metavar="NAME",
            help="Name of the alignment in a LandXML file of --line, or its number from 1.",
        )
        return file_option("--line", help, name="line_file")(named(function))

    return decorate


def is_landxml(path: Path) -> bool:
    """Whether a file is LandXML; one that cannot be opened is none."""
    from ..io import find_format

    sniff = find_format("landxml").sniff
    try:
        with path.open("rb") as file:
            return sniff is not None and sniff(file.read(_HEAD))
    except OSError:
        return False


def read_axis(
    path: Path, name: str | None, *, crs: Any = None, unit: str | None = None
) -> Alignment:
    """Return the alignment of a file, ``FILE:LAYER``.

    A CRS is that of a file that names none; a line of a vector file is reprojected to it.
    """
    from ..io import read_alignment
    from ..io.vector.survey_lines import split_layer

    file, layer = split_layer(path)
    if is_landxml(file):
        return read_alignment(file, name, crs=crs, unit=unit)
    if name is not None:
        raise Failure(f"--alignment is for LandXML, and '{path}' is none.")
    return read_alignment(file, layer=layer, crs=crs, unit=unit)
