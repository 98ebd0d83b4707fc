"""The door: callers' arrays become clean (n, 3) and (k, 2) float64 arrays, or a clear error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _kernel
from .errors import PointsError
from .threads import thread_count

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["as_points", "as_xy"]

SHOWN = 5


def as_points(points: ArrayLike, *, threads: int | None = 1) -> NDArray[np.float64]:
    """Return a fresh (n, 3) float64 array of finite coordinates in the exact range.

    -0.0 becomes 0.0, so that equal coordinates are equal bytes.

    Raises
    ------
    PointsError
        For another shape, values that are no numbers, NaN, infinity, or magnitudes outside the
        range in which the predicates are exact.
    """
    xyz = _as_floats(points, "Points")
    if xyz.ndim != 2 or xyz.shape[1] != 3:
        raise PointsError(
            f"Points have shape {xyz.shape}: (n, 3) is needed, "
            "columns easting, northing, elevation."
        )
    clean, is_sound = _kernel.clean(np.ascontiguousarray(xyz), thread_count(threads, len(xyz)))
    if not is_sound:
        _require_finite(clean)
        _require_exact_range(clean[:, :2], "Points")
    return clean


def as_xy(xy: ArrayLike) -> NDArray[np.float64]:
    """Return a (k, 2) float64 array; NaN is allowed and lies nowhere.

    Raises
    ------
    PointsError
        For another shape, values that are no numbers, infinity, or magnitudes outside the range
        in which the predicates are exact.
    """
    places = _as_floats(xy, "Places")
    if places.ndim != 2 or places.shape[1] != 2:
        raise PointsError(f"Places have shape {places.shape}: (k, 2) is needed, columns x, y.")
    places = np.ascontiguousarray(places, np.float64)
    _require_exact_range(places, "Places")
    return places


def _as_floats(values: ArrayLike, what: str) -> NDArray[np.float64]:
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biufO":
            raise TypeError
        return np.asarray(array, np.float64)
    except (TypeError, ValueError, OverflowError):
        raise PointsError(
            f"{what} are no table of real numbers: rows of equal length are needed, "
            "without text, complex numbers or dates."
        ) from None


def _require_finite(xyz: NDArray[np.float64]) -> None:
    rows = np.flatnonzero(~np.isfinite(xyz).all(axis=1))
    if len(rows):
        row = int(rows[0])
        column = int(np.argmax(~np.isfinite(xyz[row])))
        name = ("easting", "northing", "elevation")[column]
        raise PointsError(
            f"{len(rows)} of {len(xyz)} points are not finite (first: row {row}, "
            f"{name} {xyz[row, column]}): every coordinate must be a finite number.",
            rows=rows[:SHOWN],
        )


def _require_exact_range(xy: NDArray[np.float64], what: str) -> None:
    if xy.size == 0:
        return
    smallest, largest = _kernel.EXACT_RANGE
    size = np.abs(xy)
    wrong = ((size > largest) | ((size < smallest) & (size > 0))).any(axis=1)
    if wrong.any():
        row, count = int(np.argmax(wrong)), int(wrong.sum())
        x, y = xy[row, :2].tolist()
        raise PointsError(
            f"{what} have {count} {'row' if count == 1 else 'rows'} outside the exact range "
            f"(first: row {row}, "
            f"x {x!r}, y {y!r}): magnitudes from {smallest:.0e} to "
            f"{largest:.0e}, or 0, are allowed.",
            rows=np.flatnonzero(wrong)[:SHOWN],
        )
