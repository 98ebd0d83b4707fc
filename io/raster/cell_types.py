"""Values of cells in another type, and another value for cells without data."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import is_finite_number
from ...base.errors import FormatError, OptionError, WriteError, choice
from ...base.policies import CellType
from ...base.sentences import FILE, height

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray
    from ...base.results import Raster
    from ...base.types import CellStorage


def require_north_up(raster: Raster, what: str) -> None:
    """Refuse, by a FormatError, cells that a format cannot place; ``what`` it is for a sentence."""
    if not raster.grid.is_north_up:
        a, b, _, d, e, _ = raster.grid.transform
        raise FormatError(
            f"Cannot write {FILE}: {what} holds rows from north to south with columns from west to "
            f"east, and the geotransform of this raster has {a:g}, {b:g}, {d:g}, {e:g}; GeoTIFF "
            "holds any."
        )


def store_as(raster: Raster, dtype: CellType | None, nodata: float | None) -> Raster:
    """Return a raster whose cells are of a type, and have a value where there is no data.

    Parameters
    ----------
    raster : Raster
    dtype : str or None
        None keeps that of ``raster.stored_as``, or else of the bands.
    nodata : float or None
        None keeps that of ``raster.stored_as``, or else of the raster, which is NaN if nothing else
        was chosen.

    Returns
    -------
    Raster
        Its blocks are converted as they are asked for, whole numbers rounded to the nearest. A
        value that the type cannot hold, and one that is that of cells without data, ends the
        writing with a WriteError.

    Raises
    ------
    OptionError
        If the type is unknown, or cannot hold the value of cells without data.
    """
    if dtype is not None:
        choice("dtype", dtype, CellType)
    kept: str | None = dtype
    if raster.stored_as is not None:
        kept, nodata = _find_usual(raster.stored_as, dtype, nodata)
    if kept is None and nodata is None:
        return raster
    chosen = raster.nodata if nodata is None else _as_nodata(nodata)
    bands: dict[str, Any] = {}
    for name, band in raster.bands.items():
        kind = np.dtype(band.dtype if kept is None else kept)
        _require_nodata(chosen, kind, raster, band)
        bands[name] = _StoredBand(name, band, kind, raster.nodata, chosen)
    return replace(raster, bands=bands, nodata=chosen)


def _find_usual(
    usual: CellStorage, dtype: str | None, nodata: float | None
) -> tuple[str, float | None]:
    """Return the type and the value without data that were asked for, or else the usual ones.

    That value is rounded as cells are; it is left out if the type that was asked for has none.
    """
    kind = np.dtype(usual.dtype if dtype is None else dtype)
    if nodata is not None or usual.nodata is None:
        return kind.name, nodata
    if kind.kind == "f":
        with np.errstate(over="ignore"):
            rounded = float(np.float64(usual.nodata).astype(kind))
        return kind.name, rounded if math.isfinite(rounded) else None
    low, high = _find_limits(kind)
    fits = low <= usual.nodata <= high and usual.nodata == int(usual.nodata)
    return kind.name, usual.nodata if fits else None


def _as_nodata(nodata: Any) -> float:
    if not (is_finite_number(nodata) or (isinstance(nodata, float) and math.isnan(nodata))):
        raise OptionError("nodata", nodata, "a number or NaN")
    return float(nodata)


def _require_nodata(nodata: float, kind: np.dtype[Any], raster: Raster, band: Any) -> None:
    """Refuse a value that cells of the type cannot have, if any may need one."""
    if kind.kind == "f":
        with np.errstate(over="ignore"):
            if math.isnan(nodata) or float(np.float64(nodata).astype(kind)) == nodata:
                return
        raise OptionError("nodata", nodata, f"a value that {kind.name} holds exactly, or NaN")
    if math.isnan(nodata):
        if np.dtype(band.dtype).kind == "f" or not math.isnan(raster.nodata):
            allowed = f"given with dtype={kind.name!r}, which has no NaN for cells without data"
            raise OptionError("nodata", nodata, allowed)
        return
    low, high = _find_limits(kind)
    if not (nodata == int(nodata) and low <= nodata <= high):
        raise OptionError("nodata", nodata, f"a whole number from {low} to {high}")


def _find_limits(kind: np.dtype[Any]) -> tuple[int, int]:
    if kind.kind == "b":
        return 0, 1
    limits = np.iinfo(kind)
    return int(limits.min), int(limits.max)


@dataclass(frozen=True, eq=False)
class _StoredBand:
    """A band whose blocks are converted when they are asked for."""

    name: str
    band: Any
    dtype: np.dtype[Any]
    missing: float
    """Value of cells without data in the band."""
    nodata: float
    """What they have instead."""

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self.band.shape)

    def __getitem__(self, place: Any) -> AnyArray:
        values = np.asarray(self.band[place])
        is_missing = _find_missing(values, self.missing)
        stored = self._convert(values, ~is_missing)
        taken = (stored == self.nodata) & ~is_missing
        if taken.any():
            raise WriteError(
                f"Cannot write {FILE}: a cell of the band '{self.name}' has the value "
                f"{self.nodata:g} itself, which is that of cells without data: choose another."
            )
        if is_missing.any():
            stored[is_missing] = self.nodata
        return stored

    def _convert(self, values: AnyArray, known: BoolArray) -> AnyArray:
        if self.dtype.kind == "f":
            with np.errstate(over="ignore", invalid="ignore"):
                stored = values.astype(self.dtype)
            lost = known & np.isinf(stored) & np.isfinite(values)
        else:
            low, high = _find_limits(self.dtype)
            whole = np.rint(values) if values.dtype.kind == "f" else values
            with np.errstate(invalid="ignore"):
                lost = known & ~((whole >= low) & (whole <= high))
                stored = np.where(known & ~lost, whole, 0).astype(self.dtype)
        if lost.any():
            raise WriteError(
                f"Cannot write {FILE}: the value {height(float(values[lost][0]))} of the band "
                f"'{self.name}' is none that {self.dtype.name} can hold."
            )
        return stored


def _find_missing(values: AnyArray, nodata: float) -> BoolArray:
    is_missing: BoolArray = values == nodata
    return is_missing | np.isnan(values) if values.dtype.kind == "f" else is_missing
