"""Lines of DXF drawings as features, by the reader of drawings: blocks, arcs and elevations too."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING

import numpy as np

from ...base import optional
from ...base.errors import OptionError, ReadError
from ...base.sentences import FILE, counted
from ..cad.dxf.model_space import ModelSpace, read_model_space
from ..cad.dxf.names import ELEVATION_PROPERTY, UNKNOWN
from .layers import Layer

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import AnyArray, Int64Array, ObjectArray

__all__ = ["read_drawing_layer"]

_WHOLE = "entities"
"""What GDAL calls the one layer that it takes a drawing for."""

_MOST_STEPS = 1_000_000


def read_drawing_layer(
    path: Path, *, layer: str | None, where: str | None, lines_only: bool
) -> Layer:
    """Read the lines of a drawing, and its points unless they are not wanted.

    Parameters
    ----------
    path : Path
    layer : str, optional
        Names or patterns of layers, with commas between.
    where : str, optional
        Condition on the columns ``layer``, ``name`` and ``kind``, as in SQL.
    lines_only : bool

    Returns
    -------
    Layer
        With these columns; lines of plane entities without elevation have none.

    Raises
    ------
    MissingExtraError
        If ezdxf is not installed.
    ReadError
        If the file is damaged, there is nothing in it, or the condition is none.
    """
    try:
        drawing = read_model_space(path, layer=None if layer == _WHOLE else layer)
    except OptionError as error:
        raise ReadError(
            f"{FILE} has no layer '{layer}' with lines: there must be {error.allowed}."
        ) from error
    shapes, columns = _gather_shapes(drawing, lines_only=lines_only)
    notes = _describe_rest(drawing, lines_only=lines_only)
    kept = np.arange(len(shapes)) if where is None else _select_rows(columns, where)
    if len(kept) == 0:
        part = f" where {where}" if where is not None else " that are lines" * lines_only
        raise ReadError(f"{FILE} has no features{part}.")
    return Layer(
        path,
        kept,
        shapes[kept],
        {name: column[kept] for name, column in columns.items()},
        drawing.stated.crs,
        tuple(notes),
        elevation_unit=_find_elevation_unit(drawing),
    )


def _find_elevation_unit(drawing: ModelSpace) -> str:
    crs, unit = drawing.stated.crs, drawing.stated.unit
    if crs is None or unit is None or crs.horizontal_unit != unit:
        return ""
    return "" if dict(drawing.value["properties"]).get(ELEVATION_PROPERTY) == UNKNOWN else unit.text


def _gather_shapes(
    drawing: ModelSpace, *, lines_only: bool
) -> tuple[ObjectArray, dict[str, AnyArray]]:
    shapely = optional.load("shapely")
    shapes = [shapely.LineString(rows) for rows in drawing.lines]
    layers = drawing.arrays["line_layers"].tolist()
    stated = drawing.value["line_names"] or [[]] * len(shapes)
    stated = [[*one, "", ""][:2] for one in stated]
    if not lines_only:
        points = drawing.arrays["points"]
        shapes += list(shapely.points(points)) if len(points) else []
        layers += drawing.arrays["point_layers"].tolist()
        stated += [["", ""]] * len(points)
    columns = {
        "layer": [drawing.value["layers"][k] for k in layers],
        "name": [name for _, name in stated],
        "kind": [kind if kind in ("hard", "soft") else "" for kind, _ in stated],
    }
    packed = np.empty(len(shapes), object)
    packed[:] = shapes
    return packed, {name: np.array(column, object) for name, column in columns.items()}


def _describe_rest(drawing: ModelSpace, *, lines_only: bool) -> list[str]:
    name, arrays = drawing.path.name, drawing.arrays
    rest = [counted(len(arrays["faces"]), "face")] if len(arrays["faces"]) else []
    if lines_only and len(arrays["points"]):
        rest.append(counted(len(arrays["points"]), "point"))
    notes = [f"'{name}': not read: {' and '.join(rest)}."] if rest else []
    notes += [f"'{name}': {note}" for note in drawing.describe_left_out()]
    unit = drawing.stated.unit
    if unit is not None:
        notes.append(f"'{name}': coordinates are taken as they are, $INSUNITS says {unit.name}.")
    return notes


def _select_rows(columns: dict[str, AnyArray], where: str) -> Int64Array:
    """Return the rows that a condition chooses, by SQLite on a table in memory."""
    names = ", ".join(columns)
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    with closing(sqlite3.connect(":memory:")) as base:
        base.execute(f"CREATE TABLE drawing ({names})")
        marks = ", ".join("?" * len(columns))
        base.executemany(f"INSERT INTO drawing VALUES ({marks})", rows)
        base.set_progress_handler(lambda: 1, _MOST_STEPS * 100)
        try:
            found = base.execute(f"SELECT rowid FROM drawing WHERE ({where}) ORDER BY rowid")
            return np.array([row[0] - 1 for row in found], np.int64)
        except (sqlite3.Error, sqlite3.Warning) as error:
            raise ReadError(
                f"the condition {where!r} is none on the columns {names}: {error}."
            ) from error
