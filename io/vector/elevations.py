"""Where the elevations of a layer are: in its geometry or in a column; refused where in doubt."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..._sentences import counted, height
from ...crs import FOOT, US_SURVEY_FOOT, Unit
from ...errors import OptionError, ReadError

if TYPE_CHECKING:
    from ...arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from .features import Features

__all__ = [
    "Elevations",
    "describe_unused_columns",
    "find_elevations",
    "find_named_unit",
    "require_absolute",
]

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

_ALTITUDE_MODE = "altitudemode"
_RELATIVE = frozenset(
    {"relativetoground", "clamptoground", "relativetoseafloor", "clamptoseafloor"}
)
"""Modes of KML, of which only "absolute" means elevations."""

_SAME = 0.006
"""CRS units by which a rounded column and the geometry may differ: half a hundredth."""


_UNIT_AT_END = re.compile(
    r"[\s_.(\[-]+(us[\s_-]?ft|ft[\s_-]?us|ft|feet|foot|m|met(?:er|re)s?)[)\]]?$"
)
"""A unit behind the name of a column, as in ``elev_ft`` or ``Height (m)``."""


class Elevations(NamedTuple):
    """Elevations of vertices."""

    z: Float64Array
    """(n,), NaN where there is none."""
    unit: Unit | None = None
    """What the name of their column says."""
    notes: tuple[str, ...] = ()
    """What was assumed."""


def find_named_unit(name: str, features: Features) -> Unit | None:
    """Return the unit that the name of a column ends with; None if it ends with none.

    Feet are those of the CRS, as "ft" is written for either kind.
    """
    found = _UNIT_AT_END.search(name.lower())
    unit = None if found is None else Unit.of(found[1])
    if unit != FOOT or features.crs is None or features.crs.is_geographic:
        return unit
    units = (features.crs.vertical_unit, features.crs.horizontal_unit)
    return US_SURVEY_FOOT if next(filter(None, units)) == US_SURVEY_FOOT else unit


def find_elevations(
    features: Features,
    z: Float64Array,
    has_z: BoolArray,
    rows: Int64Array,
    z_field: str | None,
) -> Elevations:
    """Find the elevation of each vertex, in the geometry or in a column.

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
        return _take_asked(features, z, has_z, rows, z_field)
    columns = _find_columns(features)
    if not has_z.any():
        return _take_column(features, columns, rows)
    z = _require_all(features, z, has_z, rows)
    require_absolute(features, has_z, rows, "z_field='geometry' takes them as they are")
    for name, values in columns.items():
        _require_same(features, z, values[rows], name, rows)
    return Elevations(z)


def _take_asked(
    features: Features,
    z: Float64Array,
    has_z: BoolArray,
    rows: Int64Array,
    name: str,
) -> Elevations:
    column = features.find_column(name)
    if column is None and name.lower() == GEOMETRY:
        if not has_z.any():
            raise ReadError(
                f"'{features.path}' has no elevations in its geometry.", path=features.path
            )
        return Elevations(_require_all(features, z, has_z, rows))
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
    return Elevations(values[rows], find_named_unit(name, features))


def describe_unused_columns(features: Features) -> list[str]:
    """Tell of columns of elevations beside lines without any, which are draped."""
    names = ", ".join(_find_columns(features))
    if not names:
        return []
    return [
        f"'{features.path.name}': the lines have no elevations in their geometry and are draped on "
        f"the surface; the column {names} is not used."
    ]


def require_absolute(features: Features, has_z: BoolArray, rows: Int64Array, remedy: str) -> None:
    """Refuse heights that KML says are above the ground, or are to be ignored.

    Parameters
    ----------
    features : Features
    has_z : (n,) bool array
        Whether a vertex has a height.
    rows : (n,) int array
        Feature of each vertex.
    remedy : str
        The option that settles it, and what it does.

    Raises
    ------
    ReadError
    """
    column = features.find_column(_ALTITUDE_MODE)
    if column is None:
        return
    modes = [str(mode or "") for mode in column.tolist()]
    relative = np.array([mode.rpartition(":")[2].lower() in _RELATIVE for mode in modes], np.bool_)
    wrong = has_z & relative[rows]
    if wrong.any():
        row = int(rows[np.argmax(wrong)])
        raise ReadError(
            f"{features.label(row)} has the altitudeMode '{modes[row]}': its heights are not "
            f"elevations but measured from the ground, or to be ignored; the option {remedy}.",
            path=features.path,
        )


def _require_all(
    features: Features,
    z: Float64Array,
    has_z: BoolArray,
    rows: Int64Array,
) -> Float64Array:
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


def _find_columns(features: Features) -> dict[str, Float64Array]:
    """Return the columns that hold elevations, by their names."""
    found = {}
    for name, column in features.columns.items():
        values = _as_numbers(column) if name.lower() in _NAMES else None
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


def _take_column(
    features: Features, columns: dict[str, Float64Array], rows: Int64Array
) -> Elevations:
    """Take the only column that can be meant; several that agree are one."""
    if not columns:
        known = ", ".join(features.names)
        raise ReadError(
            f"'{features.path}' has no elevations: none in the geometry, and "
            + (f"no column of numbers with such a name ({known}): " if known else "no column: ")
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
    unit = find_named_unit(name, features)
    told = "" if unit is None else f", in {unit.name} as its name says"
    note = f"Elevations are those of the column '{name}'{told}."
    return Elevations(values[rows], unit, (note,))


def _require_same(
    features: Features,
    z: Float64Array,
    values: Float64Array,
    name: str,
    rows: Int64Array,
) -> None:
    """Refuse a column of elevations that differs from the geometry."""
    with np.errstate(invalid="ignore"):
        differs = np.abs(values - z) > _SAME
    if differs.any():
        first = int(np.argmax(differs))
        raise ReadError(
            f"'{features.path}' has two elevations for each point that differ: "
            f"{height(z[first])} in "
            f"the geometry and {height(values[first])} in the column '{name}' (feature "
            f"{features.numbers[rows[first]]}): the option z_field chooses, '{GEOMETRY}' or "
            f"'{name}'.",
            path=features.path,
        )
