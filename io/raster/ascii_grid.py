"""Esri ASCII grid: one band as text that any GIS reads, and the CRS in a file beside it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import find_wkt
from ...base.errors import OptionError, WriteError
from ...base.notes import warn
from ...base.sentences import FILE
from ..registry import replacing_data_set
from .cell_types import require_north_up

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...base.progress import Tell
    from ...base.results import Raster

_NODATA = -9999.0
_BLOCK_CELLS = 1 << 20


def write(
    raster: Raster, path: Path, *, band: str | None = None, progress: Tell | None = None
) -> None:
    """Write one band of a raster as an Esri ASCII grid, and its CRS beside it, as ``.prj``.

    Parameters
    ----------
    band : str, optional
        Needed if there are several.

    Raises
    ------
    FormatError
        If rows do not run from north to south and columns to the east.
    OptionError
        If there is no such band, or several and none is named.
    WriteError
        Also if the value for no data is that of a cell.

    Warns
    -----
    LossWarning
        For units and notes, which have no place.

    Notes
    -----
    Each number has the fewest digits that give the same double back. Cells without data, NaN and
    infinite ones have the raster's own value for no data, or -9999 where that is NaN.
    Cells that are not square have ``dx`` and ``dy`` in the header, as GDAL writes and reads them;
    ESRI's own programs read ``cellsize`` alone.
    """
    require_north_up(raster, "a text grid")
    name = _choose_band(raster, band)
    nodata = raster.nodata if math.isfinite(raster.nodata) else _NODATA
    lost = [what for what, there in (("units", raster.units), ("notes", raster.notes)) if there]
    if lost:
        warn(f"{FILE} is a text grid, which has no place for {' and '.join(lost)}.")
    with replacing_data_set(path, "asc") as new:
        with new.open("w", encoding="ascii", newline="") as file:
            file.write(_format_head(raster, nodata))
            for done, lines in _iterate_rows(raster, name, nodata):
                file.write(lines)
                if progress is not None:
                    progress(done)
        if raster.crs is not None:
            text = find_wkt(raster.crs, "WKT1_ESRI") or raster.crs.to_wkt()
            new.with_suffix(".prj").write_text(text, encoding="utf-8")


def _choose_band(raster: Raster, band: str | None) -> str:
    names = list(raster.bands)
    if band is None and len(names) == 1:
        return names[0]
    if band not in names:
        raise OptionError("band", band, f"one of {', '.join(names)}, as a text grid holds one")
    return band


def _format_head(raster: Raster, nodata: float) -> str:
    grid = raster.grid
    rows, columns = grid.shape
    if isinstance(grid.spacing, tuple):  # as GDAL has it
        size = "".join(
            f"{name} {float(side)!r}\n"
            for name, side in zip(("dx", "dy"), grid.spacing, strict=True)
        )
    else:
        size = f"cellsize {float(grid.spacing)!r}\n"
    return (
        f"ncols {columns}\nnrows {rows}\nxllcorner {float(grid.bounds.xmin)!r}\n"
        f"yllcorner {float(grid.bounds.ymin)!r}\n{size}"
        f"NODATA_value {_format_number(nodata)}\n"
    )


def _format_number(value: float) -> str:
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))


def _iterate_rows(raster: Raster, name: str, nodata: float) -> Any:
    """Yield the fraction done and the text of some rows, from the north."""
    rows, columns = raster.grid.shape
    band = raster.bands[name]
    step = max(1, _BLOCK_CELLS // max(1, columns))
    for start in range(0, rows, step):
        stop = min(start + step, rows)
        values = np.asarray(band[start:stop, 0:columns])
        texts = [" ".join(line) for line in _format_values(values, raster, nodata)]
        yield stop / rows, "\n".join(texts) + "\n"


def _format_values(values: AnyArray, raster: Raster, nodata: float) -> list[list[str]]:
    if values.dtype.kind == "b":
        values = values.astype(np.uint8)
    if values.dtype.kind != "f":
        return [list(map(str, row)) for row in values.tolist()]
    empty = ~np.isfinite(values)
    if not math.isfinite(raster.nodata) and (values == nodata).any():
        raise WriteError(
            f"Cannot write {FILE}: a cell has the value {nodata:g}, which stands for no data "
            "there: give the raster another nodata value.",
        )
    if empty.any():
        values = np.where(empty, nodata, values)
    if values.dtype.itemsize == 4:  # the digits of single precision, not those of its double
        return [list(map(str, row)) for row in values]
    return [list(map(repr, row)) for row in values.astype(np.float64).tolist()]
