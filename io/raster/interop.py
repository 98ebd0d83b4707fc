"""Rasters that other libraries have open as points, and rasters of a TIN as theirs."""

from __future__ import annotations

from contextlib import contextmanager
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.checks import require_type
from ...base.errors import OptionError
from ...base.notes import naming_file
from ...base.results import Raster
from ...base.types import Affine
from .gdal_child import cut_strips, describe
from .header import Header
from .reading import Choice, make_survey

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ...base.arrays import AnyArray, Float64Array, UInt8Array
    from ...base.crs import CrsLike, UnitLike
    from ...tin import Bounds, Survey
    from ..isolated import Answer

_AXES = (("x", "y"), ("lon", "lat"), ("longitude", "latitude"))
_MAPPINGS = ("spatial_ref", "crs")
"""What the coordinate of the CRS is called where no attribute points to it."""

_MOST_DRIFT = 1e-3
"""Of a cell: as far centres may lie from even steps."""


def from_raster(
    raster: Any,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    band: int | str | None = None,
    window: Sequence[float] | Bounds | None = None,
    cells: Sequence[int] | None = None,
    stride: int | None = None,
    nodata: float | Sequence[float] | None = None,
    fill: bool = False,
) -> Survey:
    """Return the cells of a raster that another library holds as points at their centres.

    Parameters
    ----------
    raster : open dataset of rasterio, DataArray or Dataset of xarray, or Raster
        Of xarray the coordinates ``x`` and ``y`` (or ``lon`` and ``lat``) are the centres, as
        rioxarray has them; its CRS is that of the grid mapping, usually ``spatial_ref``; cells that
        are NaN or ``_FillValue`` have no data. The cells of a DataArray that is computed when it is
        looked at (of dask) are asked for strip by strip.
    crs : CRS, str, int or pyproj.CRS, optional
        CRS wanted: the points are transformed to it, nothing is resampled. It declares the CRS of
        a raster that has none.
    elevation_unit : Unit or str, optional
        Unit of the elevations, where the raster does not tell.
    band : int or str, optional
        Number of the band, from 1; of a Dataset or a Raster the name. Default the first, but a
        Dataset or a Raster of several must be told which.
    window, cells, stride, nodata, fill
        As of :func:`tinsmith.read` for rasters: the part and every how many of the cells are
        taken, further values without data, and whether the surface spans voids.

    Returns
    -------
    Survey
        The same as :func:`tinsmith.read` gives for a file of the raster: nodata, masks, scale,
        offset, CRS and unit are honoured, and the surface ends at voids unless ``fill``.

    Raises
    ------
    ReadError
        If it has no georeference, coordinates in degrees, or no cell with an elevation.
    OptionError
        If it is no raster, or an option is none that is allowed.
    CrsError
        If the points cannot be transformed.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray
    >>> import tinsmith as ts
    >>> heights = np.array([[5.0, 6.0, 7.0], [6.0, np.nan, 8.0]])
    >>> array = xarray.DataArray(heights, {"y": [30.0, 20.0], "x": [0.0, 10.0, 20.0]})
    >>> survey = ts.from_raster(array, crs="EPSG:32616", fill=True)
    >>> survey
    <Survey: 5 points from raster, crs EPSG:32616>
    >>> ts.triangulate(survey)
    <TIN: 5 vertices, 3 triangles, z 5 to 8, crs EPSG:32616>
    """
    dataset, number = _open(raster, band)
    header = Header(
        path=Path(str(dataset.name) or "raster"),
        limits=None,
        **{**(about := describe(dataset)), "transform": Affine(*about["transform"])},
    )
    choice = Choice(*(crs, elevation_unit, number, window, cells, stride), nodata=nodata, fill=fill)
    with naming_file(header.path):
        return make_survey(header, partial(_cut, dataset), choice)


@contextmanager
def _cut(dataset: Any, where: dict[str, Any]) -> Iterator[Iterator[Answer]]:
    yield cut_strips(dataset, **where)


def _open(raster: Any, band: int | str | None) -> tuple[Any, int | None]:
    """Return what has the attributes of a dataset of rasterio, and the number of the band."""
    if isinstance(raster, Raster):
        name = _choose_name(list(raster.bands), band)
        return _describe_raster(raster, name), None
    if hasattr(raster, "data_vars"):
        names = [str(name) for name, one in raster.data_vars.items() if one.ndim >= 2]
        raster, band = raster[_choose_name(names, band)], None
    if isinstance(band, str):
        raise OptionError("band", band, "a number from 1", or_none=True)
    if hasattr(raster, "dims") and hasattr(raster, "coords"):
        return _describe_array(raster, band), None
    if all(hasattr(raster, name) for name in ("read_masks", "transform", "nodatavals")):
        return raster, band
    raise OptionError(
        "raster", raster, "an open dataset of rasterio, a DataArray or Dataset, or a Raster"
    )


def _choose_name(names: list[str], band: int | str | None) -> str:
    """Return the name of a band; of several one must be asked for."""
    if isinstance(band, str) and band in names:
        return band
    if band is None and len(names) == 1:
        return names[0]
    if isinstance(band, int) and not isinstance(band, bool) and 1 <= band <= len(names):
        return names[band - 1]
    raise OptionError("band", band, names or "a band, and there is none")


# ------------------------------------------------------- as a dataset of rasterio


class _Cells:
    """Cells of one band, with what ``describe`` and ``cut_strips`` ask a dataset for."""

    def __init__(self, values: Any, transform: Sequence[float], **about: Any) -> None:
        self.values = values
        self.count = 1
        self.subdatasets: list[str] = []
        self.colorinterp = (SimpleNamespace(name="gray"),)
        self.height, self.width = (int(side) for side in values.shape)
        self.dtypes = (str(values.dtype),)
        self.transform = tuple(transform)
        self.block_shapes = ((1, self.width),)
        self.name = about["name"]
        self.nodatavals = (about["nodata"],)
        self.scales, self.offsets = (about.get("scale", 1.0),), (about.get("offset", 0.0),)
        self.units = (about["unit"],)
        self.descriptions = ("",)
        self._words = about.get("words", {})
        self._axis_words = about.get("axis_words", {})
        text = about["crs"]
        self.crs = None if text is None else SimpleNamespace(to_wkt=lambda: text)

    def read(self, band: int, *, window: Any) -> AnyArray:  # noqa: ARG002 - as rasterio
        """Return the cells of a window."""
        (top, bottom), (left, right) = window
        return np.ma.getdata(np.asarray(self.values[top:bottom, left:right]))

    def tags(self, band: int | None = None) -> dict[str, str]:
        """Return what names and describes the band, or the axes, as GDAL does for netCDF."""
        return dict(self._axis_words if band is None else self._words)

    def read_masks(self, band: int, *, window: Any) -> UInt8Array:
        """Return 255 for every cell: what has no data is told by its value."""
        return np.full(self.read(band, window=window).shape, 255, np.uint8)


def _describe_raster(raster: Raster, name: str) -> _Cells:
    unit = raster.units.get(name)
    return _Cells(
        raster.bands[name],
        raster.grid.transform,
        name=raster.name or name,
        nodata=raster.nodata,
        unit=getattr(unit, "name", unit),
        crs=None if raster.crs is None else raster.crs.to_wkt(),
    )


def _describe_array(array: Any, band: int | None) -> _Cells:
    across, up = _find_axes(array)
    extra = [name for name in array.dims if name not in (across, up)]
    flat = array.isel({name: _choose_index(array, name, band) for name in extra})
    cells = flat.transpose(up, across)
    mapping = _find_mapping(array)
    attributes = dict(array.attrs)
    fill = attributes.get(
        "_FillValue", attributes.get("missing_value", array.encoding.get("_FillValue"))
    )
    return _Cells(
        cells,
        _find_transform(array, across, up, mapping),
        name=str(array.name or "raster"),
        nodata=None if fill is None else float(np.ravel(fill)[0]),
        unit=attributes.get("units"),
        scale=float(attributes.get("scale_factor", 1.0)),
        offset=float(attributes.get("add_offset", 0.0)),
        crs=mapping.get("crs_wkt") or mapping.get("spatial_ref"),
        words={key: str(value) for key, value in attributes.items()}
        | {"NETCDF_VARNAME": str(array.name or "")},
        axis_words={
            f"{axis}#{key}": str(value)
            for axis in (across, up)
            if axis in array.coords
            for key, value in array.coords[axis].attrs.items()
        },
    )


def _find_axes(array: Any) -> tuple[str, str]:
    for axes in _AXES:
        if set(axes) <= set(array.dims):
            return axes
    raise OptionError("raster", tuple(array.dims), "an array with the dimensions y and x")


def _choose_index(array: Any, name: str, band: int | None) -> int:
    """Return the place along a further dimension, of which there must be no doubt."""
    count = array.sizes[name]
    if count == 1 and band in (None, 1):
        return 0
    if name == "band" and band is not None and 1 <= band <= count:
        return band - 1
    raise OptionError("band", band, f"one of the {count} along '{name}'; isel chooses others")


def _find_mapping(array: Any) -> dict[str, Any]:
    """Return the attributes of the grid mapping; none if there is none."""
    named = array.encoding.get("grid_mapping") or array.attrs.get("grid_mapping")
    for name in (named, *_MAPPINGS):
        if name is not None and name in array.coords:
            return dict(array.coords[name].attrs)
    return {}


def _find_transform(array: Any, across: str, up: str, mapping: dict[str, Any]) -> tuple[float, ...]:
    """Return the georeference: that of the coordinates; to the last bit, where it is written."""
    written = _parse_transform(mapping)
    if across not in array.coords or up not in array.coords:
        return (1.0, 0.0, 0.0, 0.0, 1.0, 0.0) if written is None else written
    x, y = (np.asarray(array.coords[name].values, np.float64) for name in (across, up))
    if written is not None and _fits(written, x, y):
        return written
    if len(x) < 2 or len(y) < 2:
        raise OptionError("raster", array.shape, "one with two or more columns and rows")
    a, e = ((side[-1] - side[0]) / (len(side) - 1) for side in (x, y))
    found = (float(a), 0.0, float(x[0] - a / 2), 0.0, float(e), float(y[0] - e / 2))
    if not _fits(found, x, y):
        raise OptionError("raster", array.name, f"one with even steps of {across} and {up}")
    return found


def _parse_transform(mapping: dict[str, Any]) -> tuple[float, ...] | None:
    numbers = str(mapping.get("GeoTransform", "")).split()
    if len(numbers) != 6:
        return None
    west, a, b, north, d, e = map(float, numbers)
    return a, b, west, d, e, north


def _fits(transform: tuple[float, ...], x: Float64Array, y: Float64Array) -> bool:
    """Whether the centres of an upright transform are the coordinates."""
    a, b, west, d, e, north = transform
    if b != 0.0 or d != 0.0:
        return False
    off_x = np.abs(west + a * (np.arange(len(x)) + 0.5) - x).max()
    off_y = np.abs(north + e * (np.arange(len(y)) + 0.5) - y).max()
    return bool(off_x <= _MOST_DRIFT * abs(a) and off_y <= _MOST_DRIFT * abs(e))


# ----------------------------------------------------------------------- and out


def to_rasterio(raster: Raster) -> Any:
    """Return a raster as a dataset of rasterio in memory, open for reading.

    Parameters
    ----------
    raster : Raster

    Returns
    -------
    rasterio.io.DatasetReader
        Of a GeoTIFF without overviews, as :func:`tinsmith.write` makes it: bands with names and
        units, CRS, transform and nodata. Close it to give its memory back.

    Raises
    ------
    MissingExtraError
        If rasterio is not installed.
    OptionError
        If ``raster`` is none.
    WriteError
        If the value of cells without data is none that the bands can hold.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 4, 7], [0, 4, 8]], crs="EPSG:32616")
    >>> with ts.to_rasterio(ts.rasterize(tin, spacing=1.0)) as dataset:
    ...     dataset.shape, dataset.crs.to_epsg(), dataset.descriptions
    ((4, 4), 32616, ('elevation',))
    """
    rasterio = optional.load("rasterio.io", "Handing a raster over to rasterio")
    require_type("raster", raster, Raster)
    from .geotiff import write

    with TemporaryDirectory() as folder:
        path = Path(folder, "raster.tif")
        write(raster, path, overviews="none")
        memory = rasterio.MemoryFile(path.read_bytes())
    dataset = memory.open()
    dataset.memory = memory  # the bytes are there as long as somebody holds this
    return dataset
