"""Geometries of other libraries: shapely's, GeoPandas', and whatever has a ``__geo_interface__``.

None of the libraries is imported: what a value is can be told by its attributes, and nobody has a
geometry of shapely without its module loaded.

References
----------
S. Gillies, "A Python Protocol for Geospatial Data", 2008, https://gist.github.com/sgillies/2217756.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...base.optional import find_loaded

MISSING = "missing geometry"
"""The kind of a row without a geometry."""

_NESTING = {"Point": -1, "LineString": 0, "LinearRing": 0, "Polygon": 1}
"""Levels of lists around the vertices of a geometry."""

_GROUPS = {"FeatureCollection": "features", "GeometryCollection": "geometries"}
_TYPES = {*_NESTING, *_GROUPS, *(f"Multi{name}" for name in _NESTING), "Feature"}


class Geometry(NamedTuple):
    """A geometry that is no collection."""

    kind: str
    """"Point", "LineString", "Polygon", "missing geometry", or another type that is none of these.
    """
    rings: list[Any]
    """list of (k, 2) or (k, 3) arrays, of a polygon the outer ring, then those of its islands; of a
    point or a line one array."""
    row: int
    """The row that it is, or is a part of."""


class Geometries(NamedTuple):
    """Geometries, the columns of their rows, and how many rows; what is empty is left out."""

    parts: list[Geometry]
    columns: Mapping[str, Sequence[Any]]
    rows: int


def is_plain(given: Any) -> bool:
    """Tell what is surely no geometry: arrays of numbers, and rows of them."""
    if type(given) is np.ndarray:
        return bool(given.dtype != object)
    if type(given) in (list, tuple):
        return not given or type(given[0]) in (list, tuple, float, int) or is_plain(given[0])
    return given is None or isinstance(given, str | bytes | int | float)


def find_geometries(given: Any) -> Geometries | None:
    """Return the geometries that a value is or holds, None of anything else.

    Parameters
    ----------
    given : object
        A geometry of shapely, a sequence of them, a GeoSeries or GeoDataFrame, an object with a
        ``__geo_interface__``, or a mapping as such a one has it.

    Examples
    --------
    >>> line = {"type": "MultiLineString", "coordinates": [[[0, 0], [1, 1]], [[2, 2], [3, 3]]]}
    >>> [part.kind for part in find_geometries(line).parts]
    ['LineString', 'LineString']
    >>> find_geometries([[0, 0], [1, 1]]) is None
    True
    """
    if is_plain(given):
        return None
    shapely = find_shapely()
    if shapely is not None:
        rows = _list_rows(shapely, given)
        if rows is not None:
            parts = [part for k, row in enumerate(rows) for part in _walk(shapely, row, k)]
            return Geometries(parts, _find_columns(given), len(rows))
    interface = given if isinstance(given, Mapping) else getattr(given, "__geo_interface__", None)
    if isinstance(interface, Mapping) and interface.get("type") in _TYPES:
        return _read_interface(interface)
    return None


def find_shapely() -> Any:
    """Return the module of shapely if it is loaded."""
    return find_loaded("shapely", "Geometry", "get_type_id", "is_empty", "get_coordinates")


def _list_rows(shapely: Any, given: Any) -> Sequence[Any] | None:
    """Return geometries of shapely, None for a missing one; None if there are none."""
    if isinstance(given, shapely.Geometry):
        return [given]
    column = getattr(given, "geometry", given)
    is_row = isinstance(column, list | tuple) or getattr(column, "ndim", 0) == 1
    if not is_row or getattr(column, "dtype", object) in (np.float64, np.int64):
        return None
    rows: list[Any] = list(column)
    first = next((row for row in rows if row is not None), None)
    if not isinstance(first, shapely.Geometry):
        return None
    return [row if isinstance(row, shapely.Geometry) else None for row in rows]


def _find_columns(given: Any) -> Mapping[str, Sequence[Any]]:
    names = getattr(given, "columns", None)
    if names is None or callable(names):
        return {}
    return {str(name): list(given[name]) for name in names if name != given.geometry.name}


def _walk(shapely: Any, geometry: Any, row: int) -> Iterator[Geometry]:
    """Take a geometry of shapely apart, without recursion."""
    pending = [geometry]
    while pending:
        one = pending.pop()
        if one is None:
            yield Geometry(MISSING, [], row)
        elif hasattr(one, "geoms"):
            pending.extend(reversed(one.geoms))
        elif not one.is_empty:
            kind = "LineString" if one.geom_type == "LinearRing" else one.geom_type
            rings = [one.exterior, *one.interiors] if kind == "Polygon" else [one]
            has_z = bool(one.has_z)
            arrays = [np.array(shapely.get_coordinates(ring, include_z=has_z)) for ring in rings]
            yield Geometry(kind, arrays, row)


def _read_interface(interface: Mapping[str, Any]) -> Geometries:
    """Take a mapping apart: the members of a collection of features are rows, else it is one."""
    is_collection = interface["type"] == "FeatureCollection"
    features = list(interface["features"]) if is_collection else [interface]
    parts = [part for row, one in enumerate(features) for part in _walk_mapping(one, row)]
    properties = [(one or {}).get("properties") or {} for one in features]
    names = dict.fromkeys(name for one in properties for name in one)
    columns = {str(name): [one.get(name) for one in properties] for name in names}
    return Geometries(parts, columns, len(features))


def _walk_mapping(given: Any, row: int) -> Iterator[Geometry]:
    pending = [given]
    while pending:
        geometry = pending.pop(0) or {"type": MISSING}
        kind = str(geometry["type"])
        if kind == "Feature":
            pending.insert(0, geometry["geometry"])
        elif kind in _GROUPS:
            pending[:0] = geometry[_GROUPS[kind]]
        elif kind.removeprefix("Multi") in _NESTING:
            yield from _read_coordinates(kind, geometry["coordinates"], row)
        else:
            yield Geometry(kind, [], row)


def _read_coordinates(kind: str, coordinates: Any, row: int) -> Iterator[Geometry]:
    name = kind.removeprefix("Multi")
    level = _NESTING[name]
    for part in coordinates if kind != name else [coordinates]:
        if len(part) == 0:
            continue
        rings = list(part) if level == 1 else [[part] if level < 0 else part]
        yield Geometry("LineString" if name == "LinearRing" else name, rings, row)
