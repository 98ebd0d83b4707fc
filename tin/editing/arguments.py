"""Arguments of edits: what a caller gave, checked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import LinesError, PointsError
from ...base.sentences import counted, shown
from .._kernel import LARGEST_ELEVATION
from ..constraints import Breakline, as_coords
from ..validation import (
    Table,
    as_elevations,
    as_points,
    as_table,
    as_vertex_array,
    clean_points,
    find_geometries,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array, Int64Array


def copy_argument(value: Any) -> Any:
    """Return an argument so that the caller's further use of it changes nothing."""
    if type(value) in (int, float, str):
        return value
    if isinstance(value, list):
        return [copy_argument(one) if isinstance(one, list) else one for one in value]
    return value.copy() if isinstance(value, np.ndarray) else value


def as_array(given: Any) -> Any:
    """Return points or a line with names, or of another library, as numbers that can be kept.

    Anything else, and what is no such table, is returned as it is, to be refused in its place.
    """
    line = find_geometries(given)
    if line is not None and any(part.kind != "Point" for part in line.parts):
        return as_coords(given, "a breakline", least=2)
    try:
        values, is_masked = as_table(given, "Points", least=2)
    except PointsError:
        return given
    return given if is_masked is not None else values


def as_vertices(vertices: ArrayLike, count: int) -> Int64Array:
    """Return vertex numbers below ``count``; none of an empty list."""
    only = vertices[0] if isinstance(vertices, list) and len(vertices) == 1 else vertices
    if type(only) is int and 0 <= only < count:  # most edits: no arrays for one number
        return np.array([only], np.int64)
    numbers = np.atleast_1d(as_vertex_array(vertices, count))
    if numbers.ndim != 1:
        raise PointsError(f"Invalid vertices {shown(vertices)}: whole numbers are needed.")
    return numbers


def as_new_points(points: ArrayLike) -> Float64Array:
    """Return points to insert; an empty list is none."""
    is_empty = isinstance(points, list | tuple) and not points
    return as_points(np.empty((0, 3)) if is_empty else points)


def as_breakline(line: Any) -> Breakline:
    """Return a line to add, given as one, as its coordinates, or as a mapping of its arguments."""
    if isinstance(line, Breakline):
        return line
    if not isinstance(line, Mapping):
        return Breakline(line)
    unknown = [name for name in line if name not in ("coords", "kind", "priority", "name")]
    if unknown or "coords" not in line:
        raise LinesError(
            f"A breakline has {', '.join(map(shown, line))}: coords are needed, and kind, priority "
            "and name are allowed."
        )
    return Breakline(**line)


def write_breakline(line: Any) -> dict[str, Any]:
    """Return a line as a mapping of its arguments, as edits are written down."""
    made = as_breakline(line)
    named = {"name": made.name} if made.name else {}
    kind, priority = made.kind, made.priority
    return {"coords": made.coords.tolist(), "kind": kind, "priority": priority, **named}


def scale_breakline(line: Breakline, factor: float) -> Breakline:
    """Return a line that is not draped, with its elevations times a factor."""
    coords = line.coords * (1.0, 1.0, factor)
    return Breakline(coords, kind=line.kind, priority=line.priority, name=line.name)


def as_ends(a: int, b: int, count: int) -> Int64Array:
    """Return the two ends of an edge."""
    ends = as_vertices([a, b], count)
    if ends[0] == ends[1]:
        raise PointsError("An edge has two different ends.")
    return ends


def require_distinct(vertices: Int64Array) -> Int64Array:
    """Refuse vertices that are named twice; return them."""
    if len(vertices) > 1 and len(np.unique(vertices)) < len(vertices):
        raise PointsError("A vertex is named twice: it can be removed once.")
    return vertices


def as_point(point: Any) -> Float64Array:
    """Return a point given alone, or as a table of one row."""
    values, is_masked = as_table(point, "Points")
    if is_masked is not None:
        raise PointsError("The point is masked: one, easting, northing, elevation, is needed.")
    rows = clean_points(Table(values[None] if values.ndim == 1 else np.atleast_2d(values))).values
    if len(rows) != 1:
        raise PointsError(
            f"There are {len(rows)} points: one, easting, northing, elevation, is needed."
        )
    row: Float64Array = rows[0]
    return row


def as_vertex_elevations(z: ArrayLike, count: int) -> list[float]:
    """Return the elevation of each of so many vertices, given one for all or one for each."""
    if type(z) is float and abs(z) <= LARGEST_ELEVATION:
        return [z + 0.0] * count
    elevations = as_elevations(z) + 0.0  # no -0.0
    if elevations.ndim == 1 and len(elevations) != count:
        raise PointsError(
            f"{counted(elevations.size, 'elevation')} for {counted(count, 'vertex', 'vertices')}: "
            "one each, or one for all, is needed."
        )
    values: list[float] = np.broadcast_to(elevations, count).tolist()
    return values
