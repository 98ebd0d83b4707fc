"""A raster file as a Raster, whose cells are read when they are asked for."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import as_path
from ...base.crs import CRS, Unit
from ...base.errors import OptionError, ReadError
from ...base.results import Raster
from ...base.sentences import FILE
from ...base.types import CellStorage
from ...terrain.gridding import as_parts, to_grid
from ...tin.screening import parse_nodata
from ..door import names_its_file
from ..isolated import is_file_object, is_pipe, require_local, require_readable
from ..reprojection import place
from .header import Header, read_header, stream_strips
from .meaning import settle_axes
from .reading import choose_elevations, find_elevation_unit, find_middle

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import AnyArray, BoolArray, Float64Array
    from ...base.crs import CrsLike, UnitLike

_STRIP_CELLS = 4_000_000
"""Cells that come from the child process at a time."""


@names_its_file
def read_raster(
    path: str | os.PathLike[str],
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    band: int | None = None,
    nodata: float | Sequence[float] | None = None,
) -> Raster:
    """Read the elevations of a raster file as a raster, block by block as they are asked for.

    :func:`tinsmith.read` reads its cells as points. This is for rasters that are larger than
    memory, and for what works on cells: :func:`tinsmith.simplify`.

    Parameters
    ----------
    path : str or os.PathLike
        A local file that GDAL reads. It must stay as it is while the raster is used.
    crs : CRS, str, int or pyproj.CRS, optional
        Declares the CRS of a raster that has none. Nothing is transformed.
    elevation_unit : Unit or str, optional
        Unit of the elevations, if the file does not give it.
    band : int, optional
        Band to read, from 1; default the first.
    nodata : float or sequence of float, optional
        Elevations that stand for no data, besides the one that the raster declares.

    Returns
    -------
    Raster
        With the band "elevation", in which cells without an elevation are NaN.

    Raises
    ------
    ReadError
        If GDAL cannot read the file, it is a pipe or a picture, it has no georeference, or its CRS
        is in degrees.
    OptionError
        If its cells have no area, ``crs`` is another than that of the file, or an option is not one
        that it has.
    MissingExtraError
        If rasterio is not installed.

    Notes
    -----
    Scale and offset of the band are applied. The rows asked for last are kept in memory, in their
    whole width.

    Examples
    --------
    >>> import tinsmith as ts
    >>> dem = ts.read_raster("sample_data/jacksboro.tif")
    >>> ts.simplify(dem, tolerance=20.0).report.simplification.largest_error <= 20.0
    True
    """
    if is_file_object(path):
        allowed = "the name of a file, whose cells are read as they are asked for; tinsmith.read"
        raise OptionError("path", path, f"{allowed} takes file objects")
    file = as_path(path)
    require_local(path)
    if is_pipe(file):
        raise ReadError(
            f"{FILE} is a pipe, and rows of a raster are read as they are asked for: write it to "
            "a file, and name that.",
        )
    require_readable(file)
    return _make_raster(
        read_header(file), CRS.of(crs), Unit.of(elevation_unit), band, parse_nodata(nodata)
    )


def _make_raster(
    header: Header,
    target: CRS | None,
    declared: Unit | None,
    band: int | None,
    marks: Float64Array,
) -> Raster:
    path = header.path
    number, header, said = choose_elevations(header, band)
    header, source, noted = settle_axes(header, target)
    unit, notes = find_elevation_unit(header, number, source, declared)
    grid = to_grid(header.transform, (header.height, header.width), os.fspath(path))
    if source is not None and target is not None and not source.is_same(target):
        raise OptionError("crs", target, f"that of {FILE}, {source}: cells are not transformed")
    placed = place(find_middle(header), source=source, target=target, unit=unit)
    bands: dict[str, Any] = {"elevation": _FileBand(header, number, marks)}
    stored = CellStorage(header.dtypes[number - 1], header.nodata[number - 1])
    is_kept = (header.scales[number - 1], header.offsets[number - 1]) == (1.0, 0.0)
    has_nodata = np.dtype(stored.dtype).kind == "f" or stored.nodata is not None
    return Raster(
        bands,
        grid,
        crs=placed.crs,
        stored_as=stored if is_kept and has_nodata else None,
        units={"elevation": placed.elevation_unit},
        name=path.stem,
        notes=[*said, *noted, *notes, *placed.notes],
    )


class _FileBand:
    """A band of a file; cells without an elevation are NaN."""

    def __init__(self, header: Header, number: int, marks: Float64Array) -> None:
        self._header, self._number, self._marks = header, number, marks
        self._factors = header.scales[number - 1], header.offsets[number - 1]
        self.shape = (header.height, header.width)
        is_exact = header.dtypes[number - 1] in ("uint8", "int8", "uint16", "int16", "float32")
        is_plain = is_exact and self._factors == (1.0, 0.0)
        self.dtype = np.dtype(np.float32 if is_plain else np.float64)
        self._rows = slice(0, 0)
        self._strip = np.empty((0, header.width), self.dtype)

    def __getitem__(self, key: Any) -> AnyArray:
        rows, columns = as_parts(key, self.shape)
        if not (self._rows.start <= rows.start and rows.stop <= self._rows.stop):
            self._strip = np.empty((0, self.shape[1]), self.dtype)  # not two at a time
            self._strip, self._rows = self._read(rows), rows
        first = self._rows.start
        return self._strip[rows.start - first : rows.stop - first, columns]

    def _read(self, rows: slice) -> AnyArray:
        """Read rows in their whole width."""
        where = {"band": self._number, "column": 0, "width": self.shape[1], "stride": 1}
        height = max(1, _STRIP_CELLS // self.shape[1])
        starts = range(rows.start, rows.stop, height)
        ends = [[start, min(start + height, rows.stop) - 1] for start in starts]
        found = np.empty((rows.stop - rows.start, self.shape[1]), self.dtype)
        with stream_strips(self._header, {**where, "rows": ends}) as answers:
            for (first, last), answer in zip(ends, answers, strict=False):
                part = self._convert(answer.arrays["values"], answer.arrays["valid"] != 0)
                found[first - rows.start : last + 1 - rows.start] = part
        return found

    def _convert(self, values: AnyArray, valid: BoolArray) -> AnyArray:
        scale, offset = self._factors
        z = values.astype(self.dtype)
        if self._factors != (1.0, 0.0):
            with np.errstate(over="ignore", invalid="ignore"):
                z = z * scale + offset
        if (valid & ~np.isfinite(z)).any():
            raise ReadError(
                f"cells of band {self._number} would have elevations that "
                "are not finite: its scale or offset is wrong.",
            )
        valid &= ~np.isin(z.astype(np.float64), self._marks)
        return np.where(valid, z, self.dtype.type(np.nan))
