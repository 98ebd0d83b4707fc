"""Where the elevations of a layer are: in its geometry or in a column; refused where in doubt."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.crs import CRS, FOOT, US_SURVEY_FOOT, Unit
from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE, counted, height
from ..delimited import find_role, find_unit_word
from ..reprojection import settle_unit

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from .layers import Layer

GEOMETRY = "geometry"
_NAMES = frozenset(("contour", "grid_code", "gridcode", "orthometric", "quote", "ele"))
"""Names that programs give to columns of elevations, beside those that headers of texts have."""

_HEIGHTS_OF_ANYTHING = frozenset(("h",))
"""Beside elevations in the geometry these are columns like any other."""

_SAME = 0.006
"""CRS units by which a rounded column and the geometry may differ: half a hundredth."""


class Elevations(NamedTuple):
    """Elevations of vertices."""

    z: Float64Array
    """(n,), NaN where there is none."""
    unit: Unit | None = None
    """What the name of their column says."""
    notes: tuple[str, ...] = ()
    """What was assumed."""


def find_elevation_unit(features: Layer, declared: Unit | None) -> Unit | None:
    """Return the unit of the elevations in geometries that the file or the caller tells.

    Raises
    ------
    OptionError
        If the two differ.
    """
    return settle_stated_unit(features.elevation_unit, features.crs, declared)


def settle_stated_unit(word: str | None, crs: CRS | None, declared: Unit | None) -> Unit | None:
    """Return the unit that a file's word, else the vertical axis of its CRS, or a caller tells."""
    try:
        stated = Unit.of(word or None)
    except OptionError:  # such as "unknown", which is what we write
        stated = None
    return settle_unit(declared, stated or (None if crs is None else crs.vertical_unit))


def list_elevation_columns(features: Layer) -> list[str]:
    """Return the names of the columns that hold elevations."""
    return list(_find_columns(features))


def find_named_unit(name: str, features: Layer) -> Unit | None:
    """Return the unit that the name of a column tells, as in ``elev_ft``; None if it tells none.

    Feet are those of the CRS, as "ft" is written for either kind.
    """
    unit = Unit.of(find_unit_word(name))
    if unit != FOOT or features.crs is None or features.crs.is_geographic:
        return unit
    units = (features.crs.vertical_unit, features.crs.horizontal_unit)
    return US_SURVEY_FOOT if next(filter(None, units)) == US_SURVEY_FOOT else unit


def find_elevations(
    features: Layer,
    z: Float64Array,
    has_z: BoolArray,
    rows: Int64Array,
    z_field: str | None,
) -> Elevations:
    """Find the elevation of each vertex, in the geometry or in a column.

    Parameters
    ----------
    features : Layer
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
        return _take_asked(features, z, has_z, rows, z_field)
    columns = _find_columns(features)
    if not has_z.any():
        return _take_column(features, columns, rows)
    z = _require_all(features, z, has_z, rows)
    notes = []
    for name, values in columns.items():
        if name.lower() in _HEIGHTS_OF_ANYTHING:
            continue
        unit = _find_other_unit(z, values[rows])
        if unit is None:
            _require_same(features, z, values[rows], name, rows)
        else:
            notes.append(
                f"The column '{name}' tells the elevations of the geometry in {unit.name}."
            )
    return Elevations(z, notes=tuple(notes))


def _find_other_unit(z: Float64Array, values: Float64Array) -> Unit | None:
    """Return the unit in which a column tells the elevations of a geometry in metres, if in feet.

    So GeoJSON has them, whose geometries are in metres.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        if not np.isfinite(values).all() or (np.abs(values - z) <= _SAME).all():
            return None
        for unit in (FOOT, US_SURVEY_FOOT):
            factor = unit.metres or 1.0
            if (np.abs(values * factor - z) <= _SAME * factor).all():
                return unit
    return None


def _take_asked(
    features: Layer,
    z: Float64Array,
    has_z: BoolArray,
    rows: Int64Array,
    name: str,
) -> Elevations:
    column = features.find_column(name)
    if column is None and name.lower() == GEOMETRY:
        if not has_z.any():
            raise ReadError(f"{FILE} has no elevations in its geometry.")
        return Elevations(_require_all(features, z, has_z, rows))
    if column is None:
        known = ", ".join(features.names) or "none"
        raise OptionError("z_field", name, f"a column of {FILE} ({known}) or geometry")
    values = _as_numbers(column)
    if values is None:
        raise OptionError("z_field", name, f"a column of numbers in {FILE}")
    if np.isnan(values).all():
        raise ReadError(f"the column '{name}' has no value that is a number.")
    return Elevations(values[rows], find_named_unit(name, features))


def _require_all(
    features: Layer,
    z: Float64Array,
    has_z: BoolArray,
    rows: Int64Array,
) -> Float64Array:
    """Refuse a layer in which only some geometries have an elevation that is a number."""
    missing = ~has_z | ~np.isfinite(z)
    if missing.any():
        row = int(rows[np.argmax(missing)])
        raise ReadError(
            f"{counted(int(missing.sum()), 'vertex', 'vertices')} of "
            f"{len(z):,} without an elevation (first: feature {features.numbers[row]}), while "
            "others have one in the geometry: the option `where` leaves features out, `z_field` "
            "names a column."
        )
    return z


def _find_columns(features: Layer) -> dict[str, Float64Array]:
    found = {}
    for name, column in features.columns.items():
        is_named = name.lower() in _NAMES or find_role(name) == "elevation"
        values = _as_numbers(column) if is_named else None
        if values is not None and np.isfinite(values).any():
            found[name] = values
    return found


def _as_numbers(column: AnyArray) -> Float64Array | None:
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


def _take_column(features: Layer, columns: dict[str, Float64Array], rows: Int64Array) -> Elevations:
    """Take the only column that can be meant; several that agree are one."""
    if not columns:
        known = ", ".join(features.names)
        raise ReadError(
            f"{FILE} has no elevations: none in the geometry, and "
            + (f"no column of numbers with such a name ({known}): " if known else "no column: ")
            + " ".join(("the option `z_field` names the column that holds them.", *features.notes))
        )
    name, values = next(iter(columns.items()))
    for other, others in columns.items():
        if not np.array_equal(values, others, equal_nan=True):
            raise ReadError(
                f"{FILE} has several columns that may hold elevations, and they "
                f"differ: {', '.join(columns)}; the option `z_field` chooses ({name} or {other})."
            )
    unit = find_named_unit(name, features)
    stated = "" if unit is None else f", in {unit.name} as its name says"
    note = f"Elevations are those of the column '{name}'{stated}."
    return Elevations(values[rows], unit, (note,))


def _require_same(
    features: Layer,
    z: Float64Array,
    values: Float64Array,
    name: str,
    rows: Int64Array,
) -> None:
    with np.errstate(invalid="ignore"):
        differs = np.abs(values - z) > _SAME
    if differs.any():
        first = int(np.argmax(differs))
        raise ReadError(
            f"{FILE} has two elevations for each point that differ: "
            f"{height(z[first])} in "
            f"the geometry and {height(values[first])} in the column '{name}' (feature "
            f"{features.numbers[rows[first]]}): the option `z_field` chooses, '{GEOMETRY}' or "
            f"'{name}'."
        )
