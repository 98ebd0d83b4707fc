"""Raster: bands of values in the cells of a grid."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..checks import as_floats, as_length
from ..crs import CRS, shorten_crs
from ..errors import OptionError
from ..notes import as_notes
from ..ranges import require_degrees
from ..sentences import counted
from ..types import Grid
from .columns import FrozenMapping, Noted, as_name, as_units, frozen_copy, named_items

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..arrays import AnyArray
    from .columns import Units

_FEWEST_ULPS = 8.0
"""Roundings that the far edge of a grid may be off its spacing times its cells."""


@dataclass(frozen=True, eq=False, repr=False)
class Raster(Noted):
    """Values in the square cells of a grid, in one or several bands.

    Attributes
    ----------
    bands : mapping of str to (rows, columns) array
        By name; row 0 is the northernmost. Numbers or truth values. Instead of an array, anything
        with ``shape``, ``dtype`` and ``band[rows, columns]`` (slices) that returns an array: its
        blocks are asked for as they are written, so that a raster may be larger than memory.
    grid : Grid
    crs : CRS or None
        Given as a code ("EPSG:32616"), number, WKT or ``pyproj.CRS``.
    nodata : float
        Value of cells without surface; NaN by default.
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
        # Of the first and the last cell of the last and the first row the centres.
        box, (rows, columns) = self.grid.bounds, self.grid.shape
        across, up = box.width / columns / 2, box.height / rows / 2
        low, high = (box.xmin + across, box.ymin + up), (box.xmax - across, box.ymax - up)
        require_degrees(np.array([low, high]), crs, "Corners")
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

    def to_xarray(self) -> Any:
        """Return a data set of xarray, with a variable for each band.

        Returns
        -------
        xarray.Dataset
            Dimensions ``y`` and ``x``, coordinates of the cell centres, northings falling. The CRS
            is in the coordinate ``spatial_ref``, as CF and rioxarray have it; each variable has
            ``units`` if they are known, and ``_FillValue``.

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
            f"spacing {self.grid.spacing:g}, bands {', '.join(self.bands)}, "
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
    as_length("spacing of the grid", grid.spacing)
    bounds = grid.bounds
    sides = ((bounds.xmin, bounds.xmax, columns), (bounds.ymin, bounds.ymax, rows))
    for low, high, cells in sides:
        rounding = _FEWEST_ULPS * math.ulp(max(abs(low), abs(high), cells * grid.spacing))
        if not abs(high - low - cells * grid.spacing) <= rounding:
            allowed = f"{cells} cells of {grid.spacing!r} apart"
            raise OptionError("bounds of the grid", (low, high), allowed=allowed)
