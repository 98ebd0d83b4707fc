"""Edits of a TIN from a table: a row for each point or vertex, with what is done to it."""

from __future__ import annotations

import csv
import io
from itertools import groupby
from typing import TYPE_CHECKING, Any, NamedTuple

from ..base.sentences import shown
from .output import Failure

if TYPE_CHECKING:
    from pathlib import Path

_ALIASES = {"easting": "x", "northing": "y", "elevation": "z", "operation": "op"}
_WHOLE = ("vertex", "a", "b", "number", "priority")
_TEXT = ("op", "line", "name", "kind")
_NUMBERS = ("x", "y", "z")
_NEEDS = {
    "insert": ("x", "y", "z"),
    "remove": ("vertex",),
    "move": ("vertex", "x", "y", "z"),
    "set_elevation": ("vertex", "z"),
    "flip": ("a", "b"),
    "add_breakline": ("x", "y"),
    "remove_breakline": ("number",),
}
"""Columns that each edit needs."""
_MAY_HAVE = {"add_breakline": ("z", "line", "name", "kind", "priority")}
"""Columns that it takes besides."""


class _Row(NamedTuple):
    where: str
    op: str
    values: dict[str, Any]

    @property
    def group(self) -> tuple[str, ...]:
        """What rows that are one edit have in common: those of one line, or of one operation."""
        if self.op == "add_breakline":
            return self.op, self.values.get("line", "")
        return (self.op,) if self.op in ("insert", "remove", "set_elevation") else (self.where,)


def read_edit_table(text: str, path: Path) -> list[dict[str, Any]]:
    """Return the edits of a table, as those of a script.

    The columns are op, and what the edits need: x, y, z (or easting, northing, elevation), vertex,
    a, b, number, line, name, kind, priority. Rows one behind the other that insert, remove or set
    elevations are one edit, and so are those that add a breakline and have the same line.

    Raises
    ------
    Failure
        If a column or an operation is unknown, or a value is missing, too much or no number.
    """
    first = text.partition("\n")[0]
    table = csv.reader(io.StringIO(text), delimiter=max(",;\t", key=first.count))
    header = [one.strip().lower() for one in next(table, [])]
    header = [_ALIASES.get(name, name) for name in header]
    known = (*_TEXT, *_NUMBERS, *_WHOLE)
    wrong = [name for name in header if name not in known]
    if "op" not in header or wrong or len(set(header)) < len(header):
        found = f"the column {shown(wrong[0])}" if wrong else "no column op, or one twice"
        raise Failure(f"'{path}' has {found}: a table of edits has {', '.join(known)}.")
    rows = [
        _read_row(header, row, f"'{path}', line {table.line_num}")
        for row in table
        if any(map(str.strip, row))
    ]
    return [_make_edit([*group]) for _, group in groupby(rows, key=lambda row: row.group)]


def _read_row(header: list[str], row: list[str], where: str) -> _Row:
    if len(row) > len(header):
        raise Failure(f"{where}: there are {len(row)} values for {len(header)} columns.")
    given = dict(zip(header, map(str.strip, row), strict=False))
    filled = {name: text for name, text in given.items() if text}
    op = filled.pop("op", "")
    if op not in _NEEDS:
        raise Failure(f"{where}: op is {shown(op)}: one of {', '.join(_NEEDS)} is needed.")
    missing = [name for name in _NEEDS[op] if name not in filled]
    more = [name for name in filled if name not in (*_NEEDS[op], *_MAY_HAVE.get(op, ()))]
    if missing or more:
        fault = f"{missing[0]} is missing" if missing else f"{more[0]} is not for it"
        raise Failure(f"{where}: {op} needs {', '.join(_NEEDS[op])}, and {fault}.")
    return _Row(where, op, {name: _read_value(name, text, where) for name, text in filled.items()})


def _read_value(name: str, text: str, where: str) -> Any:
    if name in _TEXT:
        return text
    try:
        return int(text) if name in _WHOLE else float(text)
    except ValueError:
        kind = "a whole number" if name in _WHOLE else "a number"
        raise Failure(f"{where}: {name} is {shown(text)}: {kind} is needed.") from None


def _make_edit(rows: list[_Row]) -> dict[str, Any]:
    """Return the edit of some rows, as scripts have it."""
    op, first = rows[0].op, rows[0].values
    if op == "insert":
        return {"op": op, "points": _list_places(rows)}
    if op == "add_breakline":
        columns: tuple[str, ...] = ("name", "kind", "priority")
        named = {name: first[name] for name in columns if name in first}
        return {"op": op, "coords": _list_places(rows), **named}
    if op == "move":
        return {"op": op, "vertex": first["vertex"], "point": _list_places(rows)[0]}
    if op in ("remove", "set_elevation"):
        z = {} if op == "remove" else {"z": [row.values["z"] for row in rows]}
        return {"op": op, "vertices": [row.values["vertex"] for row in rows], **z}
    return {"op": op, **first}


def _list_places(rows: list[_Row]) -> list[list[float]]:
    """Return the coordinates of rows, of a line that is draped without elevations."""
    axes = [name for name in _NUMBERS if name in rows[0].values]
    for row in rows:
        if [name for name in _NUMBERS if name in row.values] != axes:
            raise Failure(f"{row.where}: all vertices of a line have elevations, or none has.")
    return [[row.values[name] for name in axes] for row in rows]
