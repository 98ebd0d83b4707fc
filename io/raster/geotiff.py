"""GeoTIFF and cloud optimized GeoTIFF through rasterio, block by block."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.errors import WriteError, choice
from ...base.policies import CellType, OverviewMethod, RasterCompression
from ...base.results import UNKNOWN_UNIT, unit_text
from ...base.sentences import FILE
from ..registry import replacing_data_set
from ..reprojection import require_kept
from .cell_types import store_as

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.progress import Tell
    from ...base.results import Raster

_TILE = 512
_BLOCK_CELLS = 4 * 1024 * 1024
"""Cells that are asked for at a time."""
_SMALLEST_OVERVIEW = 256
_LEVEL = 4
"""Of deflate: a third quicker than the usual 6, for files that are 1 to 10 percent larger."""
_LARGEST_DRAFT = 1 << 30
_WIDER = {"bool": "uint8", "float16": "float32"}
"""What GDAL keeps beside a raster, and would use with the new one."""


def write(
    raster: Raster,
    path: Path,
    *,
    overviews: OverviewMethod | None = None,
    compression: RasterCompression = "deflate",
    dtype: CellType | None = None,
    nodata: float | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a raster as a tiled GeoTIFF, compressed without loss.

    Parameters
    ----------
    overviews : {"average", "nearest", "none"}, optional
        How the cells of smaller copies for display are found. Default the mean, but the nearest
        cell for whole numbers and if a band is an aspect, whose mean is none.
    compression : {"deflate", "none"}, optional
        Without loss, as every GIS reads it, by all cores; or none, for the fastest file.
    dtype : {"float32", "float64", "int8", "int16", "int32", "uint8", "uint16", "uint32"}, optional
        Type of the cells; whole numbers are rounded to the nearest. Default that of the raster, or
        of the raster file from which it was read or whose floating cells it has (``like``).
    nodata : float, optional
        Value of cells without data, which no other cell may have. Default as of ``dtype``; NaN if
        nothing else was chosen.

    Raises
    ------
    OptionError
        If there are no such overviews, compression or type, or it cannot hold the value of cells
        without data.
    WriteError
        Also if a value is none that the cells can hold, or that of cells without data.

    Notes
    -----
    Bands have their names and units; the tag ``unit`` is "unknown" where it is not known. Bands of
    several types are written in the one that holds all of them. A file that may grow beyond 4 GB
    is a BigTIFF. Blocks of some million cells are asked for and written, so that memory does not
    grow with the raster; while some are computed, others are compressed. The bytes are the same for
    any number of cores.
    """
    raster = store_as(raster, dtype, nodata)
    resampling = _choose_resampling(raster, overviews)
    choice("compression", compression, RasterCompression)
    with replacing_data_set(path, "geotiff") as new, _translate_faults():
        _write_tiles(raster, new, compression, progress)
        factors = [] if resampling == "none" else _list_factors(raster)
        rasterio = optional.load("rasterio", "Writing overviews")
        if factors:
            packing = {
                "COMPRESS_OVERVIEW": "DEFLATE",
                "PREDICTOR_OVERVIEW": str(_choose_predictor(_choose_dtype(raster))),
                "ZLEVEL_OVERVIEW": str(_LEVEL),
            }
            with (
                rasterio.Env(
                    BIGTIFF_OVERVIEW="IF_SAFER",
                    GDAL_NUM_THREADS=_choose_threads(),
                    **(packing if compression == "deflate" else {}),
                ),
                rasterio.open(new, "r+") as dataset,
            ):
                dataset.build_overviews(factors, rasterio.enums.Resampling[resampling])
        _require_complete(new, factors)
        _require_crs(raster, new)


def write_cog(
    raster: Raster,
    path: Path,
    *,
    overviews: OverviewMethod | None = None,
    dtype: CellType | None = None,
    nodata: float | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a raster as a cloud optimized GeoTIFF; errors as :func:`write`.

    Parameters
    ----------
    overviews : {"average", "nearest", "none"}, optional
        How the cells of smaller copies for display are found, as :func:`write` chooses it.
    dtype : {"float32", "float64", "int8", "int16", "int32", "uint8", "uint16", "uint32"}, optional
        Type of the cells; whole numbers are rounded to the nearest. Default that of the raster, or
        of the raster file from which it was read or whose floating cells it has (``like``).
    nodata : float, optional
        Value of cells without data, which no other cell may have. Default as of ``dtype``; NaN if
        nothing else was chosen.

    Notes
    -----
    The driver copies a whole raster: a GeoTIFF is written beside it first, and removed.
    """
    raster = store_as(raster, dtype, nodata)
    resampling = _choose_resampling(raster, overviews)
    with replacing_data_set(path, "cog") as new, _translate_faults():
        plain = new.with_name(f"plain-{new.name}")
        size = math.prod(raster.shape) * len(raster.bands) * _choose_dtype(raster).itemsize
        _write_tiles(raster, plain, "none" if size <= _LARGEST_DRAFT else "deflate", progress)
        optional.load("rasterio.shutil", f"Writing {FILE}").copy(
            os.fspath(plain),
            os.fspath(new),
            driver="COG",
            COMPRESS="DEFLATE",
            LEVEL=_LEVEL,
            PREDICTOR="YES",
            NUM_THREADS=_choose_threads(),
            BIGTIFF="IF_SAFER",
            OVERVIEWS="NONE" if resampling == "none" else "AUTO",
            **({} if resampling == "none" else {"OVERVIEW_RESAMPLING": resampling.upper()}),
        )
        plain.unlink()
        _require_complete(new)
        _require_crs(raster, new)


def _choose_resampling(raster: Raster, overviews: str | None) -> str:
    if overviews is not None:
        return choice("overviews", overviews, OverviewMethod)
    is_circular = any("aspect" in name.casefold() for name in raster.bands)
    return "nearest" if is_circular or _choose_dtype(raster).kind != "f" else "average"


def _choose_dtype(raster: Raster) -> np.dtype[Any]:
    """Return the type that holds the values of all bands, one that GeoTIFF knows."""
    found = np.result_type(*(np.dtype(band.dtype) for band in raster.bands.values()))
    known = np.dtype(_WIDER.get(found.name, found.name))
    return np.dtype(np.float64) if known.kind == "f" and known.itemsize > 8 else known


def _choose_nodata(raster: Raster, dtype: np.dtype[Any]) -> float | None:
    """Return the value of cells without data; None where there is none."""
    value = raster.nodata
    if dtype.kind == "f":
        with np.errstate(over="ignore"):
            held = float(np.float64(value).astype(dtype))
    elif math.isnan(value):
        return None
    else:
        limits = np.iinfo(dtype)
        held = value if value == int(value) and limits.min <= value <= limits.max else math.inf
    if held == value or math.isnan(value):
        return value
    raise WriteError(
        f"Cannot write {FILE}: nodata {value!r} is no value that bands of {dtype.name} can have.",
    )


def _write_tiles(
    raster: Raster,
    new: Path,
    compression: RasterCompression,
    progress: Tell | None,
) -> None:
    rasterio = optional.load("rasterio", f"Writing {FILE}")
    with rasterio.open(new, "w", **_make_profile(raster, compression)) as dataset:
        for number, name in enumerate(raster.bands, 1):
            dataset.set_band_description(number, name)
            unit = unit_text(raster.units, name)
            if unit == UNKNOWN_UNIT:
                dataset.update_tags(number, unit=unit)
            elif unit:
                dataset.set_band_unit(number, unit)
        if raster.notes:
            dataset.update_tags(notes=" ".join(raster.notes))
        blocks = list(_iterate_blocks(*raster.shape))
        for done, (rows, columns) in enumerate(blocks, 1):
            window = rasterio.windows.Window.from_slices(rows, columns)
            for number, band in enumerate(raster.bands.values(), 1):
                values = np.asarray(band[rows, columns])
                dataset.write(values.astype(dataset.dtypes[0], copy=False), number, window=window)
            if progress is not None:
                progress(done / len(blocks))


def _make_profile(raster: Raster, compression: RasterCompression) -> dict[str, Any]:
    (rows, columns), dtype = raster.shape, _choose_dtype(raster)
    affine = optional.load("rasterio", f"Writing {FILE}").Affine
    tiles = {"tiled": True, "blockxsize": _TILE, "blockysize": _TILE}
    packing = {"compress": "deflate", "predictor": _choose_predictor(dtype), "zlevel": _LEVEL}
    return {
        "driver": "GTiff",
        "width": columns,
        "height": rows,
        "count": len(raster.bands),
        "dtype": dtype.name,
        "crs": _make_gdal_crs(raster),
        "transform": affine(*raster.grid.transform),
        "nodata": _choose_nodata(raster, dtype),
        "interleave": "band",
        "bigtiff": "IF_SAFER",
        "num_threads": _choose_threads(),
        **(packing if compression == "deflate" else {}),
        **(tiles if max(rows, columns) > _TILE else {}),
    }


@cache
def _first_process() -> int:
    """Return the process that first wrote a raster, of which a fork is a copy."""
    return os.getpid()


def _choose_threads() -> str:
    """Return how many threads GDAL may take: one in a fork.

    GDAL keeps the threads of its first file, and a fork, which has none, would wait for them.
    """
    return "ALL_CPUS" if os.getpid() == _first_process() else "1"


def _choose_predictor(dtype: np.dtype[Any]) -> int:
    return 3 if dtype.kind == "f" else 2


def _make_gdal_crs(raster: Raster) -> Any:
    """Return the CRS for GDAL: as a code where it knows it, whose vertical part it keeps."""
    rasterio = optional.load("rasterio", f"Writing {FILE}")
    if raster.crs is None:
        return None
    try:
        return rasterio.crs.CRS.from_user_input(str(raster.crs))
    except rasterio.errors.CRSError:
        return rasterio.crs.CRS.from_wkt(raster.crs.to_wkt())


def _require_crs(raster: Raster, new: Path) -> None:
    rasterio = optional.load("rasterio", f"Writing {FILE}")
    if raster.crs is None:
        return
    with rasterio.open(new) as dataset:
        found = None if dataset.crs is None else dataset.crs.to_wkt(version="WKT2_2019")
    require_kept(raster.crs, found)


def _require_complete(new: Path, factors: Sequence[int] | None = None) -> None:
    """Read every block, those of overviews too.

    GDAL does not say when a disk is full as it closes a file, and overviews whose directory was
    not written are none.
    """
    rasterio = optional.load("rasterio", f"Writing {FILE}")
    with rasterio.open(new) as dataset:
        levels = len(dataset.overviews(1))
    if factors is not None and levels != len(factors):
        raise _describe_missing("overviews")
    for options in ({}, *({"overview_level": level} for level in range(levels))):
        with rasterio.open(new, num_threads=_choose_threads(), **options) as dataset:
            # Refuse a file without the place of a block, which reads as cells without data.
            for number in dataset.indexes:
                for (row, column), _ in dataset.block_windows(number):
                    place = dataset.get_tag_item(
                        f"BLOCK_OFFSET_{column}_{row}", "TIFF", bidx=number
                    )
                    if place is None:
                        raise _describe_missing("cells")
            for rows, columns in _iterate_blocks(*dataset.shape):
                dataset.read(window=rasterio.windows.Window.from_slices(rows, columns))


def _describe_missing(what: str) -> WriteError:
    return WriteError(f"Cannot write {FILE}: {what} are missing in the file; is the disk full?")


def _iterate_blocks(rows: int, columns: int) -> Iterator[tuple[slice, slice]]:
    """Cut a raster into blocks of whole tiles, from the north-west on."""
    width = min(columns, _BLOCK_CELLS // _TILE)
    height = max(1, _BLOCK_CELLS // (width * _TILE)) * _TILE
    for top in range(0, rows, height):
        for left in range(0, columns, width):
            yield slice(top, min(top + height, rows)), slice(left, min(left + width, columns))


def _list_factors(raster: Raster) -> list[int]:
    """Return how many cells make one of each overview, in each direction."""
    largest = max(raster.shape)
    return [2**k for k in range(1, 32) if largest / 2 ** (k - 1) > _SMALLEST_OVERVIEW * 2]


@contextmanager
def _translate_faults() -> Iterator[None]:
    rasterio = optional.load("rasterio", f"Writing {FILE}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
            yield
    except (rasterio.errors.RasterioError, rasterio._err.CPLE_BaseError) as error:
        reason = " ".join(str(error.__cause__ or error).split()).rstrip(".")
        raise WriteError(f"Cannot write {FILE}: {reason}.") from error
