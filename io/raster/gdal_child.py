"""A raster through rasterio, as the child process reads it: its header, and strips of cells."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..isolated import RASTER_DRIVERS, REFERRING_DRIVERS, Answer, make_environment

ENVIRONMENT = make_environment()

_SAID = 64
"""Bands of which is told what they are said to hold."""
_WORDS = ("standard_name", "long_name", "positive", "NETCDF_VARNAME")
_AXIS = re.compile(r"[^#]+#(units|standard_name)|NETCDF_DIM_EXTRA")


def prepare() -> None:
    """Load the library, and make sure that no driver is loaded that follows references."""
    _require_plain_drivers(set(REFERRING_DRIVERS))


def _require_plain_drivers(unwanted: set[str]) -> None:
    import rasterio

    with rasterio.Env() as env:
        loaded = unwanted & set(env.drivers())
    if loaded:
        raise RuntimeError(f"the GDAL driver {min(loaded)} cannot be switched off")


def read_header(path: str, *, is_virtual: bool = False) -> Answer:
    """Return what a raster says of itself; keys as the attributes of a rasterio dataset."""
    with _open_raster(path, is_virtual) as dataset:
        return Answer(describe(dataset), {})


def describe(dataset: Any) -> dict[str, Any]:
    """Return what a dataset of rasterio says of itself."""
    return {
        "count": dataset.count,
        "subdatasets": list(dataset.subdatasets[:5]),
        "colours": [one.name for one in dataset.colorinterp],
        "dtypes": list(dataset.dtypes),
        "width": dataset.width,
        "height": dataset.height,
        "transform": list(dataset.transform[:6]),
        "block_height": int(dataset.block_shapes[0][0]) if dataset.count else 1,
        "block_width": int(dataset.block_shapes[0][1]) if dataset.count else 1,
        "scales": list(dataset.scales),
        "offsets": list(dataset.offsets),
        "nodata": list(dataset.nodatavals),
        "units": [unit or None for unit in dataset.units],
        "crs": dataset.crs.to_wkt() if dataset.crs else None,
        "meanings": [_list_words(dataset, band) for band in range(1, dataset.count + 1)[:_SAID]],
        "tags": {key: value for key, value in dataset.tags().items() if _AXIS.fullmatch(key)},
    }


def _list_words(dataset: Any, band: int) -> dict[str, str]:
    """Return what a dataset says of the meaning of a band."""
    tags = {key: value for key, value in dataset.tags(band).items() if key in _WORDS}
    return {**tags, "description": dataset.descriptions[band - 1] or ""}


def read_strips(
    path: str,
    *,
    band: int,
    column: int,
    width: int,
    rows: list[list[int]],
    stride: int,
    is_virtual: bool = False,
) -> Iterator[Answer]:
    """Yield the values of strips, and whether each is valid: not masked, not nodata, finite.

    Parameters
    ----------
    path : str
    band : int
    column, width : int
        Of the window to read.
    rows : list of [int, int]
        First and last row of each strip, both wanted.
    stride : int
        Every how many of the rows and columns.
    is_virtual : bool
    """
    with _open_raster(path, is_virtual) as dataset:
        yield from cut_strips(
            dataset, band=band, column=column, width=width, rows=rows, stride=stride
        )


def cut_strips(
    dataset: Any, *, band: int, column: int, width: int, rows: list[list[int]], stride: int
) -> Iterator[Answer]:
    """Yield what :func:`read_strips` does, of a dataset that is open."""
    for first, last in rows:
        window = ((first, last + 1), (column, column + width))
        values = dataset.read(band, window=window)[::stride, ::stride]
        valid = dataset.read_masks(band, window=window)[::stride, ::stride] != 0
        if values.dtype.kind == "f":
            valid &= np.isfinite(values)
        nodata = dataset.nodatavals[band - 1]
        if nodata is not None and not np.isnan(nodata):
            valid &= values != nodata
        yield Answer(None, {"values": values, "valid": valid.astype(np.uint8)})


@contextmanager
def _open_raster(path: str, is_virtual: bool) -> Iterator[Any]:
    """Open a raster; of what GDAL says of a fault, its own words are passed on."""
    import rasterio
    from rasterio.errors import NotGeoreferencedWarning, RasterioError

    try:
        with warnings.catch_warnings(), rasterio.Env():
            warnings.simplefilter("ignore", NotGeoreferencedWarning)
            with rasterio.DatasetReader(path, driver=_list_drivers(is_virtual)) as dataset:
                yield dataset
    except RasterioError as error:
        raise RuntimeError(str(error.__cause__ or error)) from error


def _list_drivers(is_virtual: bool) -> list[str]:
    import rasterio

    with rasterio.Env() as env:
        there = env.drivers()
    return ["VRT"] if is_virtual else [name for name in RASTER_DRIVERS if name in there]
