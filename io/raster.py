"""Elevation rasters of any format that GDAL reads, as points at the pixel centres."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

import numpy as np

from ..crs import CRS, Unit
from ..errors import OptionError
from ..tin import Bounds, MissingExtraError, Survey
from .errors import FormatError, ReadError
from .placing import place, settle_unit

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from ..crs import CrsLike, UnitLike

__all__ = ["read", "recognises"]

_STRIP_CELLS = 4_000_000
"""Cells read at a time, so that memory holds little but the points."""

_COLOURS = ("red", "green", "blue", "palette", "cyan", "magenta", "yellow", "black")


@dataclass(frozen=True, slots=True)
class _Cells:
    """The cells to read: a window, every how many of its rows and columns, within which bounds."""

    column: int
    row: int
    width: int
    height: int
    stride: int
    bounds: Bounds | None = None

    @property
    def columns(self) -> NDArray[np.int64]:
        return np.arange(self.column, self.column + self.width, self.stride)

    def rows(self, start: int, stop: int) -> NDArray[np.int64]:
        """Return the rows wanted among ``start`` to ``stop``."""
        first = start + (self.row - start) % self.stride
        return np.arange(first, stop, self.stride)


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    z_unit: UnitLike | None = None,
    band: int | None = None,
    window: Sequence[int] | Bounds | None = None,
    stride: int = 1,
) -> Survey:
    """Read a raster as points, one at the centre of every cell that has an elevation.

    Parameters
    ----------
    path : Path
    crs : CRS, str, int or pyproj.CRS, optional
        CRS wanted. The points are transformed to it, nothing is resampled. It declares the CRS
        of a raster that has none.
    z_unit : Unit or str, optional
        Unit of the elevations, if neither the band nor the vertical axis of its CRS gives one; or
        the one of the two that is right, if they differ.
    band : int, optional
        Band to read, from 1; default the first.
    window : (4,) sequence of int, or Bounds, optional
        Part to read: column and row of the first cell (from 0), width and height in cells; or
        bounds in the raster's own CRS, which hold the centres of the cells wanted.
    stride : int
        Read every ``stride``-th row and column only.

    Returns
    -------
    Survey
        Rows of the raster from north to south, as stored. ``skipped["nodata cells"]`` counts
        cells that are nodata, masked, NaN or infinite.

    Raises
    ------
    ReadError
        If GDAL cannot read the file, it is a picture or has no georeference, its CRS is in
        degrees and no other is wanted, or no cell has an elevation.
    FormatError
        If band, window or stride is not one that the raster has.
    CrsError
        If the points cannot be transformed.
    OptionError
        If ``z_unit`` is unknown, or another than the raster's own.
    MissingExtraError
        If rasterio is not installed.

    Notes
    -----
    Scale and offset of the band are applied. The raster is read in strips; memory is 48 bytes
    for each valid cell at most, and a strip.
    """
    with _opened(path) as dataset:
        number = _band(dataset, band, path)
        _require_elevations(dataset, number, band is not None, path)
        target, source = CRS.of(crs), _crs_of(dataset)
        unit, notes = _elevation_unit(dataset, number, source, Unit.of(z_unit), path)
        cells = _cells(dataset, window, stride, path)
        place(_middle(dataset), source=source, target=target, path=path)
        points, n_nodata = _points(dataset, number, cells, path)
    if len(points) == 0:
        raise ReadError(
            f"'{path}': none of the {n_nodata} cells of band {number} has an elevation, "
            "all are nodata.",
            path=path,
        )
    placed = place(points, source=source, target=target, path=path, unit=unit)
    return Survey(
        points=placed.points,
        crs=placed.crs,
        elevation_unit=placed.elevation_unit,
        source=path.name,
        skipped={"nodata cells": n_nodata} if n_nodata else {},
        notes=[*notes, *placed.notes],
    )


def recognises(path: Path) -> bool:
    """Whether GDAL takes a file for a raster.

    Raises
    ------
    MissingExtraError
        If rasterio is not installed.
    """
    try:
        with _opened(path):
            return True
    except ReadError:
        return False


# ------------------------------------------------------------------ the dataset


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Open a raster; every fault of GDAL inside the block becomes a ReadError."""
    try:
        import rasterio
        from rasterio.errors import NotGeoreferencedWarning, RasterioError
    except ImportError as error:
        raise MissingExtraError("rasterio", extra="raster", purpose="Reading a raster") from error
    try:
        with warnings.catch_warnings(), rasterio.Env():
            warnings.simplefilter("ignore", NotGeoreferencedWarning)
            with rasterio.open(path) as dataset:
                yield dataset
    except RasterioError as error:
        reason = str(error.__cause__ or error).rstrip(".").replace("\n", " ")
        raise ReadError(
            f"'{path}' cannot be read as a raster, it may be damaged or truncated: {reason}.",
            path=path,
        ) from error


def _band(dataset: Any, band: int | None, path: Path) -> int:
    if dataset.count == 0:
        parts = ", ".join(dataset.subdatasets[:5])
        raise ReadError(
            f"'{path}' holds no band of its own"
            + (f" but several rasters ({parts}): extract one of them first." if parts else "."),
            path=path,
        )
    number = 1 if band is None else band
    if not isinstance(number, Integral) or not 1 <= number <= dataset.count:
        there_are = "only band 1 is" if dataset.count == 1 else f"bands 1 to {dataset.count} are"
        raise FormatError(f"Invalid band {band!r}: {there_are} in '{path}'.")
    return int(number)


def _require_elevations(dataset: Any, band: int, is_told: bool, path: Path) -> None:
    """Refuse pictures, complex numbers and rasters whose place is unknown."""
    meaning = dataset.colorinterp[band - 1].name
    if meaning in _COLOURS and not is_told:
        raise ReadError(
            f"'{path}' is a picture (band 1 is its {meaning}), not a raster of elevations: name "
            "the band if one holds them.",
            path=path,
        )
    if dataset.dtypes[band - 1].startswith("complex"):
        raise ReadError(f"'{path}': band {band} holds complex numbers, no elevations.", path=path)
    if dataset.transform.is_identity:
        raise ReadError(
            f"'{path}' has no georeference, so the coordinates of its cells are unknown: add a "
            "world file or set the transform with a GIS.",
            path=path,
        )


def _crs_of(dataset: Any) -> CRS | None:
    return CRS.of(dataset.crs.to_wkt()) if dataset.crs else None


def _elevation_unit(
    dataset: Any, band: int, source: CRS | None, declared: Unit | None, path: Path
) -> tuple[Unit | None, list[str]]:
    """Return the unit that band, vertical axis or caller give, and a note on one not understood."""
    word = str(dataset.units[band - 1] or "").strip()
    vertical = None if source is None else source.vertical_unit
    try:
        of_band = Unit.of(word or None)
    except OptionError:
        note = f"The unit of band {band}, '{word}', is no length: the elevations have none."
        return settle_unit(declared, vertical, path), [] if declared or vertical else [note]
    if of_band is None or vertical is None or of_band == vertical:
        return settle_unit(declared, of_band or vertical, path), []
    if declared in (of_band, vertical):
        return declared, []
    raise ReadError(
        f"'{path}' gives its elevations two units: {of_band.name} (of band {band}) and "
        f"{vertical.name} (of the vertical axis of its CRS); declare the one that is right.",
        path=path,
    )


def _middle(dataset: Any) -> NDArray[np.float64]:
    x, y = _applied(dataset.transform, dataset.width / 2, dataset.height / 2)
    return np.array([[x, y, 0.0]])


def _applied(transform: Any, column: Any, row: Any) -> tuple[Any, Any]:
    """Apply an affine transform; its own operator for that differs between versions."""
    a, b, c, d, e, f = transform[:6]
    return column * a + row * b + c, column * d + row * e + f


# ------------------------------------------------------------------ which cells


def _cells(dataset: Any, window: Sequence[int] | Bounds | None, stride: int, path: Path) -> _Cells:
    bounds = None
    if window is None:
        part = (0, 0, dataset.width, dataset.height)
    elif isinstance(window, Bounds):
        bounds = window
        part = _part_of_bounds(dataset, bounds, path)
    else:
        part = _part_of_window(dataset, window, path)
    smaller = min(part[2:])
    if not isinstance(stride, Integral) or not (1 <= stride < smaller or stride == 1):
        raise FormatError(
            f"Invalid stride {stride!r}: a whole number from 1 to {max(1, smaller - 1)} is needed "
            f"for the {part[2]} columns and {part[3]} rows to read."
        )
    return _Cells(*part, int(stride), bounds)


def _part_of_window(dataset: Any, window: Sequence[int], path: Path) -> tuple[int, int, int, int]:
    size = f"the raster has {dataset.width} columns and {dataset.height} rows"
    try:
        numbers = tuple(window)
    except TypeError:
        numbers = ()
    if len(numbers) != 4 or not all(isinstance(one, Integral) for one in numbers):
        raise FormatError(
            f"Invalid window {window!r}: four whole numbers (first column, first row, width, "
            f"height) or Bounds are needed; {size}."
        )
    column, row, width, height = (int(one) for one in numbers)
    fits = 0 <= column < column + width <= dataset.width
    if not (fits and 0 <= row < row + height <= dataset.height):
        raise FormatError(f"Window {numbers} does not lie in '{path}': {size}.")
    return column, row, width, height


def _part_of_bounds(dataset: Any, bounds: Bounds, path: Path) -> tuple[int, int, int, int]:
    """Return the cells of the smallest upright window that covers the bounds."""
    limits = (bounds.xmin, bounds.ymin, bounds.xmax, bounds.ymax)
    if not all(isinstance(one, Real) and np.isfinite(one) for one in limits):
        raise FormatError(f"Invalid window {bounds}: four finite numbers are needed.")
    x = np.array([bounds.xmin, bounds.xmin, bounds.xmax, bounds.xmax])
    y = np.array([bounds.ymin, bounds.ymax, bounds.ymin, bounds.ymax])
    columns, rows = _applied(~dataset.transform, x, y)
    column, row = max(0, int(np.floor(columns.min()))), max(0, int(np.floor(rows.min())))
    right = min(dataset.width, int(np.ceil(columns.max())))
    bottom = min(dataset.height, int(np.ceil(rows.max())))
    if column >= right or row >= bottom or bounds.width < 0 or bounds.height < 0:
        left, low, east, high = dataset.bounds
        raise FormatError(
            f"Window {limits} does not meet '{path}', which spans easting {left:g} to {east:g} "
            f"and northing {low:g} to {high:g}."
        )
    return column, row, right - column, bottom - row


# ------------------------------------------------------------------ points


def _points(dataset: Any, band: int, cells: _Cells, path: Path) -> tuple[NDArray[np.float64], int]:
    """Return the points of valid cells, and how many cells had none."""
    strips: list[NDArray[np.float64]] = []
    n_nodata = 0
    height = _strip_height(dataset, cells)
    for start in range(cells.row, cells.row + cells.height, height):
        stop = min(start + height, cells.row + cells.height)
        rows = cells.rows(start, stop)
        if len(rows):
            points, missing = _strip(dataset, band, cells, rows)
            strips.append(points)
            n_nodata += missing
    if not any(map(len, strips)) and n_nodata == 0:
        raise FormatError(f"Window {cells.bounds} holds no cell centre of '{path}'.")
    return np.concatenate(strips), n_nodata


def _strip_height(dataset: Any, cells: _Cells) -> int:
    """Return a number of rows that are whole blocks of the file, of some million cells."""
    block = max(1, int(dataset.block_shapes[0][0]))
    return max(1, _STRIP_CELLS // (block * cells.width)) * block


def _strip(
    dataset: Any, band: int, cells: _Cells, rows: NDArray[np.int64]
) -> tuple[NDArray[np.float64], int]:
    from rasterio.windows import Window

    first, last = int(rows[0]), int(rows[-1])
    window = Window(cells.column, first, cells.width, last - first + 1)
    taken = (slice(None, None, cells.stride), slice(None, None, cells.stride))
    values = dataset.read(band, window=window)[taken]
    has_value = _has_value(dataset, band, window, values, taken)
    x, y = _centres(dataset, cells.columns, rows)
    wanted = _within(cells.bounds, x, y)
    keep = has_value & wanted
    elevation = values[keep].astype(np.float64)
    scale, offset = dataset.scales[band - 1], dataset.offsets[band - 1]
    if (scale, offset) != (1.0, 0.0):
        elevation = elevation * scale + offset
    points = np.stack([x[keep], y[keep], elevation], axis=1)
    return points, int(np.count_nonzero(wanted & ~has_value))


def _has_value(
    dataset: Any, band: int, window: Any, values: NDArray[Any], taken: tuple[slice, slice]
) -> NDArray[np.bool_]:
    """Whether cells are valid: not masked, not nodata, finite."""
    valid: NDArray[np.bool_] = dataset.read_masks(band, window=window)[taken] != 0
    if values.dtype.kind == "f":
        valid &= np.isfinite(values)
    nodata = dataset.nodatavals[band - 1]
    if nodata is not None and not np.isnan(nodata):
        valid &= values != nodata
    return valid


def _centres(
    dataset: Any, columns: NDArray[np.int64], rows: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return easting and northing of the cell centres, (rows, columns) arrays."""
    x, y = _applied(dataset.transform, columns[None, :] + 0.5, rows[:, None] + 0.5)
    return x, y


def _within(
    bounds: Bounds | None, x: NDArray[np.float64], y: NDArray[np.float64]
) -> NDArray[np.bool_]:
    if bounds is None:
        return np.ones(x.shape, np.bool_)
    inside: NDArray[np.bool_] = (x >= bounds.xmin) & (x <= bounds.xmax)
    return inside & (y >= bounds.ymin) & (y <= bounds.ymax)
