"""Rasters as data sets of xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import optional
from .columns import unit_text

if TYPE_CHECKING:
    from ..arrays import Float64Array
    from ..types import Grid
    from .raster import Raster

_MAPPING = "spatial_ref"


def locate_centers(
    grid: Grid, rows: slice | None = None, columns: slice | None = None
) -> tuple[Float64Array, Float64Array]:
    """Return the eastings of columns and the northings of rows, at the centres of cells.

    Examples
    --------
    >>> from tinsmith import Bounds, Grid
    >>> locate_centers(Grid(Bounds(0.0, 0.0, 2.0, 3.0), shape=(3, 2), spacing=1.0))[1]
    array([2.5, 1.5, 0.5])
    """
    height, width = grid.shape
    x = grid.bounds.xmin + (_list_numbers(columns, width) + 0.5) * grid.spacing
    y = grid.bounds.ymax - (_list_numbers(rows, height) + 0.5) * grid.spacing
    return x, y


def _list_numbers(part: slice | None, count: int) -> Float64Array:
    chosen = slice(0, count) if part is None else part
    return np.arange(chosen.start, chosen.stop, dtype=np.float64)


def build_dataset(raster: Raster) -> Any:
    """Return a data set of xarray, as :meth:`Raster.to_xarray` describes it."""
    xarray = optional.load("xarray", "Turning a raster into a data set")
    east, north = locate_centers(raster.grid)
    variables = {}
    for name, band in raster.bands.items():
        unit, kind = unit_text(raster.units, name), np.dtype(band.dtype).kind
        attributes: dict[str, Any] = {"grid_mapping": _MAPPING} | ({"units": unit} if unit else {})
        if kind == "f" or not np.isnan(raster.nodata):
            attributes["_FillValue"] = raster.nodata
        variables[name] = (("y", "x"), np.array(band[:, :]), attributes)
    bounds, spacing = raster.grid.bounds, raster.grid.spacing
    numbers = (bounds.xmin, spacing, 0.0, bounds.ymax, 0.0, -spacing)
    reference = {"GeoTransform": " ".join(map(repr, map(float, numbers)))}
    if raster.crs is not None:
        reference["crs_wkt"] = raster.crs.to_wkt()
    coordinates = {"y": ("y", north), "x": ("x", east), _MAPPING: ((), 0, reference)}
    about = {"title": raster.name, "notes": list(raster.notes)}
    return xarray.Dataset(
        variables, coords=coordinates, attrs={name: value for name, value in about.items() if value}
    )
