"""Raster: bands of values in the cells of a grid."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..checks import as_floats, as_length
from ..crs import CRS, shorten_crs
from ..errors import OptionError
from ..lazy import raise_missing
from ..notes import as_notes
from ..ranges import require_degrees
from ..sentences import counted, write_spacing
from ..types import CellStorage, Grid
from .columns import FrozenMapping, Noted, as_name, as_units, frozen_copy, named_items

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..arrays import AnyArray, Float64Array
    from .columns import Units

_FEWEST_ULPS = 8.0
"""Roundings that the far edge of a grid may be off its spacing times its cells."""


@dataclass(frozen=True, eq=False, repr=False)
class Raster(Noted):
    """Values in the cells of a grid, in one or several bands.

    Attributes
    ----------
    bands : mapping of str to (rows, columns) array
        By name; row 0 is the northernmost where the grid is north up. Numbers or truth values.
        Instead of an array, anything with ``shape``, ``dtype`` and ``band[rows, columns]`` (slices)
        that returns an array: its blocks are asked for as they are written, so that a raster may be
        larger than memory.
    grid : Grid
    crs : CRS or None
        Given as a code ("EPSG:32616"), number, WKT or ``pyproj.CRS``.
    nodata : float
        Value of cells without surface; NaN by default.
    stored_as : CellStorage, optional
        Type of cells and value without data in files where nothing else is asked for: those of the
        raster file that it was read from, or whose cells it has.
    units : mapping of str to Unit, str or None
        Of bands: a unit or its symbol, None if it is not known; a band without an entry has none.
    name, notes
        As of :class:`tinsmith.Features`.

    Raises
    ------
    OptionError
        If shapes do not fit the grid, or a unit, name or value without data is none.
    CrsError
        If the CRS is not known.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> grid = ts.Grid(ts.Bounds(0.0, 0.0, 3.0, 2.0), shape=(2, 3), spacing=1.0)
    >>> ts.Raster({"elevation": np.zeros((2, 3))}, grid, crs="EPSG:32616", units={"elevation": "m"})
    <Raster: 2 rows by 3 columns, spacing 1, bands elevation, crs EPSG:32616>
    """

    bands: Mapping[str, AnyArray]
    grid: Grid
    crs: CRS | None = field(default=None, kw_only=True)
    nodata: float = field(default=math.nan, kw_only=True)
    stored_as: CellStorage | None = field(default=None, kw_only=True)
    units: Units = field(default_factory=dict, kw_only=True)
    name: str = field(default="", kw_only=True)
    notes: Sequence[str] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        keep = object.__setattr__
        require_grid(self.grid)
        items = dict(named_items("bands", self.bands))
        if not items:
            raise OptionError("bands", 0, allowed="1 or more", what="number of bands")
        shape = tuple(self.grid.shape)
        bands = {name: _as_band(name, values, shape) for name, values in items.items()}
        keep(self, "bands", FrozenMapping(bands))
        crs = CRS.of(self.crs)
        require_degrees(_list_corners(self.grid), crs, "Corners")
        keep(self, "crs", crs)
        nodata: Any = self.nodata
        is_number = isinstance(nodata, int | float | np.number) and not isinstance(nodata, bool)
        number = as_floats(nodata) if is_number else None
        if number is None:
            raise OptionError("nodata", nodata, allowed="a number or NaN")
        keep(self, "nodata", float(number))
        keep(self, "units", as_units(self.units, bands))
        keep(self, "name", as_name(self.name))
        keep(self, "notes", as_notes(self.notes))

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.grid.shape

    if not TYPE_CHECKING:  # which would take any name for an attribute

        def __getattr__(self, name: str) -> Any:
            raise_missing(self, name)

    def to_xarray(self) -> Any:
        """Return a data set of xarray, with a variable for each band.

        Returns
        -------
        xarray.Dataset
            Dimensions ``y`` and ``x``, coordinates of the cell centres, northings falling if the
            grid is north up; of a rotated grid ``xc`` and ``yc``, one for each cell, as rioxarray
            has them. The CRS and the geotransform are in the coordinate ``spatial_ref``, as CF and
            rioxarray have it; each variable has ``units`` if they are known, and ``_FillValue``.

        Raises
        ------
        MissingExtraError
            If xarray is not installed.

        Examples
        --------
        >>> import numpy as np
        >>> import tinsmith as ts
        >>> grid = ts.Grid(ts.Bounds(0.0, 0.0, 2.0, 2.0), shape=(2, 2), spacing=1.0)
        >>> ts.Raster({"elevation": np.eye(2)}, grid).to_xarray()["y"].values
        array([1.5, 0.5])
        """
        from .gridded import build_dataset

        return build_dataset(self)

    def __repr__(self) -> str:
        rows, columns = self.grid.shape
        title = f" {self.name}" if self.name else ""
        return (
            f"<Raster{title}: {counted(rows, 'row')} by {counted(columns, 'column')}, "
            f"spacing {write_spacing(self.grid.spacing)}, bands {', '.join(self.bands)}, "
            f"crs {shorten_crs(self.crs)}>"
        )


def _as_band(name: str, values: Any, shape: tuple[int, ...]) -> Any:
    is_lazy = not isinstance(values, np.ndarray) and all(
        hasattr(values, member) for member in ("shape", "dtype", "__getitem__")
    )
    band = values if is_lazy else np.asarray(values)
    if tuple(band.shape) != shape:
        raise OptionError(f"shape of band '{name}'", tuple(band.shape), allowed=f"{shape}")
    if np.dtype(band.dtype).kind not in "biuf":
        raise OptionError(
            f"type of band '{name}'", str(band.dtype), allowed="one of numbers or truth values"
        )
    return band if is_lazy else frozen_copy(band)


def require_grid(grid: Any) -> None:
    """Refuse a grid whose bounds, shape and spacing do not fit together."""
    if not isinstance(grid, Grid):
        raise OptionError("grid", type(grid).__name__, allowed="a Grid")
    rows, columns = grid.shape
    if rows < 1 or columns < 1:
        raise OptionError("shape of the grid", grid.shape, allowed="1 or more rows and columns")
    sides = grid.spacing if isinstance(grid.spacing, tuple) else (grid.spacing,)
    if len(sides) not in (1, 2):
        raise OptionError("spacing of the grid", grid.spacing, allowed="one or two lengths")
    for side in sides:
        as_length("spacing of the grid", side)
    if grid.transform != Grid(grid.bounds, grid.shape, grid.spacing).transform:
        _require_transform(grid)
        return
    bounds, (width, height) = grid.bounds, (sides[0], sides[-1])
    axes = (
        (bounds.xmin, bounds.xmax, columns, width),
        (bounds.ymin, bounds.ymax, rows, height),
    )
    for low, high, cells, side in axes:
        rounding = _FEWEST_ULPS * math.ulp(max(abs(low), abs(high), cells * side))
        if not abs(high - low - cells * side) <= rounding:
            allowed = f"{cells} cells of {side!r} apart"
            raise OptionError("bounds of the grid", (low, high), allowed=allowed)


def _require_transform(grid: Grid) -> None:
    """Refuse bounds and spacing that are not those of the geotransform."""
    wanted = Grid.of_transform(grid.transform, grid.shape)
    given, found = (
        np.array([one.xmin, one.ymin, one.xmax, one.ymax]) for one in (grid.bounds, wanted.bounds)
    )
    rounding = _FEWEST_ULPS * math.ulp(float(np.abs(found).max()))
    if not np.abs(given - found).max() <= rounding:
        raise OptionError("bounds of the grid", grid.bounds, f"those of its cells, {wanted.bounds}")
    if np.ravel(grid.spacing).tolist() != np.ravel(wanted.spacing).tolist():
        allowed = f"that of its cells, {wanted.spacing!r}"
        raise OptionError("spacing of the grid", grid.spacing, allowed)


def require_square(grid: Grid, name: str, value: Any) -> None:
    """Refuse, by an OptionError, cells that are not square, or rows that are not from north up."""
    if not grid.is_north_up or isinstance(grid.spacing, tuple):
        a, b, _, d, e, _ = grid.transform
        turned = "" if b == 0.0 == d else f", with {b:g} and {d:g} of rotation"
        allowed = f"a north-up raster of square cells (these are {a:g} by {-e:g}{turned})"
        raise OptionError(name, value, allowed)


def _list_corners(grid: Grid) -> Float64Array:
    """Return the centres of the four cells at the corners."""
    rows, columns = grid.shape
    across, down = np.meshgrid([0.5, columns - 0.5], [0.5, rows - 0.5])
    return np.column_stack(grid.transform.apply(across.ravel(), down.ravel()))
