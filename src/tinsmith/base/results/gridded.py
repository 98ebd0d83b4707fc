"""Rasters as data sets of xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import optional
from ..errors import OptionError
from .columns import unit_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..arrays import Float64Array
    from ..types import Grid
    from .raster import Raster

_MAPPING = "spatial_ref"


def locate_centers(
    grid: Grid, rows: slice | None = None, columns: slice | None = None
) -> tuple[Float64Array, Float64Array]:
    """Return the eastings of columns and the northings of rows, at the centres of cells.

    The grid is aligned with the axes of its CRS.

    Examples
    --------
    >>> from tinsmith import Bounds, Grid
    >>> locate_centers(Grid(Bounds(0.0, 0.0, 2.0, 3.0), shape=(3, 2), spacing=1.0))[1]
    array([2.5, 1.5, 0.5])
    """
    (height, width), affine = grid.shape, grid.transform
    if not grid.is_aligned:
        raise OptionError("grid", grid, "one whose cells lie along the axes of its CRS")
    x = affine.c + (_list_numbers(columns, width) + 0.5) * affine.a
    y = affine.f + (_list_numbers(rows, height) + 0.5) * affine.e
    return x, y


def locate_all_centers(
    grid: Grid, rows: slice | None = None, columns: slice | None = None
) -> tuple[Float64Array, Float64Array]:
    """Return easting and northing of the centre of each cell, (rows, columns), of any grid.

    Examples
    --------
    >>> from tinsmith import Grid
    >>> turned = Grid.of_transform((3.0, 4.0, 0.0, 4.0, -3.0, 10.0), shape=(1, 2))
    >>> locate_all_centers(turned)
    (array([[3.5, 6.5]]), array([[10.5, 14.5]]))
    """
    if grid.is_aligned:
        x, y = locate_centers(grid, rows, columns)
        return np.broadcast_to(x, (len(y), len(x))), np.broadcast_to(y[:, None], (len(y), len(x)))
    height, width = grid.shape
    across = _list_numbers(columns, width) + 0.5
    return grid.transform.apply(across, (_list_numbers(rows, height) + 0.5)[:, None])


def _list_numbers(part: slice | None, count: int) -> Float64Array:
    chosen = slice(0, count) if part is None else part
    return np.arange(chosen.start, chosen.stop, dtype=np.float64)


class Turn(NamedTuple):
    """How cells are turned over so that rows run from north to south and columns to the east."""

    rows: int
    columns: int
    """1 or -1, steps through the cells."""

    def of(self, cells: Any) -> Any:
        """Return cells, or what stands for rows and columns, turned over; twice is not at all."""
        return cells if self == (1, 1) else cells[:: self.rows, :: self.columns]

    def of_parts(self, parts: tuple[slice, slice], shape: Sequence[int]) -> tuple[slice, slice]:
        """Return rows and columns as they are numbered in the turned cells."""
        rows, columns = (
            part if step > 0 else slice(side - part.stop, side - part.start)
            for part, side, step in zip(parts, shape, self, strict=True)
        )
        return rows, columns


def find_turn(grid: Grid) -> Turn:
    """Return how the cells of a grid that is aligned with its axes are turned to north up.

    Those of others are turned over where they are mirrored.
    """
    a, b, _, d, e, _ = grid.transform
    if grid.is_aligned:
        return Turn(1 if e < 0.0 else -1, 1 if a > 0.0 else -1)
    return Turn(1, 1 if a * e - b * d < 0.0 else -1)


def build_dataset(raster: Raster) -> Any:
    """Return a data set of xarray, as :meth:`Raster.to_xarray` describes it."""
    xarray = optional.load("xarray", "Turning a raster into a data set")
    variables = {}
    for name, band in raster.bands.items():
        unit, kind = unit_text(raster.units, name), np.dtype(band.dtype).kind
        attributes: dict[str, Any] = {"grid_mapping": _MAPPING} | ({"units": unit} if unit else {})
        if kind == "f" or not np.isnan(raster.nodata):
            attributes["_FillValue"] = raster.nodata
        variables[name] = (("y", "x"), np.array(band[:, :]), attributes)
    affine = raster.grid.transform
    numbers = (affine.c, affine.a, affine.b, affine.f, affine.d, affine.e)
    reference = {"GeoTransform": " ".join(map(repr, map(float, numbers)))}
    if raster.crs is not None:
        reference["crs_wkt"] = raster.crs.to_wkt()
    coordinates: dict[str, Any] = {_MAPPING: ((), 0, reference)}
    if raster.grid.is_aligned:
        east, north = locate_centers(raster.grid)
        coordinates = {"y": ("y", north), "x": ("x", east), **coordinates}
    else:
        xc, yc = locate_all_centers(raster.grid)
        coordinates = {"yc": (("y", "x"), yc), "xc": (("y", "x"), xc), **coordinates}
    about = {"title": raster.name, "notes": list(raster.notes)}
    return xarray.Dataset(
        variables, coords=coordinates, attrs={name: value for name, value in about.items() if value}
    )
