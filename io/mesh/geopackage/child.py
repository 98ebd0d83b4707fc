"""The tables of a GeoPackage of a TIN, as the child process reads them: nothing but tables."""

from __future__ import annotations

import json
import re
import sqlite3
from contextlib import closing
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.sentences import FILE
from ...isolated import Answer, Refusal
from .page_reading import decode_integers, read_columns
from .schema import (
    FORMER_NUMBERS,
    NUMBERS,
    POINT,
    RECORD,
    TRIANGLE,
    declare_layer,
    declare_numbers,
    digest_arrays,
    digest_lines,
)

if TYPE_CHECKING:
    from ....base.arrays import AnyArray, BoolArray, Float64Array

_TYPE = re.compile(r"[<|][bif][148]|\|u1")
_SHAPE = re.compile(r"[0-9]{1,12}( [0-9]{1,12}){0,2}")
_TRIANGLE = np.dtype([("corners", "i8", (3,)), ("flags", "i8")])
_READ_ONLY = {sqlite3.SQLITE_SELECT, sqlite3.SQLITE_READ, sqlite3.SQLITE_FUNCTION}


def read_tables(path: str) -> Answer:
    """Return points, triangles, flags and record of a file.

    The value holds the ``document`` and the ``digests`` as text, that of the ``lines``, and the
    names of the record's arrays; the arrays are ``points``, ``triangles``, ``flags`` and those of
    the record, each behind a space.
    """
    try:
        with closing(_open(path)) as file:
            table = _require_plain_tables(file)
            size = Path(path).stat().st_size
            texts, arrays = _read_record(file)
            lines = file.execute("SELECT geom, kind, name FROM lines ORDER BY fid")
            rows = [row for row in lines if [type(one) for one in row] == [bytes, str, str]]
            mesh = _read_as_written(path, file, table, texts["digests"])
            if mesh is None:
                triangles = _read_triangles(file, table, size)
                mesh = {
                    "points": _read_points(file),
                    "triangles": triangles["corners"].copy(),
                    "flags": triangles["flags"].copy(),
                }
            own = {f" {name}": array for name, array in arrays.items()}
            return Answer({**texts, "lines": digest_lines(rows)}, mesh | own)
    except (sqlite3.Error, OverflowError, UnicodeError) as error:
        raise Refusal(f"{FILE} is a damaged GeoPackage ({error}).") from error


def _open(path: str) -> sqlite3.Connection:
    file = sqlite3.connect(f"{Path(path).as_uri()}?mode=ro&immutable=1", uri=True)
    file.execute("PRAGMA trusted_schema = OFF")
    file.execute("PRAGMA cell_size_check = ON")
    return file


def _require_plain_tables(file: sqlite3.Connection) -> str:
    """Refuse views and virtual tables in place of tables; then allow reading only.

    Return the table of triangles, which may stand beside a view of that name.
    """
    rows = file.execute("SELECT name, type, sql FROM sqlite_master").fetchall()
    plain = {
        name
        for name, kind, sql in rows
        if kind == "table" and isinstance(sql, str) and re.match(r"CREATE\s+TABLE\b", sql, re.I)
    }
    table = NUMBERS if NUMBERS in plain and "triangles" not in plain else "triangles"
    missing = {"vertices", table, "lines", RECORD} - plain
    if missing:
        raise Refusal(f"{FILE} is no GeoPackage of a TIN: it has no table '{min(missing)}'.")
    file.set_authorizer(
        lambda action, *_: sqlite3.SQLITE_OK if action in _READ_ONLY else sqlite3.SQLITE_DENY
    )
    return table


def _read_as_written(
    path: str, file: sqlite3.Connection, table: str, digests: str
) -> dict[str, AnyArray] | None:
    """Return points, triangles and flags by the pages that hold them, if no other wrote to these.

    That they are what was written, their digest tells.
    """
    tables = {
        name: (sql, root)
        for name, sql, root in file.execute(
            "SELECT name, sql, rootpage FROM sqlite_master WHERE name IN ('vertices', ?)", (table,)
        )
    }
    is_compact = tables[table][0] in (declare_numbers(), FORMER_NUMBERS)
    is_whole = table == "triangles" and tables[table][0] == declare_layer(table)
    are_vertices = tables["vertices"][0].startswith(declare_layer("vertices")[:-1])
    if not (are_vertices and (is_compact or is_whole)):  # attributes may follow
        return None
    with Path(path).open("rb") as content:
        vertices = read_columns(content, tables["vertices"][1], [POINT.itemsize])
        polygons = [] if is_compact else [TRIANGLE.itemsize]
        triangles = read_columns(
            content, tables[table][1], [*polygons, 0, 0, 0, 0], skip=len(polygons)
        )
    if vertices is None or triangles is None:
        return None
    rows = vertices[0].view(POINT).ravel()
    if not _are_points(rows).all():
        return None
    points = np.ascontiguousarray(rows["xyz"])
    a, b, c, flags = (decode_integers(column) for column in triangles)
    corners = np.column_stack([a, b, c])
    constrained = (flags[:, None] & np.array([1, 2, 4])) != 0
    try:
        stated = json.loads(digests)
    except (ValueError, RecursionError):
        return None
    digest = digest_arrays(points, corners.astype(np.int32), constrained)
    if not isinstance(stated, dict) or stated.get("mesh") != digest:
        return None
    return {"points": points, "triangles": corners, "flags": flags}


def _read_points(file: sqlite3.Connection) -> Float64Array:
    blobs = []
    found = file.execute("SELECT vertex, geom FROM vertices ORDER BY vertex")
    for count, (number, blob) in enumerate(found):
        if number != count or not isinstance(blob, bytes) or len(blob) != POINT.itemsize:
            raise Refusal(f"layer 'vertices' has no point with z of number {count}.")
        blobs.append(blob)
    rows = np.frombuffer(b"".join(blobs), POINT)
    is_point = _are_points(rows)
    if not is_point.all():
        number = int(np.argmin(is_point))
        raise Refusal(f"layer 'vertices' has no point with z of number {number}.")
    return np.ascontiguousarray(rows["xyz"])


def _are_points(rows: AnyArray) -> BoolArray:
    found: BoolArray = (rows["magic"] == b"GP") & (rows["order"] == 1) & (rows["kind"] == 1001)
    return found


def _read_triangles(file: sqlite3.Connection, table: str, size: int) -> AnyArray:
    rows = file.execute(f"SELECT a, b, c, constrained FROM {table} ORDER BY fid")
    found = (((a, b, c), flags) for a, b, c, flags in islice(rows, size))
    try:
        return np.fromiter(found, _TRIANGLE)
    except (TypeError, ValueError) as error:
        raise Refusal(
            "layer 'triangles' has a column a, b, c or constrained that is no whole number."
        ) from error


def _read_record(file: sqlite3.Connection) -> tuple[dict[str, str], dict[str, AnyArray]]:
    texts, arrays = {}, {}
    for name, kind, shape, data in file.execute(f"SELECT name, type, shape, data FROM {RECORD}"):
        if kind == "json" and name in ("digests", "document") and isinstance(data, bytes):
            texts[name] = data.decode()
        elif _is_array(kind, shape, data):
            arrays[str(name)] = np.frombuffer(data, kind).reshape([int(n) for n in shape.split()])
        else:
            raise Refusal(f"the table '{RECORD}' is damaged at '{name}'.")
    if len(texts) < 2:
        raise Refusal(f"the table '{RECORD}' has no document.")
    return texts, arrays


def _is_array(kind: Any, shape: Any, data: Any) -> bool:
    if not (isinstance(kind, str) and isinstance(shape, str) and isinstance(data, bytes)):
        return False
    if not (_TYPE.fullmatch(kind) and _SHAPE.fullmatch(shape)):
        return False
    count = 1
    for axis in shape.split():
        count *= int(axis)
    return len(data) == count * np.dtype(kind).itemsize
