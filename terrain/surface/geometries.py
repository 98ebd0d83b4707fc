"""Geometries: points, lines and polygons as callers give them become Features, or places."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.checks import is_collection
from ...base.crs import CRS
from ...base.errors import LinesError, PointsError
from ...base.georeference import require_same_crs
from ...base.results import Features
from ...base.sentences import counted, shown
from ...tin import Breakline, validation
from ...tin.building import find_crs
from ...tin.constraints import as_coords
from ...tin.topology import find_offsets
from ...tin.validation import find_geometries, has_coordinates, require_exact_range

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, Float64Array
    from ...tin import TIN
    from ...tin.validation import Geometries

_KINDS = {"Point": "points", "LineString": "lines", "Polygon": "polygons"}
_LEAST = {"points": 1, "lines": 2, "polygons": 4}
"""Vertices of a piece; a ring repeats its first."""


class _Item(NamedTuple):
    """One feature: its kind, its parts, each as pieces (a ring is one) of coordinates."""

    kind: str
    parts: list[list[Any]]
    properties: Mapping[str, Any]


def as_features(given: Any, what: str = "line") -> Features:
    """Return geometries as features of one kind.

    They are Features, a Breakline, a (k, 2) or (k, 3) array, which is a polyline, a geometry of
    shapely, a GeoDataFrame, or whatever has a ``__geo_interface__``, or a sequence of these.
    ``what`` is what one of them is called in sentences.

    Raises LinesError if it is something else, of several kinds, empty, or has coordinates that are
    not finite; CrsError if the CRS that it names is unknown.
    """
    if isinstance(given, Features):
        features = given
    else:
        items = list(_walk(given, what))
        features = _gather(items, CRS.of(getattr(given, "crs", None)), what)
    if len(features.coordinates) == 0:
        raise LinesError(f"There is no {what}: at least one is needed.")
    try:
        require_exact_range(features.coordinates[:, :2], f"Vertices of a {what}")
    except PointsError as error:
        raise LinesError(str(error)) from None
    return features


# ---------------------------------------------------------------- what is given


def _walk(given: Any, what: str) -> Iterator[_Item]:
    """Take apart what is given; features keep their properties."""
    if isinstance(given, Breakline):
        yield _as_line(given.coords, what)
    elif (found := find_geometries(given)) is not None:
        yield from _take_geometries(found, what)
    elif _is_one_line(given):
        yield _as_line(given, what)
    elif is_collection(given) and not isinstance(given, Mapping):
        for one in given:
            if not (_is_one_line(one) or isinstance(one, Breakline) or find_geometries(one)):
                raise _refuse(one, what)
            yield from _walk(one, what)
    else:
        raise _refuse(given, what)


def _refuse(given: Any, what: str) -> LinesError:
    return LinesError(
        f"Invalid {what} {shown(given)}: a (k, 2) array, a Breakline, Features, or a geometry "
        "is needed."
    )


def _is_one_line(given: Any) -> bool:
    """Whether it is a table of numbers: of columns, of two dimensions, or rows of numbers."""
    if has_coordinates(given):
        return True
    if isinstance(given, np.ndarray) and given.dtype != object:
        return given.ndim == 2
    if hasattr(given, "columns") or not isinstance(given, Sequence) or isinstance(given, str):
        return hasattr(given, "columns")
    first = given[0] if len(given) else None
    if not isinstance(first, Sequence | np.ndarray) or isinstance(first, str):
        return False
    return len(first) > 0 and not isinstance(first[0], Sequence | np.ndarray)


def _as_line(coords: Any, what: str) -> _Item:
    return _Item("lines", [[as_coords(coords, f"a {what}", least=2)]], {})


def _take_geometries(found: Geometries, what: str) -> Iterator[_Item]:
    """Make an item of the geometries of a row, which are of one kind."""
    empty = set(range(found.rows)) - {part.row for part in found.parts}
    if empty:
        raise LinesError(f"The {what} in row {min(empty)} has no coordinates.")
    for (row, kind), parts in groupby(found.parts, key=lambda part: (part.row, part.kind)):
        if kind not in _KINDS:
            raise LinesError(f"Invalid {what}: a geometry of type {shown(kind)} has no place here.")
        name = _KINDS[kind]
        tables = [
            [as_coords(ring, f"a {what}", least=_LEAST[name]) for ring in part.rings]
            for part in parts
        ]
        yield _Item(name, tables, {key: column[row] for key, column in found.columns.items()})


# ---------------------------------------------------------------- as features


def _gather(items: list[_Item], crs: CRS | None, what: str) -> Features:
    kinds = sorted({item.kind for item in items})
    if len(kinds) > 1:
        raise LinesError(f"There are {' and '.join(kinds)} together: give one kind at a time.")
    if not items:
        raise LinesError(f"There is no {what}: at least one is needed.")
    if kinds == ["points"]:
        items = [item._replace(parts=[part]) for item in items for part in item.parts]
    pieces = [piece for item in items for part in item.parts for piece in part]
    width = min(piece.shape[1] for piece in pieces)
    coordinates = np.concatenate([piece[:, :width] for piece in pieces])
    of_items = find_offsets([len(item.parts) for item in items])
    of_parts = find_offsets([len(part) for item in items for part in item.parts])
    of_pieces = find_offsets([len(piece) for piece in pieces])
    has_parts = any(len(item.parts) > 1 for item in items)
    levels = {"points": (), "lines": (of_pieces,), "polygons": (of_pieces, of_parts)}[kinds[0]]
    rows = [item.properties for item in items]
    names = dict.fromkeys(str(name) for row in rows for name in row)
    return Features(
        kind=kinds[0],  # type: ignore[arg-type]
        coordinates=coordinates,
        offsets=(*levels, of_items) if has_parts else levels,
        columns={name: _as_column([row.get(name) for row in rows]) for name in names},
        crs=crs,
    )


def _as_column(values: list[Any]) -> AnyArray:
    """Return values as truth values, whole numbers, numbers, or else as texts."""
    plain = [value.item() if isinstance(value, np.generic) else value for value in values]
    kinds = {type(value) for value in plain}
    if kinds == {bool} or (kinds == {int} and max(map(abs, plain)) < 2**63):
        return np.array(plain)
    if kinds <= {int, float, type(None)} and kinds != {type(None)}:
        return np.array([np.nan if value is None else value for value in plain], float)
    return np.array([None if value is None else str(value) for value in plain], object)


def as_places(tin: TIN, points: Any, what: str) -> tuple[Float64Array, tuple[str, ...]]:
    """Return places on a surface, (k, 2), and what was assumed of them.

    They are one place or several, as arrays, shapes, data frames or Features.

    Raises CrsError if their CRS is another one. Raises PointsError if there is none, or one lies
    outside the surface.
    """
    is_named = isinstance(points, Features)
    if is_named and points.kind != "points":
        raise PointsError(f"Points are needed for {what}, and there are {points.kind}.")
    notes = require_same_crs(find_crs(points), tin.crs, what, is_plain=not is_named)
    if is_named:
        notes += tuple(points.notes)
        points = points.coordinates[:, :2]
    xy = validation.as_places(points)[0] + 0.0
    if len(xy) == 0:
        raise PointsError(f"There is no point for {what}: at least one is needed.")
    outside = np.flatnonzero(tin.locate(xy) < 0)
    if len(outside):
        first = int(outside[0])
        raise PointsError(
            f"{len(outside):,} of {counted(len(xy), 'point')} for {what} "
            f"{'lies' if len(outside) == 1 else 'lie'} outside the surface (first: number {first}, "
            f"at {tuple(xy[first].tolist())}).",
            rows=outside[:5],
        )
    return xy, notes
