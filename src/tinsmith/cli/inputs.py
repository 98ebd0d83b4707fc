"""Inputs of a command besides its points: features of a vector file, contours, cells."""

from __future__ import annotations

from inspect import signature
from typing import TYPE_CHECKING

import click

from ..base.sentences import counted
from .output.failures import Failure
from .paths import Named

if TYPE_CHECKING:
    from pathlib import Path

    from ..base.arrays import AnyArray
    from ..terrain import Features, Raster
    from ..tin import TIN, Survey
    from .job import Job
    from .options import Reading

__all__ = [
    "as_contours",
    "count_cells",
    "find_cells",
    "name_features",
    "read_cells",
    "read_features",
    "read_lines",
    "read_places",
    "require_contours",
]

# ---------------------------------------------------------------- features


def name_features(path: Path | None, place: str) -> list[Named]:
    """Return a vector file, if one is given, for the list of inputs; ``place`` says where."""
    from ..io.vector.survey_lines import split_layer

    return [] if path is None else [Named(split_layer(path)[0], place)]


def read_features(given: Path, tin: TIN) -> Features:
    """Return the features of a vector file, ``FILE:LAYER``, in the CRS of a TIN."""
    from ..io.vector.geometries import read_geometries
    from ..io.vector.survey_lines import split_layer

    path, layer = split_layer(given)
    return read_geometries(path, crs=tin.crs, layer=layer)


def read_places(given: Path, tin: TIN) -> Features:
    """Return the points of a vector file, in the CRS of a TIN.

    Raises
    ------
    Failure
        If it holds anything else than points.
    """
    found = read_features(given, tin)
    if found.kind != "points":
        raise Failure(f"'{given}' has {found.kind}: points are needed.")
    return found


def read_lines(given: Path, tin: TIN, purpose: str) -> Features:
    """Return the lines of a vector file, and the rings of its polygons, in the CRS of a TIN.

    Raises
    ------
    Failure
        If it holds points; ``purpose`` says what lines are for.
    """
    from ..terrain import Features

    found = read_features(given, tin)
    if found.kind == "points":
        raise Failure(f"'{given}' has points: {purpose}.")
    lines = Features.of_lines(found.coordinates, found.offsets[0], crs=found.crs)
    return lines.with_notes(found.notes)


# ---------------------------------------------------------------- contours


def as_contours(reading: Reading) -> Reading:
    """Return the options of reading that take lines as breaklines, where a format has a choice.

    Raises
    ------
    click.UsageError
        If they are to be taken as something else.
    """
    given = reading.options.get("lines_as")
    if given == "points":
        raise click.UsageError("--from-contours takes lines as breaklines, --lines-as as points.")
    return reading.with_fallback(lines_as="breaklines")


def require_contours(survey: Survey, path: Path) -> None:
    """Refuse a survey most of whose lines are not level.

    Raises
    ------
    Failure
    """
    import numpy as np

    lines = [np.asarray(getattr(line, "coords", line)) for line in survey.breaklines]
    if not lines:
        raise Failure(f"'{path}' has no lines: --from-contours needs contour lines.")
    level = sum(line.shape[1] == 3 and bool((line[:, 2] == line[0, 2]).all()) for line in lines)
    if 2 * level < len(lines):
        raise Failure(
            f"'{path}': of {counted(len(lines), 'line')} {level:,} are level: these are not "
            "contours, since all points of a contour have the same elevation."
        )


# ---------------------------------------------------------------- cells of a raster


def read_cells(path: Path, job: Job) -> Raster | None:
    """Return the raster of a file; None where its cells are to be points, or it is no raster."""
    from ..base.errors import OptionError, ReadError
    from ..io.registry.lookup import choose_format

    given = job.reading.given
    chosen = None if "format" in given else choose_format(path, "read")
    if chosen is None or chosen.read_cells is None:
        return None
    read = chosen.load("read_cells")
    is_moved = job.reading.to_crs is not None
    if is_moved or job.how.shaping or {*given} - {*signature(read).parameters}:
        return None
    try:
        return read(path, **given)  # type: ignore[no-any-return]
    except (OptionError, ReadError):
        return None  # as points it can be read, or it is told why not


def count_cells(raster: Raster) -> str:
    """Write how many cells a raster has."""
    rows, columns = raster.shape
    return f"{rows * columns:,} cells"


def find_cells(raster: Raster, places: AnyArray) -> list[int]:
    """Return the cells whose centres are at places, row by row, -1 where there is none."""
    from ..base.results.gridded import locate_centers

    columns, rows = (
        {centre: number for number, centre in enumerate(centres.tolist())}
        for centres in locate_centers(raster.grid)
    )
    width = raster.shape[1]
    return [
        rows[y] * width + columns[x] if x in columns and y in rows else -1
        for x, y in places.tolist()
    ]
