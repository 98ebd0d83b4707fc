"""Tables of coordinates as callers have them: arrays, masked arrays, named columns, geometries.

Columns with names are taken by their names, in whatever order they stand; columns without names by
their order. No library of tables or geometries is imported: what a value is can be told by its
attributes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import PointsError
from ...base.optional import find_loaded
from .geometries import find_geometries, find_shapely

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array

COORDINATES = ("easting", "northing", "elevation")
_NAMES = {
    "easting": ("x", "e", "east", "easting", "eastings", "lon", "long", "lng", "longitude"),
    "northing": ("y", "n", "north", "northing", "northings", "lat", "latitude"),
    "elevation": ("z", "elevation", "elev", "ele", "height", "h", "altitude", "alt"),
}
_ROLE_OF = {name: role for role, names in _NAMES.items() for name in names}
_SHOWN = 8
_LARGEST_INTEGER = 2**53
_POINTS = (0, 4)
"""What shapely numbers points and multipoints."""

_AXES = ({"x", "y"}, {"lon", "lat"}, {"longitude", "latitude"})
"""Names of the dimensions of a raster."""


class Table(NamedTuple):
    """Numbers, and which rows are masked.

    Attributes
    ----------
    values : float64 array
        (n, 3) or (n, 2) if it was a table of columns or geometries; else of the shape given.
        0 where masked.
    is_masked : (n,) bool array or None
        Rows with a masked value; None if there are none.
    """

    values: Float64Array
    is_masked: BoolArray | None = None


def as_table(given: Any, what: str, *, least: int = 3, most: int = 3) -> Table:
    """Return coordinates as numbers: ``least`` are needed, ``most`` are taken if they are there.

    Columns are found by their names if they have some: x, y, z; easting, northing, elevation; lon,
    lat, height. Others are not looked at. Errors begin with ``what``, in the plural.
    """
    if _is_plain(given):
        return Table(_as_numbers(given, what))
    if hasattr(given, "n_cells") and hasattr(given, "points"):
        raise PointsError(
            f"{what} are a mesh of PyVista: tinsmith.from_mesh takes its triangles, and `.points` "
            "are its points."
        )
    # refuse the cells of a raster, whose rows are no points
    dimensions = getattr(given, "dims", ())
    is_named = isinstance(dimensions, tuple | Mapping)
    has_axes = is_named and any(axes <= set(dimensions) for axes in _AXES)
    if has_axes or (hasattr(given, "transform") and hasattr(given, "block_shapes")):
        raise PointsError(
            f"{what} are the cells of a raster: tinsmith.from_raster makes points of them."
        )
    given = _unwrap(given)
    geometry = _read_points(getattr(given, "geometry", given), what)
    names = _find_names(given)
    if geometry is not None:
        return Table(_add_elevations(geometry, given, what, most=most))
    if names is None:
        return _read_unnamed(given, what)
    found = _find_roles(names, what)
    for role in COORDINATES[:least]:
        if role not in found:
            raise PointsError(
                f"{what} have columns {_list_names(names)}, and none of them is called {role}: "
                f"one of {', '.join(_NAMES[role])} is needed."
            )
    columns = [given[found[role]] for role in COORDINATES[:most] if role in found]
    return _stack(columns, what)


def has_coordinates(given: Any) -> bool:
    """Whether a value has columns of eastings and northings by their names."""
    names = _find_names(given)
    roles = set() if names is None else {_ROLE_OF.get(str(one).strip().casefold()) for one in names}
    return {"easting", "northing"} <= roles


def _is_plain(given: Any) -> bool:
    """Tell if a value is surely without names, masks and geometries; most are, and soon known."""
    if type(given) is np.ndarray:
        return given.dtype.names is None and given.dtype.kind != "O"
    if type(given) is list:
        return all(type(row) is list for row in given)
    return type(given) in (float, int)


def is_masked_array(given: Any) -> bool:
    """Whether values are a masked array, which nobody can have without its module loaded."""
    masked = find_loaded("numpy.ma", "MaskedArray")
    return masked is not None and isinstance(given, masked.MaskedArray)


def _unwrap(given: Any) -> Any:
    """Return masked rows in a list as one masked array."""
    if isinstance(given, list | tuple) and any(map(is_masked_array, given)):
        return np.ma.array(given)
    return given


def _read_unnamed(given: Any, what: str) -> Table:
    if not is_masked_array(given):
        return Table(_as_numbers(given, what))
    mask = np.ma.getmaskarray(given)
    values = _as_numbers(np.where(mask, 0, given.data), what)
    rows = np.atleast_1d(mask)
    is_masked = np.asarray(rows.any(axis=tuple(range(1, rows.ndim))), np.bool_)
    return Table(values, is_masked if is_masked.any() else None)


def _as_numbers(values: Any, what: str) -> Float64Array:
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biufO" or (
            array.dtype.kind == "O" and any(isinstance(value, str | bytes) for value in array.flat)
        ):
            raise TypeError
        numbers = np.asarray(array, np.float64)
    except Exception:
        raise PointsError(
            f"{what} are no table of real numbers: rows of equal length are needed, "
            "without text, complex numbers or dates."
        ) from None
    _require_held(array, what)
    return numbers


def _require_held(array: AnyArray, what: str) -> None:
    """Refuse whole numbers that doubles may not hold."""
    if array.dtype.kind not in "iu" or array.dtype.itemsize < 8:
        return
    is_large = (array > _LARGEST_INTEGER) | (array < -_LARGEST_INTEGER)
    if is_large.any():
        first = array[is_large][0]
        raise PointsError(
            f"{what} have the whole number {first}: doubles, in which coordinates are, hold those "
            f"up to 2**53 = {_LARGEST_INTEGER}."
        )


# ------------------------------------------------------------------------- names


def _find_names(given: Any) -> Sequence[Any] | None:
    """Return the names of columns, None if they have none but their numbers."""
    dtype = getattr(given, "dtype", None)
    if isinstance(dtype, np.dtype):
        return dtype.names
    if isinstance(given, Mapping):
        return list(given)
    names = getattr(given, "column_names", None)
    if names is None and hasattr(given, "to_numpy"):
        names = getattr(given, "columns", None)
    if names is None or callable(names):
        return None
    names = list(names)
    return None if names == list(range(len(names))) else names


def _find_roles(names: Sequence[Any], what: str) -> dict[str, Any]:
    """Return the name of the column of each coordinate."""
    found: dict[str, Any] = {}
    for name in names:
        role = _ROLE_OF.get(str(name).strip().casefold())
        if role is None:
            continue
        if role in found:
            raise PointsError(
                f"{what} have two columns for the {role}, '{found[role]}' and '{name}': "
                "one of them must go."
            )
        found[role] = name
    return found


def _list_names(names: Sequence[Any]) -> str:
    more = ", ..." if len(names) > _SHOWN else ""
    return ", ".join(f"'{name}'" for name in names[:_SHOWN]) + more


def _stack(columns: list[Any], what: str) -> Table:
    tables = [_read_unnamed(_fill_missing(column), what) for column in columns]
    lengths = {table.values.shape for table in tables}
    if len(lengths) != 1 or tables[0].values.ndim != 1:
        raise PointsError(f"{what} have columns of different lengths, or of more than numbers.")
    masks = [table.is_masked for table in tables if table.is_masked is not None]
    values = np.stack([table.values for table in tables], axis=1)
    return Table(values, np.logical_or.reduce(masks) if masks else None)


def _fill_missing(column: Any) -> Any:
    """Return a column of a data frame with NaN for what is missing."""
    if not hasattr(column, "isna"):
        return column
    try:
        if column.dtype.kind in "iu" and not column.isna().any():
            return column.to_numpy(dtype=column.dtype.kind + "8")
        return column.to_numpy(dtype=np.float64, na_value=np.nan)
    except Exception:
        return np.asarray(column)


# --------------------------------------------------------------------- geometries


class _Places(NamedTuple):
    """Coordinates of points, (n, 3) with NaN for no elevation, and the row each is of."""

    coordinates: Float64Array
    rows: Int64Array


def _read_points(given: Any, what: str) -> _Places | None:
    """Return the coordinates of points, those of shapely and others; None of all else."""
    shapely = find_shapely()
    if shapely is None:  # then nobody has one of its geometries
        return _read_foreign_points(given, what)
    if isinstance(given, shapely.Geometry):
        return _read_coordinates(shapely, np.array([given], object))
    first = next(iter(given), None) if _is_row_of_objects(given) else None
    if not isinstance(first, shapely.Geometry):
        return _read_foreign_points(given, what)
    geometries = np.asarray(given, object)
    is_point = np.isin(shapely.get_type_id(geometries), _POINTS)
    if not is_point.all() or shapely.is_empty(geometries).any():
        raise _refuse_geometries(what)
    return _read_coordinates(shapely, geometries)


def _read_coordinates(shapely: Any, geometries: AnyArray) -> _Places:
    found = shapely.get_coordinates(geometries, include_z=True, return_index=True)
    return _Places(np.asarray(found[0], np.float64), np.asarray(found[1], np.int64))


def _read_foreign_points(given: Any, what: str) -> _Places | None:
    """Return the coordinates of what has a ``__geo_interface__`` of points."""
    found = None if isinstance(given, list | tuple) else find_geometries(given)
    if found is None:
        return None
    if any(part.kind != "Point" for part in found.parts):
        raise _refuse_geometries(what)
    given_rows = [_as_numbers(part.rings[0], what)[0] for part in found.parts]
    rows = [[*row, np.nan] if len(row) == 2 else row[:3] for row in given_rows]
    owners = np.array([part.row for part in found.parts], np.int64)
    return _Places(np.array(rows, np.float64).reshape(-1, 3), owners)


def _refuse_geometries(what: str) -> PointsError:
    return PointsError(f"{what} are geometries, but not all of them points with coordinates.")


def _is_row_of_objects(given: Any) -> bool:
    if isinstance(given, list | tuple):
        return True
    is_one_dimensional = getattr(given, "ndim", 0) == 1 and hasattr(given, "__len__")
    return is_one_dimensional and getattr(given, "dtype", None) != np.float64


def _add_elevations(places: _Places, given: Any, what: str, *, most: int) -> Float64Array:
    """Return the columns asked for, elevations from a column if the geometries have none."""
    geometry = places.coordinates
    if most == 2:
        return geometry[:, :2]
    column = _find_roles(_find_names(given) or (), what).get("elevation")
    is_flat = bool(np.isnan(geometry[:, 2]).all())
    if column is not None:
        own = _stack([given[column]], what).values[places.rows, 0]
        if not (is_flat or np.array_equal(own, geometry[:, 2])):
            raise PointsError(
                f"{what} have elevations in their geometries and others in column '{column}': "
                "one of them must go."
            )
        return np.column_stack([geometry[:, :2], own])
    return geometry[:, :2] if is_flat else geometry
