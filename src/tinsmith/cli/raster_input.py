"""Rasters whose cells a command takes as they are, without a TIN of all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from ..base.arrays import AnyArray
    from ..terrain import Raster
    from .request import Request

__all__ = ["count_cells", "find_cells", "read_cells"]

_OF_CELLS = ("crs", "z_unit", "band", "nodata")
"""Options of reading that a raster has when its cells are not read as points."""


def read_cells(path: Path, request: Request) -> Raster | None:
    """Return the raster of a file; None where its cells are to be points, or it is no raster."""
    from ..base.errors import OptionError, ReadError
    from ..io.raster.elevations import read_raster
    from ..io.raster.formats import FORMATS

    given = request.reading.given
    is_raster = path.suffix.lower() in FORMATS[0].suffixes and given.pop("format", None) is None
    is_moved = request.reading.to_crs is not None
    if not is_raster or is_moved or request.how.shaping or set(given) - set(_OF_CELLS):
        return None
    try:
        return read_raster(path, **given)
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
