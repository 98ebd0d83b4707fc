"""Where the elevations of a layer are: in its geometry or in a column; refused where in doubt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..._sentences import counted
from ...errors import OptionError, ReadError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .features import Features

__all__ = ["find_elevations"]

GEOMETRY = "geometry"
_NAMES = frozenset(
    (
        *("z", "elev", "elevation", "elevations", "height", "altitude", "level", "alt", "hgt"),
        *("hoehe", "höhe", "kote", "quote", "quota", "cota", "altitud", "altitude_m", "rl"),
        *("z_value", "zvalue", "elev_m", "elev_ft", "elevation_m", "elevation_ft", "contour"),
        *("height_m", "z_m", "z_ft", "ele", "point_z", "grid_code", "gridcode", "orthometric"),
    )
)
"""Columns that hold elevations, by the names that programs and people give them."""

_SAME = 0.006
"""CRS units by which a rounded column and the geometry may differ: half a hundredth."""


def find_elevations(
    features: Features,
    z: NDArray[np.float64],
    has_z: NDArray[np.bool_],
    rows: NDArray[np.int64],
    z_field: str | None,
) -> tuple[NDArray[np.float64], list[str]]:
    """Return the elevation of each vertex, NaN where there is none, and what was assumed.

    Parameters
    ----------
    features : Features
    z : (n,) float64 array
        Third coordinates.
    has_z : (n,) bool array
        Whether the vertex has one.
    rows : (n,) int64 array
        Feature of each vertex.
    z_field : str, optional

    Raises
    ------
    ReadError
        If there is none, or there are two that differ.
    OptionError
        If there is no such column, or it holds no numbers.
    """
    if z_field is not None:
        return _take_asked(features, z, has_z, rows, z_field), []
    columns = _find_columns(features)
    if not has_z.any():
        return _take_column(features, columns, rows)
    z = _require_all(features, z, has_z, rows)
    for name, values in columns.items():
        _require_same(features, z, values[rows], name, rows)
    return z, []


def _take_asked(
    features: Features,
    z: NDArray[np.float64],
    has_z: NDArray[np.bool_],
    rows: NDArray[np.int64],
    name: str,
) -> NDArray[np.float64]:
    column = features.columns.get(name.lower())
    if column is None and name.lower() == GEOMETRY:
        if not has_z.any():
            raise ReadError(
                f"'{features.path}' has no elevations in its geometry.", path=features.path
            )
        return _require_all(features, z, has_z, rows)
    if column is None:
        known = ", ".join(features.names) or "none"
        raise OptionError("z_field", name, f"a column of '{features.path}' ({known}) or geometry")
    values = _as_numbers(column)
    if values is None:
        raise OptionError("z_field", name, f"a column of numbers in '{features.path}'")
    if np.isnan(values).all():
        raise ReadError(
            f"'{features.path}': the column '{name}' has no value that is a number.",
            path=features.path,
        )
    return values[rows]


def _require_all(
    features: Features,
    z: NDArray[np.float64],
    has_z: NDArray[np.bool_],
    rows: NDArray[np.int64],
) -> NDArray[np.float64]:
    """Refuse a layer in which only some geometries have an elevation that is a number."""
    missing = ~has_z | ~np.isfinite(z)
    if missing.any():
        row = int(rows[np.argmax(missing)])
        raise ReadError(
            f"'{features.path}': {counted(int(missing.sum()), 'vertex', 'vertices')} of "
            f"{len(z):,} without an elevation (first: feature {features.numbers[row]}), while "
            "others have one in the geometry: the option where leaves features out, z_field names "
            "a column.",
            path=features.path,
        )
    return z


def _find_columns(features: Features) -> dict[str, NDArray[np.float64]]:
    """Return the columns that hold elevations, by their names."""
    found = {}
    for name, column in features.columns.items():
        values = _as_numbers(column) if name in _NAMES else None
        if values is not None and np.isfinite(values).any():
            found[name] = values
    return found


def _as_numbers(column: NDArray[Any]) -> NDArray[np.float64] | None:
    """Return a column as numbers, NaN where it has none; None if it holds something else."""
    if column.dtype.kind in "iuf":
        values = column.astype(np.float64)
        values[~np.isfinite(values)] = np.nan
        return values
    if column.dtype.kind == "b":
        return None
    texts = ["" if one is None else str(one).strip() for one in column.tolist()]
    try:
        values = np.array([float(one) if one else np.nan for one in texts])
    except ValueError:
        return None
    return None if np.isinf(values).any() else values


def _take_column(
    features: Features, columns: dict[str, NDArray[np.float64]], rows: NDArray[np.int64]
) -> tuple[NDArray[np.float64], list[str]]:
    """Take the only column that can be meant; several that agree are one."""
    if not columns:
        known = ", ".join(features.names)
        raise ReadError(
            f"'{features.path}' has no elevations: none in the geometry, and "
            + (f"no column of that name ({known}): " if known else "no column: ")
            + "the option z_field names the column that holds them.",
            path=features.path,
        )
    name, values = next(iter(columns.items()))
    for other, others in columns.items():
        if not np.array_equal(values, others, equal_nan=True):
            raise ReadError(
                f"'{features.path}' has several columns that may hold elevations, and they "
                f"differ: {', '.join(columns)}; the option z_field chooses ({name} or {other}).",
                path=features.path,
            )
    return values[rows], [f"Elevations are those of the column '{name}'."]


def _require_same(
    features: Features,
    z: NDArray[np.float64],
    values: NDArray[np.float64],
    name: str,
    rows: NDArray[np.int64],
) -> None:
    """Refuse a column of elevations that differs from the geometry."""
    with np.errstate(invalid="ignore"):
        differs = np.abs(values - z) > _SAME
    if differs.any():
        first = int(np.argmax(differs))
        raise ReadError(
            f"'{features.path}' has two elevations for each point that differ: {z[first]:.10g} in "
            f"the geometry and {values[first]:.10g} in the column '{name}' (feature "
            f"{features.numbers[rows[first]]}): the option z_field chooses, '{GEOMETRY}' or "
            f"'{name}'.",
            path=features.path,
        )
