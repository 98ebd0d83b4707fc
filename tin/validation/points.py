"""Points on entry: callers' arrays become clean (n, 3) and (k, 2) float64 arrays, or errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import PointsError
from ...base.sentences import counted, inflect
from .. import _kernel
from .tables import Table, as_table
from .threads import thread_count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array

SHOWN = 5


def require_three(count: int) -> None:
    """Refuse fewer points than a triangle has."""
    if count < 3:
        raise PointsError(
            f"{counted(count, 'point')} cannot make a TIN: at least three not collinear "
            "ones are needed."
        )


def as_points(points: Any, *, threads: int | None = 1) -> Float64Array:
    """Return a fresh (n, 3) float64 array of finite coordinates in the exact range.

    -0.0 becomes 0.0, so that equal coordinates are equal bytes.
    """
    xyz, is_masked = as_masked_points(points, threads=threads)
    if is_masked is not None:
        rows = np.flatnonzero(is_masked)
        are = inflect("[is masked|are masked]", len(rows))
        raise PointsError(
            f"{len(rows)} of {counted(len(xyz), 'point')} {are} (first: row {rows[0]}): leave "
            f"{inflect('[it|them]', len(rows))} out.",
            rows=rows[:SHOWN],
        )
    return xyz


def as_masked_points(points: Any, *, threads: int | None = 1) -> Table:
    """Return points as :func:`as_points` does, and which of them are masked; these are 0, 0, 0."""
    return clean_points(as_table(points, "Points"), threads=threads)


def clean_points(table: Table, *, threads: int | None = 1) -> Table:
    """Check a table as :func:`as_masked_points` does; the numbers are fresh ones."""
    xyz, is_masked = table
    if xyz.ndim != 2 or xyz.shape[1] != 3:
        raise PointsError(
            f"Points have shape {xyz.shape}: (n, 3) is needed, "
            "columns easting, northing, elevation."
        )
    if is_masked is not None:
        xyz = np.where(is_masked[:, None], 0.0, xyz)
    clean, is_sound = _kernel.clean(np.ascontiguousarray(xyz), thread_count(threads, len(xyz)))
    if not is_sound:
        _require_finite(clean)
        require_exact_range(clean[:, :2], "Points")
        _require_elevations(clean)
    return Table(clean, is_masked)


def as_xy(xy: Any) -> Float64Array:
    """Return a (k, 2) float64 array; NaN is allowed and lies nowhere, and so is what is masked."""
    queries, is_masked = as_table(xy, "Query points", least=2, most=2)
    if queries.shape == (0,):  # an empty list is no queries
        queries = queries.reshape(0, 2)
    if queries.ndim != 2 or queries.shape[1] != 2:
        raise PointsError(
            f"Query points have shape {queries.shape}: (k, 2) is needed, columns x, y."
        )
    if is_masked is not None:
        queries = np.where(is_masked[:, None], np.nan, queries)
    queries = np.ascontiguousarray(queries, np.float64)
    require_exact_range(queries, "Query points")
    return queries


def as_places(xy: Any) -> tuple[Float64Array, bool]:
    """Return one place, or several, as :func:`as_xy` does, and whether it is one."""
    shape = getattr(xy, "shape", None)
    if shape is None:
        is_one = isinstance(xy, list | tuple) and len(xy) == 2 and not np.ndim(xy[0])
    else:
        is_one = tuple(shape) == (2,)
    if is_one:  # two points of shapely are no coordinates of one
        is_one = not any(hasattr(one, "__geo_interface__") for one in xy)
    return as_xy([xy] if is_one else xy), is_one


def as_pairs(x: Any, y: Any) -> tuple[Float64Array, tuple[int, ...]]:
    """Return places of eastings and northings that are given apart, (k, 2), and their shape."""
    columns = [as_table(one, "Query points", least=1, most=1) for one in (x, y)]
    if any(one.is_masked is not None for one in columns):
        raise PointsError("Query points given as x and y are masked: give rows of both.")
    try:
        across, up = np.broadcast_arrays(*(one.values for one in columns))
    except ValueError:
        raise PointsError(
            f"Query points have x of shape {columns[0].values.shape} and y of shape "
            f"{columns[1].values.shape}: as many are needed, or one of them single."
        ) from None
    return as_xy(np.stack([across.ravel(), up.ravel()], axis=1)), across.shape


def as_elevations(values: Any) -> Float64Array:
    """Return one elevation or several as a float64 array of finite numbers."""
    elevations, is_masked = as_table(values, "Elevations")
    if elevations.ndim > 1:
        raise PointsError(f"Elevations have shape {elevations.shape}: one, or a row, is needed.")
    if is_masked is not None:
        raise PointsError("An elevation is masked: numbers are needed.")
    if not np.isfinite(elevations).all():
        raise PointsError("An elevation is not finite: every coordinate must be a finite number.")
    size = np.abs(elevations)
    if (size > _kernel.LARGEST_ELEVATION).any():
        raise PointsError(
            f"An elevation has a magnitude of {size.max():.3g}: {_allowed_elevations()}."
        )
    return elevations


def _require_finite(xyz: Float64Array) -> None:
    rows = np.flatnonzero(~np.isfinite(xyz).all(axis=1))
    if len(rows):
        row = int(rows[0])
        column = int(np.argmax(~np.isfinite(xyz[row])))
        name = ("easting", "northing", "elevation")[column]
        are = inflect("[is|are] not finite", len(rows))
        raise PointsError(
            f"{len(rows)} of {counted(len(xyz), 'point')} {are} (first: row {row}, "
            f"{name} {xyz[row, column]}): every coordinate must be a finite number.",
            rows=rows[:SHOWN],
        )


def _require_elevations(xyz: Float64Array) -> None:
    rows = np.flatnonzero(np.abs(xyz[:, 2]) > _kernel.LARGEST_ELEVATION)
    if len(rows):
        has = inflect("[has|have] an elevation", len(rows))
        raise PointsError(
            f"{len(rows)} of {counted(len(xyz), 'point')} {has} out of range (first: row "
            f"{rows[0]}, elevation {xyz[rows[0], 2]:.3g}): {_allowed_elevations()}.",
            rows=rows[:SHOWN],
        )


def _allowed_elevations() -> str:
    return f"magnitudes up to {_kernel.LARGEST_ELEVATION:.0e} are allowed"


def require_exact_range(xy: Float64Array, what: str, names: Sequence[str] = ("x", "y")) -> None:
    """Refuse coordinates, (n, k), for which the predicates are not exact; NaN passes.

    The sentence begins with ``what``, in the plural; ``names`` are those of the columns.
    """
    if xy.flags.c_contiguous and _kernel.are_in_exact_range(xy):
        return
    smallest, largest = _kernel.EXACT_RANGE
    size = np.abs(xy)
    wrong = ((size > largest) | ((size < smallest) & (size > 0))).any(axis=1)
    if wrong.any():
        row, count = int(np.argmax(wrong)), int(wrong.sum())
        place = ", ".join(
            f"{name} {value!r}" for name, value in zip(names, xy[row].tolist(), strict=True)
        )
        raise PointsError(
            f"{what} have {count} {'row' if count == 1 else 'rows'} outside the exact range "
            f"(first: row {row}, {place}): magnitudes from {smallest:.0e} to "
            f"{largest:.0e}, or 0, are allowed.",
            rows=np.flatnonzero(wrong)[:SHOWN],
        )
