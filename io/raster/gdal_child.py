"""A raster through rasterio, as the child process reads it: its header, and strips of cells."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..isolated import Answer
from ..isolated.gdal import RASTER_DRIVERS, REFERRING_DRIVERS, make_environment

__all__ = [
    "DEPTHS",
    "ENVIRONMENT",
    "cut_strips",
    "describe",
    "prepare",
    "read_header",
    "read_strips",
]

ENVIRONMENT = make_environment()

DEPTHS = frozenset(
    {"depth", "sea_floor_depth", "sea_floor_depth_below_geoid",
     "sea_floor_depth_below_mean_sea_level", "sea_floor_depth_below_sea_surface",
     "sea_floor_depth_below_geopotential_datum"}
)  # fmt: skip
"""Standard names of the CF conventions for numbers that grow downwards."""

_AXIS = "NETCDF_DIM_"
_AXIS_NAMES = (
    frozenset({"x", "lon", "longitude", "easting", "projection_x_coordinate"}),
    frozenset({"y", "lat", "latitude", "northing", "projection_y_coordinate"}),
)


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
        "units": [unit or None for unit in dataset.units],
        "crs": dataset.crs.to_wkt() if dataset.crs else None,
        "descriptions": [text or "" for text in dataset.descriptions],
        "depths": [_is_depth(dataset.tags(band)) for band in dataset.indexes],
        "series": [_find_place_in_series(dataset.tags(band)) for band in dataset.indexes],
        "axis_units": _find_axis_units(dataset.tags()),
    }


def _is_depth(tags: dict[str, str]) -> bool:
    """Whether the numbers of a band grow downwards, by the conventions of netCDF."""
    told = tags.get("positive", "").lower()
    return told == "down" if told else tags.get("standard_name", "") in DEPTHS


def _find_place_in_series(tags: dict[str, str]) -> str:
    """Return where a band of netCDF stands on a further axis, such as "time 0"; empty if none."""
    places = [
        f"{key[len(_AXIS) :]} {value}" for key, value in tags.items() if key.startswith(_AXIS)
    ]
    return ", ".join(places)


def _find_axis_units(tags: dict[str, str]) -> list[str]:
    """Return the units of the x and y of netCDF, in the words of the file; empty if not told."""
    found = []
    for names in _AXIS_NAMES:
        variables = (key.rpartition("#")[0] for key in tags if key.endswith("#units"))
        units = [
            tags[f"{one}#units"].strip()
            for one in variables
            if {one.lower(), tags.get(f"{one}#standard_name", "")} & names
        ]
        found.append(units[0] if units else "")
    return found if all(found) else []


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
        valid = _find_valid(dataset, band, window, values, stride)
        yield Answer(None, {"values": values, "valid": valid.astype(np.uint8)})


def _find_valid(dataset: Any, band: int, window: Any, values: Any, stride: int) -> Any:
    valid = dataset.read_masks(band, window=window)[::stride, ::stride] != 0
    if values.dtype.kind == "f":
        valid &= np.isfinite(values)
    nodata = dataset.nodatavals[band - 1]
    if nodata is not None and not np.isnan(nodata):
        valid &= values != nodata
    return valid


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
