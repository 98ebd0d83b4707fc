"""Geometries of other libraries as breaklines, regions and water."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from ...base.errors import LinesError
from ...base.policies import BreaklineKind
from ...base.sentences import shown
from .breaklines import Breakline, Water, as_ring

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from ..validation import Geometries, Geometry

_LEVELS = ("z", "level", "elevation", "height")
"""Columns that hold the elevation of water, the same as in files."""


def convert_geometries(found: Geometries, what: str) -> list[Any]:
    """Return geometries as what they are given for, or raise LinesError.

    ``what`` is "breaklines", "water", or what regions are called.
    """
    convert = _CONVERTERS.get(what)
    return list(list_regions(found, what) if convert is None else convert(found))


def list_regions(found: Geometries, what: str) -> Iterator[list[Any]]:
    """Return the rings of each polygon, and of each closed line."""
    for part in found.parts:
        is_closed = part.kind == "LineString" and _is_closed(part.rings[0])
        if part.kind != "Polygon" and not is_closed:
            raise LinesError(f"Invalid {what.removesuffix('s')}: a {part.kind} is no polygon.")
        yield part.rings


def _is_closed(coords: Sequence[Any]) -> bool:
    return len(coords) > 3 and tuple(coords[0]) == tuple(coords[-1])


def _list_breaklines(found: Geometries) -> Iterator[Breakline]:
    """Return lines, and the rings of polygons, with the kind, priority and name of their row."""
    for part in found.parts:
        if part.kind not in ("LineString", "Polygon"):
            raise LinesError(f"Invalid breaklines: a {part.kind} is no line.")
        row = {name: _find_value(found, name, part.row) for name in ("kind", "priority", "name")}
        for ring in part.rings:
            yield Breakline(
                ring,
                kind=_as_kind(row["kind"], part.row),
                priority=_as_priority(row["priority"], part.row),
                name="" if row["name"] is None else str(row["name"]).strip(),
            )


def _find_value(found: Geometries, name: str, row: int) -> Any:
    """Return a value of a column, whatever the case of its name; None if there is none."""
    for column, values in found.columns.items():
        if column.casefold() == name:
            value = np.asarray(values, object)[row]
            return None if value is None or value != value else value
    return None


def _as_kind(value: Any, row: int) -> BreaklineKind:
    allowed: dict[str, BreaklineKind] = {kind: kind for kind in get_args(BreaklineKind)}
    chosen = allowed.get(str(value or "hard").strip().lower())
    if chosen is None:
        raise LinesError(
            f"The line in row {row} has the kind {shown(value)}: {' or '.join(allowed)}, or none, "
            "is allowed; geometries without the column are hard."
        )
    return chosen


def _as_priority(value: Any, row: int) -> int:
    try:
        number = float(0 if value is None else value)
    except (TypeError, ValueError, ArithmeticError):
        number = np.nan
    if number != np.rint(number):
        raise LinesError(
            f"The line in row {row} has the priority {shown(value)}: a whole number is needed."
        )
    return int(number)


def _list_water(found: Geometries) -> Iterator[Water]:
    """Return flat polygons, at the elevation of a column, or of their corners if all are equal."""
    for part in found.parts:
        if part.kind != "Polygon":
            raise LinesError(f"Invalid water: a {part.kind} is no polygon.")
        if len(part.rings) > 1:
            raise LinesError(
                f"The water in row {part.row} has an island, and a water polygon has one ring: cut "
                "the polygon in two along the island."
            )
        name = _find_value(found, "name", part.row)
        z = _find_level(found, part)
        yield Water(part.rings[0], z, name="" if name is None else str(name).strip())


def _find_level(found: Geometries, part: Geometry) -> float:
    values = {name: _find_value(found, name, part.row) for name in _LEVELS}
    levels = {name: value for name, value in values.items() if value is not None}
    if len(set(map(str, levels.values()))) > 1:
        raise LinesError(
            f"The water in row {part.row} has several columns that may hold its elevation, and "
            f"they differ: {', '.join(levels)}."
        )
    if levels:
        return _as_level(next(iter(levels.values())), part.row)
    ring = as_ring(part.rings[0], f"the ring of row {part.row}")
    if ring.shape[1] == 3 and np.ptp(ring[:, 2]) == 0:
        return float(ring[0, 2])
    has = "corners of several" if ring.shape[1] == 3 else "none"
    raise LinesError(
        f"The water in row {part.row} needs one elevation and has {has}: a column "
        f"({', '.join(_LEVELS)}), corners of one elevation, or tinsmith.Water give it."
    )


def _as_level(value: Any, row: int) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, ArithmeticError):
        raise LinesError(
            f"The water in row {row} has the elevation {shown(value)}: a number is needed."
        ) from None


_CONVERTERS: dict[str, Callable[[Geometries], Iterator[Any]]] = {
    "breaklines": _list_breaklines,
    "water": _list_water,
}
